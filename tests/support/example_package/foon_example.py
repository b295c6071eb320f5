"""A search and an engine for foon-asp, as somebody else may write them."""

import itertools
import time
from collections.abc import Iterable

from foon_asp.engines import EngineAnswer, NotCheckedError
from foon_asp.problem import Objective, Problem
from foon_asp.searches import Ending, Retrieval, SearchSettings


def fewest_open(problem: Problem, settings: SearchSettings) -> Retrieval:
    """Search depth-first, and make each object by the unit that leaves the fewest objects to be made."""
    units: list[int] = []
    waiting = list(problem.goals)
    seen = set(problem.kitchen)
    while waiting:
        wanted = waiting.pop()
        if wanted in seen:
            continue
        seen.add(wanted)
        makers = problem.network.producers[wanted]
        if not makers:
            return Retrieval(Ending.STUCK, stuck_at=wanted)
        unit = min(makers, key=lambda maker: len(set(problem.needs[maker]) - seen))
        if unit not in units:
            units.append(unit)
            waiting += problem.needs[unit]
    return Retrieval(Ending.TREE, tuple(reversed(units)))


def every_set(
    problem: Problem, objectives: tuple[Objective, ...], forbidden: frozenset[int], seconds: float
) -> EngineAnswer:
    """Try every set of units, the small ones first, until one makes the goals."""
    if objectives[0] is not Objective.UNITS:
        raise NotCheckedError("it counts units, and nothing else")
    end = time.monotonic() + seconds
    usable = sorted(_usable(problem, forbidden))
    if not _at_hand(problem, usable).issuperset(problem.goals):
        return EngineAnswer("every-set", objectives[:1], None, True)
    for number in range(len(usable)):
        for units in itertools.combinations(usable, number):
            if time.monotonic() > end:
                return EngineAnswer("every-set", objectives[:1], None, False)
            if _at_hand(problem, units).issuperset(problem.goals):
                return EngineAnswer("every-set", objectives[:1], units, True)
    return EngineAnswer("every-set", objectives[:1], tuple(usable), True)


def _usable(problem: Problem, forbidden: frozenset[int]) -> set[int]:
    """List the units that the goals can need."""
    units: set[int] = set()
    waiting = list(problem.goals)
    while waiting:
        wanted = waiting.pop()
        if wanted not in problem.kitchen:
            new = set(problem.makers[wanted]) - units - forbidden
            units |= new
            waiting += [need for unit in new for need in problem.needs[unit]]
    return units


def _at_hand(problem: Problem, units: Iterable[int]) -> set[int]:
    """Give what is at hand after all units that can run have run."""
    at_hand, left = set(problem.kitchen), set(units)
    while ready := {unit for unit in left if at_hand.issuperset(problem.needs[unit])}:
        left -= ready
        at_hand.update(made for unit in ready for made in problem.gives[unit])
    return at_hand
