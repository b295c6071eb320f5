"""The linear relaxation of the hitting set problem over landmark cuts, which grows by the cuts it violates.

Each action is a column, each cut a row: its landmark actions add up to at least 1. Cuts are looked for in the
graph of first achievers, where fewer actions cross them. They are returned as cuts of the whole graph.
"""

import math
import random
from collections.abc import Callable, Collection, Iterable, Sequence
from fractions import Fraction
from typing import Any

from foon_asp.hypergraph.covering import Covering
from foon_asp.hypergraph.cut import Cutter
from foon_asp.hypergraph.first_achievers import FirstAchievers
from foon_asp.hypergraph.hypergraph import Hypergraph
from foon_asp.hypergraph.violated_cuts import disjoint_violated_cuts

PARTS = 720720  # of 1: most weights are simple fractions


class LandmarkRelaxation:
    """The relaxation over some actions, which all have to be able to run.

    Objects and actions of the relaxation have new numbers, from 0.

    ``actions``: for each action, its number in the whole graph.
    ``graph``: the graph of first achievers over these actions, the *subgraph*.
    ``targets``: the targets in the subgraph.
    ``costs``: the cost of each action.
    ``greatest_cost``: the greatest of the costs.
    ``relative_costs``: the costs divided by the greatest one, since costs may be too great for floats.
    ``covering``: the linear program, with ``relative_costs`` as the costs of columns.
    ``cuts``: the cut of each row, given by its objects in the subgraph.
    ``rows``: the landmark of each row, as an array of actions.
    """

    def __init__(
        self,
        graph: Hypergraph,
        targets: Iterable[int],
        actions: Collection[int],
        cost: Callable[[int], int],
        expired: Callable[[], bool] = lambda: False,
    ) -> None:
        import numpy as np  # noqa: PLC0415 (a part of HiGHS is there already)

        self._np = np
        self.actions = sorted(actions)
        plain, self._objects, self.targets = _subgraph(graph, targets, self.actions)
        self._achievers = FirstAchievers(plain, expired)
        self.graph = self._achievers.graph
        self.costs = [cost(a) for a in self.actions]
        self.greatest_cost = max(self.costs, default=1)
        self.relative_costs = np.array([c / self.greatest_cost for c in self.costs])
        self.covering = Covering(self.relative_costs.tolist())
        self.cuts: list[frozenset[int]] = []
        self.rows: list[Any] = []
        self._random = random.Random(0)
        self._whole_cuts: dict[frozenset[int], frozenset[int]] = {}

    def add_cut(self, cut: frozenset[int]) -> None:
        """Add a row for a cut of the subgraph, given by its objects.

        The columns of the row are the actions of the landmark.
        """
        self.rows.append(self._np.array(self.landmark_of(cut), dtype=self._np.int32))
        self.cuts.append(cut)
        self.covering.add_row(self.rows[-1])

    def add_whole_cuts(self, cuts: Iterable[Iterable[int]]) -> None:
        """Add rows for cuts of the whole graph, each given by its objects.

        Objects that the subgraph lacks are left out.
        """
        position = {o: i for i, o in enumerate(self._objects)}
        for objects in cuts:
            self.add_cut(frozenset(position[o] for o in objects if o in position))

    def landmark_of(self, cut: frozenset[int]) -> list[int]:
        """Return the landmark of a cut of the subgraph, ascending."""
        return self._achievers.landmark_of(cut)

    def whole_cut(self, cut: frozenset[int]) -> frozenset[int]:
        """Return the cut of the whole graph with the same landmark as a cut of the subgraph.

        The result has object numbers of the whole graph. Results are cached.
        """
        if cut not in self._whole_cuts:
            self._whole_cuts[cut] = frozenset(self._objects[o] for o in self._achievers.widen(cut))
        return self._whole_cuts[cut]

    def separate(
        self,
        cutters: Iterable[Cutter],
        used: Collection[int],
        lp_values: Any,
        budget: int,
        stopped: Callable[[], bool],
    ) -> tuple[int, int]:
        """Add cuts that an LP solution violates; return the numbers of cuts added and of actions looked at.

        ``cutters`` are asked one after the other. The landmarks of the added cuts are disjoint, and have no
        action of ``used``. ``lp_values`` is an array of the LP value of each action. It is changed in place.
        Ends when no cut is left, ``budget`` actions were looked at, or ``stopped`` returns true.
        """
        added = looks = 0
        for cutter in cutters:
            cuts = disjoint_violated_cuts(cutter, used, lp_values, self.relative_costs, self._random.random)
            while looks < budget and not stopped():
                looks += len(cutter.actions)
                cut = next(cuts, None)
                if cut is None:
                    break
                added += 1
                self.add_cut(frozenset(cut.objects))
        return added, looks

    def costs_in_parts(self) -> Any:
        """Return an array of the cost of each action, in parts: :data:`PARTS` is a cost of 1.

        It has integers of 64 bits if the sum of the costs fits, else integers of Python.
        """
        fits = sum(self.costs) * PARTS < 2**62
        return self._np.array(self.costs, dtype=self._np.int64 if fits else object) * PARTS

    def feasible_weights(self, dual_values: Iterable[tuple[int, float]], capacity: Any) -> dict[int, int]:
        """Return for each row a feasible weight, in parts: its dual, rounded and limited by ``capacity``.

        ``dual_values`` are pairs of a row and its dual. Negative and infinite duals count as 0. ``capacity``
        is an array of the cost of each action, in parts. Weights are subtracted from the array in place, so
        it has the reduced costs at the end. If costs remain on all actions of a landmark, the weight of its
        row is raised. The weights add up to a lower bound, whatever the duals are.
        """
        scale = self.greatest_cost * PARTS
        rounded_duals = {row: round(Fraction(w) * scale) if 0 < w < math.inf else 0 for row, w in dual_values}
        weights = dict.fromkeys(rounded_duals, 0)
        greatest_first = sorted(rounded_duals, key=lambda row: -rounded_duals[row])
        for within_duals in (True, False):
            for row in greatest_first:
                upper = rounded_duals[row] if within_duals else math.inf
                weight = int(min(upper, capacity[self.rows[row]].min())) if upper else 0
                if weight:
                    weights[row] += weight
                    capacity[self.rows[row]] -= weight
        return weights


def _subgraph(
    graph: Hypergraph, targets: Iterable[int], actions: Sequence[int]
) -> tuple[Hypergraph, list[int], list[int]]:
    """Return the graph of the given actions, the old number of each of its objects, and its targets.

    The old numbers are those in the whole graph, and the targets have their new numbers. The objects of the
    new graph are the targets and the non-initial preconditions of the actions. No object of it is initial.
    """
    targets, start = tuple(targets), graph.start
    objects = sorted({o for a in actions for o in graph.needs[a] if o not in start}.union(targets))
    number = {o: i for i, o in enumerate(objects)}
    subgraph = Hypergraph(
        len(number),
        [[number[o] for o in graph.needs[a] if o in number] for a in actions],
        [[number[o] for o in graph.gives[a] if o in number] for a in actions],
        (),
    )
    return subgraph, objects, [number[o] for o in targets]
