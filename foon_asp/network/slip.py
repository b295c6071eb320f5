"""Object nodes that are one edit away from another one."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from foon_asp.network.node_pattern import NodePattern
from foon_asp.network.object_node import ObjectNode
from foon_asp.network.spelling import one_letter_apart, without_doubles

# The kind of a name in a node, and the name. A container stands for a relation of any word.
_NodePart = tuple[str, str]


class Slip(NamedTuple):
    """The only name in which two nodes differ: ``name`` in the first node, ``other`` in the second one.

    ``kind`` is the kind of name: label, state, relation, container or ingredient. The name of a relation is
    the whole relation, such as ``in [bowl]``.
    """

    kind: str
    name: str
    other: str


def slip_between(node: ObjectNode, other: ObjectNode | NodePattern) -> Slip | None:
    """Return the name in which two nodes differ, if it is the only one and its spellings are one edit apart.

    Otherwise return ``None``. An edit adds, omits or changes a letter, or swaps it with the next. Differences
    in doubled letters, capitals, blanks and punctuation count as one edit together. Two relations to one
    object by different words (``in [bowl]``, ``on [bowl]``) are one edit apart, too. The words of contents
    are not compared.

    If ``other`` is a :class:`NodePattern` that states no relations, only the objects of relations are
    compared, as containers.
    """
    as_containers = isinstance(other, NodePattern) and not other.relations
    remaining, other_remaining = (
        list(_named_parts(node, as_containers)),
        list(_named_parts(other, as_containers)),
    )
    for part in list(remaining):
        if part in other_remaining:
            remaining.remove(part)
            other_remaining.remove(part)
    if len(remaining) != 1 or len(other_remaining) != 1:
        return None
    (kind, name), (other_kind, other_name) = remaining[0], other_remaining[0]
    if kind != other_kind:
        return None
    if kind == "relation":
        if name.partition("[")[2] == other_name.partition("[")[2]:
            return Slip(kind, name, other_name)
        if name.partition("[")[0] != other_name.partition("[")[0]:
            return None
    if one_letter_apart(name, other_name) or without_doubles(name) == without_doubles(other_name):
        return Slip(kind, name, other_name)
    return None


def nearest_nodes(node: ObjectNode, others: Iterable[ObjectNode], max_nodes: int) -> list[ObjectNode]:
    """Return up to ``max_nodes`` of the ``others``: nodes with the label of ``node``, the most similar first.

    Nodes with the fewest different states, relations and ingredients are the most similar. The node itself is
    left out.
    """
    parts = set(_named_parts(node, as_containers=False))
    ranked = sorted(
        (len(parts.symmetric_difference(_named_parts(other, as_containers=False))), str(other), other)
        for other in others
        if other.label == node.label and other != node
    )
    return [other for _, _, other in ranked[:max_nodes]]


def _named_parts(node: ObjectNode | NodePattern, as_containers: bool) -> Iterator[_NodePart]:
    """Yield the names in a node, each after its kind: ``("state", "chopped")``.

    If ``as_containers``, relations are yielded as the containers that they name, without their words.
    """
    yield "label", node.label
    yield from (("state", state) for state in sorted(node.states))
    yield from (("ingredient", ingredient) for ingredient in node.ingredients)
    if as_containers:
        if isinstance(node, NodePattern):
            if node.container is not None:
                yield "container", node.container
        else:
            yield from (("container", name) for name in sorted({r.object for r in node.relations}))
    else:
        yield from (
            ("relation", f"{relation.word} [{relation.object}]") for relation in sorted(node.relations)
        )
