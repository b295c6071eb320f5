"""Optimal cost partitioning over landmark cuts: the dual of the hitting set relaxation.

Greedy weights of cuts depend on the order of the cuts. Here all cuts are weighed at once, and cuts that the
LP solution violates are added until none is found. See Bonet and Helmert (2010), and Katz and Domshlak (2010)
for cost partitioning.

The floats of HiGHS are rounded to integers such that the weights on each action add up to at most its cost.
So the bound is valid whatever the floats were.
"""

import math
import random
from collections.abc import Callable, Collection, Iterable, Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.hypergraph import tuning
from foon_asp.hypergraph.covering import ROUGH_TOLERANCE, LpSolution, UnsolvedError
from foon_asp.hypergraph.cut import Cutter
from foon_asp.hypergraph.hypergraph import Hypergraph
from foon_asp.hypergraph.landmark_relaxation import PARTS, LandmarkRelaxation


class CostPartition(NamedTuple):
    """A cost partition over cuts. Its costs are integers: the costs times :data:`PARTS`.

    ``bound``: the sum of the weights. No derivation by the actions of the relaxation costs less.
    ``reduced_costs``: the reduced cost of each action.
    ``cuts``: pairs of a cut, given by its objects, and its weight, which is not 0.
    ``lp_values``: the LP value of each action, from 0 to about 1.
    ``tight``: the cuts that the LP solution satisfies with equality. The next relaxation begins with them.
    """

    bound: int
    reduced_costs: dict[int, int]
    cuts: list[tuple[frozenset[int], int]]
    lp_values: dict[int, float]
    tight: Sequence[frozenset[int]] = ()


def float_quotient(a: int, b: int) -> float:
    """Return ``a / b`` as a float; infinity if it is too large for a float."""
    try:
        return a / b
    except OverflowError:
        return math.inf


def has_stalled(values: Sequence[float], remaining_gap: float) -> bool:
    """Return whether the last few LP solutions closed hardly any of the remaining gap.

    ``values``: the costs of all LP solutions so far, which grow as cuts are added.
    ``remaining_gap``: the cost that is needed, minus the last of the ``values``.

    Compares the last value with the one ``tuning.RELAXATION.stalled_solutions`` earlier. Returns ``False`` if
    there are too few values.
    """
    return (
        len(values) > tuning.RELAXATION.stalled_solutions
        and values[-1] - values[-1 - tuning.RELAXATION.stalled_solutions]
        < tuning.RELAXATION.stalled_growth * remaining_gap
    )


class CostPartitioning:
    """A cost partition over landmark cuts of the targets, improved with each LP solution until it is optimal.

    ``actions``: the actions of the relaxation. All of them have to be able to run.
    ``expired``: returns whether time is up.
    ``known_cuts``: the cuts to begin with, each by its objects.
    ``converged``: an attribute that becomes true when further solutions would not help, or time is up.
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
            ([], []) if self._cutter.hopeless else self._make_cutters(relaxation.graph)
        )
        self._interior_point = True  # faster, until it is not exact enough
        self._values: list[float] = []
        self._last: LpSolution | None = None
        self.converged = False
        if not self._cutter.hopeless:
            relaxation.add_whole_cuts(known_cuts)

    def advance(self, sufficient_bound: int, max_solutions: float = math.inf) -> CostPartition | None:
        """Solve the LP and add violated cuts in turn; return the cost partition of the last solution.

        Sets :attr:`converged` and ends in four cases: the bound reaches ``sufficient_bound``, no cut is
        violated, the bound hardly grows, or time is up. Also ends after ``max_solutions`` solutions. The next
        call then continues from there.

        Returns ``None`` if the targets cannot be reached or are all initial, or HiGHS never had a solution.
        """
        if self._cutter.hopeless or not self._cutter.targets:
            self.converged = True
            return None
        sufficient_hundredths = 100 * sufficient_bound - 99  # hundredths: costs are whole, and so are bounds
        solutions = 0
        while self._last is None or not self._expired():
            solution = self._solve_lp()
            if solution is None:
                break
            self._last = solution
            self._values.append(solution.value)
            solutions += 1
            remaining_gap = (
                float_quotient(sufficient_hundredths, 100 * self._relaxation.greatest_cost) - solution.value
            )
            is_last_round = remaining_gap <= 0 or has_stalled(self._values, remaining_gap)
            if is_last_round or not self._separate(solution.x):
                if self._interior_point and not is_last_round:
                    self._interior_point = False
                    continue
                partition = self._rounded_partition(solution)
                cost = Fraction(solution.value) * self._relaxation.greatest_cost
                rounding_loss = cost - Fraction(partition.bound, PARTS)
                if not self._interior_point or rounding_loss < Fraction(1, 100):
                    self.converged = True
                    return partition
                self._interior_point = False
            elif solutions >= max_solutions:
                return self._rounded_partition(solution)
        self.converged = True
        return None if self._last is None else self._rounded_partition(self._last)

    def _solve_lp(self) -> LpSolution | None:
        """Return a solution of the LP with all cuts so far; ``None`` if HiGHS fails.

        The solution is an interior point as long as ``_interior_point`` is true. If HiGHS finds no such
        point, this attribute becomes false, and the solution is basic.
        """
        if self._interior_point:
            solution = self._relaxation.covering.interior_point(self._expired)
            if solution is not None:
                return solution
            self._interior_point = False
        try:
            basic = self._relaxation.covering.solve(self._expired)
        except UnsolvedError:
            return None
        return LpSolution(basic.value, basic.x, self._relaxation.covering.duals())

    def _separate(self, x: list[float]) -> bool:
        """Add cuts that an LP solution violates, with disjoint landmarks; return whether any was added.

        ``x`` has the LP value of each column. Actions of cost 0 count as used. Cutters for single targets are
        asked first, in random order.
        """
        import numpy as np  # noqa: PLC0415 (a part of HiGHS is there already)

        relaxation = self._relaxation
        lp_values = np.where(relaxation.relative_costs > 0, x, 1.0)
        self._random.shuffle(self._single_target_cutters)
        cutters = (*self._single_target_cutters, *self._other_targets_cutters)
        budget = tuning.RELAXATION.cuts * len(relaxation.actions)
        added, _ = relaxation.separate(cutters, (), lp_values, budget, self._expired)
        return added > 0

    def _make_cutters(self, graph: Hypergraph) -> tuple[list[Cutter], list[Cutter]]:
        """Return a list of cutters for one target each, and a list with one cutter for all other targets.

        A target has its own cutter if at most half of the actions are relevant to it. Once a budget of effort
        is used up, no more targets get a cutter of their own. If there is only one target, the first list is
        empty. If each target has its own cutter, the second list is empty.
        """
        count, targets = len(self._relaxation.actions), self._cutter.targets
        single_target_cutters: list[Cutter] = []
        other_targets: list[int] = []
        effort = tuning.RELAXATION.cuts * count if len(targets) > 1 else 0
        all_reachable = bytearray(b"\1") * graph.size
        for target in targets:
            if effort > 0:
                cutter = Cutter(graph, [target], reachable=all_reachable)
                effort -= len(cutter.actions)
                if 2 * len(cutter.actions) <= count:
                    single_target_cutters.append(cutter)
                    continue
            other_targets.append(target)
        other_cutters = [Cutter(graph, other_targets, reachable=all_reachable)] if other_targets else []
        return single_target_cutters, other_cutters

    def _rounded_partition(self, solution: LpSolution) -> CostPartition:
        """Return the cost partition by the duals of an LP solution, rounded to integers."""
        import numpy as np  # noqa: PLC0415 (a part of HiGHS is there already)

        relaxation, lp_values = self._relaxation, np.array(solution.x)
        capacity, rows = relaxation.costs_in_parts(), relaxation.rows
        dual_values = [*solution.duals] + [0.0] * (len(rows) - len(solution.duals))  # for rows added since
        weights = relaxation.feasible_weights(enumerate(dual_values), capacity)
        whole, cuts, tight = relaxation.whole_cut, relaxation.cuts, 1 + ROUGH_TOLERANCE
        return CostPartition(
            sum(weights.values()),
            dict(zip(relaxation.actions, capacity.tolist(), strict=True)),
            [(whole(cuts[row]), weight) for row, weight in weights.items() if weight],
            dict(zip(relaxation.actions, solution.x, strict=True)),
            [whole(cut) for cut, row in zip(cuts, rows, strict=True) if lp_values[row].sum() < tight],
        )
