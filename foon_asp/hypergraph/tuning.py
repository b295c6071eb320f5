"""Numbers that steer the stages of presolve; none of them decides what is proved, only how fast.

``benchmarks/tuning.py`` halves and doubles each, and prints what changes on the instances that it names.
Stages read the objects at the end of this module when they are called.
"""

from fractions import Fraction
from typing import NamedTuple


class PresolveTuning(NamedTuple):
    """When a stage of :mod:`foon_asp.hypergraph.reduction` begins, and when it ends.

    ``lazy_actions``: actions of a network. In a larger one, only those near the goals are looked at first.
    ``first_actions``: actions nearest to the goals among which the first tree is looked for.
    ``required_achievers``: achievers of a required set that are looked at while trees are looked for.
    ``neighbourhood_actions``: actions of the neighbourhood in which better trees are looked for.
    ``easy_actions``: candidates. With fewer, clingo is faster than a thorough search for better trees.
    ``relaxed_actions``: candidates. With fewer, clingo is faster than the linear relaxation.
    ``branching_budget``: actions that branch and bound may look at; some 20 s of processor time.
    ``branching_bound``: share of the incumbent's cost that the bound has to reach before branching begins.
    ``sufficient_bound``: share of the incumbent's cost. From this bound on, branching is faster than cuts.
    ``search_looks``: looks at each action in a search for a better tree that follows an LP solution.
    ``sparse_share``: share of the candidates. Up to it, trees are searched by branching, else by
    perturbation.
    ``landmark_actions``: sum of the sizes of landmarks, per action, after which greedy cuts end.
    ``worthwhile_share``: share of the candidates. Another turn follows only if fewer remain.
    """

    lazy_actions: int = 40_000
    first_actions: int = 4_000
    required_achievers: int = 50
    neighbourhood_actions: int = 2_000
    easy_actions: int = 600
    relaxed_actions: int = 200
    branching_budget: int = 3_000_000
    branching_bound: Fraction = Fraction(3, 4)
    sufficient_bound: Fraction = Fraction(49, 50)
    search_looks: int = 20
    sparse_share: float = 0.2
    landmark_actions: float = 20
    worthwhile_share: float = 0.9


class CutTuning(NamedTuple):
    """How landmark cuts and h-values are looked for.

    ``guided_cuts``: cuts after which the h-values that guide cuts are computed anew. With more targets than
    this, it is one cut for each target.
    ``guides``: how often h-values are computed, at most, while as many cuts are found as there are objects.
    Each time looks at all objects, so without a maximum cuts would take quadratic time
    (``benchmarks/shapes.py``, grid by kitchen).
    ``lazy_depth``: depth of the recursion of lazy h_max.
    ``lazy_looks``: actions that lazy h_max looks at in all.
    """

    guided_cuts: int = 64
    guides: int = 32
    lazy_depth: int = 100
    lazy_looks: int = 200_000


class RelaxationTuning(NamedTuple):
    """How the linear relaxation is solved and searched.

    ``cuts``: violated cuts with disjoint landmarks that are separated for one LP solution, at most.
    ``stalled_solutions``: solutions after which a bound that hardly grows counts as optimal.
    ``stalled_growth``: share of the gap that these solutions have to gain.
    ``node_rounds``: rounds of separation at each node but the root.
    ``guess_interval``: nodes from one guess of derivations to the next.
    ``landmark_bits``: bits of the landmark sets by which first achievers are computed; in larger graphs, only
    landmarks among fewer objects are computed.
    ``starting_landmarks``: sum of the sizes of the landmarks with which it begins, per action.
    ``run_seconds``: seconds of an interior-point run, which cannot be continued.
    """

    cuts: int = 40
    stalled_solutions: int = 8
    stalled_growth: float = 0.01
    node_rounds: int = 3
    guess_interval: int = 10
    landmark_bits: int = 400_000_000
    starting_landmarks: int = 2
    run_seconds: float = 2.0


class ProofTuning(NamedTuple):
    """How certificates are looked for, by :class:`foon_asp.hypergraph.optimality_proof.Prover`.

    ``rounded_actions``: actions. With more, rounded weights are tried before exact ones.
    ``greedy_cuts``: known cuts that get weights greedily. Others get weights only from the LP.
    ``fixed_share``: share of the actions. If more are above the cutoff, these are fixed before anything else.
    ``search_budget``: actions that branch and bound may look at; about a minute of processor time.
    ``proof_length``: objects and landmark actions that a proof by branching may list.
    ``pivots``: steps of the exact simplex algorithm from the basis of floats; few are needed.
    """

    rounded_actions: int = 1000
    greedy_cuts: int = 200
    fixed_share: float = 0.5
    search_budget: int = 10_000_000
    proof_length: int = 2_000_000
    pivots: int = 400


class PriceTuning(NamedTuple):
    """How a limit on a sum over units is priced, by :mod:`foon_asp.hypergraph.priced_limit`.

    ``prices``: prices that are tried.
    ``easy_units``: units. With fewer, clingo is faster than another price.
    ``rising_units``: units. With more, rising prices are tried.
    ``rising_prices``: rising prices that are tried, at most.
    """

    prices: int = 2
    easy_units: int = 1000
    rising_units: int = 2000
    rising_prices: int = 8


class SharedTuning(NamedTuple):
    """What the goals of a network share, in :mod:`foon_asp.hypergraph.shared_landmarks`.

    ``violated_landmarks``: known landmarks that are added for one LP solution, at most.
    ``unions``: unions of trees that are made irredundant to find a first tree.
    """

    violated_landmarks: int = 40
    unions: int = 3


PRESOLVE = PresolveTuning()
CUTS = CutTuning()
RELAXATION = RelaxationTuning()
PROOF = ProofTuning()
PRICES = PriceTuning()
SHARED = SharedTuning()
