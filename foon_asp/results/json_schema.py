"""JSON Schemas of results, from their fields and docstrings."""

import inspect
import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import PurePath
from typing import Any

import msgspec
from msgspec import Struct, structs

from foon_asp.json_layout import Json, json_line, schema_name
from foon_asp.problem import Costs, Objective
from foon_asp.results.values import Figure

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
    """Return the JSON Schema (draft 2020-12) of a class of documents; it refers to no other schema.

    Title and descriptions are from docstrings. Keys that the class does not have are forbidden.
    """
    (top,), definitions = msgspec.json.schema_components(
        [document], schema_hook=_schema_of_type, ref_template=_REFERENCE
    )
    bases = {kind.__name__: inspect.getmro(kind) for kind in _structs_in(document)}
    for name, definition in definitions.items():
        _describe_struct(definition, bases.get(name, ()))
    for name, definition in reversed(_OWN.values()):  # each may refer to one before it
        if _REFERENCE.format(name=name) in repr(definitions):
            definitions[name] = definition
    root = definitions.pop(top["$ref"].rpartition("/")[2])
    title = root["description"].rstrip(".")
    schema = {"$schema": _DRAFT, **root, "$defs": dict(sorted(definitions.items())), "title": title}
    _put_null_last(schema)
    _constrain_keys(schema)
    return schema


def schema_of_rows(kind: str, row: type[Struct]) -> Json:
    """Return the JSON Schema of a line in a file of rows.

    The first line has the question, every other line a row. ``kind`` is the kind of the rows, such as
    ``batch-row``; ``row`` is their class.
    """
    row_schema = schema_of(row)
    name = {"schema": {"const": schema_name(kind)}}
    first = {
        "title": "The first line: what is asked of all",
        "type": "object",
        "properties": {**name, "question": {"type": "object"}},
        "required": ["schema", "question"],
        "additionalProperties": False,
    }
    line = {
        "title": row_schema["title"],
        "type": "object",
        "properties": {**name, **row_schema["properties"]},
        "required": ["schema", *row_schema["properties"]],
        "additionalProperties": False,
    }
    title = f"A line of the results of {kind.removesuffix('-row')}"
    return {"$schema": _DRAFT, "title": title, "oneOf": [first, line], "$defs": row_schema["$defs"]}


def _constrain_keys(schema: Any) -> None:
    """Add, in place, a pattern for the free keys of objects, which are names of objectives or phases."""
    for inner in schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else ():
        _constrain_keys(inner)
    if isinstance(schema, dict) and isinstance(schema.get("additionalProperties"), dict):
        schema["propertyNames"] = {"pattern": _KEY}


def _put_null_last(schema: Any) -> None:
    """Sort the alternatives of each field in place, null last, since their order depends on msgspec."""
    for inner in schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else ():
        _put_null_last(inner)
    if isinstance(schema, dict) and "anyOf" in schema:
        schema["anyOf"].sort(key=lambda choice: (choice == {"type": "null"}, json_line(choice)))


def _schema_of_type(kind: type) -> Json:
    """Return the schema of a type that msgspec does not know: a number, costs, an objective or a path.

    Raises :class:`NotImplementedError` for any other type, as msgspec expects.
    """
    if kind in _OWN:
        return {"$ref": _REFERENCE.format(name=_OWN[kind][0])}
    if issubclass(kind, Objective | PurePath):
        return {"type": "string"}
    raise NotImplementedError(kind)


def _structs_in(document: type[Struct]) -> set[type[Struct]]:
    """Return the class of a document, and the struct classes in its fields at any depth."""
    kinds, waiting = set[type[Struct]](), [msgspec.inspect.type_info(document)]
    for info in waiting:  # grows during the loop
        if isinstance(info, msgspec.inspect.StructType) and info.cls not in kinds:
            kinds.add(info.cls)
            waiting += (field.type for field in info.fields)
        for name in ("item_type", "item_types", "types", "key_type", "value_type", "type"):
            inner = getattr(info, name, ())
            waiting += inner if isinstance(inner, tuple) else (inner,)
    return kinds


def _describe_struct(schema: Json, bases: Sequence[type]) -> None:
    """Add descriptions from docstrings to the schema of a struct, in place; forbid other keys.

    ``bases`` are the struct's class and its base classes, whose docstrings describe inherited fields. If
    ``bases`` is empty, the docstring is the description in the schema.
    """
    docstring = schema.pop("description", "")
    schema["description"] = docstring.partition("\n")[0]
    if "properties" in schema:
        _require_written(schema)
        schema["additionalProperties"] = False
        keys = {field.name: field.encode_name for field in structs.fields(bases[0])} if bases else {}
        for text in (base.__doc__ or "" for base in bases) if bases else (docstring,):
            _describe_fields(schema, text, keys)


def _require_written(schema: Json) -> None:
    """Require, in place, the keys that are always written; fields that may be unset stay optional.

    If no key is required, at least one key has to be there. Default values are removed from the schema.
    """
    fields = schema["properties"]
    written = {name for name in fields if fields[name].pop("default", _UNSET) is not _UNSET}
    required = {*written, *schema.get("required", ())}
    schema["required"] = [name for name in schema["properties"] if name in required]
    if not required:
        schema["minProperties"] = 1


def _describe_fields(schema: Json, docstring: str, keys: Mapping[str, str]) -> None:
    """Add the descriptions in the ``Attributes`` of a docstring to fields without one, in place.

    ``keys`` are the keys in JSON by the name of the field.
    """
    for name, text in _ATTRIBUTE.findall(inspect.cleandoc(docstring)):
        key = keys.get(name, name)
        if key in schema["properties"]:
            schema["properties"][key].setdefault("description", " ".join(text.split()))
