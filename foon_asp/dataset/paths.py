"""Paths as callers of Python write them."""

from collections.abc import Iterable
from os import PathLike
from pathlib import Path

File = str | PathLike[str]
"""A path; for a constraint also a rule, or the name of one of ours, such as ``forbid_motion``."""

Files = File | Iterable[File]


def files(given: Files) -> tuple[Path, ...]:
    """Read one path or several."""
    one = isinstance(given, str | PathLike)
    return tuple(map(as_path, [given] if one else given))  # type: ignore[arg-type]


def as_path(file: File) -> Path:
    """Return the path of a file; one that is a path keeps its class, which says how it is shown."""
    return file if isinstance(file, Path) else Path(file)
