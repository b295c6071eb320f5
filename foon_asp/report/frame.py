"""Results as tables, for pandas and as text: rows of plain values, made of the JSON of a result."""

import csv
import io
from collections.abc import Iterator
from typing import Any

from foon_asp.errors import UserError
from foon_asp.escapes import escaped
from foon_asp.report.comparison_table import cell_text, markdown_row
from foon_asp.text.json_value import Json, json_text, read_json, schema_name

# What a document lists, the first that it has: one row each.
_LISTS = (
    *("answers", "comparisons", "trees", "points", "regrets", "intervals", "rows", "lists", "separate"),
    *("roots", "constraints", "rules", "findings", "levels", "steps", "units"),
)
_TWO_TREES = {"a": "only_in_a", "b": "only_in_b", "both": "in_both"}  # lists with rows of one kind
_APPROX = ".approx"


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
    return [{name: _plain(value) for name, value in row.items()} for row in _rows(document)]


def document_text(document: Json, format_: str) -> str:
    """Give a document as ``json``, or its rows as ``csv`` or ``markdown``."""
    text = json_text(document)
    if format_ == "json":
        return text
    return (csv_text if format_ == "csv" else markdown_text)(read_json(text))


def csv_text(document: Json) -> str:
    """Give the rows as CSV, with a line of headings; what lists parts of its own is left out.

    Figures are exact, and beside them, under a name that ends in ``.approx``, as decimals.
    """
    found = []
    for row in _rows(document):
        cells: Json = {}
        for name, value in row.items():
            cells[name] = value["exact"] if _is_figure(value) else _plain(value)
            if _is_figure(value):
                cells[name + _APPROX] = value["approx"]
        found.append(cells)
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerows([cell_text(cell) for cell in row] for row in _table(found))
    return file.getvalue()


def markdown_text(document: Json) -> str:
    """Give the same as a table in Markdown, for people: without empty columns, and rounded to six digits."""
    found = [{name: _rounded(value) for name, value in row.items()} for row in rows(document)]
    columns = [each for each in zip(*_table(found), strict=True) if each[0] != "schema" and any(each[1:])]
    if not columns:
        return ""
    headings, *others = zip(*columns, strict=True)
    lines = [headings, ["---"] * len(headings), *others]
    return "".join(f"{markdown_row([escaped(cell) for cell in line])}\n" for line in lines)


def _table(found: list[Json]) -> list[list[str]]:
    names = dict.fromkeys(name for row in found for name, value in row.items() if not _is_nested(value))
    # null in some rows, and in others with parts
    whole = {name.rpartition(".")[0] for name in names if not name.endswith(_APPROX)}
    wanted = [name for name in names if name not in whole]
    columns = [name for name in wanted if not any(_is_nested(row.get(name)) for row in found)]
    return [columns, *([_cell(_value(row, name)) for name in columns] for row in found)]


def _value(row: Json, name: str) -> Any:
    """Give a value of a row; a whole number is its own decimal."""
    return row.get(name, row.get(name.removesuffix(_APPROX)) if name.endswith(_APPROX) else None)


def _is_nested(value: Any) -> bool:
    return isinstance(value, list) and any(isinstance(each, dict | list) for each in value)


def _cell(value: Any) -> str:
    if isinstance(value, list):
        return " + ".join(map(_cell, value))
    if isinstance(value, bool):
        return "yes" if value else "no"
    return "" if value is None else str(value)


def _rounded(value: Any) -> Any:
    if not isinstance(value, float):
        return value
    return int(value) if value.is_integer() else f"{value:.6g}"


def _rows(document: Json) -> Iterator[Json]:
    """Give the rows of :func:`rows` with all figures as they are."""
    if document.get("schema") == schema_name("each"):
        for answer in document["answers"]:
            goals = " + ".join(goal["node"] for goal in answer["goals"])
            yield from ({"goals": goals, **row} for row in _rows(answer))
        return
    name = next((name for name in _LISTS if isinstance(document.get(name), list)), None)
    if _TWO_TREES["both"] in document:
        listed = [{"in": tree, **unit} for tree, key in _TWO_TREES.items() for unit in document[key]]
        pairs = document.get("nearly_the_same", ())
        listed += [
            {"in": f"{side}, nearly {other}", **pair[side]} for pair in pairs for side, other in ("ab", "ba")
        ]
    else:
        listed = [document] if name is None else document[name]
    yield from (dict(_flat("", row)) for each in listed for row in _searches(each))


def _searches(row: Json) -> Iterator[Json]:
    """Give a row for each search of a comparison; others as they are."""
    searches = row.get("searches")
    if not isinstance(searches, list):
        yield row
        return
    for search in searches:
        yield {"goal": row["goal"], **search}


def _flat(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict) and (not name or _plain(value) is value):
        for key, inner in value.items():
            yield from _flat(f"{name}.{key}" if name else key, inner)
    else:
        yield name, value


def _is_figure(value: Any) -> bool:
    return isinstance(value, dict) and value.keys() == {"exact", "approx"}


def _plain(value: Any) -> Any:
    """Give a figure, a node, a place or a list of them in one value; others as they are."""
    if isinstance(value, list):
        return [_plain(each) for each in value]
    if isinstance(value, dict):
        if _is_figure(value):
            return value["approx"]
        if "node" in value and "label" in value:
            return value["node"]
        if value.keys() >= {"file", "line"} and "motion" not in value:
            return f"{value['file']}:{value['line']}"
        if value.keys() >= {"name", "example"}:
            return f"{value['name']}={value['example']}"
    return value
