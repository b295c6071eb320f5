"""Numbers that steer the stages of a presolve; none of them decides what is proved, only how fast.

`benchmarks/tuning.py` halves and doubles each and prints what moves, on the instances that it names.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class PresolveTuning:
    """When a stage of :mod:`foon_asp.hypergraph.reduction` begins, and when it ends.

    ``lazy_actions``: actions of a network; with more, only those near the goals are looked at first.
    ``first_actions``: actions nearest to the goals among which the first tree is looked for.
    ``required_achievers``: achievers of a required set that are looked at while trees are looked for.
    ``neighbourhood_actions``: actions of the neighbourhood in which better trees are looked for.
    ``easy_actions``: actions; with fewer, clingo is faster than a thorough search for better trees.
    ``relaxed_actions``: actions; with fewer, clingo is faster than the linear relaxation.
    ``rounds``: rounds of cuts, better trees and fixing, at most.
    ``branching_budget``: actions that branch and bound may look at; some 20 s of processor time.
    ``branching_bound``: share of the incumbent's cost; branching begins from such a bound on.
    ``sufficient_bound``: share of the incumbent's cost; from such a bound on, branching is faster than cuts.
    ``search_looks``: looks at each action in a search for a better tree that follows an LP solution.
    ``sparse_share``: share of the candidates; searched by branching up to it, else by perturbation.
    ``landmark_actions``: sizes of all landmarks together, for each action, after which greedy cuts end.
    ``worthwhile_share``: share of the candidates that may remain for another turn to pay.
    """

    lazy_actions: int = 40_000
    first_actions: int = 4_000
    required_achievers: int = 50
    neighbourhood_actions: int = 2_000
    easy_actions: int = 600
    relaxed_actions: int = 200
    rounds: int = 24
    branching_budget: int = 3_000_000
    branching_bound: float = 0.75
    sufficient_bound: float = 0.98
    search_looks: int = 10
    sparse_share: float = 0.2
    landmark_actions: float = 20
    worthwhile_share: float = 0.9


PRESOLVE = PresolveTuning()
