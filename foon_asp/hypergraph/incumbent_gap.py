"""The gap of a question: an incumbent, a lower bound, and the actions of trees that cost between the two."""

from collections.abc import Collection, Generator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

from foon_asp.hypergraph.landmark_cuts import Cuts

if TYPE_CHECKING:  # few questions need it
    from foon_asp.hypergraph.cost_partition import CostPartition
    from foon_asp.hypergraph.proof_tree import Cases


class FirstCuts(NamedTuple):
    """Landmark cuts found before any action was excluded, and the actions over which they were found."""

    cuts: Cuts
    actions: Collection[int]


class Evidence(NamedTuple):
    """The cuts and the case split that prove the lower bound of a gap.

    ``first``: the landmark cuts found before any reduction.
    ``cuts``: the greedy cost partition with the greatest bound.
    ``partition``: the last optimal cost partition that raised the bound.
    ``tight``: the tight cuts of all LP solutions so far, in order.
    ``starting``: the tight cuts of the last LP solution. The next relaxation begins with them.
    ``cases``: the actions branched on, as nested cases; ``None`` if branching proved nothing.
    """

    first: FirstCuts | None = None
    cuts: Cuts | None = None
    partition: "CostPartition | None" = None
    tight: tuple[frozenset[int], ...] = ()
    starting: tuple[frozenset[int], ...] = ()
    cases: "Cases" = None


NO_EVIDENCE = Evidence()


@dataclass(frozen=True, eq=False, repr=False)
class Gap:
    """The state of a question between two stages. Each stage turns it into a smaller gap.

    ``incumbent``: the actions of the best tree so far.
    ``lower_bound``: a lower bound on the cost of every tree, in the units of :class:`ExactCosts`.
    ``candidates``: the actions that better trees can have. If equally good trees are wanted, the actions of
    such trees are candidates as well.
    ``budget``: the number of actions that branch and bound may still look at.
    ``proved``: whether the incumbent is proved optimal.
    ``evidence``: the cuts that prove the lower bound.
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

    def with_bound(self, lower_bound: int, evidence: Evidence) -> "Gap":
        """Return the gap with new evidence, and with this lower bound if it is greater."""
        return replace(self, lower_bound=max(self.lower_bound, lower_bound), evidence=evidence)

    def as_proved(self) -> "Gap":
        """Return the gap with its incumbent marked as proved optimal."""
        return replace(self, proved=True)


# A stage yields each gap that it reaches, and returns the last.
Stage = Generator[Gap, None, Gap]
