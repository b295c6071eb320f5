"""The verbs of the command line under headings: the questions of the catalog, and work with files."""

import importlib
from collections.abc import Mapping
from typing import Final

import click

from foon_asp.questions.index import INDEX, Entry

# Verbs that ask nothing, and those whose question is not in the catalog.
_OTHERS: Final[Mapping[str, Entry]] = {
    "batch": Entry("Solve", "Answer every question of a file, thousands in one run."),
    "shell": Entry("Tools", "Read the data once, then ask and change the question line by line."),
    "stats": Entry("Data", "Count what is in a network."),
    "facts": Entry("Tools", "Print the facts that clingo is given for a goal."),
    "encodings": Entry("Tools", "Print where the answer-set programs are, or copy them to edit."),
    "constraints": Entry("Tools", "List the ready-made constraints."),
    "completion": Entry("Tools", "Print a script by which a shell completes verbs, options and names."),
    "schema": Entry("Tools", "Print the JSON Schema of what a verb prints with --format json."),
    "init": Entry("Data", "Write a data folder to start from, of a recipe of yours or a small one of ours."),
    "lint": Entry("Data", "Find what is wrong with networks, kitchens and lists of objects."),
    "vocabulary": Entry("Data", "Learn the names of FOONs, against which lint holds other files."),
    "fmt": Entry("Data", "Bring FOON files into canonical form."),
    "lsp": Entry("Tools", "Serve an editor: findings while typing, completion, renaming and more."),
    "rename": Entry("Data", "Rename an object, a state or a motion everywhere, and show the change first."),
    "convert": Entry("Data", "Write FOON files in another dialect."),
    "merge": Entry("Data", "Merge FOONs into a universal FOON."),
    "import": Entry("Data", "Merge networks into a store, for networks too large to read."),
}
VERBS: Final[Mapping[str, Entry]] = {**INDEX, **_OTHERS}
GROUPS = ("Solve", "Explain", "Compare", "Data", "Prove", "Tools")
_MODULES = {"import": "import_files"}  # of verbs that cannot be the name of a module


def verb_command(verb: str) -> click.Command:
    """Give the command of a verb; its module is imported only then."""
    if verb in INDEX:
        from foon_asp.cli.question_command import question_command

        return question_command(verb)
    module = _MODULES.get(verb, verb.replace("-", "_"))
    command: click.Command = importlib.import_module(f"foon_asp.cli.{module}").command
    return command
