"""A question made small before it is searched: a good tree, a lower bound, and what is left between them."""

import gc
from collections.abc import Callable, Collection, Sequence
from typing import NamedTuple

from foon_asp.bounds import Cuts, landmark_cuts
from foon_asp.problem import Objective, Problem
from foon_asp.reduce.derivation import Derivations, derive
from foon_asp.reduce.dominance import undominated
from foon_asp.reduce.exact_costs import CoarseCosts, ExactCosts, TooFineError
from foon_asp.reduce.forced import beside_forced
from foon_asp.reduce.graph import Graph, graph_of
from foon_asp.reduce.near import near
from foon_asp.reduce.reductions import ALL, Reduction
from foon_asp.reduce.upper_bound import improved, without_spare

_MANY = 2000  # actions among which better trees are looked for
_ROUNDS = 12  # of cuts, trees and what they leave


class Reduced(NamedTuple):
    """What is left of a question.

    ``tree`` are the units of a tree, or ``None`` where there is none. ``units`` are those that a better tree
    can have and those of the tree, ascending. ``settled`` says that the tree is proved optimal. ``costs``
    compares trees exactly and ``bound`` is a lower bound by it on every tree; ``None`` and 0 where there is
    none. ``cuts`` are the weighted cuts that gave it, over the units left at the time. ``interrupted`` says
    that ctrl-C ended it early.
    """

    tree: frozenset[int] | None
    units: tuple[int, ...]
    settled: bool
    costs: ExactCosts | None
    bound: int
    cuts: Cuts | None
    interrupted: bool = False


class Listener:
    """Hears of trees and bounds as they are found; override what you want to know."""

    def tree(self, units: frozenset[int]) -> None:
        """Hear of a tree that is better than the one before."""

    def bound(self, costs: ExactCosts, bound: int) -> None:
        """Hear of a lower bound on all trees."""


def reduce(
    problem: Problem,
    objectives: Sequence[Objective],
    reductions: Collection[Reduction] = ALL,
    expired: Callable[[], bool] = lambda: False,
    listener: Listener | None = None,
) -> Reduced:
    """Leave of a problem what a search for the best tree still has to look at.

    ``objectives`` is the list as it is optimized, ``units`` being in it, so that every unit costs
    something. Without reductions that is what can be made from the kitchen and the goals can need.
    """
    reducer = _Reducer(problem, tuple(objectives), frozenset(reductions), expired, listener or Listener())
    collecting = gc.isenabled()
    gc.disable()  # nothing here is circular, and a collection walks over the whole network
    try:
        return reducer.reduce()
    finally:
        if collecting:
            gc.enable()


class _Reducer:
    def __init__(
        self,
        problem: Problem,
        objectives: tuple[Objective, ...],
        reductions: frozenset[Reduction],
        expired: Callable[[], bool],
        listener: Listener,
    ) -> None:
        self.problem, self.objectives, self.reductions = problem, objectives, reductions
        self.expired, self.listener = expired, listener
        self.graph: Graph = graph_of(problem, objectives)
        self.coarse = CoarseCosts(problem, objectives[0])
        self.left: Collection[int] = ()
        self.tree: set[int] = set()
        self.costs: ExactCosts | None = None
        self.bound = 0
        self.cuts: Cuts | None = None

    def reduce(self) -> Reduced:
        graph = self.graph
        cone, _ = graph.cone()
        made = derive(graph, cone, self.coarse, added=False)
        first = made.tree(graph, graph.goals)
        if first is None:
            return Reduced(None, (), False, None, 0, None)
        if len(made.before) < len(cone):  # what cannot run may have been all that some others are for
            cone, _ = graph.cone(made.before)
        self.left = cone if len(made.before) < len(cone) else made.before
        self.tree = first
        if not self.reductions:
            return self._result(settled=False)
        try:
            self.tree = without_spare(graph, first, self.coarse)
            self.listener.tree(self._units(self.tree))
            settled = self._narrow(made)
        except KeyboardInterrupt:
            return self._result(settled=False)._replace(interrupted=True)
        return self._result(settled)

    def _narrow(self, made: Derivations) -> bool:
        """Go around until nothing changes; whether the tree is proved optimal."""
        try:
            self.costs = costs = ExactCosts(self.problem, self.objectives, self.left)
        except TooFineError:
            costs = None
        guide = made.cost
        for _ in range(_ROUNDS):
            before = len(self.left), self.tree
            if costs is not None and self.reductions & {Reduction.BOUNDS, Reduction.DEAR}:
                if self._bound(costs, guide):
                    return True
                self._drop_dear(costs)
            if costs is not None and Reduction.DOMINATED in self.reductions:
                self.left = undominated(self.graph, self.left, costs)
            if Reduction.FORCED in self.reductions and len(self.left) <= _MANY:
                self.left = beside_forced(self.graph, self.left)
            if self.expired() or (len(self.left), self.tree) == before:
                break
            guide = derive(self.graph, self.left, costs or self.coarse, added=False).cost
        return False

    def _bound(self, costs: ExactCosts, guide: dict[int, int]) -> bool:
        """Find cuts, and better trees near what they leave; whether bounds meet."""
        searched = Reduction.BOUNDS in self.reductions
        self.cuts = cuts = landmark_cuts(self.graph, self.graph.goals, self.left, costs, guide, self.expired)
        total = self._total(costs)
        bound = total if cuts.hopeless else min(cuts.bound, total)
        if bound > self.bound:
            self.bound = bound
            self.listener.bound(costs, bound)
        if searched and (cuts.hopeless or costs.met(cuts, self.tree)):
            return True

        def rest(action: int) -> int:
            return cuts.left[action] if action in cuts.left else costs(action)

        few = near(self.graph, self.left, rest, total - cuts.bound, most=_MANY)
        better = improved(self.graph, few | self.tree, self.tree, costs, rest, self.expired)
        if better is not self.tree:
            self.tree = better
            self.listener.tree(self._units(better))
        return searched and costs.met(cuts, better)

    def _drop_dear(self, costs: ExactCosts) -> None:
        """Leave out what only trees have that are no better than the one in hand."""
        if Reduction.DEAR not in self.reductions or self.cuts is None:
            return
        cuts = self.cuts

        def rest(action: int) -> int:
            return cuts.left[action] if action in cuts.left else costs(action)

        limit = self._total(costs) - cuts.bound + costs.doubt
        if Reduction.BOUNDS in self.reductions and not costs.doubt:
            limit -= 1
        left = near(self.graph, self.left, rest, limit)
        while True:
            made = derive(self.graph, left, rest, added=False)
            nearer = near(self.graph, left, rest, limit, made.before)
            if len(nearer) == len(left):
                break
            left = nearer
        self.left = left

    def _total(self, costs: ExactCosts) -> int:
        return sum(map(costs, self.tree))

    def _units(self, actions: Collection[int]) -> frozenset[int]:
        return frozenset(a for a in actions if a < self.graph.units)

    def _result(self, settled: bool) -> Reduced:
        tree = self._units(self.tree)
        left = set(self._units(self.left))
        if self.reductions:
            left |= tree
        return Reduced(tree, tuple(sorted(left)), settled, self.costs, self.bound, self.cuts)
