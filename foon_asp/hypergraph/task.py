"""A question to reduce: data that all stages read and none changes."""

import random
from collections.abc import Callable, Collection
from dataclasses import dataclass, field

from foon_asp.hypergraph.exact_costs import ExactCosts
from foon_asp.hypergraph.goal_graph import GoalGraph
from foon_asp.hypergraph.incumbent_gap import Gap
from foon_asp.hypergraph.reductions import Reduction
from foon_asp.hypergraph.tuning import PresolveTuning
from foon_asp.problem import Objective, Problem


@dataclass(frozen=True, eq=False, repr=False)
class Task:
    """A question as a graph with costs, and the settings of its reduction.

    ``expired``: returns whether time is up.
    ``thin_graph``: the graph with few achievers of each required set, for estimates.
    ``coarse_costs``: rough costs, for estimates.
    ``scope``: the actions that trees may have.
    ``costs``: exact costs; ``None`` before the first tree, and if rates are too fine for them.
    ``below``: a cost; 0 for none. Trees that cost less are wanted, even if they are no better than the
    incumbent.
    ``random_source``: the source of random numbers of perturbation search, always with the same seed.
    """

    problem: Problem
    objectives: tuple[Objective, ...]
    reductions: frozenset[Reduction]
    expired: Callable[[], bool]
    graph: GoalGraph
    thin_graph: GoalGraph
    coarse_costs: Callable[[int], int]
    tuning: PresolveTuning
    scope: Collection[int]
    costs: ExactCosts | None = None
    below: int = 0
    random_source: random.Random = field(default_factory=lambda: random.Random(0))

    def incumbent_cost(self, gap: Gap) -> int:
        """Return the cost of the incumbent."""
        assert self.costs is not None
        return sum(map(self.costs, gap.incumbent))

    def is_better(self, tree: Collection[int], gap: Gap) -> bool:
        """Return whether a tree costs less than the incumbent."""
        assert self.costs is not None
        return sum(map(self.costs, tree)) < self.incumbent_cost(gap)

    def only_better(self, gap: Gap) -> bool:
        """Return whether only trees better than the incumbent are wanted.

        They are with the reduction ``bounds``, unless the incumbent costs less than ``below``.
        """
        return Reduction.BOUNDS in self.reductions and self.incumbent_cost(gap) >= self.below

    def cutoff(self, gap: Gap) -> int:
        """Return the greatest cost of trees that are still wanted, plus :attr:`ExactCosts.doubt`.

        With the reduction ``bounds``, trees that cost as much as the incumbent are not wanted.
        """
        assert self.costs is not None
        return (
            max(self.incumbent_cost(gap), self.below)
            + self.costs.doubt
            - (Reduction.BOUNDS in self.reductions)
        )
