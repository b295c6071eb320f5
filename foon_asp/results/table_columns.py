"""Rows of results as tables with a column for each value: CSV, Markdown and data frames."""

import csv
import io
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from foon_asp.errors import UserError
from foon_asp.escapes import escaped
from foon_asp.json_layout import Json

_EXACT = "_exact"
_WRITTEN_NUMBER = re.compile(r"[+-]?[0-9]+(?:[./][0-9]+)?(?:e[+-]?[0-9]+)?", re.ASCII)


def flat_row(row: Json) -> Json:
    """Return a row with its nested values as entries of the row itself, and without its schema.

    The key of an entry that was nested has a dot: ``costs.units``. An exact number becomes a decimal, and
    another key ending in ``_exact`` has the exact number. Nodes and places are in one-line notation. Lists of
    structured values are left out.
    """
    return {
        flat_name: value
        for name, inner in row.items()
        if name != "schema"
        for flat_name, value in _flat_items(name, inner)
    }


def _flat_items(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    """Yield the flat key and the value of each leaf of a nested value; ``name`` is the key of the value.

    A fraction has two leaves, a decimal and the exact number. Lists of structured values have none.
    """
    word = _one_line_value(value)
    if word is not value:
        yield name, word
    elif isinstance(value, dict) and value.keys() == {"exact", "approx"}:
        yield name, value["approx"]
        yield name + _EXACT, value["exact"]
    elif isinstance(value, dict):
        for key, inner in value.items():
            yield from _flat_items(f"{name}.{key}", inner)
    elif not isinstance(value, list | tuple):
        yield name, value
    elif not any(isinstance(_one_line_value(member), dict | list | tuple) for member in value):
        yield name, [_one_line_value(member) for member in value]


def _one_line_value(value: Any) -> Any:
    """Return a node, the change of a node, a place or a constant in one-line notation.

    Other values are returned unchanged.
    """
    if isinstance(value, dict):
        if "node" in value and "label" in value:
            return value["node"]
        if value.keys() >= {"file", "line"} and "motion" not in value:
            return f"{value['file']}:{value['line']}"
        if value.keys() == {"object", "before", "after"}:
            return " → ".join(
                "" if node is None else node["node"] for node in (value["before"], value["after"])
            )
        if value.keys() >= {"name", "example"}:
            return f"{value['name']}={value['example']}"
    return value


def table_cells(
    rows: Iterable[Json], columns: Sequence[str] | None = None
) -> tuple[Sequence[str], list[list[Any]]]:
    """Return the names of the columns of flat rows, and a list of cells for each row.

    ``columns`` are the names to use. By default, they are all keys in the rows, except a key such as
    ``costs`` if a row has ``costs.units``. A cell is ``None`` if the row has no value. In a column of exact
    numbers, the cell of a whole number is the number as text.
    """
    rows = list(rows)
    if columns is None:
        names = list(dict.fromkeys(name for row in rows for name in row))
        inner = {name.rpartition(".")[0] for name in names}  # null in some rows, and in others with parts
        columns = [name for name in names if name not in inner]
    return columns, [[_cell(row, name) for name in columns] for row in rows]


def _cell(row: Json, name: str) -> Any:
    """Return the value of a row in a column, or ``None``; an exact column has whole numbers as text, too."""
    if name not in row and name.endswith(_EXACT):
        whole_number = row.get(name.removesuffix(_EXACT))
        return None if whole_number is None else str(whole_number)
    return row.get(name)


def csv_text(rows: Iterable[Json], names: Sequence[str] | None = None) -> str:
    """Return flat rows as CSV with a line of headings; ``true`` and ``false`` are as pandas reads them.

    ``names`` are the columns; by default, all keys in the rows. Cells are made safe by :func:`safe_cell`.
    """
    columns, cells = table_cells(rows, names)
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerows(
        [columns, *([safe_cell(_cell_text(cell, words=("false", "true"))) for cell in row] for row in cells)]
    )
    return file.getvalue()


def safe_cell(text: str) -> str:
    """Return the text of a cell with control characters escaped, safe for spreadsheets.

    An apostrophe is put before a text that spreadsheets would take for a formula, but not before a number
    such as ``-1``.
    """
    text = escaped(text)  # of what begins a formula, tabs and line ends
    return f"'{text}" if text[:1] in {"=", "+", "-", "@"} and not _WRITTEN_NUMBER.fullmatch(text) else text


def markdown_text(rows: Iterable[Json]) -> str:
    """Return flat rows as a Markdown table for people; empty if no cell has a value.

    The table has no empty columns and no exact numbers; other numbers have six digits.
    """
    columns, cells = table_cells(rows)
    lists = [
        [name, *map(_rounded_cell_text, column)]
        for name, column in zip(columns, zip(*cells, strict=True), strict=True)
    ]
    shown = [column for column in lists if not column[0].endswith(_EXACT) and any(column[1:])]
    if not shown:
        return ""
    headings, *lines = zip(*shown, strict=True)
    return "".join(markdown_row(line) for line in (headings, ["---"] * len(headings), *lines))


def markdown_row(cells: Iterable[str]) -> str:
    """Return a row of cells as a line of a table in Markdown; bars in cells are escaped."""
    shown = (escaped(cell).replace("|", "\\|") for cell in cells)
    return f"| {' | '.join(shown)} |\n"


def _rounded_cell_text(value: Any) -> str:
    """Return a cell as text, with floats in six digits; a float that is whole has no decimal point."""
    if isinstance(value, float):
        return str(int(value)) if value.is_integer() else f"{value:.6g}"
    return _cell_text(value)


def _cell_text(value: Any, words: tuple[str, str] = ("no", "yes")) -> str:
    """Return a cell as text; items of a list are joined by ``+``.

    ``words`` are the words for false and true. ``None`` becomes an empty text.
    """
    if isinstance(value, list):
        return " + ".join(map(_cell_text, value))
    if isinstance(value, bool):
        return words[value]
    return "" if value is None else str(value)


def data_frame(rows: Iterable[Json]) -> Any:
    """Return flat rows as a data frame of pandas; raises :class:`UserError` if pandas is not installed."""
    try:
        import pandas  # noqa: PLC0415 (an extra)
    except ImportError:
        raise UserError("a data frame needs pandas: pip install 'foon-asp[notebook]'") from None
    columns, cells = table_cells(rows)
    return pandas.DataFrame(cells, columns=columns)
