"""Object nodes, entries of kitchens and goals, and places as plain values, the way blocks hold them."""

from typing import Any
from zlib import crc32

from foon_asp.network import Contents, NodePattern, ObjectNode, Relation, Source
from foon_asp.text.object_list import ListedObject


def node_values(node: ObjectNode, in_kitchen: bool) -> list[object]:
    """Give a node as lists, first whether it is in the store's kitchen; what is empty at the end is cut."""
    label, states, relations, contents = node
    values = [int(in_kitchen), label, sorted(states), sorted(relations), contents]
    while len(values) > 2 and not values[-1]:
        values.pop()
    return values


def node_of(values: list[Any]) -> ObjectNode:
    """Give the node back."""
    parts: list[Any] = [*values[1:], (), (), ()]
    label, states, relations, contents = parts[:4]
    return ObjectNode(
        label,
        frozenset(states),
        frozenset(Relation(word, related) for word, related in relations),
        tuple(Contents(word, tuple(items)) for word, items in contents),
    )


def entry_values(entry: ListedObject) -> list[object]:
    """Give an entry of a kitchen or goals file as lists."""
    pattern, source = entry
    return [
        pattern.label,
        sorted(pattern.states),
        pattern.ingredients,
        pattern.container,
        sorted(pattern.relations),
        source.file,
        source.line,
        source.column,
    ]


def entry_of(values: list[Any]) -> ListedObject:
    """Give the entry back."""
    label, states, ingredients, container, relations, file, line, column = values
    pattern = NodePattern(
        label,
        frozenset(states),
        tuple(ingredients),
        container,
        frozenset(Relation(word, related) for word, related in relations),
    )
    return ListedObject(pattern, Source(file, line, column))


def node_hashes(node: ObjectNode) -> list[int]:
    """Give the hashes that a node is found by: one for each object that it is related to, at least one."""
    label, states, relations, _ = node
    attributes = _attributes_hash(label, states, node.ingredients)
    return [_hash(related, attributes) for related in {related for _, related in relations}] or [attributes]


def pattern_hash(pattern: NodePattern) -> int:
    """Give a hash that every node has which a kitchen or goals entry stands for, and few others."""
    attributes = _attributes_hash(pattern.label, pattern.states, pattern.ingredients)
    containers = [related for _, related in pattern.relations]
    if pattern.container is not None:
        containers.append(pattern.container)
    return _hash(min(containers), attributes) if containers else attributes


def _attributes_hash(label: str, states: frozenset[str], ingredients: tuple[str, ...]) -> int:
    ordered = sorted(states) if len(states) > 1 else states
    return _hash("\t".join((label, *ordered, "", *ingredients)), 0)


def _hash(text: str, before: int) -> int:
    return crc32(text.encode("utf-8", "surrogatepass"), before)
