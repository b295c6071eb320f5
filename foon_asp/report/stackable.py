"""Tables of ``rich`` that are stacked on a narrow console: a block for each row, a line for each cell."""

from rich.console import Console, ConsoleOptions, RenderResult
from rich.table import Table
from rich.text import Text

from foon_asp.report.stacked import NARROW


class Stackable:
    """A table of ``rich`` that a narrow console shows as blocks."""

    def __init__(self, table: Table) -> None:
        self._table = table
        self._title, self._caption = table.title, table.caption
        table.title = table.caption = None  # a table would fold them to its own width

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        table = self._table
        if self._title:
            yield Text(str(self._title), style=table.title_style or "")
        if options.max_width >= NARROW:
            yield table
            if self._caption:
                yield Text(str(self._caption), style=table.caption_style or "table.caption")
            return
        headings = [str(column.header).strip() for column in table.columns]
        rows = zip(*(column.cells for column in table.columns), strict=True)
        for number, (row, cells) in enumerate(zip(table.rows, rows, strict=True)):
            if number or self._title:
                yield Text()
            for heading, cell in zip(headings, cells, strict=True):
                shown = cell.copy() if isinstance(cell, Text) else Text(str(cell))
                if text := shown.plain.strip():
                    yield Text(f"{heading}: ", style=row.style or "").append(text, style=_style(shown))
        if self._caption:
            yield Text(f"\n{self._caption}", style="dim")


def _style(cell: Text) -> str:
    """Give the style of a whole cell, which has one at most."""
    return str(cell.style or next((span.style for span in cell.spans), ""))
