"""Comparison of two task trees: costs, common units, and the nodes where they part."""

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from typing import Literal

from msgspec import UNSET, UnsetType

from foon_asp.json_layout import schema_name
from foon_asp.network import FunctionalUnit, ObjectNode, counted
from foon_asp.problem import ContainerRule, Costs, Objective, given_outputs, needed_inputs
from foon_asp.questions.diff.difference import Difference, difference_fields
from foon_asp.questions.tree import Tree
from foon_asp.questions.used_up_note import used_up_note
from foon_asp.results.document import Unserialized
from foon_asp.results.figure_text import costs_text
from foon_asp.results.table import Block
from foon_asp.results.values import Node, Unit, UsedUpRun, Value
from foon_asp.results.values_of import listed_unit, named_node, question_fields, used_up_of


class Side(Value, frozen=True, kw_only=True):
    """A tree that is compared, with its costs, and the goals and conditions that it is for.

    Attributes:
        name: The file, or ``a`` and ``b`` for trees in Python.
        costs: What the tree costs by every objective; null where a unit is not in the network.
        used_up: Whether the steps, each done once, run where items are used up.
    """

    name: str
    goals: tuple[Node, ...]
    containers: ContainerRule
    items: Literal["lasting", "used-up"]
    level: int
    objectives: tuple[Objective, ...]
    starting_kitchen: tuple[Node, ...] | None
    costs: Costs | None
    used_up: UsedUpRun | None

    def __str__(self) -> str:
        return self.name

    @property
    def costs_text(self) -> str:
        """The costs of the tree in words."""
        return "costs unknown: units are not in the network" if self.costs is None else costs_text(self.costs)


class Making(Value, frozen=True):
    """The achiever of an object node in a tree: a unit or the kitchen.

    Attributes:
        unit: The unit that makes it first.
        kitchen: True if it is in the kitchen.
        missing: True if it is neither in the kitchen nor made.
    """

    unit: Unit | UnsetType = UNSET
    kitchen: bool | UnsetType = UNSET
    missing: bool | UnsetType = UNSET

    def __str__(self) -> str:
        if self.unit is not UNSET:
            return f"{self.unit.motion}    [{self.unit.source[0]}]"
        return "not made" if self.kitchen is UNSET else "from the kitchen"


class Parting(Value, frozen=True):
    """An object node that both trees need on the way to the goals, but get in different ways."""

    object: Node
    a: Making
    b: Making


class TreeDifference(Difference, frozen=True, kw_only=True, tag=schema_name("diff")):
    """Two task trees: what each costs, the units of only one and of both, and where the trees part.

    Attributes:
        same_units: Whether both have the same units.
        same_order: Whether the units that both have stand in the same order in both.
        they_part_at: The object nodes that both need on the way to the goals but get in different ways.

    Example:
        >>> problem = foon_asp.load().problem("macaroni")
        >>> found = foon_asp.diff(foon_asp.solve(problem), foon_asp.solve(problem, "success"))
        >>> found
        <TreeDifference: compared as task trees>
        >>> len(found.in_both), str(found.they_part_at[0].b), found.trees[1]
        (6, 'pour    [FOON.txt:1049]', <Tree for macaroni; cooked; in [pot]: 11 units>)
    """

    a: Side
    b: Side
    same_units: bool
    same_order: bool
    they_part_at: tuple[Parting, ...]

    trees = Unserialized[tuple[Tree, Tree]]()
    """The two trees."""

    def figures(self) -> Sequence[Sequence[str]]:
        """Return a table of the costs of each tree, the headings first."""
        return [("", "costs"), ("A", self.a.costs_text), ("B", self.b.costs_text)]

    def show(self) -> Iterator[Block]:
        """Yield the costs of both, the differences of their units, and where the trees part.

        If both have the same units, one line says so, and whether their order is the same.
        """
        yield "compared as task trees"
        for letter, summary, tree in (("A", self.a, self.trees[0]), ("B", self.b, self.trees[1])):
            yield f"{letter}: {summary.name}    {summary.costs_text}"
            yield from used_up_note(tree.problem, tree)
        yield ""
        if self.same_units:
            order = "the same" if self.same_order else "another"
            yield f"the same {counted(len(self.in_both), 'unit')}, in {order} order"
        else:
            yield from self.unit_lines()
        if self.they_part_at:
            yield from ("", "they part at")
        for parting in self.they_part_at:
            yield from (f"  {parting.object}", f"    A: {parting.a}", f"    B: {parting.b}")


def compare_trees(names: Sequence[str], trees: tuple[Tree, Tree]) -> TreeDifference:
    """Compare two trees: the costs, the units, and the nodes where they part, from the goals backwards."""
    goals = [node for tree in trees for node in tree.problem.goal_nodes]
    (units_a, origins_a), (units_b, origins_b) = (
        (_unit_values(tree), _origins(tree, goals)) for tree in trees
    )
    network = trees[0].problem.network
    side_a, side_b = map(_side_of, names, trees)
    difference = TreeDifference(
        a=side_a,
        b=side_b,
        same_units=units_a.keys() == units_b.keys(),
        same_order=[unit for unit in units_a if unit in units_b] == [u for u in units_b if u in units_a],
        they_part_at=tuple(
            Parting(named_node(network, node), _making(origin, units_a), _making(origins_b[node], units_b))
            for node, origin in origins_a.items()
            if origins_b.get(node, origin) != origin
        ),
        **difference_fields(units_a, units_b),
    )
    return difference.set_unserialized(trees=trees)


def _side_of(name: str, tree: Tree) -> Side:
    """Return a tree as a :class:`Side`, without costs if the network lacks one of its units."""
    problem = tree.problem
    ids = [number for unit in tree if (number := problem.network.unit_id(unit)) is not None]
    costs = problem.costs(ids) if len(ids) == len(tree) else None
    return Side(name=name, **question_fields(problem), costs=costs, used_up=used_up_of(problem, tree))


def _unit_values(tree: Tree) -> dict[FunctionalUnit, Unit]:
    """Return the units of a tree, in order and without repeats, with their values for the result."""
    units: dict[FunctionalUnit, Unit] = {}
    for unit, source in zip(tree.units, tree.places, strict=True):
        units.setdefault(unit, listed_unit(tree.problem.network, unit, source))
    return units


_Origin = FunctionalUnit | bool
"""How a tree gets an object node: the unit that makes it first, ``True`` for the kitchen, else ``False``."""


def _origins(tree: Tree, goals: Sequence[ObjectNode]) -> dict[ObjectNode, _Origin]:
    """Return the origin of each node that a tree needs for ``goals``, in the order of a backward search.

    The search is breadth first. A unit that needs a node itself does not make it. Nodes of the kitchen have
    the kitchen as origin, also if a unit makes them.
    """
    problem = tree.problem
    container_rule = problem.containers, problem.utensils, problem.network
    needed_inputs_of: dict[object, tuple[ObjectNode, ...]] = {
        unit: needed_inputs(unit, *container_rule) for unit in tree
    }
    makers = {
        node: unit
        for unit in reversed(tree.units)
        for node in given_outputs(unit, *container_rule)
        if node not in needed_inputs_of[unit]
    }
    origins: dict[ObjectNode, _Origin] = {}
    queue = deque(goals)
    while queue:
        node = queue.popleft()
        if node not in origins:
            origins[node] = problem.at_hand(node) or makers.get(node, False)
            queue += needed_inputs_of.get(origins[node], ())
    return origins


def _making(origin: _Origin, units: Mapping[FunctionalUnit, Unit]) -> Making:
    """Return an origin as a value for the result; ``units`` maps units to their values."""
    if isinstance(origin, FunctionalUnit):
        return Making(unit=units[origin])
    return Making(kitchen=True) if origin else Making(missing=True)
