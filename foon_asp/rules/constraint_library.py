"""The ready-made constraints, as described in their files."""

import re
from pathlib import Path
from typing import NamedTuple

from foon_asp.encoding.encoding import read_encoding
from foon_asp.resources import encodings_folder

_SECTION = re.compile(r"(\w+): +(\S.*)$")


class Parameter(NamedTuple):
    """A constant of a constraint: its name, its default as written, and an example from the file.

    The defaults ``""``, ``#sup`` and ``#inf`` stand for "not set".
    """

    name: str
    own_value: str
    example: str


class LibraryConstraint(NamedTuple):
    """One file of ``encodings/constraints``: its name, its title, what it demands, its parameters."""

    name: str
    file: Path
    title: str
    purpose: str
    parameters: tuple[Parameter, ...]


def library_constraints() -> list[LibraryConstraint]:
    """Read the ready-made constraints, in order of name."""
    return [_read_constraint(file) for file in sorted((encodings_folder() / "constraints").glob("*.lp"))]


def _read_constraint(file: Path) -> LibraryConstraint:
    """Read the comment at the start of a constraint's file: the title, the purpose and an example call."""
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
