"""What cannot be made for some goals, what is at the root of it, and the way there."""

import heapq
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from enum import StrEnum
from typing import NamedTuple

from foon_asp.network.dead_cycles import DeadCycle, dead_cycles
from foon_asp.problem.problem import Problem
from foon_asp.problem.relevance import reach


class Cause(StrEnum):
    """Why an object node is at the root of a dead end.

    ``missing``: it is not in the kitchen, and no unit makes it (one that needs it only hands it on).
    ``cycle``: every unit that makes it needs one of a set of nodes that can only be made from each other.
    """

    MISSING = "missing"
    CYCLE = "cycle"


class Root(NamedTuple):
    """An object node at the root of a dead end.

    ``stops`` are the units that lack it on the way to a goal, ``on_the_way`` says whether it is on the way
    that takes the fewest things. ``cycle`` is the set of nodes that feeds only itself, for that cause.
    """

    object: int
    cause: Cause
    stops: tuple[int, ...]
    on_the_way: bool
    cycle: DeadCycle | None = None


class Blocked(NamedTuple):
    """A unit that cannot run, and those of its needed inputs that cannot be had."""

    unit: int
    lacks: tuple[int, ...]


class DeadEnds(NamedTuple):
    """What cannot be made for some goals.

    ``goals`` are those that cannot. ``makers`` has every object node that is needed for one of them, on any
    way, and cannot be had, with the units that would make it, those first that take the fewest things more.
    ``roots`` are the causes, those on the easiest way first. ``available`` has a 1 for every node, by id,
    that is at hand or can be made.
    """

    goals: tuple[int, ...]
    makers: dict[int, tuple[Blocked, ...]]
    roots: tuple[Root, ...]
    available: bytearray


def dead_ends(problem: Problem) -> DeadEnds:
    """Find which goals cannot be made from the kitchen and why, whatever constraints say.

    Where every goal can be made, nothing is listed. Takes time about linear in the network.
    """
    available = reach(problem).available
    goals = tuple(goal for goal in problem.goals if not available[goal])
    makers = _makers(problem, goals, available)
    cycles: list[DeadCycle] = []
    missing = dict.fromkeys((o for o, found in makers.items() if not found), 1)
    things, easiest = h_add(makers, missing)
    while len(things) < len(makers):  # the others wait for each other, also with all that is missing at hand
        cycles += _cycles(problem, makers.keys() - things)
        in_cycles = dict.fromkeys((node for cycle in cycles for node in cycle.nodes), 1)
        things, easiest = h_add(makers, missing | in_cycles)
    cycle_of = {node: cycle for cycle in cycles for node in cycle.nodes}
    ordered = {o: _in_order(found, things, easiest.get(o)) for o, found in makers.items()}
    way = _way(goals, ordered, cycle_of)
    users = _users(ordered)
    roots = [Root(o, Cause.MISSING, tuple(sorted(users.get(o, ()))), o in way) for o in missing]
    for cycle in cycles:
        entered = [o for o, _ in cycle.steps if o in way] + sorted(way & cycle.nodes)
        node = entered[0] if entered else cycle.steps[0][0]
        stops = {unit for o in cycle.nodes for unit in users.get(o, ())}
        roots.append(Root(node, Cause.CYCLE, tuple(sorted(stops)), bool(entered), cycle))
    roots.sort(key=lambda root: not root.on_the_way)
    return DeadEnds(goals, ordered, tuple(roots), available)


def _makers(problem: Problem, goals: Sequence[int], available: bytearray) -> dict[int, tuple[Blocked, ...]]:
    """Go backwards from the goals through all that cannot be had."""
    needs = problem.needs
    makers: dict[int, tuple[Blocked, ...]] = {}
    stack = list(reversed(goals))
    while stack:
        o = stack.pop()
        if o in makers:
            continue
        makers[o] = tuple(
            Blocked(unit, tuple(need for need in needs[unit] if not available[need]))
            for unit in problem.makers[o]
            if o not in needs[unit]
        )
        stack += [lack for blocked in reversed(makers[o]) for lack in reversed(blocked.lacks)]
    return makers


def _users(makers: Mapping[int, Sequence[Blocked]]) -> dict[int, list[int]]:
    """Give for each dead end the units that lack it."""
    users: dict[int, list[int]] = {}
    for blocked in {b.unit: b for found in makers.values() for b in found}.values():
        for lack in blocked.lacks:
            users.setdefault(lack, []).append(blocked.unit)
    return users


def _in_order(found: tuple[Blocked, ...], things: dict[int, int], easiest: int | None) -> tuple[Blocked, ...]:
    """Put the easiest unit first, and then those that take the fewest things more."""
    return tuple(
        sorted(found, key=lambda b: (b.unit != easiest, sum(things[lack] for lack in b.lacks), b.unit))
    )


def _cycles(problem: Problem, waiting: Collection[int]) -> list[DeadCycle]:
    """Find sets of nodes that can only be made from each other, among those given; all else is at hand."""
    others = [o for o in range(len(problem.network.objects)) if o not in waiting]
    return dead_cycles(replace(problem.network, inputs=problem.needs, outputs=problem.gives), others)


def h_add(
    makers: Mapping[int, Sequence[Blocked]], sources: Mapping[int, int]
) -> tuple[dict[int, int], dict[int, int]]:
    """Estimate what each dead end costs, a shared source counted each time it is needed.

    ``sources`` have costs above 0, other nodes cost as much as the inputs of their cheapest unit (Bonet and
    Geffner, Planning as heuristic search, 2001, by Knuth, A generalization of Dijkstra's algorithm, 1977). A
    node that the sources do not lead to has no estimate. The second dictionary has the cheapest unit of each
    node for which it costs less than the node as a source; following these never leads in a circle.
    """
    lacking = {blocked.unit: len(blocked.lacks) for found in makers.values() for blocked in found}
    made_by: dict[int, list[int]] = {}
    for o, found in makers.items():
        for blocked in found:
            made_by.setdefault(blocked.unit, []).append(o)
    users = _users(makers)
    sums = dict.fromkeys(lacking, 0)
    settled: dict[int, int] = {}
    easiest: dict[int, int] = {}
    queue = [(cost, -1, o) for o, cost in sources.items()]
    heapq.heapify(queue)
    while queue:
        count, maker, o = heapq.heappop(queue)
        if o in settled:
            continue
        settled[o] = count
        if maker >= 0:
            easiest[o] = maker
        for unit in users.get(o, ()):
            sums[unit] += count
            lacking[unit] -= 1
            if not lacking[unit]:
                for made in made_by[unit]:
                    heapq.heappush(queue, (sums[unit], unit, made))
    return settled, easiest


def _way(
    goals: Sequence[int], makers: dict[int, tuple[Blocked, ...]], cycle_of: dict[int, DeadCycle]
) -> set[int]:
    """Give the dead ends on the easiest way: through the first unit each time, and not around a cycle."""
    way: set[int] = set()
    stack = list(goals)
    while stack:
        o = stack.pop()
        if o not in way:
            way.add(o)
            if makers[o] and o not in cycle_of:
                stack += makers[o][0].lacks
    return way
