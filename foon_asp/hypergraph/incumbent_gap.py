"""The gap of a question: an incumbent, a lower bound, and the actions that trees between them can have."""

from collections.abc import Collection, Generator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

from foon_asp.hypergraph.landmark_cuts import Cuts

if TYPE_CHECKING:  # few questions need it
    from foon_asp.hypergraph.cost_partition import SharedCosts
    from foon_asp.hypergraph.proof_tree import Cases


class FirstCuts(NamedTuple):
    """Landmark cuts found before any action was excluded, and the actions that they hold for."""

    cuts: Cuts
    actions: Collection[int]


class Evidence(NamedTuple):
    """The cuts and the case split that prove the lower bound of a gap.

    ``first`` are the cuts found before any reduction, ``cuts`` the greedy cost partition of the greatest sum,
    ``shared`` the optimal cost partition that raised the bound. ``tight`` are the tight cuts of all LP
    solutions so far, in order. ``starting`` are the tight cuts of the last solution, with which the next
    relaxation begins. ``cases`` are the actions branched on.
    """

    first: FirstCuts | None = None
    cuts: Cuts | None = None
    shared: "SharedCosts | None" = None
    tight: tuple[frozenset[int], ...] = ()
    starting: tuple[frozenset[int], ...] = ()
    cases: "Cases" = None


NO_EVIDENCE = Evidence()


@dataclass(frozen=True, eq=False, repr=False)
class Gap:
    """The state of a question between two stages; a stage makes new ones, each smaller than the one before.

    ``incumbent`` are the actions of the best tree so far, ``lower_bound`` bounds the cost of every tree, in
    the units of :class:`ExactCosts`. ``candidates`` are the actions that better trees can have, and trees
    that are as good where these are wanted. ``proved`` is true where the incumbent is proved optimal.
    ``budget`` are the actions that branch and bound may still look at.
    """

    incumbent: frozenset[int]
    lower_bound: int
    candidates: Collection[int]
    budget: int = 0
    proved: bool = False
    evidence: Evidence = NO_EVIDENCE

    def with_incumbent(self, tree: Collection[int]) -> "Gap":
        """Return the gap with another incumbent."""
        return replace(self, incumbent=frozenset(tree))

    def with_candidates(self, candidates: Collection[int]) -> "Gap":
        """Return the gap with fewer candidates."""
        return replace(self, candidates=candidates)

    def raised(self, lower_bound: int, evidence: Evidence) -> "Gap":
        """Return the gap with new evidence, and with a lower bound where that is greater."""
        return replace(self, lower_bound=max(self.lower_bound, lower_bound), evidence=evidence)

    def closed(self) -> "Gap":
        """Return the gap whose incumbent is proved optimal."""
        return replace(self, proved=True)


# A stage yields each gap that it reaches, and returns the last.
Stage = Generator[Gap, None, Gap]
