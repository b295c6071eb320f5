"""Drawings of plans, task trees and networks; the caption says whether a plan or tree executes."""

from collections.abc import Collection, Iterable, Sequence

from foon_asp.network import FunctionalUnit, Network, ObjectNode, TaskTree, counted
from foon_asp.pictures.drawing import Drawing, draw_network, draw_plan, draw_tree
from foon_asp.problem import ContainerRule, Problem, conditions, given_outputs
from foon_asp.proof.replay import replay_for
from foon_asp.proof.simulation import Verdict, simulate


def plan_drawing(problem: Problem, units: Sequence[FunctionalUnit], caption: str = "") -> Drawing:
    """Return the drawing of a plan in which items are used up, under a title and ``caption``.

    If ``caption`` is empty, another text replaces it. This text says whether the plan executes, or else which
    node it lacks. It also states the conditions and the number of units.
    """
    replay = replay_for(problem, units)
    sources = [{copy.node: copy.made for copy in (*step.gone, *step.stayed)} for step in replay.steps]
    sources += [{} for _ in units[len(sources) :]]
    makers_at_end = {copy.node: copy.made for copy in replay.left}
    goal_sources = {goal: makers_at_end.get(goal) for goal in problem.goal_nodes}
    kitchen = {node for unit in units for node in unit.inputs if problem.at_hand(node)}
    runs = "runs" if replay.shortage is None else f"does not run for want of {replay.shortage.node}"
    caption = caption or f"{runs} ({problem.conditions}), {counted(len(units), 'unit')}"
    kitchen.update(filter(problem.at_hand, goal_sources))
    captions = f"Plan for {_join_names(goal_sources)}", caption
    return draw_plan(units, sources, goal_sources, kitchen, captions)


def tree_drawing(
    tree: TaskTree,
    kitchen: Collection[ObjectNode],
    goals: Sequence[ObjectNode],
    containers: ContainerRule,
    utensils: frozenset[str],
    network: Network,
    claim: Iterable[str] = (),
) -> Drawing:
    """Return the drawing of a task tree; its caption is a title and the lines of ``claim``.

    ``claim`` says what is proved about the tree, whose units are then numbered as in ``tree``. Without a
    claim, the caption says whether the tree executes, under which conditions, and how many units it has. Then
    units are numbered in an executable order, if there is one.
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
    title = f"Task tree for {_join_names(goals)}" if goals else "Task tree"
    add_effects = [given_outputs(unit, containers, utensils, network) for unit in units]
    return draw_tree(units, kitchen, goals, (title, *lines), add_effects)


def network_drawing(
    network: Network,
    units: Iterable[int],
    kitchen: Iterable[int],
    goals: Iterable[int],
    caption: Iterable[str],
) -> Drawing:
    """Return the drawing of units of a network as a graph.

    Units, kitchen items and goals are ids in ``network``; boxes have the ids of units in the whole network.
    """
    objects = network.objects
    numbered = ((network.unit_number(unit), network.unit(unit)) for unit in units)
    return draw_network(numbered, {objects[o] for o in kitchen}, {objects[o] for o in goals}, caption)


def _join_names(nodes: Iterable[object]) -> str:
    """Return the names of nodes in one text, with plus signs between them."""
    return " + ".join(map(str, nodes))
