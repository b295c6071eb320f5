"""What a simulation found: a text, and what stands in the way."""

from collections.abc import Sequence
from typing import Any

from msgspec import UNSET, UnsetType

from foon_asp.network import FunctionalUnit, ObjectNode, Source
from foon_asp.problem import Problem, given_outputs
from foon_asp.proof.simulation import Obstacle, Simulation, Verdict
from foon_asp.report.answer import costs_text
from foon_asp.report.used_up_note import used_up_note
from foon_asp.results.values import Node, Unit, Value
from foon_asp.results.values_of import listed_unit, named_node, used_up_of

Listed = Sequence[tuple[FunctionalUnit, Source]]


class Stop(Value, frozen=True):
    """What stops the steps of a tree.

    Attributes:
        position: The first step that cannot be done, from 1; null where a goal is missing in the end.
        unit: The unit of that step, or null.
        missing: What the step lacks, or the goal.
        cycle: The steps that wait for each other, from 1; none where no cycle is to blame.
        used_up_by: Where items are used up: the steps that use up the copies there are.
    """

    position: int | None
    unit: Unit | None
    missing: Node
    cycle: tuple[int, ...]
    used_up_by: tuple[int, ...] | UnsetType = UNSET


def verdict_lines(problem: Problem, listed: Listed, simulation: Simulation) -> list[str]:
    """Say whether the listed units execute, in which order, and what stops them."""
    lines = [f"{simulation.verdict} ({problem.conditions})"]
    if simulation.as_listed is not None:
        lines.append("as listed: " + _obstacle_text(problem, listed, simulation.as_listed))
    if simulation.obstacle is not None:
        lines.append("in any order: " + _obstacle_text(problem, listed, simulation.obstacle))
    ids = [problem.network.unit_id(unit) for unit, _ in listed]
    foreign = [n for n, unit in enumerate(ids) if unit is None]
    lines += [f"unit {n + 1} is not in the network: {_unit_text(listed, n)}" for n in foreign]
    if not foreign:
        lines.append(costs_text(problem.costs(unit for unit in ids if unit is not None)))
    if simulation.verdict is not Verdict.NEVER:
        lines += used_up_note(problem, (unit for unit, _ in listed))
    repeated = len(listed) - len({unit for unit, _ in listed})
    if repeated and problem.items is None:
        count = "is repeated and counts" if repeated == 1 else "are repeated and count"
        lines.append(f"{repeated} of the {len(listed)} listed units {count} once")
    if simulation.verdict is Verdict.REORDERED:
        lines.append("an order that executes:")
        lines += [f"  {position + 1:>3}  {_unit_text(listed, position)}" for position in simulation.order]
    return lines


def _unit_text(listed: Listed, position: int) -> str:
    unit, source = listed[position]
    return f"{unit.motion}    [{source}]"


def _obstacle_text(problem: Problem, listed: Listed, obstacle: Obstacle) -> str:
    if obstacle.unit is None:
        text = f"every unit runs, but the goal is not made: {obstacle.missing}"
    else:
        text = f"unit {obstacle.unit + 1}, {_unit_text(listed, obstacle.unit)}, lacks {obstacle.missing}"
    skipping = [n for n, (unit, _) in enumerate(listed) if _skips(problem, unit, obstacle.missing)]
    if skipping:
        first = f"unit {skipping[0] + 1}, {_unit_text(listed, skipping[0])}"
        text += f"; {first}, took it as given, and so did not make it"
    if obstacle.used_up_by:
        steps = ", ".join(f"unit {n + 1} ({listed[n][0].motion})" for n in obstacle.used_up_by)
        text += f"; used up by {steps}"
    if obstacle.cycle:
        waits = " → ".join(str(position + 1) for position in (*obstacle.cycle, obstacle.cycle[0]))
        text += f"; a cycle is to blame, units that wait for each other: {waits}"
    return text


def _skips(problem: Problem, unit: FunctionalUnit, node: ObjectNode) -> bool:
    """Whether a unit has a node among its outputs and does not make it."""
    if node not in unit.outputs:
        return False
    return node not in given_outputs(unit, problem.containers, problem.utensils, problem.network)


def verdict_values(problem: Problem, listed: Listed, simulation: Simulation | None) -> dict[str, Any]:
    """Return what a simulation found as values, by key in JSON; without one, all are ``None``."""
    if simulation is None:
        return dict.fromkeys(("verdict", "as_listed", "in_any_order", "order", "used_up"))
    return {
        "verdict": simulation.verdict,
        "as_listed": _stop(problem, listed, simulation.as_listed),
        "in_any_order": _stop(problem, listed, simulation.obstacle),
        "order": tuple(position + 1 for position in simulation.order),
        "used_up": used_up_of(problem, [unit for unit, _ in listed]),
    }


def _stop(problem: Problem, listed: Listed, obstacle: Obstacle | None) -> Stop | None:
    if obstacle is None:
        return None
    network, position = problem.network, obstacle.unit
    return Stop(
        None if position is None else position + 1,
        None if position is None else listed_unit(network, *listed[position]),
        named_node(network, obstacle.missing),
        tuple(place + 1 for place in obstacle.cycle),
        tuple(place + 1 for place in obstacle.used_up_by) or UNSET,
    )
