"""Encoding of object nodes, names, and entries of kitchens and goals in the columns of a store."""

import json
from collections.abc import Iterable
from fractions import Fraction
from functools import lru_cache
from json.encoder import encode_basestring_ascii
from typing import Any, NamedTuple

import msgspec

from foon_asp.network import Contents, NodePattern, ObjectNode, Relation, Source
from foon_asp.store.tuning import STORE
from foon_asp.text.object_list import ListedObject

quoted = encode_basestring_ascii
encode = json.JSONEncoder(separators=(",", ":"), check_circular=False).encode


class AttributeColumns(NamedTuple):
    """The attributes of a node as JSON texts; the digests in certificates are of nodes in this form."""

    states: str
    relations: str
    contents: str


@lru_cache(maxsize=STORE.cached_attributes)
def attribute_columns(
    states: frozenset[str], relations: frozenset[Relation], contents: tuple[Contents, ...]
) -> AttributeColumns:
    """Return the attributes of a node as JSON."""
    related = ",".join(
        [f"[{quoted(word)},{quoted(related_object)}]" for word, related_object in sorted(relations)]
    )
    holdings = ",".join([f"[{quoted(word)},{listed(items)}]" for word, items in contents])
    return AttributeColumns(listed(sorted(states)), f"[{related}]", f"[{holdings}]")


def listed(texts: Iterable[str]) -> str:
    """Return texts as a list in JSON."""
    return f"[{','.join(map(quoted, texts))}]"


def encoded_label(label: str) -> bytes:
    """Return a label in UTF-8, including lone surrogates, which labels from JSON may have."""
    return label.encode("utf-8", "surrogatepass")


def decoded_label(name: bytes) -> str:
    """Return the label in a column, the inverse of :func:`encoded_label`."""
    return name.decode("utf-8", "surrogatepass")


def decoded(text: str) -> Any:
    """Return the value of a column in JSON; raises :class:`ValueError` or :class:`TypeError`."""
    return json.loads(text)


def listed_ids(ids: list[int]) -> str:
    """Return ids as a list in JSON."""
    return str(ids).replace(" ", "")


ids_of = msgspec.json.Decoder(tuple[int, ...]).decode
"""Return the ids in a list of numbers; raises :class:`ValueError` for any other text."""


def node_of(label: str, states: str, relations: str, contents: str) -> ObjectNode:
    """Return the node of a row."""
    return ObjectNode(
        label,
        _states(states),
        _NO_RELATIONS if relations == "[]" else _relations(relations),
        () if contents == "[]" else _contents(contents),
    )


_NO_RELATIONS = frozenset[Relation]()

# Few different lists stand in very many nodes.


@lru_cache(maxsize=STORE.cached_attributes)
def _states(text: str) -> frozenset[str]:
    return frozenset(map(_name, decoded(text)))


@lru_cache(maxsize=STORE.cached_attributes)
def _relations(text: str) -> frozenset[Relation]:
    return frozenset(Relation(_name(word), _name(related_object)) for word, related_object in decoded(text))


@lru_cache(maxsize=STORE.cached_attributes)
def _contents(text: str) -> tuple[Contents, ...]:
    return tuple(Contents(_name(word), tuple(map(_name, items))) for word, items in decoded(text))


def _name(value: object) -> str:
    if not isinstance(value, str):
        raise TypeError(f"found {value!r}, expected a name")
    return value


def number_of(text: str) -> Fraction:
    """Return an exact rate or price of less than 4,000 letters; raises :class:`ValueError` for other texts.

    Python cannot read integers of more than 4,300 digits.
    """
    number = Fraction(text if len(text) < 4000 and "e" not in text.lower() else "")
    if number < 0:
        raise ValueError(f"found {number}, expected a number from 0")
    return number


def entry_column(entry: ListedObject) -> str:
    """Return an entry of a kitchen or goals file as JSON."""
    pattern, source, amount = entry
    parts = pattern.label, sorted(pattern.states), pattern.ingredients, pattern.container
    return encode([*parts, sorted(pattern.relations), pattern.contents, *source[:3], amount])


def entry_of(text: str) -> ListedObject:
    """Return the entry in a column, the inverse of :func:`entry_column`."""
    label, states, ingredients, container, relations, contents, file, line, column, amount = decoded(text)
    pattern = NodePattern(
        _name(label),
        frozenset(map(_name, states)),
        tuple(map(_name, ingredients)),
        container if container is None else _name(container),
        frozenset(Relation(_name(word), _name(related_object)) for word, related_object in relations),
        tuple(Contents(_name(word), tuple(map(_name, items))) for word, items in contents),
    )
    source = Source(_name(file), int(line), int(column))
    return ListedObject(pattern, source, None if amount is None else int(amount))
