"""Results as tables for pandas: rows of plain values, made of the JSON of a result."""

from collections.abc import Iterator
from typing import Any

from foon_asp.errors import UserError
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
