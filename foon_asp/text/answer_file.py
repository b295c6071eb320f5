"""Task trees in files: FOON text, FOON units in JSON, or an answer of foon-asp in JSON."""

from pathlib import Path
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, ObjectNode, Source
from foon_asp.text.json_node import read_node_json
from foon_asp.text.json_value import Json, read_json, schema_name
from foon_asp.text.plain_file import read_plain_text
from foon_asp.text.reader import FoonReader

_WITH_TREE = ("answer", "search")  # kinds of documents


class ListedTree(NamedTuple):
    """A tree as a file lists it: units with their places in the order listed, ``None`` for an answer without.

    ``goals``, ``status``, and the words for ``containers`` and ``items`` are those of an answer, empty for
    files that do not know them.
    """

    units: tuple[tuple[FunctionalUnit, Source], ...] | None
    goals: tuple[ObjectNode, ...] = ()
    status: str = ""
    containers: str = ""
    items: str = ""


def read_listed_tree(file: Path, reader: FoonReader) -> ListedTree:
    """Read a tree; what ``reader`` has to say of FOON text is in its diagnostics.

    Raises :class:`UserError` for a document that has no place for a tree, is of another version, or is not of
    the form of ``docs/json.md``.
    """
    if not file.exists():
        raise UserError(f"{file}: no such file")
    text = read_plain_text(file)  # once: a pipe can be read no more than that
    found = _document(text)
    if found is None:
        return ListedTree(tuple(reader.tree_units(text, str(file))))
    try:
        answer = _with_tree(found)
        units = None if answer["units"] is None else tuple(map(_unit, answer["units"]))
        goals = tuple(map(read_node_json, answer["goals"]))
        said = (str(answer.get(key, "")) for key in ("status", "containers", "items"))
        return ListedTree(units, goals, *said)
    except (KeyError, TypeError, ValueError, IndexError, AttributeError) as error:
        what = f"{error} is missing" if isinstance(error, KeyError) else str(error)
        raise UserError(f"{file}: expected an answer of foon-asp in JSON, but {what}") from None


def _document(text: str) -> Json | None:
    """Give a document of ours, of whatever version; ``None`` for anything else."""
    if not text.lstrip().startswith("{"):
        return None
    try:
        value = read_json(text)
    except ValueError:
        return None  # the reader of FOON text in JSON says where the fault is
    return value if isinstance(value, dict) and ("schema" in value or "units" in value) else None


def _with_tree(found: Json) -> Json:
    """Give the document with the tree: what other questions found has an answer within."""
    within = found.get("answer")
    answer, kind = within if isinstance(within, dict) else found, ""
    for name in (found.get("schema"), answer.get("schema")):
        kind = str(name).removeprefix("foon-asp/").rpartition("/")[0]
        if name != schema_name(kind):
            raise ValueError(f"found the schema {name!r}, expected {schema_name('answer')!r}")
    if kind not in _WITH_TREE:
        raise ValueError(f"{schema_name(kind)!r} has no tree, or more than one")
    return answer


def _unit(value: Json) -> tuple[FunctionalUnit, Source]:
    inputs, outputs = (tuple(map(read_node_json, value[key])) for key in ("inputs", "outputs"))
    place = value["source"][0]
    if not isinstance(value["motion"], str) or not isinstance(place, dict):
        raise TypeError("a unit is not written as one")
    return FunctionalUnit.of(value["motion"], inputs, outputs), Source(str(place["file"]), int(place["line"]))
