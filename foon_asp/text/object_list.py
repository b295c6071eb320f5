"""Kitchens and goals: lists of object nodes, in JSON or as FOON text without motions."""

from pathlib import Path
from typing import NamedTuple

from foon_asp.network import NodePattern, Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.json_list import JsonList
from foon_asp.text.json_object import read_objects
from foon_asp.text.plain_file import is_json, read_plain_text
from foon_asp.text.reader import FoonReader


class ListedObject(NamedTuple):
    """One entry of a kitchen or goals file and the place where it stands."""

    pattern: NodePattern
    source: Source


def read_object_list(file: Path, warnings: list[Diagnostic] | None = None) -> list[ListedObject]:
    """Read a JSON list of ``{"label", "states", "ingredients", "container"}``, or object blocks.

    In JSON, ``states``, ``ingredients`` and ``container`` may be missing (none). What was assumed while
    reading is added to ``warnings``. Raises :class:`InputError` with the line and column of every entry
    that is not of this form.
    """
    text = read_plain_text(file)
    if file.suffix != ".json" and not is_json(text):
        return _read_blocks(text, file, warnings)
    elements = JsonList(text, file)
    entries: list[ListedObject] = []
    for block, pattern, remarks in read_objects(elements):
        if warnings is not None:
            warnings += [Diagnostic(Severity.WARNING, "json-value", text, block.source) for text in remarks]
        entries.append(ListedObject(pattern, block.source))
    if elements.errors:
        raise InputError(elements.errors)
    return entries


def _read_blocks(text: str, file: Path, warnings: list[Diagnostic] | None) -> list[ListedObject]:
    reader = FoonReader()
    blocks = reader.object_blocks(text, str(file))
    reader.raise_errors()
    if warnings is not None:
        warnings += [d for d in reader.diagnostics if d.severity is Severity.WARNING]
    return [ListedObject(NodePattern.of(block.node), block.source) for block in blocks]
