"""Plans for a robot's program: each step with its objects by role, and the steps that it waits for."""

from collections.abc import Collection, Iterable
from dataclasses import replace

from foon_asp.document.json_document import document, fraction_json, mention_json, named_json
from foon_asp.network import FunctionalUnit, ObjectNode
from foon_asp.problem import Objective, Problem, UsedUp
from foon_asp.proof.replay import replay_for, waits
from foon_asp.text.json_value import Json


def replayable(problem: Problem, units: Iterable[FunctionalUnit]) -> Problem:
    """Give a problem whose plans can be replayed: if items last, everything in the plan stays."""
    if problem.items is not None:
        return problem
    stays: dict[str | ObjectNode, bool] = {node.label: True for unit in units for node in unit.inputs}
    return replace(problem, items=UsedUp(stays))


def robot_steps(problem: Problem, objectives: Iterable[Objective], plan: Collection[int]) -> Json:
    """Give a plan that runs as a document."""
    tree = problem.tree(plan)
    replay = replay_for(replayable(problem, tree), tree)
    steps = []
    for step, (done, after, id_) in enumerate(zip(replay.steps, waits(replay), plan, strict=True)):
        unit = done.unit
        roles = _roles(unit, problem.utensils)
        steps.append(
            {
                "step": step + 1,
                **mention_json(problem.network, id_),
                **{
                    role: [named_json(problem.network, node) for node in roles[role]]
                    for role in ("acted_on", "tools")
                },
                "from": roles_labels(unit.inputs),
                "to": roles_labels(unit.outputs),
                "makes": [named_json(problem.network, copy.node) for copy in done.came],
                "after": [earlier + 1 for earlier in sorted(after)],
                "rate": None if problem.rates is None else fraction_json(problem.rate(id_)),
            }
        )
    return document("steps", problem, objectives, steps=steps)


def roles_labels(nodes: Iterable[ObjectNode]) -> list[str]:
    """Give the labels of what nodes are in, on or at."""
    return sorted({relation.object for node in nodes for relation in node.relations})


def _roles(unit: FunctionalUnit, utensils: frozenset[str]) -> dict[str, list[ObjectNode]]:
    """Divide what a unit takes: tools are utensils that nothing comes from or goes to."""
    places = {*roles_labels(unit.inputs), *roles_labels(unit.outputs)}
    taken = [node for node in unit.inputs if node.label not in places]
    return {
        "tools": [node for node in taken if node.label in utensils],
        "acted_on": [node for node in taken if node.label not in utensils],
    }
