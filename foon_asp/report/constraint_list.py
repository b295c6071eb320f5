"""The ready-made constraints for people and for programs."""

import shlex
import textwrap
from collections.abc import Sequence

from foon_asp.document.json_document import document
from foon_asp.report.stacked import columns
from foon_asp.rules.constraint_library import LibraryConstraint
from foon_asp.text.json_value import Json

_WIDTH = 100


def constraints_text(constraints: Sequence[LibraryConstraint]) -> str:
    """Give of each its name, what it demands, and how it is called."""
    blocks = []
    for constraint in constraints:
        call = f"--constraint {constraint.name}"
        for parameter in constraint.parameters:
            call += f" -c {parameter.name}={shlex.quote(parameter.example)}"
        purpose = textwrap.wrap(constraint.purpose, columns(_WIDTH) - 4)
        blocks.append("\n".join([constraint.name, *(f"    {line}" for line in purpose), f"  {call}"]))
    return "\n\n".join(blocks) + "\n"


def constraints_json(constraints: Sequence[LibraryConstraint]) -> Json:
    """Give each; an own value of ``null`` means that the parameter is not set by the file."""
    listed = [constraint._asdict() | {"file": str(constraint.file)} for constraint in constraints]
    for each in listed:
        each["parameters"] = [parameter._asdict() for parameter in each["parameters"]]
        for parameter in each["parameters"]:
            if parameter["own_value"] in {'""', "#sup", "#inf"}:
                parameter["own_value"] = None
    return document("constraints", constraints=listed)
