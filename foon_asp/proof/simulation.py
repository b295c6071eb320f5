"""Simulation of a tree whose items last, in plain Python and without the solver's code."""

from collections.abc import Iterator, Sequence
from enum import StrEnum
from typing import NamedTuple

from foon_asp.network import Network, ObjectNode, TaskTree
from foon_asp.problem import ContainerRule, Problem, given_outputs, needed_inputs


class Verdict(StrEnum):
    """How a tree executes: ``AS_LISTED``, ``REORDERED`` (in another order), or ``NEVER``.

    Example:
        >>> problem = foon_asp.load().problem("ice")
        >>> foon_asp.check(problem, foon_asp.solve(problem).tree).verdict
        <Verdict.AS_LISTED: 'executes as listed'>
    """

    AS_LISTED = "executes as listed"
    REORDERED = "executes in another order"
    NEVER = "does not execute"


class Obstacle(NamedTuple):
    """Why a tree does not execute: a unit, and an input that it lacks.

    ``unit``: the position of the unit in the tree, from 0. ``None`` if every unit runs and a goal is missing.
    ``missing``: the input or goal that is not available.
    ``cycle``: positions of units in a cycle that ``unit`` waits for. Each unit needs an output of the next,
    and the last unit needs an output of the first. If it is empty, ``unit`` depends on an input that no unit
    makes.
    ``used_up_by``: in a plan, the positions of the steps that used up copies of ``missing``.
    ``amount``: in a plan, the number of copies needed.
    """

    unit: int | None
    missing: ObjectNode
    cycle: tuple[int, ...] = ()
    used_up_by: tuple[int, ...] = ()
    amount: int = 1


class Simulation(NamedTuple):
    """The result of a simulation of a tree.

    ``verdict``: how the tree executes.
    ``order``: the positions of the units in the tree, from 0, in an order that executes. Units that cannot
    run are omitted.
    ``as_listed``: the obstacle in the listed order; ``None`` if the tree executes as listed.
    ``obstacle``: an obstacle in every order; ``None`` if some order executes.

    Example:
        >>> problem = foon_asp.load().problem("macaroni")
        >>> foon_asp.check(problem, foon_asp.search(problem, "bfs").tree).order[:4]
        (1, 2, 5, 6)
    """

    verdict: Verdict
    order: tuple[int, ...]
    as_listed: Obstacle | None
    obstacle: Obstacle | None


def simulate_for(problem: Problem, tree: TaskTree) -> Simulation:
    """Simulate a tree from the kitchen of a problem, for its goals and under its container rule.

    Items last, whatever the problem says about them.
    """
    network = problem.network
    goals = tuple(network.objects[goal] for goal in problem.goals)
    # Only goals and inputs of the tree: a large kitchen takes longer to hash than a tree to execute.
    relevant = {*goals, *(node for unit in tree for node in unit.inputs)}
    kitchen = frozenset(node for node in relevant if network.object_id(node) in problem.kitchen)
    return simulate(tree, kitchen, goals, problem.containers, problem.utensils, network)


def simulate(
    tree: TaskTree,
    kitchen: frozenset[ObjectNode],
    goals: tuple[ObjectNode, ...],
    containers: ContainerRule,
    utensils: frozenset[str],
    network: Network | None = None,
) -> Simulation:
    """Execute the units of a tree from the kitchen: first as listed, then in any order that works.

    Items last. The tree executes if all its units run and all goals are then available. Below level 3,
    ``network`` has to be the network of the units. A unit then stands for several units of level 3, which
    decide its preconditions and add effects.
    """
    needs = [needed_inputs(unit, containers, utensils, network) for unit in tree]
    gives = [given_outputs(unit, containers, utensils, network) for unit in tree]
    available = set(kitchen)
    as_listed: Obstacle | None = None
    for position, needed in enumerate(needs):
        lacking = next((node for node in needed if node not in available), None)
        if lacking is not None:
            as_listed = Obstacle(position, lacking)
            break
        available.update(gives[position])
    if as_listed is None:
        as_listed = _missing_goal(goals, available)
        if as_listed is None:
            return Simulation(Verdict.AS_LISTED, tuple(range(len(tree))), None, None)

    available = set(kitchen)
    order: list[int] = []
    waiting = list(range(len(tree)))
    progress = True
    while waiting and progress:
        held_back: list[int] = []
        for position in waiting:
            if available.issuperset(needs[position]):
                available.update(gives[position])
                order.append(position)
            else:
                held_back.append(position)
        progress = len(held_back) < len(waiting)
        waiting = held_back
    if waiting:
        lacking = next(node for node in needs[waiting[0]] if node not in available)
        blocked = Obstacle(waiting[0], lacking, _waiting_cycle(needs, gives, waiting, available))
        return Simulation(Verdict.NEVER, tuple(order), as_listed, blocked)
    obstacle = _missing_goal(goals, available)
    verdict = Verdict.REORDERED if obstacle is None else Verdict.NEVER
    return Simulation(verdict, tuple(order), as_listed, obstacle)


def _missing_goal(goals: tuple[ObjectNode, ...], available: set[ObjectNode]) -> Obstacle | None:
    """Return an obstacle for the first goal that is not available; ``None`` if all are available."""
    missing = next((goal for goal in goals if goal not in available), None)
    return None if missing is None else Obstacle(None, missing)


def _waiting_cycle(
    needs: Sequence[tuple[ObjectNode, ...]],
    gives: Sequence[tuple[ObjectNode, ...]],
    waiting: Sequence[int],
    available: set[ObjectNode],
) -> tuple[int, ...]:
    """Return a cycle of waiting units, by position, that keeps the first waiting unit from running.

    A unit waits for each waiting unit that makes an unavailable input of it. Return an empty tuple if there
    is no such cycle. ``needs`` and ``gives`` have the preconditions and add effects of each unit, by
    position.
    """
    makers: dict[ObjectNode, list[int]] = {}
    for position in waiting:
        for node in gives[position]:
            makers.setdefault(node, []).append(position)

    def waits_for(position: int) -> Iterator[int]:
        """Yield the positions of the waiting units that make an unavailable input of a unit."""
        for node in needs[position]:
            if node not in available:
                yield from makers.get(node, ())

    path = [waiting[0]]
    branches = [waits_for(waiting[0])]
    done: set[int] = set()
    while path:
        following = next(branches[-1], None)
        if following is None:
            done.add(path.pop())
            branches.pop()
        elif following in path:
            return tuple(path[path.index(following) :])
        elif following not in done:
            path.append(following)
            branches.append(waits_for(following))
    return ()
