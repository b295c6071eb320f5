"""Object blocks and functional units as listed in a file, with lines, ids and sources."""

from collections.abc import Iterable
from typing import NamedTuple

from foon_asp.network import Contents, ObjectNode, Relation, Source, UnitAmounts
from foon_asp.text.line import Line, MotionLine, ObjectLine, StateLine
from foon_asp.text.stated_amounts import counted_amounts


class ObjectBlock(NamedTuple):
    """A mention of an object node: its object line, the state lines under it, its source and its amount."""

    object: ObjectLine
    states: tuple[StateLine, ...]
    source: Source
    amount: int = 1

    @property
    def node(self) -> ObjectNode:
        """The object node that is mentioned; order, ids and fields are no part of it."""
        return node_of(self.object.label, (state.attribute for state in self.states))

    @property
    def lines(self) -> tuple[Line, ...]:
        """The lines of the block, in order."""
        return self.object, *self.states


class ReadUnit(NamedTuple):
    """A copy of a unit: its motion, its nodes in the order listed, and its sources.

    ``sources`` has one entry, unless a merged file says from which copies the unit came. ``amounts`` are
    those of nodes that the copy takes or makes several times.
    """

    motion: str
    inputs: list[ObjectNode]
    outputs: list[ObjectNode]
    sources: tuple[Source, ...]
    amounts: UnitAmounts = UnitAmounts()

    @property
    def source(self) -> Source:
        """The place of the first copy."""
        return self.sources[0]


class ListedUnit(NamedTuple):
    """A copy of a functional unit with its lines as read, nodes in the order listed.

    ``sources`` has one entry, unless a merged file says from which copies the unit came;
    ``motion_source`` is the place of its motion. ``price`` is that of this copy as written,
    empty where it has none.
    """

    motion: MotionLine
    inputs: tuple[ObjectBlock, ...]
    outputs: tuple[ObjectBlock, ...]
    sources: tuple[Source, ...]
    motion_source: Source
    price: str = ""

    @property
    def sides(self) -> tuple[list[ObjectNode], list[ObjectNode]]:
        """The input and the output nodes, in the order listed."""
        return [block.node for block in self.inputs], [block.node for block in self.outputs]

    @property
    def amounts(self) -> UnitAmounts:
        """The amounts of its nodes, where one that is listed twice is meant twice."""
        return counted_amounts(
            *([(block.node, block.amount) for block in blocks] for blocks in (self.inputs, self.outputs))
        )

    @property
    def identity(self) -> ReadUnit:
        """The unit without its lines."""
        return ReadUnit(self.motion.motion, *self.sides, self.sources)


def node_of(label: str, attributes: Iterable[str | Relation | Contents]) -> ObjectNode:
    """Return the node of a label and the attributes of the state lines under it."""
    states: list[str] = []
    relations: list[Relation] = []
    contents: list[Contents] = []
    for attribute in attributes:
        if isinstance(attribute, str):
            states.append(attribute)
        elif isinstance(attribute, Contents):
            contents.append(attribute)
        else:
            relations.append(attribute)
    contents.sort()
    return ObjectNode(label, frozenset(states), frozenset(relations), tuple(contents))
