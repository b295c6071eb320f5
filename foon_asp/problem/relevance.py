"""Forward reachability from the kitchen, and backward relevance to the goals; both in linear time."""

from collections import deque
from collections.abc import Container, Iterable, Mapping, Sequence
from functools import lru_cache
from typing import NamedTuple

from foon_asp.network import Network
from foon_asp.problem.container_rule import ContainerRule, Ids, network_sides
from foon_asp.problem.problem import Problem
from foon_asp.problem.restriction import Restriction


class Reached(NamedTuple):
    """The forward closure of the kitchen: all that can be made.

    ``units``: the ids of all reachable units in an executable order, without units that a restriction
    removes.
    ``makers``: maps the id of each object to the first unit in this order that makes the object. So these
    achievers have no cycle. Kitchen items are left out. Required sets of a restriction are included, under
    their ids in :attr:`Problem.targets`.
    ``available``: for each object of the network, 1 if it is reachable, else 0.
    """

    units: tuple[int, ...]
    makers: dict[int, int]
    available: bytearray


def reach(problem: Problem) -> Reached:
    """Return the objects and units reachable from the kitchen, in linear time (Dowling & Gallier 1984).

    Units that the problem's restriction removes are left out.
    """
    return _closure(problem.network, problem.needs, problem.gives, problem.kitchen, problem.restriction)


@lru_cache(maxsize=2)  # successive questions are mostly about the same network and kitchen
def unrestricted_reach(
    network: Network, rule: ContainerRule, utensils: frozenset[str], kitchen: frozenset[int]
) -> Reached:
    """Return what :func:`reach` returns for a problem without a restriction.

    The last two results are cached and shared: callers must not change them.
    """
    return _closure(network, *network_sides(network, rule, utensils), kitchen, None)


def _closure(
    network: Network, needs: Ids, gives: Ids, kitchen: frozenset[int], restriction: Restriction | None
) -> Reached:
    """Return the forward closure of a kitchen, without units that the restriction removes.

    ``needs`` and ``gives`` are the preconditions and add effects of each unit. With ``None`` for
    ``restriction``, no units are removed.
    """
    removed = restriction.removed if restriction else None
    available = bytearray(len(network.objects))
    missing = [len(needed) for needed in needs]
    consumers: Sequence[Sequence[int]] = network.consumers
    if needs is not network.inputs:  # inputs that are skipped are not waited for
        needed_by: list[list[int]] = [[] for _ in network.objects]
        for unit, needed in enumerate(needs):
            for o in needed:
                needed_by[o].append(unit)
        consumers = needed_by
    order: list[int] = []
    makers: dict[int, int] = {}
    queue = deque(sorted(kitchen))
    for o in queue:
        available[o] = 1

    ready = [unit for unit, count in enumerate(missing) if not count]  # a container rule skips every input
    while ready or queue:
        for unit in ready:
            if removed and removed(unit):
                continue
            order.append(unit)
            for o in gives[unit]:
                if not available[o]:
                    available[o] = 1
                    makers[o] = unit
                    queue.append(o)
        ready = []
        if queue:
            for unit in consumers[queue.popleft()]:
                missing[unit] -= 1
                if not missing[unit]:
                    ready.append(unit)
    if restriction and restriction.required:
        positions = {unit: position for position, unit in enumerate(order)}
        for o, units in enumerate(restriction.required, start=len(network.objects)):
            if reached := [positions[unit] for unit in units if unit in positions]:
                makers[o] = order[min(reached)]
    return Reached(tuple(order), makers, available)


def relevant_units(problem: Problem, reached: Reached) -> tuple[int, ...]:
    """Return the reached units that some irredundant tree can contain, in order of id.

    They are found backward from the goals and required sets through all reached achievers, down to the
    kitchen.
    """
    units, _ = search_backward(
        problem.targets, problem.makers, problem.needs, problem.kitchen, frozenset(reached.units)
    )
    return tuple(sorted(units))


def search_backward(
    goals: Iterable[int],
    makers: Sequence[Iterable[int]],
    needs: Sequence[Iterable[int]],
    start: Container[int],
    allowed: Container[int] | None = None,
) -> tuple[set[int], set[int]]:
    """Search backward from the goals through achievers, down to the objects in ``start``.

    Returns two sets of ids: the achievers found, and the objects found, which include the goals. Objects in
    ``start`` are left out. ``makers`` and ``needs`` have the achievers of each object and the preconditions
    of each unit. With ``allowed``, only these units are achievers.
    """
    objects = {o for o in goals if o not in start}
    stack = list(objects)
    achievers: set[int] = set()
    while stack:
        for unit in makers[stack.pop()]:
            if unit not in achievers and (allowed is None or unit in allowed):
                achievers.add(unit)
                for o in needs[unit]:
                    if o not in objects and o not in start:
                        objects.add(o)
                        stack.append(o)
    return achievers, objects


def units_relevant_to_plans(problem: Problem, reached: Reached) -> set[int]:
    """Return the reached units that some irredundant plan can contain, where items are used up.

    They are found backward from the goals through achievers, down to kitchen items that never run out. A unit
    that puts out no more copies of a node than it takes is no achiever of the node.
    """
    flows, endless, allowed = problem.flows, problem.endless, frozenset(reached.units)
    makers, needs = problem.makers, problem.needs
    objects = {o for o in problem.goals if o not in endless}
    stack, achievers = list(objects), set[int]()
    while stack:
        o = stack.pop()
        for unit in makers[o]:
            if unit in allowed and unit not in achievers and o in flows[unit].adds:
                achievers.add(unit)
                newly_needed = [
                    needed for needed in needs[unit] if needed not in objects and needed not in endless
                ]
                objects.update(newly_needed)
                stack += newly_needed
    return achievers


def kitchen_needed(problem: Problem) -> list[int]:
    """Return the ascending ids of kitchen items that a tree for the goals can need, or that are goals.

    Units that cannot be executed are not left out of this search.
    """
    units, _ = search_backward(problem.goals, problem.makers, problem.needs, problem.kitchen)
    needed = {o for unit in units for o in problem.needs[unit]}.union(problem.goals)
    return sorted(needed & problem.kitchen)


def first_tree(problem: Problem, reached: Reached) -> tuple[int, ...] | None:
    """Return a feasible tree, in an executable order; ``None`` if no tree exists.

    It has the first achiever (``reached.makers``) of each node that it needs. Its costs may be far from
    optimal: it is the first incumbent of a search.
    """
    chosen = follow_achievers(problem.targets, reached.makers, problem.needs, problem.kitchen)
    return None if chosen is None else tuple(unit for unit in reached.units if unit in chosen)


def follow_achievers(
    objects: Iterable[int],
    maker: Mapping[int, int],
    needs: Sequence[Iterable[int]],
    start: Container[int],
) -> set[int] | None:
    """Return a set of units that make objects out of ``start``; ``None`` if a needed object has no achiever.

    ``maker`` has one achiever for each object.
    """
    units: set[int] = set()
    stack = list(objects)
    while stack:
        o = stack.pop()
        if o in start:
            continue
        unit = maker.get(o)
        if unit is None:
            return None
        if unit not in units:
            units.add(unit)
            stack.extend(needs[unit])
    return units
