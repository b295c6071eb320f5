"""What the JSON side files say of an object node."""

from typing import NamedTuple

from foon_asp.network.object_node import ObjectNode, Relation


class NodePattern(NamedTuple):
    """An entry of a kitchen or goals file, which knows only the container and not the relation's word.

    ``container`` matches any relation to that object; ``None`` matches only nodes with no relation,
    unless ``relations`` names some, which then have to be there by word. ``ingredients`` is the sorted
    multiset of everything contained, under whatever word.
    """

    label: str
    states: frozenset[str] = frozenset()
    ingredients: tuple[str, ...] = ()
    container: str | None = None
    relations: frozenset[Relation] = frozenset()

    def matches(self, node: ObjectNode) -> bool:
        """Whether the node is one that this entry stands for."""
        if (
            node.label != self.label
            or node.states != self.states
            or node.ingredients != self.ingredients
            or not self.relations <= node.relations
        ):
            return False
        if self.container is None:
            return node.relations == self.relations
        return node.is_in(self.container)

    def __str__(self) -> str:
        parts = [self.label, *sorted(self.states), *map(str, sorted(self.relations))]
        if self.container is not None:
            parts.append(f"container [{self.container}]")
        if self.ingredients:
            parts.append(f"contains {{{','.join(self.ingredients)}}}")
        return "; ".join(parts)
