"""Stand-ins as values: the node used, the node it replaces, its price, and the next best node."""

from collections.abc import Collection, Iterator, Sequence
from fractions import Fraction

from foon_asp.network import Difference, Edit, Network
from foon_asp.problem import Objective, Problem
from foon_asp.results.figure_text import figure_text
from foon_asp.results.values import Node, Value
from foon_asp.results.values_of import node_as, node_of


class NodeEdit(Value, frozen=True):
    """A difference between the node that is used and the one that it stands in for.

    Attributes:
        edit: The kind of edit in the table of stand-ins.
        served: The differing part of the node that is replaced; empty where it has none.
        serving: The differing part of the node that is used; empty where it has none.
        price: The price in the table of stand-ins.
    """

    edit: Edit
    served: str
    serving: str
    price: Fraction

    def __str__(self) -> str:
        return f"{_edit_text(self.edit, self.served, self.serving)} ({_price_text(self.price)})"


class NextStandIn(Node, frozen=True, kw_only=True):
    """The node that would be the cheapest stand-in if the one that is used were not there.

    Attributes:
        dissimilarity: What it costs by the table of stand-ins.
    """

    dissimilarity: Fraction


class StandIn(Value, frozen=True):
    """One node that is used in place of another.

    Attributes:
        unit: The id of a unit of the network that stands for this replacement.
        used: The node that is used.
        stands_in_for: The node in whose place it is used.
        dissimilarity: What it costs by the table of stand-ins: the sum of the prices of ``edits``.
        edits: The differences between the two nodes.
        next_best: The cheapest other node in the kitchen or made by the tree; null if no other node may stand
            in.
    """

    unit: int
    used: Node
    stands_in_for: Node
    dissimilarity: Fraction
    edits: tuple[NodeEdit, ...]
    next_best: NextStandIn | None

    def lines(self) -> Iterator[str]:
        """Yield lines of text: the two nodes, the price with its edits, and the next best node."""
        yield f"  {self.used}"
        yield f"    for {self.stands_in_for}"
        yield f"    costs {_price_text(self.dissimilarity)}: {', '.join(map(str, self.edits))}"
        if self.next_best is not None:
            yield f"    next best: {self.next_best} ({_price_text(self.next_best.dissimilarity)})"


def stand_ins_in(problem: Problem, tree: Collection[int]) -> tuple[StandIn, ...]:
    """Return the stand-ins of a tree, whose units are given by id."""
    from foon_asp.standins.next_best import stand_ins_of  # noqa: PLC0415 (few answers have stand-ins)

    network = problem.network
    values: list[StandIn] = []
    for unit, serving, served, next_best in stand_ins_of(problem, tree):
        edits = _priced_edits(problem, serving, served)
        values.append(
            StandIn(
                network.unit_number(unit),
                node_of(network, serving),
                node_of(network, served),
                sum((edit.price for edit in edits), Fraction(0)),
                tuple(NodeEdit(*edit) for edit in edits),
                None if next_best is None else _next_stand_in(network, *next_best),
            )
        )
    return tuple(values)


def stand_in_lines(stand_ins: Sequence[StandIn]) -> Iterator[str]:
    """Yield lines of text on all stand-ins of a tree, with their total price; or that none are needed."""
    if not stand_ins:
        yield "no stand-ins are needed"
        return
    total = sum((stand_in.dissimilarity for stand_in in stand_ins), Fraction(0))
    yield f"stand-ins, with a dissimilarity of {_price_text(total)} in all:"
    for stand_in in stand_ins:
        yield from stand_in.lines()


def _priced_edits(problem: Problem, serving: int, served: int) -> tuple[Difference, ...]:
    """Return the differences between two nodes, by id, with their prices in the table of stand-ins.

    It is empty if the node ``serving`` cannot stand in for ``served``.
    """
    assert problem.stand_ins is not None
    objects = problem.network.objects
    return problem.stand_ins.table.differences(objects[serving], objects[served]) or ()


def _next_stand_in(network: Network, o: int, dissimilarity: Fraction) -> NextStandIn:
    """Return the next best node, by id, as a value with its dissimilarity."""
    return node_as(NextStandIn, network, o, dissimilarity=dissimilarity)


def _price_text(price: Fraction) -> str:
    """Return a dissimilarity as text; the table of stand-ins calls it a price."""
    return figure_text(Objective.DISSIMILARITY, price)


def _edit_text(edit: Edit, served: str, serving: str) -> str:
    """Return in words how the node used differs from the node that it stands in for, as ``also chopped``."""
    if edit is Edit.NODE:
        return "listed"
    if edit in {Edit.MORE_STATE, Edit.FEWER_STATE}:
        return f"also {serving}" if serving else f"not {served}"
    if edit in {Edit.MORE_INGREDIENT, Edit.FEWER_INGREDIENT}:
        return f"with {serving}" if serving else f"without {served}"
    if served and serving:
        return f"{serving} instead of {served}"
    return f"also {serving}" if serving else f"not {served}"
