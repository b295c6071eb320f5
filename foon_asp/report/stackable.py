"""Tables of ``rich`` that are stacked on a narrow console: a block for each row, a line for each cell."""

from rich.console import Console, ConsoleOptions, RenderResult
from rich.table import Table
from rich.text import Text

from foon_asp.report.stacked import NARROW


class Stackable:
    """A table of ``rich`` that a narrow console shows as blocks."""

    def __init__(self, table: Table) -> None:
        self._table = table

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        table = self._table
        if options.max_width >= NARROW:
            yield table
            return
        if table.title:
            yield Text(str(table.title), style=table.title_style or "")
        headings = [str(column.header).strip() for column in table.columns]
        rows = zip(*(column.cells for column in table.columns), strict=True)
        for number, (row, cells) in enumerate(zip(table.rows, rows, strict=True)):
            if number or table.title:
                yield Text()
            for heading, cell in zip(headings, cells, strict=True):
                shown = cell.copy() if isinstance(cell, Text) else Text(str(cell))
                if text := shown.plain.strip():
                    yield Text(f"{heading}: ", style=row.style or "").append(text, style=_style(shown))
        if table.caption:
            yield Text(f"\n{table.caption}", style="dim")


def _style(cell: Text) -> str:
    """Give the style of a whole cell, which has one at most."""
    return str(cell.style or next((span.style for span in cell.spans), ""))
