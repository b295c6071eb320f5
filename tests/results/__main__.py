"""The schemas of documents, and docs/json.md: ``python -m tests.results`` writes them anew."""

import importlib
import pkgutil
from collections.abc import Iterator
from typing import Any

import msgspec

import foon_asp
from foon_asp.batch.answer_row import AnswerRow
from foon_asp.comparison.comparison import Comparison
from foon_asp.json_layout import Json, json_text
from foon_asp.results.document import Document
from foon_asp.results.json_schema import schema_of, schema_of_rows
from foon_asp.results.schema_file import SCHEMAS
from foon_asp.results.values import Value
from tests.results.json_page import PAGE, page

ROWS: dict[str, type[msgspec.Struct]] = {"batch-row": AnswerRow, "compare-row": Comparison}
"""The rows of files of results, by kind."""
_ROOMS = ("questions", "batch")


def documents() -> dict[str, type[Document]]:
    """Return every document by kind: ``answer``, ``regret``, ..."""
    for room in _ROOMS:
        path, name = [f"{foon_asp.__path__[0]}/{room}"], f"foon_asp.{room}"
        modules = [importlib.import_module(each.name) for each in pkgutil.walk_packages(path, f"{name}.")]
        values = {each.__name__: each for each in _subclasses(Value)}
        for module in modules:  # what a field names that is imported for type checkers alone
            module.__dict__.update({n: values[n] for n in values.keys() - module.__dict__.keys()})
    found = {}
    for each in _subclasses(Document):
        tag = each.__struct_config__.tag
        if isinstance(tag, str) and tag.startswith("foon-asp/"):
            found[tag.split("/")[1]] = each
    return found


def schemas() -> dict[str, Json]:
    """Return the schema of every document and row of a file, by kind."""
    made = {kind: schema_of(document) for kind, document in documents().items()}
    return made | {kind: schema_of_rows(kind, row) for kind, row in ROWS.items()}


def _subclasses(kind: type[msgspec.Struct]) -> Iterator[Any]:
    for each in kind.__subclasses__():
        yield each
        yield from _subclasses(each)


if __name__ == "__main__":
    for kind, schema in schemas().items():
        (SCHEMAS / f"{kind}.json").write_text(json_text(schema), encoding="utf-8")
    PAGE.write_text(page(), encoding="utf-8")
    print(f"written: {len(schemas())} schemas, and {PAGE.name}")
