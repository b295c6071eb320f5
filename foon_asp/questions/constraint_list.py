"""The ready-made constraints: what each demands, and how it is called."""

import shlex
from collections.abc import Iterator

from foon_asp.json_layout import schema_name
from foon_asp.results.document import Document
from foon_asp.results.table import Block
from foon_asp.results.values import Value
from foon_asp.rules.constraint_library import library_constraints

_NOT_SET = frozenset({'""', "#sup", "#inf"})


class ConstraintParameter(Value, frozen=True):
    """A constant of a constraint.

    Attributes:
        own_value: The value that the file sets; null if it sets none.
        example: A value, as it is written in a command.
    """

    name: str
    own_value: str | None
    example: str


class ReadyMadeConstraint(Value, frozen=True):
    """A constraint that comes with the program.

    Attributes:
        purpose: What it demands of a tree.
    """

    name: str
    file: str
    title: str
    purpose: str
    parameters: tuple[ConstraintParameter, ...]


class ConstraintList(Document, frozen=True, kw_only=True, tag=schema_name("constraints")):
    """The ready-made constraints."""

    ROWS = "constraints"

    constraints: tuple[ReadyMadeConstraint, ...]

    def show(self) -> Iterator[Block]:
        """Yield the name, the meaning and the usage of each constraint."""
        for number, constraint in enumerate(self.constraints):
            call = f"--constraint {constraint.name}"
            for parameter in constraint.parameters:
                call += f" -c {parameter.name}={shlex.quote(parameter.example)}"
            yield from ([""] if number else [])
            yield from (constraint.name, f"    {constraint.purpose}", f"  {call}")


def list_constraints() -> ConstraintList:
    """Return the ready-made constraints, in order of name."""
    listed = []
    for name, file, title, purpose, parameters in library_constraints():
        constants = tuple(
            ConstraintParameter(parameter, None if value in _NOT_SET else value, example)
            for parameter, value, example in parameters
        )
        listed.append(ReadyMadeConstraint(name, str(file), title, purpose, constants))
    return ConstraintList(constraints=tuple(listed))
