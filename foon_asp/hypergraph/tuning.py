"""Numbers that steer the stages of presolve; none of them decides what is proved, only how fast.

``benchmarks/tuning.py`` halves and doubles each, and prints what changes on the instances that it names.
Stages read the objects at the end of this module when they are called.
"""

from fractions import Fraction
from typing import NamedTuple


class PresolveTuning(NamedTuple):
    """When a stage of :mod:`foon_asp.hypergraph.reduction` begins, and when it ends.

    ``lazy_actions``: a number of actions. If a network has more, only those near the goals are looked at
    first.
    ``first_actions``: how many actions, nearest to the goals, are searched for the first tree.
    ``required_achievers``: how many units of each required set are looked at while trees are looked for.
    ``neighbourhood_actions``: how many actions a neighbourhood has in which better trees are looked for.
    ``easy_actions``: a number of candidates. If there are fewer, clingo is faster than a thorough search for
    better trees.
    ``relaxed_actions``: a number of candidates. If there are fewer, clingo is faster than the linear
    relaxation.
    ``branching_budget``: how many actions branch and bound may look at; this takes about 20 s of processor
    time.
    ``branching_bound``: the share of the incumbent's cost that the bound has to reach before branching
    begins.
    ``sufficient_bound``: a share of the incumbent's cost. Once the bound reaches it, branching is faster than
    more cuts.
    ``search_looks``: how often each action is looked at in a search for a better tree that follows an LP
    solution.
    ``sparse_share``: a share of the candidates. If an LP solution uses no more, better trees are looked for
    by branching, else by perturbation.
    ``landmark_actions``: a number per action. If the sizes of landmarks add up to it, greedy cuts end.
    ``worthwhile_share``: a share of the candidates. Another round follows only if fewer remain.
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

    ``guided_cuts``: the number of cuts after which the h-values that guide cuts are computed anew. If there
    are more targets than that, h-values are computed after as many cuts as there are targets.
    ``guides``: at least ``objects / guides`` cuts are found between two computations of h-values. Each
    computation looks at all objects, so computing them more often would take quadratic time
    (``benchmarks/shapes.py``, grid by kitchen).
    ``lazy_depth``: the greatest depth of the recursion of lazy h_max.
    ``lazy_looks``: how many actions one lazy h_max test looks at in all.
    """

    guided_cuts: int = 64
    guides: int = 32
    lazy_depth: int = 100
    lazy_looks: int = 200_000


class RelaxationTuning(NamedTuple):
    """How the linear relaxation is solved and searched.

    ``cuts``: how many violated cuts with disjoint landmarks are added for one LP solution, at most.
    ``stalled_solutions``: the number of solutions after which a bound that hardly grows counts as optimal.
    ``stalled_growth``: the share of the gap that these solutions have to close.
    ``node_rounds``: how many rounds of cuts there are at each node except the root.
    ``guess_interval``: the number of nodes from one call of the primal heuristic to the next.
    ``landmark_bits``: the number of bits of all landmark sets by which first achievers are computed. In
    larger graphs, only landmarks among some of the objects are computed.
    ``starting_landmarks``: the greatest sum of the sizes of landmarks to begin with, per action.
    ``run_seconds``: the time limit of an interior-point run, which cannot be continued.
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

    ``rounded_actions``: a number of actions. If there are more, rounded weights are tried before exact ones.
    ``greedy_cuts``: how many known cuts get weights greedily. The others get weights only from the LP.
    ``fixed_share``: if the reduced costs of more than this share of the actions are above the cutoff, all
    these actions are fixed at once.
    ``search_budget``: how many actions branch and bound may look at; this takes about a minute of processor
    time.
    ``proof_length``: how many objects and landmark actions a proof by branching may list.
    ``pivots``: how many steps the exact simplex algorithm may take from the basis of floats; few are needed.
    """

    rounded_actions: int = 1000
    greedy_cuts: int = 200
    fixed_share: float = 0.5
    search_budget: int = 10_000_000
    proof_length: int = 2_000_000
    pivots: int = 400


class PriceTuning(NamedTuple):
    """How a limit on a sum over units is priced, by :mod:`foon_asp.hypergraph.priced_limit`.

    ``prices``: how many prices are tried, at most.
    ``easy_units``: a number of units. If no more remain, clingo is faster than another price.
    ``rising_units``: a number of units. If more remain, rising prices are tried.
    ``rising_prices``: how many rising prices are tried, at most.
    """

    prices: int = 2
    easy_units: int = 1000
    rising_units: int = 2000
    rising_prices: int = 8


class SharedTuning(NamedTuple):
    """How the goals of a network share landmarks and trees.

    ``violated_landmarks``: how many known landmarks are added for one LP solution, at most.
    ``unions``: how many of the cheapest unions of trees are made irredundant to find a first tree.
    """

    violated_landmarks: int = 40
    unions: int = 3


PRESOLVE = PresolveTuning()
CUTS = CutTuning()
RELAXATION = RelaxationTuning()
PROOF = ProofTuning()
PRICES = PriceTuning()
SHARED = SharedTuning()
