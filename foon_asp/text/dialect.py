"""The dialects of FOON files, and which of them a text is in."""

from collections.abc import Iterator
from enum import StrEnum
from pathlib import Path

from foon_asp.text.json_list import JsonList
from foon_asp.text.line import MotionLine, ObjectLine
from foon_asp.text.plain_file import is_json, is_neutral, split_lines
from foon_asp.text.reader import FoonReader


class Dialect(StrEnum):
    """A way in which FOON files are written; ``docs/formats.md`` has an example of each."""

    PLAIN = "plain"
    """``O⇥onion``, ``M⇥chop``: names only, as in a universal FOON."""
    NO_IDS = "no-ids"
    """``O⇥onion⇥1``, ``M⇥chop⇥<0:14,0:20>``: motion flags and times in one field."""
    IDS = "ids"
    """``O294⇥onion⇥1``, ``M12⇥chop⇥0:14⇥0:20``: ids, motion flags, and times in two fields."""
    JSON = "json"
    """``{"functional_units": [...]}`` with ``object_label``, ids, motion flags and times."""
    JSON_LIST = "json-list"
    """A list of units whose objects have ``label``, ``states``, ``ingredients`` and ``container``."""

    NEUTRAL = "neutral"
    """``{"id": "chop", "inputs": ["onion"], "outputs": ["chopped onion"]}``: a unit a line, plain names."""

    @property
    def is_json(self) -> bool:
        """Whether it is JSON and not lines of text."""
        return self in {Dialect.JSON, Dialect.JSON_LIST, Dialect.NEUTRAL}

    @property
    def suffix(self) -> str:
        """The ending of the names of its files."""
        if self is Dialect.NEUTRAL:
            return ".jsonl"
        return ".json" if self.is_json else ".txt"


def dialect_of(text: str, reader: FoonReader, file: str = "") -> Dialect:
    """Tell the dialect of a text; one line with an id, flag or time is enough.

    What cannot be understood says nothing; a text without anything that does is plain.
    """
    if is_neutral(text, file):
        return Dialect.NEUTRAL
    if is_json(text):
        by_its_name = any("object_label" in value for value in _first_objects(text))
        return Dialect.JSON if by_its_name or text.lstrip(" \t\r\n")[0] == "{" else Dialect.JSON_LIST
    found = Dialect.PLAIN
    lines = dict.fromkeys(split_lines(text))
    for line in lines:
        if line[:1] not in {"O", "S", "M"}:
            continue
        parsed = reader.parse(line)
        if isinstance(parsed, Exception):
            continue
        if parsed.id:
            return Dialect.IDS
        if isinstance(parsed, ObjectLine | MotionLine) and parsed.fields:
            found = Dialect.NO_IDS
    return found


def is_object_list(text: str) -> bool:
    """Whether a text lists object nodes, as a kitchen or goals do, and has no functional units."""
    if is_json(text):
        first = next(iter(JsonList(text, Path())), None) if text.lstrip(" \t\r\n")[0] == "[" else None
        if first is None or not isinstance(first.value, dict | str):
            return False
        return isinstance(first.value, str) or "input_nodes" not in first.value
    starts = {line[:1] for line in split_lines(text)}
    return "O" in starts and "M" not in starts


def _first_objects(text: str) -> Iterator[dict[str, object]]:
    """Give the first object of a list of objects, or the objects of the first unit."""
    first = next(iter(JsonList(text, Path(), "functional_units")), None)
    value = first.value if first else None
    if not isinstance(value, dict):
        return
    nodes = value.get("input_nodes")
    for node in nodes if isinstance(nodes, list) else [value]:
        if isinstance(node, dict):
            yield node
