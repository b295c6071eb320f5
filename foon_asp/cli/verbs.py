"""The verbs of the command line, and the module that has each."""

import importlib

import click

VERBS = (
    "solve",
    "optima",
    "search",
    "compare",
    "batch",
    "check",
    "certify",
    "verify",
    "draw",
    "why-not",
    "shopping-list",
    "clash",
    "alternatives",
    "pareto",
    "regret",
    "menu",
    "assist",
    "diff",
    "shell",
    "constraints",
    "facts",
    "stats",
    "lint",
    "fmt",
    "convert",
    "merge",
    "import",
)
_MODULES = {"import": "import_files"}  # of verbs that cannot be the name of a module


def verb_command(verb: str) -> click.Command:
    """Give the command of a verb; its module is imported only then."""
    module = _MODULES.get(verb, verb.replace("-", "_"))
    command: click.Command = importlib.import_module(f"foon_asp.cli.{module}").command
    return command
