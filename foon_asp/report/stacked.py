"""Text where there is little room: a block for each row of a table, and long lines folded.

In a block, each cell is a line ``name: value``.
"""

import contextlib
import re
import textwrap
from collections.abc import Iterable, Iterator, Sequence
from contextvars import ContextVar

_BEGINS = re.compile(r" *(?:\d+  )?")  # how far in a line stands, behind its number if it has one
NARROW = 75  # columns: with fewer, a table is stacked

_room: ContextVar[int | None] = ContextVar("_room", default=None)


@contextlib.contextmanager
def room(columns: int | None) -> Iterator[None]:
    """Make texts in a ``with`` block for a terminal of so many columns; ``None`` where there is none."""
    token = _room.set(columns)
    try:
        yield
    finally:
        _room.reset(token)


def is_narrow() -> bool:
    """Whether tables of text are to be stacked."""
    return columns(NARROW) < NARROW


def columns(most: int) -> int:
    """Give how wide text may be, which would be so wide where there is room; never less than 20."""
    there = _room.get()
    return most if there is None else max(20, min(most, there))


def stacked_lines(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> Iterator[str]:
    """Give the lines of all rows, with an empty one between two; empty cells are left out."""
    width = columns(NARROW)
    for place, row in enumerate(rows):
        if place:
            yield ""
        for heading, cell in zip(headings, row, strict=True):
            if text := cell.strip():
                text = f"{heading.strip()}: {text}"
                yield from textwrap.wrap(text, width, subsequent_indent="  ", break_on_hyphens=False)


def folded(text: str) -> str:
    """Fold lines that are longer than the terminal between words; what follows stands further in."""
    width = _room.get()
    return "\n".join(line for each in text.split("\n") for line in _folded(each, width))


def _folded(line: str, width: int | None) -> list[str]:
    if width is None or len(line) <= width:
        return [line]
    begins = _BEGINS.match(line)
    assert begins
    inner = " " * min(begins.end() + 2, width // 2)
    return textwrap.wrap(
        line, max(20, width), subsequent_indent=inner, break_on_hyphens=False, break_long_words=False
    )
