"""What a simulation found: a text, and what stands in the way."""

from collections.abc import Sequence

from foon_asp.document.json_document import listed_unit_json, named_json
from foon_asp.network import FunctionalUnit, ObjectNode, Source
from foon_asp.problem import Problem, given_outputs
from foon_asp.proof.simulation import Obstacle, Simulation, Verdict
from foon_asp.report.answer import costs_text
from foon_asp.text.json_value import Json

Listed = Sequence[tuple[FunctionalUnit, Source]]


def verdict_text(problem: Problem, listed: Listed, simulation: Simulation) -> str:
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
    repeated = len(listed) - len({unit for unit, _ in listed})
    if repeated:
        count = "is repeated and counts" if repeated == 1 else "are repeated and count"
        lines.append(f"{repeated} of the {len(listed)} listed units {count} once")
    if simulation.verdict is Verdict.REORDERED:
        lines.append("an order that executes:")
        lines += [f"  {position + 1:>3}  {_unit_text(listed, position)}" for position in simulation.order]
    return "\n".join(lines) + "\n"


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
    if obstacle.cycle:
        waits = " → ".join(str(position + 1) for position in (*obstacle.cycle, obstacle.cycle[0]))
        text += f"; a cycle is to blame, units that wait for each other: {waits}"
    return text


def _skips(problem: Problem, unit: FunctionalUnit, node: ObjectNode) -> bool:
    """Whether a unit has a node among its outputs and does not make it."""
    if node not in unit.outputs:
        return False
    return node not in given_outputs(unit, problem.containers, problem.utensils, problem.network)


def verdict_json(problem: Problem, listed: Listed, simulation: Simulation | None) -> Json:
    """Give what a simulation found; positions count from 1, and without one all is ``None``."""
    if simulation is None:
        return dict.fromkeys(("verdict", "as_listed", "in_any_order", "order"))
    return {
        "verdict": str(simulation.verdict),
        "as_listed": _obstacle_json(problem, listed, simulation.as_listed),
        "in_any_order": _obstacle_json(problem, listed, simulation.obstacle),
        "order": [position + 1 for position in simulation.order],
    }


def _obstacle_json(problem: Problem, listed: Listed, obstacle: Obstacle | None) -> Json | None:
    if obstacle is None:
        return None
    network, position = problem.network, obstacle.unit
    return {
        "position": None if position is None else position + 1,
        "unit": None if position is None else listed_unit_json(network, *listed[position]),
        "missing": named_json(network, obstacle.missing),
        "cycle": [position + 1 for position in obstacle.cycle],
    }
