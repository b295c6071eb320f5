"""Entries of kitchen and goals files: patterns that object nodes match."""

from typing import NamedTuple

from foon_asp.network.object_node import Contents, ObjectNode, Relation
from foon_asp.network.quoted_name import FIRST, LISTED, quoted

LookupKey = tuple[str, frozenset[str], tuple[str, ...], str | None]
"""Label, states, ingredients and a related object, which is ``None`` for a node without relations.

A label without states may stand in thousands of containers, so the container is part of the key.
"""


class NodePattern(NamedTuple):
    """An entry of a kitchen or goals file: a pattern that object nodes match.

    A node matches if it has the ``label``, exactly the ``states``, and exactly the ``ingredients``, a sorted
    multiset. If the pattern has ``contents``, the words for the ingredients have to agree, too.

    If the pattern has a ``container``, the node needs a relation to this object, by any word. It also needs
    the ``relations``, and may have others. Without a container, it has to have exactly the ``relations``.
    """

    label: str
    states: frozenset[str] = frozenset()
    ingredients: tuple[str, ...] = ()
    container: str | None = None
    relations: frozenset[Relation] = frozenset()
    contents: tuple[Contents, ...] = ()

    @classmethod
    def of(cls, node: ObjectNode) -> "NodePattern":
        """Return the entry that only this node matches."""
        return cls(node.label, node.states, node.ingredients, None, node.relations, node.contents)

    @property
    def lookup_key(self) -> LookupKey:
        """The key of the entry, which each matching node has among its :func:`lookup_keys`.

        The related object in it is the container, or else the object of the alphabetically first relation.
        """
        related_object = self.container
        if related_object is None and self.relations:
            related_object = min(self.relations).object
        return self.label, self.states, self.ingredients, related_object

    def matches(self, node: ObjectNode) -> bool:
        """Whether the node matches this entry."""
        if (
            node.label != self.label
            or node.states != self.states
            or node.ingredients != self.ingredients
            or not self.relations <= node.relations
            or (self.contents and self.contents != node.contents)
        ):
            return False
        if self.container is None:
            return node.relations == self.relations
        return node.is_in(self.container)

    def __str__(self) -> str:
        parts = [quoted(self.label, FIRST), *map(quoted, sorted(self.states))]
        parts += map(str, sorted(self.relations))
        if self.container is not None:
            parts.append(f"container [{quoted(self.container, LISTED)}]")
        if self.contents:
            parts += map(str, self.contents)
        elif self.ingredients:
            parts.append(str(Contents("contains", self.ingredients)))
        return "; ".join(parts)


def lookup_keys(node: ObjectNode) -> list[LookupKey]:
    """Return the keys of a node, one for each related object; a node without relations has one key."""
    label, states, relations, contents = node
    ingredients = node.ingredients if contents else ()
    related_objects = {relation.object for relation in relations} if relations else (None,)
    return [(label, states, ingredients, related_object) for related_object in related_objects]
