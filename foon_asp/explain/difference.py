"""What differs between two trees, and where they part."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.network import FunctionalUnit, Network, ObjectNode, Source
from foon_asp.problem import ContainerRule, Costs, given_outputs, needed_inputs, tree_costs

Listed = Sequence[tuple[FunctionalUnit, Source]]


class Side(NamedTuple):
    """One of two trees: its units in the order listed, each once, with place, needs and products; its costs.

    ``goals`` may be empty where they are not known. ``costs.success`` is ``None`` where a rate is not known.
    """

    name: str
    units: tuple[FunctionalUnit, ...]
    places: Mapping[FunctionalUnit, Source]
    needs: Mapping[FunctionalUnit, tuple[ObjectNode, ...]]
    gives: Mapping[FunctionalUnit, tuple[ObjectNode, ...]]
    goals: tuple[ObjectNode, ...]
    kitchen: frozenset[ObjectNode]
    costs: Costs

    def origin(self, node: ObjectNode) -> FunctionalUnit | None:
        """Give the unit that makes a node first; ``None`` where the kitchen has it or no unit makes it."""
        if node in self.kitchen:
            return None
        return next((u for u in self.units if node in self.gives[u] and node not in self.needs[u]), None)


class Parting(NamedTuple):
    """An object node that both trees come to, and the unit that makes it in each, or ``None``."""

    object: ObjectNode
    left: FunctionalUnit | None
    right: FunctionalUnit | None


class Difference(NamedTuple):
    """Two trees, the units that only one has, in its order, those that both have, and where they part."""

    left: Side
    right: Side
    only_left: tuple[FunctionalUnit, ...]
    only_right: tuple[FunctionalUnit, ...]
    both: tuple[FunctionalUnit, ...]
    partings: tuple[Parting, ...]

    @property
    def same_order(self) -> bool:
        """Whether the units that both have stand in the same order in both."""
        return self.both == tuple(unit for unit in self.right.units if unit in set(self.both))


class _ListedUnit(NamedTuple):
    """A unit of any origin, as objectives look at it."""

    unit: FunctionalUnit
    rates: Mapping[str, Fraction] | None

    @property
    def inputs(self) -> tuple[ObjectNode, ...]:
        """Its input object nodes."""
        return self.unit.inputs

    @property
    def rate(self) -> Fraction:
        """The success rate of its motion."""
        if self.rates is None:
            raise ValueError("no success rates are known")
        return self.rates[self.unit.motion]


def side(
    name: str,
    listed: Listed,
    goals: Sequence[ObjectNode],
    kitchen: frozenset[ObjectNode],
    rule: ContainerRule,
    utensils: frozenset[str],
    rates: Mapping[str, Fraction] | None,
    network: Network | None = None,
) -> Side:
    """Take a tree as one side of a difference; its units need not be those of any network.

    Below level 3 the ``network`` says what its units stand for, and so what they need and make.
    """
    places = dict(reversed(listed))
    units = tuple(dict.fromkeys(unit for unit, _ in listed))
    needs = {unit: needed_inputs(unit, rule, utensils, network) for unit in units}
    gives = {unit: given_outputs(unit, rule, utensils, network) for unit in units}
    known = rates is not None and all(unit.motion in rates for unit in units)
    taken = {node for needed in needs.values() for node in needed if node in kitchen}
    costs = tree_costs([_ListedUnit(unit, rates) for unit in units], len(taken), known)
    return Side(name, units, places, needs, gives, tuple(goals), kitchen, costs)


def difference(left: Side, right: Side) -> Difference:
    """Compare two trees as sets of units, and follow both back from the goals to where they part.

    They part at an object node that both come to and have from elsewhere: from another unit, or one of them
    from the kitchen. Where no goals are known, it is from the nodes that a tree makes and does not need.
    """
    in_left, in_right = set(left.units), set(right.units)
    goals = left.goals + right.goals or (*_ends(left), *_ends(right))
    on_right_way = set(_way(right, goals))
    partings = [
        Parting(node, left.origin(node), right.origin(node))
        for node in _way(left, goals)
        if node in on_right_way
        and (left.origin(node) != right.origin(node) or (node in left.kitchen) != (node in right.kitchen))
    ]
    return Difference(
        left,
        right,
        tuple(unit for unit in left.units if unit not in in_right),
        tuple(unit for unit in right.units if unit not in in_left),
        tuple(unit for unit in left.units if unit in in_right),
        tuple(partings),
    )


def _way(tree: Side, goals: Sequence[ObjectNode]) -> dict[ObjectNode, None]:
    """Give the nodes that a tree comes to on the way back from the goals, those near the goals first."""
    way: dict[ObjectNode, None] = {}
    frontier = list(goals)
    while frontier:
        way.update(dict.fromkeys(frontier))
        makers = (tree.origin(node) for node in frontier)
        needed = dict.fromkeys(node for maker in makers if maker for node in tree.needs[maker])
        frontier = [node for node in needed if node not in way]
    return way


def _ends(tree: Side) -> list[ObjectNode]:
    needed = {node for needs in tree.needs.values() for node in needs}
    return [node for unit in tree.units for node in tree.gives[unit] if node not in needed]
