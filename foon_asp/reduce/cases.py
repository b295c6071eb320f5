"""Best-first search over cases for the best tree under rules: each case removes units that break them."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from heapq import heappop, heappush
from itertools import count
from typing import NamedTuple, Protocol

from foon_asp.problem import Objective, Problem, Restriction
from foon_asp.reduce.reduction import Reduced, reduce
from foon_asp.reduce.wide import Wide
from foon_asp.reduce.within_limit import Limited, any_within_limit

_EFFORT = 8000  # units in all cases together; beyond it, importing and running clingo is faster
_CASE = 150  # the fixed cost of a case, in units

Units = frozenset[int]
Key = tuple[int | Fraction, ...]


class Rules(Protocol):
    """Antimonotone rules: a tree keeps to them still when units are removed from it."""

    def conflict(self, problem: Problem, units: Units) -> Sequence[Units] | None:
        """Return sets of units such that the tree, but no tree that keeps to the rules, has a unit of each.

        ``None`` where the tree keeps to the rules.
        """

    def barred(self, problem: Problem, without: Units) -> Units:
        """Return units in no tree that keeps to the rules and has no unit of ``without``."""

    def counted(self, problem: Problem) -> Iterator[tuple[Callable[[int], int], int]]:
        """Yield for each limit the count of each unit, and the greatest sum of a tree."""


class Kept(NamedTuple):
    """The best tree that keeps to rules; ``tree`` is ``None`` where no tree does."""

    tree: Units | None


def best_kept(
    problem: Problem,
    objectives: Sequence[Objective],
    wide: Wide,
    reduced: Reduced,
    rules: Rules,
    expired: Callable[[], bool],
) -> Kept | None:
    """Return the best tree that keeps to rules, where ``reduced`` keeps only to those of its restriction.

    If the best tree of a case breaks the rules, it has a unit of each of some sets, and a tree that keeps to
    them has no unit of one of the sets: the search branches into a case without each set, best bound first.
    ``None`` where there are too many cases, or bounds do not prove one optimal. Raises ``KeyboardInterrupt``
    when time is up.
    """
    all_units, restriction = frozenset(range(len(problem.network))), wide.problem.restriction
    assert restriction is not None
    beyond = all_units - wide.everything()  # the best tree has no irrelevant units
    kept: list[tuple[Key, Units]] = []
    effort, number, seen = _EFFORT, count(), {Units()}
    waiting: list[tuple[Key, int, Units]] = [((), next(number), Units())]
    while waiting and not (kept and min(kept)[0] <= waiting[0][0]):
        promise, _, without = heappop(waiting)
        excluded_units = beyond | without
        effort -= _CASE + len(all_units) - len(excluded_units)
        if effort < 0:
            return None
        result = reduced
        if without or not reduced.settled:
            excluded_units |= rules.barred(problem, excluded_units)
            case = Restriction(excluded_units.__contains__, restriction.required)
            result = reduce(replace(wide.problem, restriction=case), objectives, expired=expired)
            if result.interrupted:
                raise KeyboardInterrupt
        if result.tree is None:
            continue
        key = problem.costs(result.tree).key(objectives)
        conflict = rules.conflict(problem, result.tree)
        if conflict is None:
            if not result.settled:
                return None
            kept.append((key, result.tree))
            continue
        for counts, max_count in () if without else rules.counted(problem):
            limited = any_within_limit(wide, counts, max_count, expired)
            if limited == Limited(None):
                return Kept(None)
            if limited and limited.tree and rules.conflict(problem, limited.tree) is None:
                kept.append((problem.costs(limited.tree).key(objectives), limited.tree))
                beyond |= all_units - wide.units_within(wide.total(limited.tree) - 1, expired)
        for units in conflict:
            excluded = without | units
            if excluded not in seen:
                seen.add(excluded)
                heappush(waiting, (key if result.settled else promise, next(number), excluded))
    return Kept(min(kept)[1] if kept else None)
