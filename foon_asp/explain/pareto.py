"""Trade-offs: the Pareto front of two or three objectives, every point with a tree."""

import time
from collections.abc import Sequence
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import NamedTuple

from foon_asp.asp import Reporter, Settings, Status, solve
from foon_asp.asp.at_most import better_than
from foon_asp.asp.postconditions import Postconditions
from foon_asp.errors import UserError
from foon_asp.explain.alternatives import Tree
from foon_asp.problem import Costs, Objective, Problem

_FEWEST, _MOST = 2, 3  # objectives


class Front(NamedTuple):
    """Trees none of which is as good as another by every objective and better by one.

    There is one tree for each such combination of measures, with the fewest units that it can have; they
    come in order of the first objective, the best first. ``complete`` says that every tree there is is as
    good as one of these or worse: where it is false a limit came first, and only that is open, for no tree is
    better than one of these. ``encodings`` is the folder whose encodings replaced ours, if one did.
    """

    problem: Problem
    objectives: tuple[Objective, ...]
    points: tuple[Tree, ...]
    complete: bool
    seconds: float
    encodings: Path | None = None

    def measures(self, tree: Tree) -> tuple[int | Fraction, ...]:
        """Give where a tree stands: its measure by each objective."""
        return tuple(tree.costs.measure(objective) for objective in self.objectives)


def pareto_front(
    problem: Problem,
    objectives: Sequence[Objective],
    settings: Settings | None = None,
    reporter: Reporter | None = None,
) -> Front:
    """Find the whole Pareto front of two or three objectives, and prove that nothing is missing.

    One objective leads: ``success``, which no sum can bound, if it is there, else the first. Each tree is the
    best by the leading objective, then by the others, among those that are better than every tree before it
    by one of the others. What would be better than a tree everywhere, or as good and somewhere better, would
    be among those too, and come before it: so no tree found is dominated. When no tree is left, each tree
    there is was left out first with some tree that is as good as it by the others, and no worse by the
    leading objective, by which that tree was the best of those that were left. So every point of the front
    is there, and it took one search more than there are points.

    The time limit is for all of it. Raises :class:`UserError` for another number of objectives, and like
    :func:`foon_asp.asp.solve`.
    """
    asked = tuple(objectives)
    if not _FEWEST <= len(asked) <= _MOST:
        raise UserError(
            f"found {len(asked)} objective{'s' * (len(asked) != 1)}, "
            f"expected {_FEWEST} or {_MOST} to trade against each other"
        )
    settings, reporter = (settings or Settings()).limited(), reporter or Reporter()
    later = _Silent(reporter)
    leading = Objective.SUCCESS if Objective.SUCCESS in asked else asked[0]
    others = tuple(objective for objective in asked if objective is not leading)
    began = time.monotonic()
    found: list[Tree] = []
    complete = False
    try:
        while not complete:
            now = settings
            if found:
                known = _nearest([tree.costs for tree in found], others)
                now = settings._replace(bounded=better_than(known, others))
            outcome = solve(problem, (leading, *others), now, later if found else reporter)
            if outcome.status is Status.OPTIMAL and outcome.units is not None and outcome.costs is not None:
                point = Tree(outcome.units, outcome.costs)
                _require_apart(Postconditions(problem, asked, now), point, found)
                found.append(point)
            elif outcome.status is Status.INFEASIBLE:
                complete = True
            else:
                break
    except KeyboardInterrupt:
        pass  # what was found stands
    found.sort(key=lambda tree: tree.costs.key(asked))
    seconds = time.monotonic() - began
    return Front(problem, asked, tuple(found), complete, seconds, settings.replaced)


def _require_apart(holds: Postconditions, point: Tree, found: Sequence[Tree]) -> None:
    """Require that a point of the front is as good as no other, and that no other is as good as it."""
    key = point.costs.key(holds.levels)
    for other in found:
        theirs = other.costs.key(holds.levels)
        holds.require(
            any(a < b for a, b in zip(key, theirs, strict=True))
            and any(a > b for a, b in zip(key, theirs, strict=True)),
            partial(
                "of two points of the front, {} and {}, one is as good as the other everywhere".format,
                list(point.units),
                list(other.units),
            ),
        )


def _nearest(known: Sequence[Costs], objectives: Sequence[Objective]) -> list[Costs]:
    """Leave out the costs that are no less than others everywhere: what beats those beats these by one."""

    def key(costs: Costs) -> tuple[int | Fraction, ...]:
        return tuple(map(costs.measure, objectives))

    best: list[Costs] = []
    for costs in sorted(known, key=key):
        if not any(all(a <= b for a, b in zip(key(other), key(costs), strict=True)) for other in best):
            best.append(costs)
    return best


class _Silent(Reporter):
    """Passes on the progress of one search after another, and no warning, which came with the first."""

    def __init__(self, reporter: Reporter) -> None:
        self._reporter = reporter

    def tree(self, costs: Costs) -> None:
        self._reporter.tree(costs)

    def bound(self, objective: Objective, bound: int | Fraction) -> None:
        self._reporter.bound(objective, bound)
