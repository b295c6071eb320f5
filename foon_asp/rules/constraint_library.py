"""The ready-made constraints, as the comments in their files describe them."""

import re
from pathlib import Path
from typing import NamedTuple

from foon_asp.encoding.encoding import read_encoding
from foon_asp.resources import encodings_folder

_SECTION = re.compile(r"(\w+): +(\S.*)$")


class Parameter(NamedTuple):
    """A parameter of a constraint, which is a ``#const`` of its file.

    ``own_value`` is its default as written; ``""``, ``#sup`` and ``#inf`` stand for "not set". ``example`` is
    the value in the example call of the file, empty if no example call sets it.
    """

    name: str
    own_value: str
    example: str


class LibraryConstraint(NamedTuple):
    """A ready-made constraint: a file of ``encodings/constraints``, and what its comment says.

    ``name`` is the name of the file without ``.lp``. ``purpose`` tells what the constraint demands of a tree.
    """

    name: str
    file: Path
    title: str
    purpose: str
    parameters: tuple[Parameter, ...]


def library_constraints() -> list[LibraryConstraint]:
    """Return the ready-made constraints, in order of name; their files are read anew."""
    return [_read_constraint(file) for file in sorted((encodings_folder() / "constraints").glob("*.lp"))]


def _read_constraint(file: Path) -> LibraryConstraint:
    """Return the ready-made constraint in a file.

    The comment at the start of the file has the title, the purpose and an example call. The parameters are
    the ``#const`` statements.
    """
    lines = file.read_text(encoding="utf-8").split("\n")
    header = [line.removeprefix("%").strip() for line in lines[: lines.index("")]]
    sections: dict[str, list[str]] = {}
    current: list[str] = []
    for line in header[1:]:
        if match := _SECTION.match(line):
            current = sections.setdefault(match[1], [])
            current.append(match[2])
        elif line:
            current.append(line)
    purpose = sections["Purpose"]
    example = purpose.pop() if purpose[-1].startswith("-c ") else ""
    examples = dict(setting.partition("=")[::2] for setting in example.removeprefix("-c ").split(" -c "))
    parameters = tuple(
        Parameter(name, value, examples.get(name, ""))
        for name, value in read_encoding(file).constants.items()
    )
    return LibraryConstraint(file.stem, file, header[0].rstrip("."), " ".join(purpose), parameters)
