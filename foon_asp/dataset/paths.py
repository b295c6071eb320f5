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
    return tuple(map(Path, [given] if one else given))  # type: ignore[arg-type]
