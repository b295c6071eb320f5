"""The verbs of the command line under headings: the questions of the catalog, and work with files."""

import importlib
from collections.abc import Mapping
from typing import Final

import click

from foon_asp.questions.index import INDEX, Entry

# Verbs that ask nothing, and those whose question is not in the catalog.
_OTHERS: Final[Mapping[str, Entry]] = {
    "batch": Entry("Find", "Answer every question of a file, thousands in one run."),
    "shell": Entry("Find", "Read the data once, then ask and change the question line by line."),
    "stats": Entry("Show", "Count what is in a network."),
    "facts": Entry("Show", "Print the facts that clingo is given for a goal."),
    "encodings": Entry("Show", "Print where the answer-set programs are, or copy them to edit."),
    "constraints": Entry("Show", "List the ready-made constraints."),
    "schema": Entry("Show", "Print the JSON Schema of what a verb prints with --format json."),
    "init": Entry("Files", "Write a data folder to start from, of a recipe of yours or a small one of ours."),
    "lint": Entry("Files", "Find what is wrong with networks, kitchens and lists of objects."),
    "fmt": Entry("Files", "Bring FOON files into canonical form."),
    "convert": Entry("Files", "Write FOON files in another dialect."),
    "merge": Entry("Files", "Merge FOONs into a universal FOON."),
    "import": Entry("Files", "Merge networks into a store, for networks too large to read."),
}
VERBS: Final[Mapping[str, Entry]] = {**INDEX, **_OTHERS}
GROUPS = ("Find", "Check", "Explain", "Plan", "Show", "Files")
_MODULES = {"import": "import_files"}  # of verbs that cannot be the name of a module


def verb_command(verb: str) -> click.Command:
    """Give the command of a verb; its module is imported only then."""
    if verb in INDEX:
        from foon_asp.cli.question_command import question_command

        return question_command(verb)
    module = _MODULES.get(verb, verb.replace("-", "_"))
    command: click.Command = importlib.import_module(f"foon_asp.cli.{module}").command
    return command
