"""Object nodes, entries of kitchens and goals, and places as plain values, the way blocks hold them."""

from collections.abc import Iterable
from json.encoder import encode_basestring_ascii as _quoted
from typing import Any
from zlib import crc32

from foon_asp.network import Contents, NodePattern, ObjectNode, Relation, Source
from foon_asp.text.object_list import ListedObject


def node_texts(node: ObjectNode) -> tuple[str, str, str, str]:
    """Give the four parts of a node as JSON; in one list they are what certificates have digested."""
    label, states, relations, contents = node
    related = ",".join([f"[{_quoted(word)},{_quoted(place)}]" for word, place in sorted(relations)])
    held = ",".join([f"[{_quoted(word)},[{_listed(items)}]]" for word, items in contents])
    return _quoted(label), f"[{_listed(sorted(states))}]", f"[{related}]", f"[{held}]"


def _listed(texts: Iterable[str]) -> str:
    return ",".join(map(_quoted, texts))


def node_values(texts: tuple[str, ...], in_kitchen: bool) -> str:
    """Give a node as JSON, first whether it is in the store's kitchen; what is empty at the end is cut."""
    while len(texts) > 1 and texts[-1] == "[]":
        texts = texts[:-1]
    return f"[{int(in_kitchen)},{','.join(texts)}]"


def node_of(values: list[Any]) -> ObjectNode:
    """Give the node back."""
    parts: list[Any] = [*values[1:], (), (), ()]
    label, states, relations, contents = parts[:4]
    return ObjectNode(
        label,
        frozenset(states),
        frozenset([Relation(word, related) for word, related in relations]),
        tuple([Contents(word, tuple(items)) for word, items in contents]),
    )


def entry_values(entry: ListedObject) -> list[object]:
    """Give an entry of a kitchen or goals file as lists."""
    pattern, source = entry
    return [
        pattern.label,
        sorted(pattern.states),
        pattern.contents or pattern.ingredients,
        pattern.container,
        sorted(pattern.relations),
        source.file,
        source.line,
        source.column,
    ]


def entry_of(values: list[Any]) -> ListedObject:
    """Give the entry back."""
    label, states, held, container, relations, file, line, column = values
    contents = tuple(Contents(word, tuple(items)) for word, items in held) if _has_words(held) else ()
    pattern = NodePattern(
        label,
        frozenset(states),
        ObjectNode("", contents=contents).ingredients if contents else tuple(held),
        container,
        frozenset(Relation(word, related) for word, related in relations),
        contents,
    )
    return ListedObject(pattern, Source(file, line, column))


def _has_words(held: list[Any]) -> bool:
    """Whether an entry has what a node contains by word, and not its ingredients alone."""
    return bool(held) and not isinstance(held[0], str)


def node_hashes(node: ObjectNode) -> list[int]:
    """Give the hashes that a node is found by: one for each object that it is related to, at least one."""
    label, states, relations, _ = node
    attributes = _attributes_hash(label, states, node.ingredients)
    return [_hash(related, attributes) for related in sorted({related for _, related in relations})] or [
        attributes
    ]


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
