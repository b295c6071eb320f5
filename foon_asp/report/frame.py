"""Results as tables, for pandas and as text: rows of plain values, made of the JSON of a result."""

import csv
import io
from collections.abc import Iterator
from typing import Any

from foon_asp.errors import UserError
from foon_asp.escapes import escaped
from foon_asp.report.comparison_table import cell_text, markdown_row
from foon_asp.text.json_value import Json

# What a document lists, the first that it has: one row each.
_LISTS = (
    *("answers", "comparisons", "trees", "points", "regrets", "intervals", "rows", "lists", "separate"),
    *("roots", "constraints", "steps", "units"),
)


def frame(document: Any) -> Any:
    """Give a data frame of pandas; raises :class:`UserError` where that is not installed."""
    try:
        import pandas  # noqa: PLC0415 (an extra)
    except ImportError:
        raise UserError("a data frame needs pandas: pip install 'foon-asp[notebook]'") from None
    return pandas.DataFrame(rows(document))


def rows(document: Json) -> list[Json]:
    """Give one row for each thing that a document lists, or one for the document itself.

    Figures are floats, nodes and places are in one-line notation, and what is inside another value has a name
    with a dot: ``costs.units``.
    """
    name = next((name for name in _LISTS if isinstance(document.get(name), list)), None)
    listed = [document] if name is None else document[name]
    return [dict(_flat("", row)) for each in listed for row in _searches(each)]


def csv_text(document: Json) -> str:
    """Give the rows as CSV, with a line of headings; what lists parts of its own is left out."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerows([cell_text(cell) for cell in row] for row in _table(document))
    return file.getvalue()


def markdown_text(document: Json) -> str:
    """Give the same as a table in Markdown."""
    headings, *others = _table(document)
    lines = [headings, ["---"] * len(headings), *others]
    return "".join(f"{markdown_row([escaped(cell) for cell in line])}\n" for line in lines)


def _table(document: Json) -> list[list[str]]:
    found = rows(document)
    names = dict.fromkeys(name for row in found for name, value in row.items() if not _is_nested(value))
    whole = {name.rpartition(".")[0] for name in names}  # null in some rows, and in others with parts
    wanted = [name for name in names if name not in whole]
    columns = [name for name in wanted if not any(_is_nested(row.get(name)) for row in found)]
    return [columns, *([_cell(row.get(name)) for name in columns] for row in found)]


def _is_nested(value: Any) -> bool:
    return isinstance(value, list) and any(isinstance(each, dict | list) for each in value)


def _cell(value: Any) -> str:
    if isinstance(value, list):
        return " + ".join(map(_cell, value))
    if isinstance(value, bool):
        return "yes" if value else "no"
    return "" if value is None else str(value)


def _searches(row: Json) -> Iterator[Json]:
    """Give a row for each search of a comparison; others as they are."""
    searches = row.get("searches")
    if not isinstance(searches, list):
        yield row
        return
    for search in searches:
        yield {"goal": row["goal"], **search}


def _flat(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict) and _plain(value) is value:
        for key, inner in value.items():
            yield from _flat(f"{name}.{key}" if name else key, inner)
    else:
        yield name, _plain(value)


def _plain(value: Any) -> Any:
    """Give a figure, a node, a place or a list of them in one value; others as they are."""
    if isinstance(value, list):
        return [_plain(each) for each in value]
    if isinstance(value, dict):
        if value.keys() == {"exact", "approx"}:
            return value["approx"]
        if "node" in value and "label" in value:
            return value["node"]
        if value.keys() >= {"file", "line"} and "motion" not in value:
            return f"{value['file']}:{value['line']}"
    return value
