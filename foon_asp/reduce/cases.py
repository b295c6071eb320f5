"""The best tree that keeps to rules, case by case: each leaves out a part of what breaks them."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from heapq import heappop, heappush
from itertools import count
from typing import NamedTuple, Protocol

from foon_asp.problem import Objective, Problem, Restriction
from foon_asp.reduce.reduction import Reduced, reduce
from foon_asp.reduce.wide import Wide
from foon_asp.reduce.within_limit import Limited, least

_EFFORT = 8000  # units in all cases together; to import clingo and to ask it takes less than more
_CASE = 150  # units that take as long as what every case takes

Units = frozenset[int]
Key = tuple[int | Fraction, ...]


class Rules(Protocol):
    """Rules that a tree keeps to still when units are left out of it."""

    def conflict(self, problem: Problem, units: Units) -> Sequence[Units] | None:
        """Return sets of units of each of which a tree has one, and no tree that keeps to the rules does.

        ``None`` where the tree keeps to them.
        """

    def barred(self, problem: Problem, without: Units) -> Units:
        """Return units that no tree has that keeps to the rules and has none of some others."""

    def counted(self, problem: Problem) -> Iterator[tuple[Callable[[int], int], int]]:
        """Return how much each unit counts, and what those of a tree come to at most."""


class Kept(NamedTuple):
    """The best tree that keeps to rules; ``None`` where none does."""

    tree: Units | None


def best_kept(
    problem: Problem,
    objectives: Sequence[Objective],
    wide: Wide,
    reduced: Reduced,
    rules: Rules,
    expired: Callable[[], bool],
) -> Kept | None:
    """Look for the best tree that keeps to rules, where ``reduced`` knows only of those of its restriction.

    If the best tree of a case breaks the rules, it has units of some sets, and one that keeps to them has
    none of one of these: there is a case without each. The case that promises most is next. ``None`` where
    they are too many, or one is not settled by bounds. Raises ``KeyboardInterrupt`` when time is up.
    """
    every, restriction = frozenset(range(len(problem.network))), wide.problem.restriction
    assert restriction is not None
    beyond = every - wide.everything()  # as the best tree has nothing that leads to no goal
    kept: list[tuple[Key, Units]] = []
    effort, number, seen = _EFFORT, count(), {Units()}
    waiting: list[tuple[Key, int, Units]] = [((), next(number), Units())]
    while waiting and not (kept and min(kept)[0] <= waiting[0][0]):
        promise, _, without = heappop(waiting)
        gone = beyond | without
        effort -= _CASE + len(every) - len(gone)
        if effort < 0:
            return None
        found = reduced
        if without or not reduced.settled:
            gone |= rules.barred(problem, gone)
            left = Restriction(gone.__contains__, restriction.required)
            found = reduce(replace(wide.problem, restriction=left), objectives, expired=expired)
            if found.interrupted:
                raise KeyboardInterrupt
        if found.tree is None:
            continue
        key = problem.costs(found.tree).key(objectives)
        conflict = rules.conflict(problem, found.tree)
        if conflict is None:
            if not found.settled:
                return None
            kept.append((key, found.tree))
            continue
        for counts, most in () if without else rules.counted(problem):
            within = least(wide, counts, most, expired)
            if within == Limited(None):
                return Kept(None)
            if within and within.tree and rules.conflict(problem, within.tree) is None:
                kept.append((problem.costs(within.tree).key(objectives), within.tree))
                beyond |= every - wide.within(wide.total(within.tree) - 1, expired)
        for units in conflict:
            more = without | units
            if more not in seen:
                seen.add(more)
                heappush(waiting, (key if found.settled else promise, next(number), more))
    return Kept(min(kept)[1] if kept else None)
