"""Object blocks and functional units as they stand in a file, with all that is no part of their identity."""

from collections.abc import Iterable
from typing import NamedTuple

from foon_asp.network import Contents, ObjectNode, Relation, Source
from foon_asp.text.line import MotionLine, ObjectLine, StateLine


class ObjectBlock(NamedTuple):
    """One mention of an object node: its object line, the state lines under it, and where it begins."""

    object: ObjectLine
    states: tuple[StateLine, ...]
    source: Source

    @property
    def node(self) -> ObjectNode:
        """The object node that is mentioned; order, ids and fields are no part of it."""
        return node_of(self.object, self.states)


class ListedUnit(NamedTuple):
    """One copy of a functional unit with its lines as read, nodes in the order listed.

    ``sources`` has one entry, unless a merged file says from which copies the unit came;
    ``motion_source`` is the place of its motion.
    """

    motion: MotionLine
    inputs: tuple[ObjectBlock, ...]
    outputs: tuple[ObjectBlock, ...]
    sources: tuple[Source, ...]
    motion_source: Source


def node_of(line: ObjectLine, states: Iterable[StateLine]) -> ObjectNode:
    """Build the node that an object line and the state lines under it describe."""
    plain: list[str] = []
    relations: list[Relation] = []
    contents: list[Contents] = []
    for state in states:
        attribute = state.attribute
        if isinstance(attribute, str):
            plain.append(attribute)
        elif isinstance(attribute, Relation):
            relations.append(attribute)
        else:
            contents.append(attribute)
    contents.sort()
    return ObjectNode(line.label, frozenset(plain), frozenset(relations), tuple(contents))
