"""JSON Schemas of results, made of their fields and of what their docstrings say of these."""

import inspect
import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import PurePath
from typing import Any

import msgspec
from msgspec import Struct, structs

from foon_asp.problem import Costs, Objective
from foon_asp.results.values import Figure
from foon_asp.text.json_value import Json, json_line, schema_name

_DRAFT = "https://json-schema.org/draft/2020-12/schema"
_ATTRIBUTE = re.compile(r"^    (\w+): (.*(?:\n        .*)*)", re.MULTILINE)
_REFERENCE = "#/$defs/{name}"
_KEY = "^[a-z][A-Za-z0-9_'+ -]*$"

_UNSET = object()
_FIGURE = {"anyOf": [{"type": "integer"}, {"$ref": "#/$defs/fraction"}]}
_COUNT = {"type": "integer", "minimum": 0}
_OWN: dict[Any, tuple[str, Json]] = {
    Fraction: (
        "fraction",
        {
            "description": "An exact number; approx is the nearest float, null above all of them.",
            "type": "object",
            "properties": {
                "exact": {"type": "string", "pattern": "^-?[0-9]+(/[0-9]+)?$"},
                "approx": {"type": ["number", "null"]},
            },
            "required": ["exact", "approx"],
            "additionalProperties": False,
        },
    ),
    Figure: ("figure", {"description": "A whole number, or an exact fraction.", **_FIGURE}),
    Costs: (
        "costs",
        {
            "description": "What a tree costs by every objective, null where nothing is known for it.",
            "type": "object",
            "properties": dict.fromkeys(("units", "inputs", "ingredients", "kitchen"), _COUNT),
            "required": ["units", "inputs", "ingredients", "kitchen", "success"],
            "additionalProperties": {"anyOf": [{"$ref": "#/$defs/figure"}, {"type": "null"}]},
        },
    ),
}


def schema_of(document: type[Struct]) -> Json:
    """Return the JSON Schema of a document, draft 2020-12, complete in itself."""
    (top,), parts = msgspec.json.schema_components([document], schema_hook=_hook, ref_template=_REFERENCE)
    bases = {each.__name__: inspect.getmro(each) for each in _structs(document)}
    for name, part in parts.items():
        _describe(part, bases.get(name, ()))
    for name, part in reversed(_OWN.values()):  # each may refer to one before it
        if _REFERENCE.format(name=name) in repr(parts):
            parts[name] = part
    whole = parts.pop(top["$ref"].rpartition("/")[2])
    title = whole["description"].rstrip(".")
    schema = {"$schema": _DRAFT, **whole, "$defs": dict(sorted(parts.items())), "title": title}
    _put_null_last(schema)
    _name_keys(schema)
    return schema


def schema_of_rows(kind: str, row: type[Struct]) -> Json:
    """Return the schema of a line of a file of rows: the question that all answer, or a row."""
    found = schema_of(row)
    name = {"schema": {"const": schema_name(kind)}}
    first = {
        "title": "The first line: what is asked of all",
        "type": "object",
        "properties": {**name, "question": {"type": "object"}},
        "required": ["schema", "question"],
        "additionalProperties": False,
    }
    line = {
        "title": found["title"],
        "type": "object",
        "properties": {**name, **found["properties"]},
        "required": ["schema", *found["properties"]],
        "additionalProperties": False,
    }
    title = f"A line of the results of {kind.removesuffix('-row')}"
    return {"$schema": _DRAFT, "title": title, "oneOf": [first, line], "$defs": found["$defs"]}


def _name_keys(part: Any) -> None:
    """Say what keys look like that are objectives or phases."""
    for inner in part.values() if isinstance(part, dict) else part if isinstance(part, list) else ():
        _name_keys(inner)
    if isinstance(part, dict) and isinstance(part.get("additionalProperties"), dict):
        part["propertyNames"] = {"pattern": _KEY}


def _put_null_last(part: Any) -> None:
    """Order the kinds that a field may have, which versions of msgspec list in different orders."""
    for inner in part.values() if isinstance(part, dict) else part if isinstance(part, list) else ():
        _put_null_last(inner)
    if isinstance(part, dict) and "anyOf" in part:
        part["anyOf"].sort(key=lambda each: (each == {"type": "null"}, json_line(each)))


def _hook(kind: type) -> Json:
    """Return the schema of a type that is no struct."""
    if kind in _OWN:
        return {"$ref": _REFERENCE.format(name=_OWN[kind][0])}
    if issubclass(kind, Objective | PurePath):
        return {"type": "string"}
    raise NotImplementedError(kind)


def _structs(document: type[Struct]) -> set[type[Struct]]:
    """Return the structs that the fields of a document are made of, and those of their fields."""
    found, waiting = set[type[Struct]](), [msgspec.inspect.type_info(document)]
    for info in waiting:  # grows on the way
        if isinstance(info, msgspec.inspect.StructType) and info.cls not in found:
            found.add(info.cls)
            waiting += (field.type for field in info.fields)
        for name in ("item_type", "item_types", "types", "key_type", "value_type", "type"):
            inner = getattr(info, name, ())
            waiting += inner if isinstance(inner, tuple) else (inner,)
    return found


def _describe(part: Json, bases: Sequence[type]) -> None:
    """Say of each field what docstrings say of it, and allow no other keys.

    ``bases`` are the class of the part and those that it stands on.
    """
    docstring = part.pop("description", "")
    part["description"] = docstring.partition("\n")[0]
    if "properties" in part:
        _require_written(part)
        part["additionalProperties"] = False
        keys = {field.name: field.encode_name for field in structs.fields(bases[0])} if bases else {}
        for text in (base.__doc__ or "" for base in bases) if bases else (docstring,):
            _describe_fields(part, text, keys)


def _require_written(part: Json) -> None:
    """Require the keys that are always written: all but those of fields that are unset."""
    fields = part["properties"]
    written = {name for name in fields if fields[name].pop("default", _UNSET) is not _UNSET}
    required = {*written, *part.get("required", ())}
    part["required"] = [name for name in part["properties"] if name in required]
    if not required:
        part["minProperties"] = 1


def _describe_fields(part: Json, docstring: str, keys: Mapping[str, str]) -> None:
    for name, text in _ATTRIBUTE.findall(inspect.cleandoc(docstring)):
        key = keys.get(name, name)
        if key in part["properties"]:
            part["properties"][key].setdefault("description", " ".join(text.split()))
