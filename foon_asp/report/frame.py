"""The rows of results that are no documents yet, made of their JSON."""

from collections.abc import Iterator

from foon_asp.results.plain import csv_text, flat_row, markdown_text
from foon_asp.text.json_value import Json, json_text, read_json, schema_name

# What a document lists, the first that it has: one row each.
_LISTS = (
    *("answers", "comparisons", "trees", "points", "regrets", "intervals", "rows", "lists", "roots"),
    *("constraints", "rules", "findings", "levels", "steps", "units"),
)
_MENU = ("separate", "answer")  # a tree for each goal, and one for all


def document_text(document: Json, format_: str) -> str:
    """Return a document as ``json``, or its rows as ``csv`` or ``markdown``."""
    text = json_text(document)
    if format_ == "json":
        return text
    rows = map(flat_row, listed_rows(read_json(text)))
    return (csv_text if format_ == "csv" else markdown_text)(rows)


def listed_rows(document: Json) -> Iterator[Json]:
    """Return one row for each thing that a document lists, or one for the document itself."""
    if document.get("schema") == schema_name("each"):
        for answer in document["answers"]:
            goals = " + ".join(goal["node"] for goal in answer["goals"])
            yield from ({"goals": goals, **row} for row in listed_rows(answer))
        return
    name = next((name for name in _LISTS if isinstance(document.get(name), list)), None)
    if _MENU[0] in document:
        listed = [*document[_MENU[0]], document[_MENU[1]]]
    else:
        listed = [document] if name is None else document[name]
    yield from (row for each in listed for row in _searches(each))


def _searches(row: Json) -> Iterator[Json]:
    """Give a row for each search of a comparison; others as they are."""
    searches = row.get("searches")
    if not isinstance(searches, list):
        yield row
        return
    for search in searches:
        yield {"goal": row["goal"], **search}
