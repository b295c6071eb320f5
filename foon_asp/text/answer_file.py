"""Task trees in files: FOON text, FOON units in JSON, an answer of foon-asp in JSON, or atoms of clingo."""

import re
from collections.abc import Callable, Iterator, Mapping
from itertools import chain, repeat
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.json_layout import Json, read_json, schema_name
from foon_asp.network import Amounts, FunctionalUnit, Network, ObjectNode, Source
from foon_asp.text.json_node import read_node_json
from foon_asp.text.plain_file import read_plain_text
from foon_asp.text.reader import FoonReader

_KINDS_WITH_TREE = ("answer", "search")  # kinds of documents
_ATOM = r"[a-z]\w*(?:\([^()]*\))?\.?"
_ATOMS = re.compile(rf"(?:^[ \t]*{_ATOM}(?:[ \t]+{_ATOM})*[ \t]*(?:\r?\n|\Z))+", re.MULTILINE | re.ASCII)
_USE = re.compile(r"\buse\((\d+)\)", re.ASCII)
_TREE_COMMENT = "# Task tree for:"  # in the comments that FOON text begins with


class ListedTree(NamedTuple):
    """A tree as a file lists it.

    ``units``: the units in the order of the file, each with its source; ``None`` for an answer without a
    tree.
    ``numbers``: the ids U in the atoms ``use(U)`` of clingo's output. If there are any, ``units`` is empty.
    ``goals``, ``status``, ``containers``, ``items``: fields of an answer of foon-asp; empty for other files.
    ``wanted``: how many copies of each goal the answer wants; a goal without a stated number is missing.
    ``is_tree``: false for FOON without a comment ``# Task tree for:``. Such a file may be a network.
    ``amounts``: how many copies of nodes the units take and make, where this is not 1.
    """

    units: tuple[tuple[FunctionalUnit, Source], ...] | None
    goals: tuple[ObjectNode, ...] = ()
    wanted: Mapping[ObjectNode, int] = MappingProxyType({})
    status: str = ""
    containers: str = ""
    items: str = ""
    numbers: tuple[int, ...] = ()
    is_tree: bool = True
    amounts: Amounts = MappingProxyType({})

    def with_units(self, file: Path, network: Callable[[], Network]) -> "ListedTree":
        """Return the tree with the units of its ``numbers``, each with its first source, and no numbers.

        A tree without numbers is returned as it is. ``network`` is a function that returns the network in
        which the numbers are ids of units. Raises :class:`UserError` for a number that is no id of a unit.
        Its message names ``file``.
        """
        if not self.numbers:
            return self
        whole_network = network()
        units = []
        for number in self.numbers:
            unit = whole_network.unit_of_number(number)
            if unit is None:
                raise UserError(
                    f"{file}: use({number}): the network has no unit {number}, "
                    f"only 0 to {len(whole_network) - 1}"
                )
            units.append((whole_network.unit(unit), whole_network.sources[unit][0]))
        return self._replace(units=tuple(units), numbers=())


def read_listed_tree(file: Path, reader: FoonReader) -> ListedTree:
    """Return the tree that a file lists: as FOON units in text or JSON, as an answer, or as atoms of clingo.

    In output of clingo, the last answer with units counts, since it is the best. Units of FOON are read by
    ``reader``, which records diagnostics and amounts.

    Raises :class:`InputError` for errors in units of FOON. Raises :class:`UserError` for a missing file, and
    for JSON of foon-asp without a field for a tree, of another version, or of another form than
    ``docs/json.md`` describes.
    """
    if not file.exists():
        raise UserError(f"{file}: no such file")
    text = read_plain_text(file)  # a pipe can be read only once
    document = _foon_asp_document(text)
    if numbers := _used_ids(text):
        return ListedTree((), numbers=numbers)
    if document is None:
        is_tree = _TREE_COMMENT in text.partition("//")[0]
        units_and_sources = tuple(reader.tree_units(text, str(file)))
        amounts = reader.amounts.amounts_by_unit().units
        return ListedTree(units_and_sources, is_tree=is_tree, amounts=amounts)
    try:
        answer = _answer_with_tree(document)
        steps = answer["units"]
        units = None if steps is None else tuple(chain.from_iterable(map(_executions, steps)))
        goals = tuple(map(read_node_json, answer["goals"]))
        numbers_wanted = (goal.get("wanted") for goal in answer["goals"])
        wanted = {goal: int(n) for goal, n in zip(goals, numbers_wanted, strict=True) if n is not None}
        status, containers, items = (str(answer.get(key, "")) for key in ("status", "containers", "items"))
        return ListedTree(units, goals, wanted, status, containers, items)
    except (KeyError, TypeError, ValueError, IndexError, AttributeError) as error:
        fault = f"{error} is missing" if isinstance(error, KeyError) else str(error)
        raise UserError(f"{file}: expected an answer of foon-asp in JSON, but {fault}") from None


def _used_ids(text: str) -> tuple[int, ...]:
    """Return the ids U in the atoms ``use(U)`` of the last answer of clingo that has any.

    Return an empty tuple for any other text.
    """
    answers = [tuple(map(int, _USE.findall(block))) for block in _ATOMS.findall(text)]
    return next((numbers for numbers in reversed(answers) if numbers), ())


def _foon_asp_document(text: str) -> Json | None:
    """Return a text's JSON object if it has a key ``schema`` or ``units``.

    Return ``None`` for any other text, and for JSON with a fault.
    """
    if not text.lstrip().startswith("{"):
        return None
    try:
        value = read_json(text)
    except ValueError:
        return None  # the reader of FOON text in JSON says where the fault is
    return value if isinstance(value, dict) and ("schema" in value or "units" in value) else None


def _answer_with_tree(document: Json) -> Json:
    """Return the answer that has the tree: the document itself, or the value of its key ``answer``.

    Raises :class:`ValueError` for an unknown schema, and for a kind of document without exactly one tree.
    """
    inner_answer = document.get("answer")
    answer, kind = inner_answer if isinstance(inner_answer, dict) else document, ""
    for name in (document.get("schema"), answer.get("schema")):
        kind = str(name).removeprefix("foon-asp/").rpartition("/")[0]
        if name != schema_name(kind):
            raise ValueError(f"found the schema {name!r}, expected {schema_name('answer')!r}")
    if kind not in _KINDS_WITH_TREE:
        raise ValueError(f"{schema_name(kind)!r} has no tree, or more than one")
    return answer


def _executions(value: Json) -> Iterator[tuple[FunctionalUnit, Source]]:
    """Yield the unit of a step and its source as often as the step's key ``times`` says, by default once."""
    return repeat(_unit(value), int(value.get("times", 1)))


def _unit(value: Json) -> tuple[FunctionalUnit, Source]:
    """Return a unit and its first source from the JSON of the unit in an answer.

    For JSON of another form, raises an error that :func:`read_listed_tree` reports, such as ``KeyError``.
    """
    inputs, outputs = (tuple(map(read_node_json, value[key])) for key in ("inputs", "outputs"))
    source = value["source"][0]
    if not isinstance(value["motion"], str) or not isinstance(source, dict):
        raise TypeError("a unit is not written as one")
    return FunctionalUnit.of(value["motion"], inputs, outputs), Source(
        str(source["file"]), int(source["line"])
    )
