"""The columns of a store: how object nodes, names, and entries of kitchens and goals are encoded in them."""

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

json_string = encode_basestring_ascii
encode_json = json.JSONEncoder(separators=(",", ":"), check_circular=False).encode


class AttributeColumns(NamedTuple):
    """The attributes of a node as JSON texts. The digests in certificates are computed from this form."""

    states: str
    relations: str
    contents: str


@lru_cache(maxsize=STORE.cached_attributes)
def attribute_columns(
    states: frozenset[str], relations: frozenset[Relation], contents: tuple[Contents, ...]
) -> AttributeColumns:
    """Return the attributes of a node as JSON texts; states and relations are sorted."""
    related = ",".join(
        [f"[{json_string(word)},{json_string(related_object)}]" for word, related_object in sorted(relations)]
    )
    holdings = ",".join([f"[{json_string(word)},{json_list(items)}]" for word, items in contents])
    return AttributeColumns(json_list(sorted(states)), f"[{related}]", f"[{holdings}]")


def json_list(texts: Iterable[str]) -> str:
    """Return texts as a list in JSON, without spaces."""
    return f"[{','.join(map(json_string, texts))}]"


def encode_label(label: str) -> bytes:
    """Return a label in UTF-8, including lone surrogates, which labels from JSON may have."""
    return label.encode("utf-8", "surrogatepass")


def decode_label(name: bytes) -> str:
    """Return the label that :func:`encode_label` encoded."""
    return name.decode("utf-8", "surrogatepass")


def decode_json(text: str) -> Any:
    """Return the value that a column states in JSON.

    Raises :class:`ValueError` or :class:`TypeError` for a column that is no JSON.
    """
    return json.loads(text)


def encode_ids(ids: list[int]) -> str:
    """Return ids as a list in JSON, without spaces: ``[3,14]``."""
    return str(ids).replace(" ", "")


decode_ids = msgspec.json.Decoder(tuple[int, ...]).decode
"""Return the ids that :func:`encode_ids` encoded; raises :class:`ValueError` for any other text."""


def decode_node(label: str, states: str, relations: str, contents: str) -> ObjectNode:
    """Return the node of a row, whose attributes are as :func:`attribute_columns` returns them.

    Raises :class:`ValueError` or :class:`TypeError` for other attributes.
    """
    return ObjectNode(
        label,
        _decode_states(states),
        _NO_RELATIONS if relations == "[]" else _decode_relations(relations),
        () if contents == "[]" else _decode_contents(contents),
    )


_NO_RELATIONS = frozenset[Relation]()

# Few different lists stand in very many nodes.


@lru_cache(maxsize=STORE.cached_attributes)
def _decode_states(text: str) -> frozenset[str]:
    """Return the states that :func:`attribute_columns` encoded."""
    return frozenset(map(_checked_name, decode_json(text)))


@lru_cache(maxsize=STORE.cached_attributes)
def _decode_relations(text: str) -> frozenset[Relation]:
    """Return the relations that :func:`attribute_columns` encoded."""
    return frozenset(
        Relation(_checked_name(word), _checked_name(related_object))
        for word, related_object in decode_json(text)
    )


@lru_cache(maxsize=STORE.cached_attributes)
def _decode_contents(text: str) -> tuple[Contents, ...]:
    """Return the contents that :func:`attribute_columns` encoded."""
    return tuple(
        Contents(_checked_name(word), tuple(map(_checked_name, items))) for word, items in decode_json(text)
    )


def _checked_name(value: object) -> str:
    """Return a value of JSON if it is a text; raises :class:`TypeError` for any other."""
    if not isinstance(value, str):
        raise TypeError(f"found {value!r}, expected a name")
    return value


def decode_number(text: str) -> Fraction:
    """Return the rate or price that a text states, such as ``3/4``.

    Raises :class:`ValueError` for negative numbers, numbers with an exponent, and other texts. Also raises it
    for 4,000 letters or more, since Python cannot read integers of more than 4,300 digits.
    """
    number = Fraction(text if len(text) < 4000 and "e" not in text.lower() else "")
    if number < 0:
        raise ValueError(f"found {number}, expected a number from 0")
    return number


def encode_entry(entry: ListedObject) -> str:
    """Return an entry of a kitchen or goals file as JSON, with its amount and its place without videos."""
    pattern, source, amount = entry
    parts = pattern.label, sorted(pattern.states), pattern.ingredients, pattern.container
    return encode_json([*parts, sorted(pattern.relations), pattern.contents, *source[:3], amount])


def decode_entry(text: str) -> ListedObject:
    """Return the entry that :func:`encode_entry` encoded.

    Raises :class:`ValueError` or :class:`TypeError` for any other text.
    """
    label, states, ingredients, container, relations, contents, file, line, column, amount = decode_json(text)
    pattern = NodePattern(
        _checked_name(label),
        frozenset(map(_checked_name, states)),
        tuple(map(_checked_name, ingredients)),
        container if container is None else _checked_name(container),
        frozenset(
            Relation(_checked_name(word), _checked_name(related_object)) for word, related_object in relations
        ),
        tuple(Contents(_checked_name(word), tuple(map(_checked_name, items))) for word, items in contents),
    )
    source = Source(_checked_name(file), int(line), int(column))
    return ListedObject(pattern, source, None if amount is None else int(amount))
