"""Optimal cost partitioning over landmark cuts: the dual of the hitting set relaxation.

Greedy weights of cuts depend on the order of the cuts. Here all cuts are weighed at once, and cuts that the
LP solution violates are added until none is found (Bonet and Helmert 2010; Katz and Domshlak 2010 for cost
partitioning). The floats of HiGHS are rounded to integers such that the weights on each action add up to at
most its cost. So the bound is valid whatever the floats were.
"""

import math
import random
from collections.abc import Callable, Collection, Iterable, Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.hypergraph import tuning
from foon_asp.hypergraph.covering import ROUGH_TOLERANCE, UnsolvedError, Weighed
from foon_asp.hypergraph.cut import Cutter
from foon_asp.hypergraph.hypergraph import Hypergraph
from foon_asp.hypergraph.landmark_relaxation import PARTS, LandmarkRelaxation


class SharedCosts(NamedTuple):
    """A cost partition over cuts, in :data:`PARTS` of 1.

    ``bound``: a lower bound on the cost of derivations by the actions of the relaxation.
    ``reduced_costs``: the reduced cost of each action.
    ``cuts``: the objects of each cut, and its weight.
    ``shares``: the LP value of each action.
    ``tight``: the cuts that the LP solution satisfies with equality; the next relaxation begins with them.
    """

    bound: int
    reduced_costs: dict[int, int]
    cuts: list[tuple[frozenset[int], int]]
    shares: dict[int, float]
    tight: Sequence[frozenset[int]] = ()


def quotient(a: int, b: int) -> float:
    """Return ``a / b``, or infinity where no float is so large."""
    try:
        return a / b
    except OverflowError:
        return math.inf


def stalled(values: Sequence[float], lacks: float) -> bool:
    """Return whether the last few of the LP ``values`` closed hardly any of the remaining gap ``lacks``."""
    return (
        len(values) > tuning.RELAXATION.stalled_solutions
        and values[-1] - values[-1 - tuning.RELAXATION.stalled_solutions]
        < tuning.RELAXATION.stalled_growth * lacks
    )


class CostPartitioning:
    """An optimal cost partition over landmark cuts of the targets, improved with each LP solution.

    All of the actions can run, and actions of cost 0 count as used. ``known_cuts`` are cuts to begin with,
    each by its objects. ``converged`` becomes true when further solutions would not help, or when time is up.
    """

    def __init__(
        self,
        graph: Hypergraph,
        targets: Iterable[int],
        actions: Collection[int],
        cost: Callable[[int], int],
        expired: Callable[[], bool],
        known_cuts: Iterable[Iterable[int]],
    ) -> None:
        self._expired = expired
        self._relaxation = relaxation = LandmarkRelaxation(graph, targets, actions, cost, expired)
        self._cutter = Cutter(relaxation.graph, relaxation.targets)
        self._random = random.Random(0)
        self._single_target_cutters, self._other_targets_cutters = (
            ([], []) if self._cutter.hopeless else self._by_target(relaxation.graph)
        )
        self._interior_point = True  # faster, until it is not exact enough
        self._values: list[float] = []
        self._last: Weighed | None = None
        self.converged = False
        if not self._cutter.hopeless:
            relaxation.add_known(known_cuts)

    def advance(self, enough: int, max_solutions: float = math.inf) -> SharedCosts | None:
        """Solve the LP and add violated cuts, until the bound is ``enough``, ``max_solutions`` times at most.

        Returns the cost partition of the last solution; ``None`` where the targets cannot be reached or are
        all initial, and where HiGHS fails.
        """
        if self._cutter.hopeless or not self._cutter.targets:
            self.converged = True
            return None
        above = 100 * enough - 99  # hundredths: costs are whole, and so are bounds
        solutions = 0
        while self._last is None or not self._expired():
            relaxed = self._solved()
            if relaxed is None:
                break
            self._last = relaxed
            self._values.append(relaxed.value)
            solutions += 1
            lacks = quotient(above, 100 * self._relaxation.dearest) - relaxed.value
            ends = lacks <= 0 or stalled(self._values, lacks)
            if ends or not self._separate(relaxed.x):
                if self._interior_point and not ends:
                    self._interior_point = False
                    continue
                shared = self._shared(relaxed)
                lost = Fraction(relaxed.value) * self._relaxation.dearest - Fraction(shared.bound, PARTS)
                if not self._interior_point or lost < Fraction(1, 100):
                    self.converged = True
                    return shared
                self._interior_point = False
            elif solutions >= max_solutions:
                return self._shared(relaxed)
        self.converged = True
        return None if self._last is None else self._shared(self._last)

    def _solved(self) -> Weighed | None:
        """Return an LP solution; ``None`` where HiGHS finds none before time is up."""
        if self._interior_point:
            relaxed = self._relaxation.covering.interior_point(self._expired)
            if relaxed is not None:
                return relaxed
            self._interior_point = False
        try:
            solved = self._relaxation.covering.solve(self._expired)
        except UnsolvedError:
            return None
        return Weighed(solved.value, solved.x, self._relaxation.covering.weights())

    def _separate(self, x: list[float]) -> bool:
        """Add disjoint cuts that an LP solution violates; return whether any was added."""
        import numpy as np  # noqa: PLC0415 (a part of HiGHS is there already)

        relaxation = self._relaxation
        shares = np.where(relaxation.relative > 0, x, 1.0)
        self._random.shuffle(self._single_target_cutters)
        cutters = (*self._single_target_cutters, *self._other_targets_cutters)
        budget = tuning.RELAXATION.cuts * len(relaxation.actions)
        added, _ = relaxation.separate(cutters, (), shares, budget, self._expired)
        return added > 0

    def _by_target(self, graph: Hypergraph) -> tuple[list[Cutter], list[Cutter]]:
        """Return cutters for single targets with few relevant actions, and a cutter for all other targets.

        The second list is empty if there are no other targets.
        """
        count, targets = len(self._relaxation.actions), self._cutter.targets
        alone: list[Cutter] = []
        others: list[int] = []
        effort = tuning.RELAXATION.cuts * count if len(targets) > 1 else 0
        everything = bytearray(b"\1") * graph.size
        for target in targets:
            if effort > 0:
                cutter = Cutter(graph, [target], reachable=everything)
                effort -= len(cutter.actions)
                if 2 * len(cutter.actions) <= count:
                    alone.append(cutter)
                    continue
            others.append(target)
        together = [Cutter(graph, others, reachable=everything)] if others else []
        return alone, together

    def _shared(self, solved: Weighed) -> SharedCosts:
        """Return the cost partition by the rounded dual values of an LP solution."""
        import numpy as np  # noqa: PLC0415 (a part of HiGHS is there already)

        relaxation, shares = self._relaxation, np.array(solved.x)
        capacity, rows = relaxation.in_parts(), relaxation.rows
        dual_values = [*solved.weights] + [0.0] * (len(rows) - len(solved.weights))  # for rows added since
        weights = relaxation.shared_out(enumerate(dual_values), capacity)
        whole, cuts, tight = relaxation.whole, relaxation.cuts, 1 + ROUGH_TOLERANCE
        return SharedCosts(
            sum(weights.values()),
            dict(zip(relaxation.actions, capacity.tolist(), strict=True)),
            [(whole(cuts[row]), weight) for row, weight in weights.items() if weight],
            dict(zip(relaxation.actions, solved.x, strict=True)),
            [whole(cut) for cut, row in zip(cuts, rows, strict=True) if shares[row].sum() < tight],
        )
