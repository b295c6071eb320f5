"""Forward simulation of a tree, in plain Python and independent of the solver."""

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
    """Why a tree does not execute: the position of a unit in the tree (from 0) and an input it lacks.

    ``unit`` is ``None`` when every unit runs and a goal is still missing; ``missing`` is then the goal.
    ``cycle`` has the positions of a cycle of units that ``unit`` waits for: each waits for an output of the
    next one, and the last for an output of the first. If the cycle is empty, ``unit`` needs, perhaps through
    other units, an input that no unit of the tree makes. In a plan, ``used_up_by`` are the positions of the
    steps that used up copies of ``missing``, and ``amount`` is the number of copies needed.
    """

    unit: int | None
    missing: ObjectNode
    cycle: tuple[int, ...] = ()
    used_up_by: tuple[int, ...] = ()
    amount: int = 1


class Simulation(NamedTuple):
    """The result of a simulation of a tree.

    ``verdict`` tells how the tree executes. ``order`` has positions in the tree, in an executable order;
    units that cannot run are omitted. ``as_listed`` is the obstacle of the listed order, and ``obstacle``
    that of every order; ``None`` without an obstacle.

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
    """Execute a tree from the kitchen of a problem, for its goals and under its container rule."""
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
    """Execute the units of a tree from the kitchen, first as listed, then in any order that works.

    Items are not consumed. The tree executes if all its units run and all goals are then available. Below
    level 3, a unit stands for several units of the ``network`` of level 3, which decide its preconditions and
    add effects.
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
    """Return the first goal that is not available as an obstacle; ``None`` if all are available."""
    missing = next((goal for goal in goals if goal not in available), None)
    return None if missing is None else Obstacle(None, missing)


def _waiting_cycle(
    needs: Sequence[tuple[ObjectNode, ...]],
    gives: Sequence[tuple[ObjectNode, ...]],
    waiting: Sequence[int],
    available: set[ObjectNode],
) -> tuple[int, ...]:
    """Return the positions of a cycle of units that the first waiting unit waits for; empty without one."""
    makers: dict[ObjectNode, list[int]] = {}
    for position in waiting:
        for node in gives[position]:
            makers.setdefault(node, []).append(position)

    def waits_for(position: int) -> Iterator[int]:
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
