"""Where something was read."""

from typing import NamedTuple


class Source(NamedTuple):
    """The place of one copy of a unit or of a listed item.

    ``line`` and ``column`` count from 1. ``videos`` are the addresses from the ``# Source:`` lines
    at the top of the file, from which the annotator wrote the graph.
    """

    file: str
    line: int
    column: int = 1
    videos: tuple[str, ...] = ()

    def __str__(self) -> str:
        file = self.file.replace("\n", "\\n")  # within a line, whatever a file is called
        return f"{file}:{self.line}"
