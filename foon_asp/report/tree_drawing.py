"""Task trees as drawings: the answer to a question, or a tree of any origin and whether it executes."""

from collections.abc import Collection, Iterable, Sequence

from foon_asp.asp import Outcome
from foon_asp.network import FunctionalUnit, Network, ObjectNode, TaskTree, counted
from foon_asp.problem import ContainerRule, Problem, conditions, given_outputs
from foon_asp.proof.replay import replay_for
from foon_asp.proof.simulation import Verdict, simulate
from foon_asp.report.answer import headline
from foon_asp.report.drawing import Drawing, draw_plan, draw_tree


def solved_tree(outcome: Outcome, units: tuple[int, ...]) -> Drawing:
    """Draw the tree of an answer; the caption says what is proved of it."""
    return listed_tree(outcome.problem, units, headline(outcome))


def listed_tree(problem: Problem, units: Sequence[int], caption: str) -> Drawing:
    """Draw units by id, in an order that executes, as a tree for the goals of a problem."""
    if problem.items is not None:
        return plan_drawing(problem, problem.tree(units).units, caption=caption)
    objects = problem.network.objects
    goals = [objects[o] for o in problem.goals]
    met = {o for unit in units for o in (*problem.network.inputs[unit], *problem.network.outputs[unit])}
    kitchen = {objects[o] for o in met.union(problem.goals) if o in problem.kitchen}
    tree = problem.tree(units)
    gives = [[objects[o] for o in problem.gives[unit]] for unit in units]
    return draw_tree(tree.units, kitchen, goals, (f"Task tree for {_joined(goals)}", caption), gives)


def plan_drawing(
    problem: Problem, units: Sequence[FunctionalUnit], name: str = "", caption: str = ""
) -> Drawing:
    """Draw a plan in which items are used up; without a caption, it says whether the plan runs."""
    replay = replay_for(problem, units)
    taken = [{copy.node: copy.made for copy in (*step.gone, *step.stayed)} for step in replay.steps]
    taken += [{} for _ in units[len(taken) :]]
    left = {copy.node: copy.made for copy in replay.left}
    kept = {goal: left.get(goal) for goal in problem.goal_nodes}
    kitchen = {node for unit in units for node in unit.inputs if problem.at_hand(node)}
    runs = "runs" if replay.shortage is None else f"does not run for want of {replay.shortage.node}"
    caption = caption or f"{runs} ({problem.conditions}), {counted(len(units), 'unit')}"
    title = f"Plan {name} for {_joined(kept)}" if name else f"Plan for {_joined(kept)}"
    return draw_plan(units, taken, kept, kitchen.union(filter(problem.at_hand, kept)), (title, caption))


def given_tree(
    name: str,
    tree: TaskTree,
    kitchen: Collection[ObjectNode],
    goals: Sequence[ObjectNode],
    containers: ContainerRule,
    utensils: frozenset[str],
    network: Network,
) -> Drawing:
    """Draw a tree of any origin, numbered in an order that executes if one does; the caption says whether."""
    simulation = simulate(tree, frozenset(kitchen), tuple(goals), containers, utensils, network)
    units = tree.units
    if simulation.verdict is Verdict.REORDERED:
        units = tuple(units[position] for position in simulation.order)
    title = f"Task tree {name}".rstrip() + (f" for {_joined(goals)}" if goals else "")
    verdict = {
        Verdict.AS_LISTED: "executes as listed",
        Verdict.REORDERED: "executes in the order of the numbers, not as listed",
        Verdict.NEVER: "does not execute; numbered as listed",
    }[simulation.verdict]
    caption = f"{verdict} ({conditions(containers, network.level)}), {counted(len(units), 'unit')}"
    gives = [given_outputs(unit, containers, utensils, network) for unit in units]
    return draw_tree(units, kitchen, goals, (title, caption), gives)


def _joined(nodes: Iterable[object]) -> str:
    return " + ".join(map(str, nodes))
