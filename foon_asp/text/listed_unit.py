"""Object blocks and functional units as a file lists them, with lines, ids and sources."""

from collections.abc import Callable, Iterable
from typing import NamedTuple

from foon_asp.network import Contents, ObjectNode, Relation, Source, UnitAmounts
from foon_asp.text.line import Line, MotionLine, ObjectLine, StateLine
from foon_asp.text.stated_amounts import counted_amounts


class ObjectBlock(NamedTuple):
    """A mention of an object node: its object line, the state lines under it, its source and its amount.

    ``amount`` is ``None`` where none is stated. This means one copy in a unit, and any number of copies in a
    kitchen.
    """

    object: ObjectLine
    states: tuple[StateLine, ...]
    source: Source
    amount: int | None = None

    @property
    def node(self) -> ObjectNode:
        """The object node that is mentioned; order, ids and fields of the lines are no part of it."""
        return node_of(self.object.label, (state.attribute for state in self.states))

    @property
    def lines(self) -> tuple[Line, ...]:
        """The object line, then the state lines in the order of the file."""
        return self.object, *self.states


class ReadUnit(NamedTuple):
    """A copy of a unit without its lines: motion, nodes in the order listed, sources and amounts.

    ``sources`` has one entry. In a merged file, it has an entry for each copy that the unit was merged from.
    ``amounts`` has the nodes of which the copy takes or makes several.
    """

    motion: str
    inputs: list[ObjectNode]
    outputs: list[ObjectNode]
    sources: tuple[Source, ...]
    amounts: UnitAmounts = UnitAmounts()

    @property
    def source(self) -> Source:
        """The first of the sources."""
        return self.sources[0]


class ListedUnit(NamedTuple):
    """A copy of a functional unit with its lines as read, nodes in the order listed.

    ``sources`` has one entry. In a merged file, it has an entry for each copy that the unit was merged from.
    ``motion_source`` is the place of the motion. ``price`` is the price of this copy as written, or empty.
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
        """The amounts above 1 of nodes on each side.

        If a node is listed twice, its amounts are added up.
        """
        return counted_amounts(
            *([(block.node, block.amount or 1) for block in blocks] for blocks in (self.inputs, self.outputs))
        )

    @property
    def without_repeats(self) -> "ListedUnit":
        """The unit with each node once on a side, with the greatest of its amounts, as in FOON text."""
        return self._replace(
            inputs=_merge_mentions(self.inputs, max), outputs=_merge_mentions(self.outputs, max)
        )

    @property
    def with_totals(self) -> "ListedUnit":
        """The unit with each node once on a side, with the sum of its amounts, as in JSON."""
        return self._replace(
            inputs=_merge_mentions(self.inputs, sum), outputs=_merge_mentions(self.outputs, sum)
        )

    @property
    def identity(self) -> ReadUnit:
        """The unit without its lines and amounts."""
        return ReadUnit(self.motion.motion, *self.sides, self.sources)


def _merge_mentions(
    blocks: tuple[ObjectBlock, ...], combine: Callable[[Iterable[int]], int]
) -> tuple[ObjectBlock, ...]:
    """Return the first block of each node, with an amount for all blocks of the node.

    ``combine`` makes this amount from the amounts of the blocks. Without repeated nodes, the blocks are
    returned as they are.
    """
    mentions: dict[ObjectNode, list[ObjectBlock]] = {}
    for block in blocks:
        mentions.setdefault(block.node, []).append(block)
    if len(mentions) == len(blocks):
        return blocks
    return tuple(
        first._replace(amount=combine(block.amount or 1 for block in (first, *others)))
        for first, *others in mentions.values()
    )


def node_of(label: str, attributes: Iterable[str | Relation | Contents]) -> ObjectNode:
    """Return the node that has a label and attributes, which are states, relations and contents."""
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
