"""Paths that a user names, which are shown on one line whatever is in them."""

import os
from pathlib import Path, PosixPath, WindowsPath
from typing import TYPE_CHECKING

from foon_asp.escapes import escaped

if TYPE_CHECKING:
    _Base = Path
else:
    _Base = WindowsPath if os.name == "nt" else PosixPath


class NamedPath(_Base):
    """A path that a message has in it as letters alone: ``f"{path}"`` escapes, ``str(path)`` is the name.

    What is found in a folder by it is shown in the same way.
    """

    def __format__(self, spec: str) -> str:
        return format(escaped(str(self)), spec)
