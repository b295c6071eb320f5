"""What one search returned, for people, for programs and as FOON text."""

import json

from foon_asp.problem import Problem
from foon_asp.proof import Simulation
from foon_asp.report.answer import (
    costs_json,
    costs_text,
    goal_lines,
    goals_stand_for_json,
    steps,
    unit_json,
)
from foon_asp.report.verdict import Listed, obstacle_json, verdict_text
from foon_asp.search import Ending, Retrieval, Search
from foon_asp.text import write_units


def retrieval_text(
    problem: Problem, search: Search, retrieval: Retrieval, simulation: Simulation | None
) -> str:
    """Say what the search promises, whether its tree executes, and list the tree as it was returned."""
    lines = list(goal_lines(problem))
    lines.append(f"{search.name} promises {search.promise}")
    if simulation is None:
        return "\n".join([*lines, _ending(problem, retrieval)]) + "\n"
    lines.append(verdict_text(problem, _listed(problem, retrieval), simulation).rstrip("\n"))
    return "\n".join([*lines, "", *steps(problem, retrieval.units)]) + "\n"


def retrieval_json(
    problem: Problem, search: Search, retrieval: Retrieval, simulation: Simulation | None
) -> str:
    """Give the same as JSON; positions count from 1."""
    objects = problem.network.objects
    listed = _listed(problem, retrieval)
    result = {
        "goals": [str(objects[goal]) for goal in problem.goals],
        **goals_stand_for_json(problem),
        "containers": str(problem.containers),
        "level": problem.network.level,
        "search": search.name,
        "ending": str(retrieval.ending),
        "stuck_at": None if retrieval.stuck_at is None else str(objects[retrieval.stuck_at]),
        "verdict": None if simulation is None else str(simulation.verdict),
        "as_listed": None if simulation is None else obstacle_json(listed, simulation.as_listed),
        "in_any_order": None if simulation is None else obstacle_json(listed, simulation.obstacle),
        "order": None if simulation is None else [position + 1 for position in simulation.order],
        "costs": None if simulation is None else costs_json(problem.costs(retrieval.units)),
        "units": None
        if simulation is None
        else [unit_json(problem.network, unit) for unit in retrieval.units],
    }
    return json.dumps(result, indent=2, ensure_ascii=False) + "\n"


def retrieval_foon(
    problem: Problem, search: Search, retrieval: Retrieval, simulation: Simulation | None
) -> str:
    """Give the tree as FOON text, in the order listed; a comment says whether it executes."""
    if simulation is None:
        return f"# {search.name}: {_ending(problem, retrieval)}\n"
    goals = " + ".join(str(problem.network.objects[goal]) for goal in problem.goals)
    comments = [
        f"Task tree for: {goals}",
        f"{search.name} ({problem.conditions}): {simulation.verdict}, "
        f"{costs_text(problem.costs(retrieval.units))}",
    ]
    return write_units(map(problem.network.unit, retrieval.units), comments)


def _listed(problem: Problem, retrieval: Retrieval) -> Listed:
    network = problem.network
    return [(network.unit(unit), network.sources[unit][0]) for unit in retrieval.units]


def _ending(problem: Problem, retrieval: Retrieval) -> str:
    if retrieval.ending is Ending.STUCK and retrieval.stuck_at is not None:
        stuck = problem.network.objects[retrieval.stuck_at]
        return f"no tree: no unit makes {stuck}, and it is not in the kitchen"
    if retrieval.ending is Ending.NONE:
        return "no tree: none executes, at any depth"
    return "unknown: stopped at a limit before a tree was found"
