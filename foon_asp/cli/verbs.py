"""The verbs of the command line, by heading of the help."""

import importlib
from collections.abc import Mapping, Sequence
from typing import Final

import click

from foon_asp.questions.index import INDEX, Entry

FOR_PROGRAMS = "For programs"
SHELL_REQUEST = "_FOON_ASP_COMPLETE"
"""The environment variable by which a shell asks for completions; click determines its name."""

# Verbs without a question, and those whose question is not in the catalog.
_OTHER_VERBS: Final[Mapping[str, Entry]] = {
    "batch": Entry("Solve", "Answer every question of a file, thousands in one run."),
    "init": Entry("Data", "Write a data folder to start from: your recipe, or an example."),
    "lint": Entry("Data", "Find errors and doubtful places in FOON files."),
    "fmt": Entry("Data", "Bring FOON files into canonical form."),
    "convert": Entry("Data", "Write FOON files in another dialect."),
    "merge": Entry("Data", "Merge FOONs into a universal FOON, or into a store."),
    "facts": Entry("Tools", "Print the facts that clingo is given for a goal."),
    "encodings": Entry("Tools", "Print where the answer-set programs are, or copy them to edit."),
    "constraints": Entry("Tools", "List the ready-made constraints."),
    "help": Entry("Tools", "List all verbs, or explain one."),
    "rename": Entry(FOR_PROGRAMS, "Rename an object, a state or a motion in all files."),
    "schema": Entry(FOR_PROGRAMS, "Print the JSON Schema of what a verb prints with --format json."),
    "completion": Entry(FOR_PROGRAMS, "Print a script by which a shell completes verbs, options and names."),
    "lsp": Entry(FOR_PROGRAMS, "Serve an editor: findings while typing, completion, renaming and more."),
}
VERBS: Final[Mapping[str, Entry]] = {**INDEX, **_OTHER_VERBS}
GROUPS = ("Solve", "Explain", "Compare", "Data", "Prove", "Tools", FOR_PROGRAMS)
FIRST_VERBS = ("solve", "view", "compare", "why-not", "check", "alternatives", "schedule", "lint", "init")


def verb_command(verb: str) -> click.Command:
    """Import the module of a verb, and return its command."""
    if verb in INDEX:
        from foon_asp.cli.question_command import question_command

        return question_command(verb)
    module = importlib.import_module(f"foon_asp.cli.{verb.replace('-', '_')}_command")
    command: click.Command = module.command
    return command


def verbs_of(group: str) -> Sequence[str]:
    """Return the verbs under a heading of the help, in the order in which the help lists them."""
    return [verb for verb, entry in VERBS.items() if entry.group == group]


def write_verbs(formatter: click.HelpFormatter, heading: str, verbs: Sequence[str]) -> None:
    """Write verbs under a heading into the help, each with one line that explains it."""
    with formatter.section(heading):
        formatter.write_dl([(verb, VERBS[verb].line) for verb in verbs])
