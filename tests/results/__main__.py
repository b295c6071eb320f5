"""The schemas of results: ``python -m tests.results`` writes them anew into the package."""

import importlib
import pkgutil
from collections.abc import Iterator
from typing import Any

import msgspec

import foon_asp.questions
from foon_asp.document.schema import SCHEMAS
from foon_asp.questions.result import Document
from foon_asp.results.schema import schema_of
from foon_asp.results.values import Value
from foon_asp.text.json_value import Json, json_text


def results() -> dict[str, type[Document]]:
    """Return every result that is a document, by kind: ``answer``, ``regret``, ..."""
    names = [each.name for each in pkgutil.walk_packages(foon_asp.questions.__path__, "foon_asp.questions.")]
    modules = list(map(importlib.import_module, names))
    values = {each.__name__: each for each in _subclasses(Value)}
    for module in modules:  # what a field names that is imported for type checkers alone
        module.__dict__.update({name: values[name] for name in values.keys() - module.__dict__.keys()})
    found = {}
    for each in _subclasses(Document):
        tag = each.__struct_config__.tag
        if isinstance(tag, str) and tag.startswith("foon-asp/"):
            found[tag.split("/")[1]] = each
    return found


def made(kind: str, result: type[Document]) -> str:
    """Return the text of the schema of a kind, as it lies in the package."""
    schema: Json = schema_of(result)
    return json_text({**schema, "title": schema["description"].rstrip(".")})


def _subclasses(kind: type[msgspec.Struct]) -> Iterator[Any]:
    for each in kind.__subclasses__():
        yield each
        yield from _subclasses(each)


if __name__ == "__main__":
    for kind, result in results().items():
        (SCHEMAS / f"{kind}.json").write_text(made(kind, result), encoding="utf-8")
        print(f"written: {kind}.json")
