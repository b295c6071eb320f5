"""Where something was read."""

from typing import NamedTuple


class Source(NamedTuple):
    """The place in a ``file`` where a unit or an item was read.

    ``line`` and ``column`` count from 1. ``videos`` are the addresses from the ``# Source:`` lines at the
    top of the file, which the annotator worked from.

    Example:
        >>> str(foon_asp.Source("recipe.txt", 12))
        'recipe.txt:12'
    """

    file: str
    line: int
    column: int = 1
    videos: tuple[str, ...] = ()

    def __str__(self) -> str:
        file = self.file.replace("\n", "\\n")  # within a line, whatever a file is called
        return f"{file}:{self.line}"
