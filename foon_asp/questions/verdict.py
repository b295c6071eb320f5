"""The verdict of a simulation, as values and in words: an order that executes, or the obstacle."""

from collections.abc import Iterator
from typing import TypedDict

from msgspec import UNSET, UnsetType

from foon_asp.network import FunctionalUnit, ObjectNode
from foon_asp.problem import Problem, given_outputs
from foon_asp.proof.simulation import Obstacle, Simulation, Verdict
from foon_asp.questions.tree import Tree
from foon_asp.questions.used_up_note import used_up_note
from foon_asp.results.figure_text import costs_text
from foon_asp.results.values import Node, Unit, UsedUpRun, Value
from foon_asp.results.values_of import named_node, used_up_of


class Stop(Value, frozen=True):
    """The obstacle that stops the steps of a tree.

    Attributes:
        position: The first step that cannot be done, from 1; null where a goal is missing in the end.
        unit: The unit of that step, or null.
        missing: The node that the step lacks, or the goal that is missing.
        cycle: The numbers of the steps that wait for each other, from 1; empty if no cycle is the cause.
        used_up_by: Where items are used up: the numbers of the steps that used up the copies, from 1.
    """

    position: int | None
    unit: Unit | None
    missing: Node
    cycle: tuple[int, ...]
    used_up_by: tuple[int, ...] | UnsetType = UNSET

    @classmethod
    def of(cls, tree: Tree, obstacle: Obstacle | None) -> "Stop | None":
        """Return the obstacle of a tree as a value; ``None`` without one."""
        if obstacle is None:
            return None
        position = None if obstacle.unit is None else obstacle.unit + 1
        return cls(
            position,
            None if position is None else tree.step_unit(position),
            named_node(tree.problem.network, obstacle.missing),
            tuple(index + 1 for index in obstacle.cycle),
            tuple(index + 1 for index in obstacle.used_up_by) or UNSET,
        )


class SimulationFields(TypedDict):
    """The fields of a result that are about the simulation of a tree."""

    verdict: Verdict
    as_listed: Stop | None
    in_any_order: Stop | None
    order: tuple[int, ...]
    used_up: UsedUpRun | None


def simulation_fields(tree: Tree, simulation: Simulation) -> SimulationFields:
    """Return the fields of a result from the simulation of its tree; positions in them count from 1.

    The simulation does not say whether the tree runs with items used up: the field ``used_up`` is computed
    here.
    """
    return {
        "verdict": simulation.verdict,
        "as_listed": Stop.of(tree, simulation.as_listed),
        "in_any_order": Stop.of(tree, simulation.obstacle),
        "order": tuple(position + 1 for position in simulation.order),
        "used_up": used_up_of(tree.problem, tree),
    }


def verdict_lines(tree: Tree, simulation: Simulation) -> Iterator[str]:
    """Yield lines: the verdict, the obstacles, the costs and notes.

    If the network lacks units of the tree, these are listed in place of the costs. If only another order
    executes, that order comes last.
    """
    problem, verdict = tree.problem, simulation.verdict
    yield f"{verdict} ({problem.conditions})"
    for order, obstacle in (("as listed", simulation.as_listed), ("in any order", simulation.obstacle)):
        if obstacle is not None:
            yield f"{order}: {_obstacle_text(tree, obstacle)}"
    ids = [problem.network.unit_id(unit) for unit in tree]
    foreign = [n for n, unit in enumerate(ids, 1) if unit is None]
    yield from (f"unit {n} is not in the network: {tree.step_text(n)}" for n in foreign)
    if not foreign:
        yield costs_text(problem.costs(unit for unit in ids if unit is not None))
    if verdict is not Verdict.NEVER:
        yield from used_up_note(problem, tree)
    repeated = len(tree) - len(set(tree))
    if repeated and problem.items is None:
        count = "is repeated and counts" if repeated == 1 else "are repeated and count"
        yield f"{repeated} of the {len(tree)} listed units {count} once"
    if verdict is Verdict.REORDERED:
        yield "an order that executes:"
        yield from (f"  {index + 1:>3}  {tree.step_text(index + 1)}" for index in simulation.order)


def _obstacle_text(tree: Tree, obstacle: Obstacle) -> str:
    """Return in words which unit lacks which node, or which goal is not made, and the causes.

    Causes are a unit that took the node as given, units that used it up, and a cycle of units.
    """
    missing = f"{obstacle.amount} x {obstacle.missing}" if obstacle.amount > 1 else str(obstacle.missing)
    if obstacle.unit is None:
        text = f"every unit runs, but the goal is not made: {missing}"
    else:
        position = obstacle.unit + 1
        text = f"unit {position}, {tree.step_text(position)}, lacks {missing}"
    skipping = [n for n, unit in enumerate(tree, 1) if _takes_as_given(tree.problem, unit, obstacle.missing)]
    if skipping:
        first = f"unit {skipping[0]}, {tree.step_text(skipping[0])}"
        text += f"; {first}, took it as given, and so did not make it"
    if obstacle.used_up_by:
        steps = ", ".join(f"unit {n + 1} ({tree.units[n].motion})" for n in obstacle.used_up_by)
        text += f"; used up by {steps}"
    if obstacle.cycle:
        waits = " → ".join(str(position + 1) for position in (*obstacle.cycle, obstacle.cycle[0]))
        text += f"; a cycle is to blame, units that wait for each other: {waits}"
    return text


def _takes_as_given(problem: Problem, unit: FunctionalUnit, node: ObjectNode) -> bool:
    """Return whether a unit has a node among its outputs but, by the container rule, does not make it."""
    if node not in unit.outputs:
        return False
    return node not in given_outputs(unit, problem.containers, problem.utensils, problem.network)
