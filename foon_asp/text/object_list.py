"""Kitchens and goals in JSON: lists of object nodes that know only their container."""

import json
import re
from pathlib import Path
from typing import NamedTuple

from foon_asp.network import NodePattern, Relation, Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.line import normalize_state
from foon_asp.text.plain_file import read_plain_text

_KEYS = {"label", "states", "ingredients", "container"}
_SPACE = re.compile(r"[ \t\r\n]*")


class ListedObject(NamedTuple):
    """One entry of a kitchen or goals file and the place where it stands."""

    pattern: NodePattern
    source: Source


def read_object_list(file: Path) -> list[ListedObject]:
    """Read a JSON list of ``{"label", "states", "ingredients", "container"}`` objects.

    ``states``, ``ingredients`` and ``container`` may be missing (none). Raises :class:`InputError` with
    the line and column of the entry that is not of this form.
    """
    text = read_plain_text(file)
    entries: list[ListedObject] = []
    errors: list[Diagnostic] = []

    def place(offset: int) -> Source:
        line_start = text.rfind("\n", 0, offset) + 1
        return Source(str(file), text.count("\n", 0, offset) + 1, offset - line_start + 1)

    def error(offset: int, message: str) -> Diagnostic:
        source = place(offset)
        excerpt = text.split("\n", source.line)[source.line - 1].rstrip("\r")
        return Diagnostic(Severity.ERROR, "json", message, source, excerpt)

    line, line_offset = 1, 0  # of the entry before, so that lines are counted once
    try:
        for offset, value in _elements(text):
            line += text.count("\n", line_offset, offset)
            line_offset = offset
            column = offset - text.rfind("\n", 0, offset)
            try:
                entries.append(ListedObject(_pattern(value), Source(str(file), line, column)))
            except ValueError as problem:
                errors.append(error(offset, str(problem)))
    except json.JSONDecodeError as problem:
        errors.append(error(problem.pos, f"not JSON: {problem.msg}"))
    except ValueError as problem:  # a number of more digits than Python converts
        errors.append(error(0, f"found a value that cannot be read: {problem}"))
    except RecursionError:
        errors.append(error(0, "found lists within lists without end, expected a list of objects"))
    if errors:
        raise InputError(errors)
    return entries


def _elements(text: str) -> list[tuple[int, object]]:
    """Decode a JSON list element by element, to know the offset of each."""
    decoder = json.JSONDecoder()

    def skip(position: int) -> int:
        match = _SPACE.match(text, position)
        return match.end() if match else position

    position = skip(0)
    if text[position : position + 1] != "[":
        raise json.JSONDecodeError("expected a list, [ ... ]", text, position)
    position = skip(position + 1)
    elements: list[tuple[int, object]] = []
    while text[position : position + 1] != "]":
        if elements:
            if text[position : position + 1] != ",":
                raise json.JSONDecodeError("expected a comma or ]", text, position)
            position = skip(position + 1)
        value, end = decoder.raw_decode(text, position)
        elements.append((position, value))
        position = skip(end)
    rest = skip(position + 1)
    if rest != len(text):
        raise json.JSONDecodeError("expected the end of the file after the list", text, rest)
    return elements


def _pattern(value: object) -> NodePattern:
    if not isinstance(value, dict):
        raise ValueError(
            f'found {json.dumps(value)[:40]}, expected an object {{"label": ..., "states": [...]}}'
        )
    if not value.keys() <= _KEYS:
        unknown = min(value.keys() - _KEYS)
        raise ValueError(f"found the key {unknown!r}, expected one of {', '.join(sorted(_KEYS))}")
    label, container = value.get("label"), value.get("container")
    if not isinstance(label, str) or not label.strip():
        raise ValueError(f'found {json.dumps(label)} as "label", expected a name')
    if container is not None and not isinstance(container, str):
        raise ValueError(f'found {json.dumps(container)} as "container", expected a name or null')
    states: set[str] = set()
    relations: set[Relation] = set()
    for state in _names(value, "states"):
        attribute = normalize_state(state)
        if isinstance(attribute, Relation):
            relations.add(attribute)
        else:
            states.add(attribute)
    return NodePattern(
        label.strip(" "),
        frozenset(states),
        tuple(sorted(_names(value, "ingredients"))),
        (container or "").strip(" ") or None,
        frozenset(relations),
    )


def _names(value: dict[str, object], key: str) -> list[str]:
    names = value.get(key)
    if names is None:
        return []
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise ValueError(f'found {json.dumps(names)[:40]} as "{key}", expected a list of names')
    return [name.strip(" ") for name in names]
