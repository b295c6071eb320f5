"""Plans, trees of any origin and networks as drawings, with a caption that says whether they execute."""

from collections.abc import Collection, Iterable, Sequence

from foon_asp.network import FunctionalUnit, Network, ObjectNode, TaskTree, counted
from foon_asp.pictures.drawing import Drawing, draw_network, draw_plan, draw_tree
from foon_asp.problem import ContainerRule, Problem, conditions, given_outputs
from foon_asp.proof.replay import replay_for
from foon_asp.proof.simulation import Verdict, simulate


def plan_drawing(problem: Problem, units: Sequence[FunctionalUnit], caption: str = "") -> Drawing:
    """Draw a plan in which items are used up; without a caption, it says whether the plan runs."""
    replay = replay_for(problem, units)
    taken = [{copy.node: copy.made for copy in (*step.gone, *step.stayed)} for step in replay.steps]
    taken += [{} for _ in units[len(taken) :]]
    left = {copy.node: copy.made for copy in replay.left}
    kept = {goal: left.get(goal) for goal in problem.goal_nodes}
    kitchen = {node for unit in units for node in unit.inputs if problem.at_hand(node)}
    runs = "runs" if replay.shortage is None else f"does not run for want of {replay.shortage.node}"
    caption = caption or f"{runs} ({problem.conditions}), {counted(len(units), 'unit')}"
    captions = f"Plan for {_joined(kept)}", caption
    return draw_plan(units, taken, kept, kitchen.union(filter(problem.at_hand, kept)), captions)


def tree_drawing(
    tree: TaskTree,
    kitchen: Collection[ObjectNode],
    goals: Sequence[ObjectNode],
    containers: ContainerRule,
    utensils: frozenset[str],
    network: Network,
    claim: Iterable[str] = (),
) -> Drawing:
    """Draw a tree with lines about what is proved of it.

    Without a claim, the units are numbered in an order that executes if one does, and the caption says
    whether.
    """
    units, lines = tree.units, [*claim]
    if not lines:
        simulation = simulate(tree, frozenset(kitchen), tuple(goals), containers, utensils, network)
        if simulation.verdict is Verdict.REORDERED:
            units = tuple(units[position] for position in simulation.order)
        verdict = {
            Verdict.AS_LISTED: "executes as listed",
            Verdict.REORDERED: "executes in the order of the numbers, not as listed",
            Verdict.NEVER: "does not execute; numbered as listed",
        }[simulation.verdict]
        lines = [f"{verdict} ({conditions(containers, network.level)}), {counted(len(units), 'unit')}"]
    title = f"Task tree for {_joined(goals)}" if goals else "Task tree"
    gives = [given_outputs(unit, containers, utensils, network) for unit in units]
    return draw_tree(units, kitchen, goals, (title, *lines), gives)


def network_drawing(
    network: Network,
    units: Iterable[int],
    kitchen: Iterable[int],
    goals: Iterable[int],
    caption: Iterable[str],
) -> Drawing:
    """Draw units of a network as a graph; object nodes, too, are given by id."""
    objects = network.objects
    numbered = ((network.unit_number(unit), network.unit(unit)) for unit in units)
    return draw_network(numbered, {objects[o] for o in kitchen}, {objects[o] for o in goals}, caption)


def _joined(nodes: Iterable[object]) -> str:
    return " + ".join(map(str, nodes))
