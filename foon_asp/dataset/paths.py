"""Paths that Python callers pass."""

from collections.abc import Iterable
from os import PathLike
from pathlib import Path

File = str | PathLike[str]
"""A path; for a constraint also a rule, or the name of a built-in one, such as ``forbid_motion``."""

Files = File | Iterable[File]


def as_paths(paths: Files) -> tuple[Path, ...]:
    """Return one path or several as a tuple of paths."""
    is_single = isinstance(paths, str | PathLike)
    return tuple(map(as_path, [paths] if is_single else paths))  # type: ignore[arg-type]


def as_path(file: File) -> Path:
    """Return the path of a file; a path keeps its class, which determines how messages show it."""
    return file if isinstance(file, Path) else Path(file)
