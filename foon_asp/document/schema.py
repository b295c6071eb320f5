"""The JSON Schemas of what verbs print, each in one piece."""

import re
from pathlib import Path

from foon_asp.text.json_value import Json, json_line, read_json

SCHEMAS = Path(__file__).resolve().parent / "schemas"
_SHARED = "defs"  # the file with what several schemas say
_REFERENCE = re.compile(r'"#/\$defs/([\w-]+)"')
_WHOLE = re.compile(r'"\$ref": "([\w-]+)\.json"')  # to a document of another kind


def schema_kinds() -> tuple[str, ...]:
    """List the kinds of documents: what stands in their names, ``answer`` for ``foon-asp/answer/1``."""
    return tuple(sorted(file.stem for file in SCHEMAS.glob("*.json") if file.stem != _SHARED))


def schema(kind: str) -> Json:
    """Give the schema of a kind, with all that it refers to in it: what is shared, and other kinds."""
    text = _text(kind)
    made: Json = read_json(text)
    if "$defs" in made:  # made of the fields of a result
        return made
    shared = read_json(_text(_SHARED))["$defs"]
    left, found = _REFERENCE.findall(text), dict[str, Json]()
    while left:
        name = left.pop()
        if name not in found:
            found[name] = shared.get(name) or _part(_text(name))
            for inner, part in found[name].pop("$defs", {}).items():
                found.setdefault(inner, part)
            left += _REFERENCE.findall(json_line(found[name]))
    given = made
    names = [*(name for name in shared if name in found), *sorted(found.keys() - shared.keys())]
    return given | ({"$defs": {name: found[name] for name in names}} if found else {})


def _text(kind: str) -> str:
    """Give the file of a kind, with its references as they are once all is in one piece."""
    text = (SCHEMAS / f"{kind}.json").read_text(encoding="utf-8")
    return _WHOLE.sub(r'"$ref": "#/$defs/\1"', text.replace(f"{_SHARED}.json#", "#"))


def _part(text: str) -> Json:
    """Give a schema as a part of another one."""
    part: Json = read_json(text)
    del part["$schema"]
    return part
