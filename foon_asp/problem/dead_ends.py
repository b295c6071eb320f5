"""Dead ends: goals that cannot be made from the kitchen, and the object nodes that cause it."""

import heapq
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from enum import StrEnum
from typing import NamedTuple

from foon_asp.network.dead_cycles import DeadCycle, dead_cycles
from foon_asp.problem.problem import Problem
from foon_asp.problem.relevance import reach


class Cause(StrEnum):
    """The reason why an object node causes dead ends: goals that cannot be made.

    ``missing``: the node is not in the kitchen, and every unit that makes it also needs it.
    ``cycle``: the node is in a set of nodes that can only be made from each other.
    """

    MISSING = "missing"
    CYCLE = "cycle"


class RootCause(NamedTuple):
    """An object node that causes dead ends: goals that cannot be made.

    ``object``: the id of the node. For the cause ``cycle``, it is a node of the cycle, if possible one on
    the cheapest path to the goals.
    ``cause``: why it cannot be made: ``missing`` or ``cycle``.
    ``stops``: the ids of the units that need the node, or a node of its cycle, on some path to an
    unreachable goal.
    ``on_the_way``: whether the cheapest path to the goals needs the node, or a node of its cycle. The
    cheapest path needs the fewest missing nodes, by the heuristic h_add.
    ``cycle``: the set of nodes that can only be made from each other; ``None`` for the cause ``missing``.
    """

    object: int
    cause: Cause
    stops: tuple[int, ...]
    on_the_way: bool
    cycle: DeadCycle | None = None


class Blocked(NamedTuple):
    """A unit that cannot be executed: its id, and the ids of its unreachable preconditions."""

    unit: int
    lacks: tuple[int, ...]


class DeadEnds(NamedTuple):
    """The unreachable part of a network that concerns some goals; all nodes are given by id.

    ``goals``: the unreachable goals.
    ``makers``: the achievers of each unreachable node on some path to these goals. The cheapest achiever by
    h_add comes first. A unit that also needs the node is no achiever.
    ``roots``: the causes. Causes on the cheapest path to the goals come first.
    ``available``: for each node of the network, 1 if it is reachable, else 0.
    """

    goals: tuple[int, ...]
    makers: dict[int, tuple[Blocked, ...]]
    roots: tuple[RootCause, ...]
    available: bytearray


def dead_ends(problem: Problem) -> DeadEnds:
    """Return the goals that cannot be made from the kitchen, with the causes; user rules are ignored.

    If all goals are reachable, ``goals``, ``makers`` and ``roots`` of the result are empty. The time is
    nearly linear in the size of the network.
    """
    available = reach(problem).available
    goals = tuple(goal for goal in problem.goals if not available[goal])
    achievers = _unreachable_achievers(problem, goals, available)
    cycles: list[DeadCycle] = []
    missing = dict.fromkeys((o for o, units in achievers.items() if not units), 1)
    h_values, cheapest = h_add(achievers, missing)
    while len(h_values) < len(achievers):  # nodes without a value are in cycles, or need nodes that are
        cycles += _unreachable_cycles(problem, achievers.keys() - h_values)
        in_cycles = dict.fromkeys((node for cycle in cycles for node in cycle.nodes), 1)
        h_values, cheapest = h_add(achievers, missing | in_cycles)
    cycle_of = {node: cycle for cycle in cycles for node in cycle.nodes}
    ordered = {o: _sort_achievers(units, h_values, cheapest.get(o)) for o, units in achievers.items()}
    path = _cheapest_path(goals, ordered, cycle_of)
    consumers = _consumers(ordered)
    roots = [RootCause(o, Cause.MISSING, tuple(sorted(consumers.get(o, ()))), o in path) for o in missing]
    for cycle in cycles:
        entered = [o for o, _ in cycle.steps if o in path] + sorted(path & cycle.nodes)
        node = entered[0] if entered else cycle.steps[0][0]
        stops = {unit for o in cycle.nodes for unit in consumers.get(o, ())}
        roots.append(RootCause(node, Cause.CYCLE, tuple(sorted(stops)), bool(entered), cycle))
    roots.sort(key=lambda root: not root.on_the_way)
    return DeadEnds(goals, ordered, tuple(roots), available)


def _unreachable_achievers(
    problem: Problem, goals: Sequence[int], available: bytearray
) -> dict[int, tuple[Blocked, ...]]:
    """Return the achievers of each unreachable node on paths to the goals, by node id.

    The nodes are listed depth-first, backward from the goals. A unit that also needs the node is no achiever.
    A node without achievers has an empty tuple.
    """
    needs = problem.needs
    achievers: dict[int, tuple[Blocked, ...]] = {}
    stack = list(reversed(goals))
    while stack:
        o = stack.pop()
        if o in achievers:
            continue
        achievers[o] = tuple(
            Blocked(unit, tuple(need for need in needs[unit] if not available[need]))
            for unit in problem.makers[o]
            if o not in needs[unit]
        )
        stack += [lack for blocked in reversed(achievers[o]) for lack in reversed(blocked.lacks)]
    return achievers


def _consumers(achievers: Mapping[int, Sequence[Blocked]]) -> dict[int, list[int]]:
    """Return, by node id, the ids of the blocked units that lack the node."""
    consumers: dict[int, list[int]] = {}
    for blocked in {unit.unit: unit for units in achievers.values() for unit in units}.values():
        for lack in blocked.lacks:
            consumers.setdefault(lack, []).append(blocked.unit)
    return consumers


def _sort_achievers(
    units: tuple[Blocked, ...], h_values: dict[int, int], cheapest: int | None
) -> tuple[Blocked, ...]:
    """Return the achievers of a node, sorted; the unit with the id ``cheapest`` comes first.

    The others are sorted by the sum of the h-values of the nodes that they lack, then by id, both ascending.
    If ``cheapest`` is ``None``, all are sorted in this way.
    """

    def key(blocked: Blocked) -> tuple[bool, int, int]:
        """Return the sort key of an achiever."""
        return blocked.unit != cheapest, sum(h_values[lack] for lack in blocked.lacks), blocked.unit

    return tuple(sorted(units, key=key))


def _unreachable_cycles(problem: Problem, unreachable: Collection[int]) -> list[DeadCycle]:
    """Return the sets of unreachable nodes that can only be made from each other.

    All nodes outside ``unreachable`` count as available.
    """
    available = [o for o in range(len(problem.network.objects)) if o not in unreachable]
    return dead_cycles(replace(problem.network, inputs=problem.needs, outputs=problem.gives), available)


def h_add(
    achievers: Mapping[int, Sequence[Blocked]], sources: Mapping[int, int]
) -> tuple[dict[int, int], dict[int, int]]:
    """Return two mappings by node id: h_add values (Bonet & Geffner 2001), and the ids of cheapest achievers.

    ``achievers`` has the achievers of each unreachable node. ``sources`` maps nodes to their costs, above 0.
    Any other node costs as much as the preconditions of its cheapest achiever together. The values are
    computed by Knuth's generalization of Dijkstra's algorithm (1977).

    A node that cannot be made from the sources is in neither mapping. A source has a cheapest achiever only
    if the achiever costs less than the source itself. The cheapest achievers have no cycle.
    """
    lacking = {blocked.unit: len(blocked.lacks) for units in achievers.values() for blocked in units}
    made_by: dict[int, list[int]] = {}
    for o, units in achievers.items():
        for blocked in units:
            made_by.setdefault(blocked.unit, []).append(o)
    consumers = _consumers(achievers)
    sums = dict.fromkeys(lacking, 0)
    h_values: dict[int, int] = {}
    cheapest: dict[int, int] = {}
    queue = [(cost, -1, o) for o, cost in sources.items()]
    heapq.heapify(queue)
    while queue:
        cost, achiever, o = heapq.heappop(queue)
        if o in h_values:
            continue
        h_values[o] = cost
        if achiever >= 0:
            cheapest[o] = achiever
        for unit in consumers.get(o, ()):
            sums[unit] += cost
            lacking[unit] -= 1
            if not lacking[unit]:
                for made in made_by[unit]:
                    heapq.heappush(queue, (sums[unit], unit, made))
    return h_values, cheapest


def _cheapest_path(
    goals: Sequence[int], achievers: dict[int, tuple[Blocked, ...]], cycle_of: dict[int, DeadCycle]
) -> set[int]:
    """Return the nodes on the cheapest path: backward from the goals through the first achiever of each node.

    The path ends at nodes without achievers, and at nodes in ``cycle_of``; both are included.
    """
    path: set[int] = set()
    stack = list(goals)
    while stack:
        o = stack.pop()
        if o not in path:
            path.add(o)
            if achievers[o] and o not in cycle_of:
                stack += achievers[o][0].lacks
    return path
