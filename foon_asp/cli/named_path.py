"""Paths that a user names, which are shown on one line whatever characters they have."""

import os
from pathlib import Path, PosixPath, WindowsPath
from typing import TYPE_CHECKING

import click

from foon_asp.escapes import escaped

if TYPE_CHECKING:
    _Base = Path
else:
    _Base = WindowsPath if os.name == "nt" else PosixPath


class NamedPath(_Base):
    """A path that is safe in messages: ``f"{path}"`` is escaped, ``str(path)`` is the name.

    Paths derived from it, such as the files of a folder, are of the same class.
    """

    def __format__(self, spec: str) -> str:
        """Return the escaped path, formatted by ``spec`` as a text."""
        return format(escaped(str(self)), spec)


class WrittenPath(click.Path):
    """The type of a parameter that names an output: a path that the command writes and does not read."""

    def __init__(self, allow_dash: bool = False) -> None:
        super().__init__(allow_dash=allow_dash, path_type=NamedPath)
