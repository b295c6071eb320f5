"""The ready-made constraints for people and for programs."""

import shlex
from collections.abc import Iterator, Sequence

from foon_asp.document.json_document import document
from foon_asp.rules.constraint_library import LibraryConstraint
from foon_asp.text.json_value import Json


def constraint_lines(constraints: Sequence[LibraryConstraint]) -> Iterator[str]:
    """Return for each constraint its name, what it demands, and how it is called."""
    for number, constraint in enumerate(constraints):
        call = f"--constraint {constraint.name}"
        for parameter in constraint.parameters:
            call += f" -c {parameter.name}={shlex.quote(parameter.example)}"
        yield from ([""] if number else [])
        yield from (constraint.name, f"    {constraint.purpose}", f"  {call}")


def constraints_json(constraints: Sequence[LibraryConstraint]) -> Json:
    """Give each; an own value of ``null`` means that the parameter is not set by the file."""
    listed = [constraint._asdict() | {"file": str(constraint.file)} for constraint in constraints]
    for each in listed:
        each["parameters"] = [parameter._asdict() for parameter in each["parameters"]]
        for parameter in each["parameters"]:
            if parameter["own_value"] in {'""', "#sup", "#inf"}:
                parameter["own_value"] = None
    return document("constraints", constraints=listed)
