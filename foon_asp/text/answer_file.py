"""Task trees in files: FOON text, FOON units in JSON, or an answer of foon-asp in JSON."""

from pathlib import Path
from typing import Any, NamedTuple

from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, ObjectNode, Source
from foon_asp.text.json_value import read_json
from foon_asp.text.line import LineError, parse_node
from foon_asp.text.plain_file import read_plain_text
from foon_asp.text.reader import FoonReader


class ListedTree(NamedTuple):
    """A tree as a file lists it: units with their places in the order listed, ``None`` for an answer without.

    ``goals`` and ``status`` are those of an answer, empty for files that know neither.
    """

    units: tuple[tuple[FunctionalUnit, Source], ...] | None
    goals: tuple[ObjectNode, ...] = ()
    status: str = ""


def read_listed_tree(file: Path, reader: FoonReader) -> ListedTree:
    """Read a tree; what ``reader`` has to say of FOON text is in its diagnostics.

    Raises :class:`UserError` for an answer that is not of the form of ``docs/json.md``.
    """
    if not file.exists():
        raise UserError(f"{file}: no such file")
    text = read_plain_text(file)  # once: a pipe can be read no more than that
    answer = _answer(text)
    if answer is None:
        return ListedTree(tuple(reader.tree_units(text, str(file))))
    try:
        units = None if answer["units"] is None else tuple(map(_unit, answer["units"]))
        goals = tuple(parse_node(goal) for goal in answer.get("goals", ()))
        return ListedTree(units, goals, str(answer.get("status", "")))
    except (KeyError, TypeError, IndexError, AttributeError, LineError) as error:
        raise UserError(f"{file}: expected an answer of foon-asp in JSON, but {_what(error)}") from None


def _answer(text: str) -> dict[str, Any] | None:
    """Give the object of an answer; of a shopping list that is the tree it makes possible."""
    if not text.lstrip().startswith("{"):
        return None
    try:
        value = read_json(text)
    except ValueError:
        return None  # the reader of FOON text in JSON says where the fault is
    if isinstance(value, dict) and isinstance(value.get("answer"), dict):
        value = value["answer"]
    return value if isinstance(value, dict) and "units" in value else None


def _unit(value: dict[str, Any]) -> tuple[FunctionalUnit, Source]:
    inputs, outputs = (tuple(map(parse_node, value[key])) for key in ("inputs", "outputs"))
    place = value["source"][0]
    if not isinstance(value["motion"], str) or not isinstance(place, dict):
        raise TypeError("a unit is not written as such")
    return FunctionalUnit.of(value["motion"], inputs, outputs), Source(str(place["file"]), int(place["line"]))


def _what(error: Exception) -> str:
    return f"{error} is missing" if isinstance(error, KeyError) else str(error)
