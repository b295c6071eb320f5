"""Layout of results for people: lines and tables, fitted to the width of a terminal."""

import re
import textwrap
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from foon_asp.escapes import escaped, escaped_lines

_BEGINS = re.compile(r" *(?:\d+  )?")  # the indent of a line, including its number
_COLOURS = {"good": "32", "bad": "31", "dim": "2", "strong": "1"}


class Cell(NamedTuple):
    """The text of a table cell; a terminal shows its ``style`` (good, bad, dim or strong) in colour."""

    text: str
    style: str


class Table(NamedTuple):
    """Rows under headings; columns of figures are aligned to the right.

    A row that is a single text is a line of its own, a title of the rows that follow.
    ``left_aligned``: the indices, from 0, of columns aligned to the left.
    ``indent``: the number of spaces before each line.
    ``headed``: whether the headings are a line above aligned columns. On a narrow terminal, each row
    is a block with a line ``heading: cell`` for each cell that is not empty.
    """

    headings: Sequence[str]
    rows: Sequence[Sequence[str | Cell] | str]
    left_aligned: frozenset[int] = frozenset()
    indent: int = 0
    headed: bool = True


Block = str | Table
"""A block of text for people: a line, or a table."""


def blocks_text(parts: Iterable[Block], width: int | None = None, coloured: bool = False) -> str:
    """Return lines and tables as one text.

    Parameters:
        parts: The lines and tables, from top to bottom; a line end within a line is escaped.
        width: The columns of the terminal. Longer lines are folded between words; below 75, each row of a
            table is a block of lines. ``None`` leaves lines as long as they are.
        coloured: Whether cells with a style, and headings, are coloured by terminal codes.
    """
    lines: list[str] = []
    for block in parts:
        if isinstance(block, Table):
            lines += (
                _stacked_lines(block, width)
                if width is not None and width < 75
                else _aligned_lines(block, width, coloured)
            )
        else:
            line = block.replace("\n", "\\u000a")  # a name may hold a line end
            lines += _fold(escaped_lines(line) if coloured else line, width)
    return "".join(f"{line.rstrip()}\n" for line in lines)


def _aligned_lines(table: Table, width: int | None, coloured: bool) -> Iterator[str]:
    """Yield the lines of a table with aligned columns.

    Lines that are longer than ``width`` are folded, unless they are coloured.
    """
    rows = [*([table.headings] if table.headed else []), *table.rows]
    columns = zip(*(row for row in rows if not isinstance(row, str)), strict=True)
    widths = [max(len(_cell_text(cell)) for cell in column) for column in columns]
    inset = " " * table.indent
    for number, row in enumerate(rows):
        if isinstance(row, str):
            yield _colour(inset + escaped(row), row, coloured, heading=bool(row))
            continue
        cells = []
        for index, (cell, column_width) in enumerate(zip(row, widths, strict=True)):
            text = _cell_text(cell)
            last = index == len(row) - 1
            shown = (
                text
                if last and index in table.left_aligned
                else text.ljust(column_width)
                if index in table.left_aligned
                else text.rjust(column_width)
            )
            cells.append(_colour(shown, cell, coloured, heading=table.headed and not number))
        yield from _fold(inset + "  ".join(cells), None if coloured else width)


def _stacked_lines(table: Table, width: int) -> Iterator[str]:
    """Yield, for narrow terminals, a block of lines for each row of a table, with an empty line between.

    A block has a line for each cell, after its heading. Empty rows and cells are left out.
    """
    for index, row in enumerate(filter(None, table.rows)):
        if index:
            yield ""
        if isinstance(row, str):
            yield from _fold(escaped(row), width)
            continue
        for heading, cell in zip(table.headings, row, strict=True):
            if text := _cell_text(cell).strip():
                name = f"{heading.strip()}: " if heading.strip() else ""
                yield from _fold(f"{name}{text}", width)


def _cell_text(cell: str | Cell) -> str:
    """Return the text of a cell, with control characters escaped."""
    return escaped(cell.text if isinstance(cell, Cell) else cell)


def _colour(text: str, cell: str | Cell, coloured: bool, heading: bool) -> str:
    """Return a text with terminal codes for the style of its cell, or of a heading, if ``coloured``."""
    style = "strong" if heading else cell.style if isinstance(cell, Cell) else ""
    return f"\x1b[{_COLOURS[style]}m{text}\x1b[0m" if coloured and style else text


def _fold(line: str, width: int | None) -> list[str]:
    """Return a line folded between words to a width of at least 20; further lines are indented.

    ``None`` for the width leaves the line whole. A word that is longer than the width stays whole.
    """
    if width is None or len(line) <= width:
        return [line]
    indent = _BEGINS.match(line)
    assert indent
    further_indent = " " * min(indent.end() + 2, width // 2)
    return textwrap.wrap(
        line, max(20, width), subsequent_indent=further_indent, break_on_hyphens=False, break_long_words=False
    )
