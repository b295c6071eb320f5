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

    A row that is a single text is a line of its own, over the rows that follow it.
    ``left_aligned`` are the indices of columns aligned to the left; the last of them is folded if it is too
    long. ``indent`` is the number of spaces before the table. ``headed`` says whether a wide terminal
    shows headings; a narrow one shows a block for each row, a line ``heading: cell`` for each cell.
    """

    headings: Sequence[str]
    rows: Sequence[Sequence[str | Cell] | str]
    left_aligned: frozenset[int] = frozenset()
    indent: int = 0
    headed: bool = True


Block = str | Table
"""A block of text for people: a line, or a table."""


def rendered(parts: Iterable[Block], width: int | None = None, coloured: bool = False) -> str:
    """Return lines and tables as text.

    Parameters:
        parts: The lines and tables, from top to bottom; a line end within a line is escaped.
        width: The columns of the terminal; lines that are longer are folded between words, and tables are
            stacked below 75. Without it, lines are as long as they are.
        coloured: Whether cells are coloured.
    """
    lines: list[str] = []
    for block in parts:
        if isinstance(block, Table):
            lines += (
                _stacked(block, width)
                if width is not None and width < 75
                else _aligned(block, width, coloured)
            )
        else:
            line = block.replace("\n", "\\u000a")  # a name may hold a line end
            lines += _folded(escaped_lines(line) if coloured else line, width)
    return "".join(f"{line.rstrip()}\n" for line in lines)


def _aligned(table: Table, width: int | None, coloured: bool) -> Iterator[str]:
    """Yield the lines of a table with aligned columns."""
    rows = [*([table.headings] if table.headed else []), *table.rows]
    columns = zip(*(row for row in rows if not isinstance(row, str)), strict=True)
    widths = [max(len(_text(cell)) for cell in column) for column in columns]
    inset = " " * table.indent
    for number, row in enumerate(rows):
        if isinstance(row, str):
            yield _coloured(inset + escaped(row), row, coloured, heading=bool(row))
            continue
        cells = []
        for index, (cell, column_width) in enumerate(zip(row, widths, strict=True)):
            text = _text(cell)
            last = index == len(row) - 1
            shown = (
                text
                if last and index in table.left_aligned
                else text.ljust(column_width)
                if index in table.left_aligned
                else text.rjust(column_width)
            )
            cells.append(_coloured(shown, cell, coloured, heading=table.headed and not number))
        yield from _folded(inset + "  ".join(cells), None if coloured else width)


def _stacked(table: Table, width: int) -> Iterator[str]:
    """Yield the lines of a table as a block for each row, for narrow terminals."""
    for index, row in enumerate(filter(None, table.rows)):
        if index:
            yield ""
        if isinstance(row, str):
            yield from _folded(escaped(row), width)
            continue
        for heading, cell in zip(table.headings, row, strict=True):
            if text := _text(cell).strip():
                name = f"{heading.strip()}: " if heading.strip() else ""
                yield from _folded(f"{name}{text}", width)


def _text(cell: str | Cell) -> str:
    return escaped(cell.text if isinstance(cell, Cell) else cell)


def _coloured(text: str, cell: str | Cell, coloured: bool, heading: bool) -> str:
    style = "strong" if heading else cell.style if isinstance(cell, Cell) else ""
    return f"\x1b[{_COLOURS[style]}m{text}\x1b[0m" if coloured and style else text


def _folded(line: str, width: int | None) -> list[str]:
    """Return a line wrapped between words to a width, at least 20; continuation lines are indented."""
    if width is None or len(line) <= width:
        return [line]
    begins = _BEGINS.match(line)
    assert begins
    inner = " " * min(begins.end() + 2, width // 2)
    return textwrap.wrap(
        line, max(20, width), subsequent_indent=inner, break_on_hyphens=False, break_long_words=False
    )
