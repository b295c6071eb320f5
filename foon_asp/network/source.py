"""Places in files where units and items were read."""

from typing import NamedTuple


class Source(NamedTuple):
    """The place in a ``file`` where a unit or an item was read.

    ``line`` and ``column`` count from 1. ``videos`` are the addresses of the annotated videos, which stand in
    lines ``# Source:`` at the top of the file.

    Example:
        >>> str(foon_asp.Source("recipe.txt", 12))
        'recipe.txt:12'
    """

    file: str
    line: int
    column: int = 1
    videos: tuple[str, ...] = ()

    def __str__(self) -> str:
        return f"{_without_line_breaks(self.file)}:{self.line}"

    @property
    def short(self) -> str:
        """The file and the line, such as ``recipe.txt:12``; an absolute path is cut down to the file name."""
        file = _without_line_breaks(self.file)
        return f"{file.rpartition('/')[2] if file.startswith('/') else file}:{self.line}"


def _without_line_breaks(file: str) -> str:
    """Return the name of a file in one line, each line break as a backslash and ``n``."""
    return file.replace("\n", "\\n")  # whatever a file is called
