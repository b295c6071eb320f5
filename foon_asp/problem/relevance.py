"""What can be made from the kitchen, and what of it can matter for the goals; both in linear time."""

from collections import deque
from collections.abc import Container, Iterable, Mapping, Sequence
from typing import NamedTuple

from foon_asp.problem.problem import Problem


class Reached(NamedTuple):
    """The forward closure of the kitchen.

    ``units`` are all units that some tree can contain, in an order in which they execute.
    ``makers[o]`` is the first of them to make object ``o`` (kitchen items have none), so following the
    makers back never runs in a circle. ``available`` has a 1 for every object at hand or made. A restriction
    leaves its units out, and each set that it requires has a maker like an object (``Problem.targets``).
    """

    units: tuple[int, ...]
    makers: dict[int, int]
    available: bytearray


def reach(problem: Problem) -> Reached:
    """Close the kitchen under the units: the counting algorithm, linear in the size of the network."""
    network, needs, gives = problem.network, problem.needs, problem.gives
    restriction = problem.restriction
    removed = restriction.removed if restriction else None
    available = bytearray(len(network.objects))
    missing = [len(needed) for needed in needs]
    waiting: list[list[int]] = [[] for _ in network.objects]
    for unit, needed in enumerate(needs):
        for o in needed:
            waiting[o].append(unit)
    order: list[int] = []
    makers: dict[int, int] = {}
    found = deque(sorted(problem.kitchen))
    for o in found:
        available[o] = 1

    def execute(unit: int) -> None:
        if removed and removed(unit):
            return
        order.append(unit)
        for o in gives[unit]:
            if not available[o]:
                available[o] = 1
                makers[o] = unit
                found.append(o)

    for unit, count in enumerate(missing):
        if not count:  # possible where the container rule takes every input as given
            execute(unit)
    while found:
        for unit in waiting[found.popleft()]:
            missing[unit] -= 1
            if not missing[unit]:
                execute(unit)
    if restriction and restriction.required:
        places = {unit: place for place, unit in enumerate(order)}
        for o, units in enumerate(restriction.required, start=len(network.objects)):
            if able := [place for unit in units if (place := places.get(unit)) is not None]:
                makers[o] = order[min(able)]
    return Reached(tuple(order), makers, available)


def relevant(problem: Problem, reached: Reached) -> tuple[int, ...]:
    """Give the reached units that some tree without spare units can contain, in order of id.

    Goes backwards from the goals through all reached makers and stops at the kitchen.
    """
    units, _ = backwards(
        problem.targets, problem.makers, problem.needs, problem.kitchen, frozenset(reached.units)
    )
    return tuple(sorted(units))


def backwards(
    goals: Iterable[int],
    makers: Sequence[Iterable[int]],
    needs: Sequence[Iterable[int]],
    start: Container[int],
    allowed: Container[int] | None = None,
) -> tuple[set[int], set[int]]:
    """Go backwards from the goals through all (allowed) makers, and stop at the start.

    Gives the makers that something wanted can come from, and the objects that are wanted.
    """
    wanted = {o for o in goals if o not in start}
    stack = list(wanted)
    chosen: set[int] = set()
    while stack:
        for maker in makers[stack.pop()]:
            if maker not in chosen and (allowed is None or maker in allowed):
                chosen.add(maker)
                for o in needs[maker]:
                    if o not in wanted and o not in start:
                        wanted.add(o)
                        stack.append(o)
    return chosen, wanted


def relevant_to_plans(problem: Problem, reached: Reached) -> set[int]:
    """Give the reached units that some plan without spare units can contain, where items are used up.

    They make what a goal or another of them asks for and what may run out.
    """
    makers: list[list[int]] = [[] for _ in problem.network.objects]
    for unit in reached.units:
        for o in problem.flows[unit].adds:
            makers[o].append(unit)
    units, _ = backwards(problem.goals, makers, [flow.asks for flow in problem.flows], problem.endless)
    return units


def kitchen_needed(problem: Problem) -> list[int]:
    """Give the kitchen items that a tree for the goals can take, in order of id; goals at hand among them."""
    units, _ = backwards(problem.goals, problem.makers, problem.needs, problem.kitchen)
    needed = {o for unit in units for o in problem.needs[unit]}.union(problem.goals)
    return sorted(needed & problem.kitchen)


def first_tree(problem: Problem, reached: Reached) -> tuple[int, ...] | None:
    """Give some tree, in an executable order, by following the makers; ``None`` when there is none.

    It promises nothing about costs: it is what a search stopped at once still has in hand.
    """
    chosen = follow(problem.targets, reached.makers, problem.needs, problem.kitchen)
    return None if chosen is None else tuple(unit for unit in reached.units if unit in chosen)


def follow(
    objects: Iterable[int],
    maker: Mapping[int, int],
    needs: Sequence[Iterable[int]],
    start: Container[int],
) -> set[int] | None:
    """Give all that makes the objects, by one maker each, down to the start; ``None`` where one has none."""
    chosen: set[int] = set()
    stack = list(objects)
    while stack:
        o = stack.pop()
        if o in start:
            continue
        found = maker.get(o)
        if found is None:
            return None
        if found not in chosen:
            chosen.add(found)
            stack.extend(needs[found])
    return chosen
