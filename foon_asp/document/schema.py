"""The JSON Schemas of what verbs print, each in one piece."""

import re
from pathlib import Path

from foon_asp.text.json_value import Json, json_line, read_json

SCHEMAS = Path(__file__).resolve().parent / "schemas"
_SHARED = "defs"  # the file with what several schemas say
_REFERENCE = re.compile(r'"#/\$defs/(\w+)"')


def schema_kinds() -> tuple[str, ...]:
    """List the kinds of documents: what stands in their names, ``answer`` for ``foon-asp/answer/1``."""
    return tuple(sorted(file.stem for file in SCHEMAS.glob("*.json") if file.stem != _SHARED))


def schema(kind: str) -> Json:
    """Give the schema of a kind, with all that it refers to in it."""
    text = (SCHEMAS / f"{kind}.json").read_text(encoding="utf-8").replace(f"{_SHARED}.json#", "#")
    shared = read_json((SCHEMAS / f"{_SHARED}.json").read_text(encoding="utf-8"))["$defs"]
    left, found = _REFERENCE.findall(text), set[str]()
    while left:
        name = left.pop()
        if name not in found:
            found.add(name)
            left += _REFERENCE.findall(json_line(shared[name]))
    given: Json = read_json(text)
    return given | ({"$defs": {name: shared[name] for name in shared if name in found}} if found else {})
