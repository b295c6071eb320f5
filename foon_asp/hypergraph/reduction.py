"""Presolve of a question: an incumbent, a lower bound, and the units that a better tree can have."""

import math
import random
from collections.abc import Callable, Collection, Sequence
from contextlib import AbstractContextManager, nullcontext, suppress
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from foon_asp.garbage import uncollected
from foon_asp.hypergraph.action_landmarks import relevant_beside_landmarks
from foon_asp.hypergraph.dominance import undominated
from foon_asp.hypergraph.exact_costs import CoarseCosts, ExactCosts, TooFineError
from foon_asp.hypergraph.extension import extended, extensions
from foon_asp.hypergraph.gap_bounded_subproblem import Subproblem, reduced_cost_fixing, reduced_costs_of
from foon_asp.hypergraph.goal_graph import GoalGraph, graph_of
from foon_asp.hypergraph.h_values import derive
from foon_asp.hypergraph.incumbent_trees import following, guessed, improved, irredundant, perturbation_search
from foon_asp.hypergraph.landmark_cuts import Cuts, landmark_cuts
from foon_asp.hypergraph.reduced_cost_neighbourhood import neighbourhood
from foon_asp.hypergraph.reductions import ALL, Reduction
from foon_asp.hypergraph.restricted_subproblem import restricted_subproblem
from foon_asp.problem import Objective, Problem

if TYPE_CHECKING:  # few questions need it
    from foon_asp.hypergraph.cost_partition import SharedCosts
    from foon_asp.hypergraph.optimality_proof import Cases

_LARGE = 40_000  # with more actions, it pays not to look at all of them
_FIRST = 4000  # actions nearest to the goals, among which a first tree is looked for
_ABLE = 50  # units kept of a required set while trees are looked for
_MANY = 2000  # actions among which better trees are looked for
_EASY = 600  # with fewer actions, clingo is faster than looking for better trees here
_SMALL = 200  # with fewer actions, clingo is faster than optimal cost partitioning
_ROUNDS = 24  # of cuts, better trees and reductions
_ROUNDS_AT_COSTS = 6  # of cuts, better trees and reductions where other costs are tried
_EFFORT = 3_000_000  # actions looked at while branching, before clingo is called: some 20 s of processor time
_BRANCHING_GAP = 4, 3  # branching pays where 4 times the bound is at least 3 times the cost of the incumbent
_TRIES, _THOROUGH = 10, 40  # times all actions: the effort of perturbation search, or half that of branching
_DENSE = 20  # landmark actions per action, after which the LP is better than greedy cuts
_SPARSE = 50, 0.01  # landmark actions, or share of all: larger landmarks make the LP slow and are weak
_TWOFOLD = 2  # landmark actions per action: with more, the LP begins with sparse landmarks only
_CLOSE = 0.98  # of the incumbent's cost: from such a bound on, branching is faster than more cuts
_AMONG = 0.2  # of the actions: fewer are searched by branching, more by perturbation search
_USED = 1e-4  # an action of a greater LP value counts as used by an LP solution
_WORTH = 0.9  # of the actions: another round pays if no more remain


class Reduced(NamedTuple):
    """A presolved question.

    ``tree`` are the units of the incumbent, or ``None`` where there is no tree. ``units`` are those of the
    incumbent and those that a better tree can have, ascending. ``settled`` is true where the incumbent is
    proved optimal. ``costs`` compares trees exactly, and ``bound`` is a lower bound by it on every tree;
    ``None`` and 0 where rates are too fine. ``cuts`` is the greedy cost partition of the greatest sum, over
    the units remaining at the time. ``interrupted`` is true where ctrl-C ended it, or time was up before any
    reduction: ``units`` means nothing then. ``subproblem`` is the gap-bounded subproblem, which holds
    whatever rules trees have to keep to. ``shared`` is the optimal cost partition, if one was computed.
    ``cases`` are the actions branched on. ``tight`` are the tight cuts of the LP solutions by which units
    were left out, over the units remaining at the time.
    """

    tree: frozenset[int] | None
    units: tuple[int, ...]
    settled: bool
    costs: ExactCosts | None
    bound: int
    cuts: Cuts | None
    interrupted: bool = False
    subproblem: Subproblem | None = None
    shared: "SharedCosts | None" = None
    cases: "Cases" = None
    tight: Collection[frozenset[int]] = ()


class Listener:
    """Observer of incumbents and bounds; its methods do nothing unless overridden."""

    def tree(self, units: frozenset[int]) -> None:
        """Receive a tree that is better than the one before."""

    def bound(self, costs: ExactCosts, bound: int) -> None:
        """Receive a lower bound on all trees."""


class Bounds(Listener):
    """Observer that passes on bounds only: trees found on the way may not keep to all rules."""

    def __init__(self, listener: Listener) -> None:
        self._listener = listener

    def bound(self, costs: ExactCosts, bound: int) -> None:
        """Receive a lower bound on all trees."""
        self._listener.bound(costs, bound)


def reduce(
    problem: Problem,
    objectives: Sequence[Objective],
    reductions: Collection[Reduction] = ALL,
    expired: Callable[[], bool] = lambda: False,
    listener: Listener | None = None,
    guard: Callable[[], AbstractContextManager[object]] = nullcontext,
    redundant: bool = False,
    other_rules: bool = False,
    brief: bool = False,
) -> Reduced:
    """Reduce a problem to the units that a search for the best tree still has to look at.

    ``objectives`` is the list as it is optimized, with ``units`` in it, so that every unit costs something.
    Without reductions, the relevant units that can be executed remain. ``expired`` returns whether time is
    up; longer computations are interrupted, as by ctrl-C, by the ``guard``. With ``other_rules``, trees have
    to keep to rules unknown here, for which ``subproblem`` is computed; with ``redundant``, they may have
    units that lead to no goal. ``brief`` computes any tree and ``subproblem`` only.
    """
    with uncollected():
        with guard():
            reducer = _Reducer(
                problem,
                tuple(objectives),
                frozenset(reductions),
                expired,
                listener or Listener(),
                redundant,
                other_rules,
            )
            reducer.brief = brief
        return reducer.reduce(guard)


def at_costs(
    subproblem: Subproblem,
    objectives: Sequence[Objective],
    costs: ExactCosts,
    expired: Callable[[], bool],
    known_tree: Collection[int] = (),
    below: int = 0,
    max_actions: float = math.inf,
) -> Reduced:
    """Reduce a gap-bounded subproblem under other costs, with ``known_tree`` as a first incumbent, if any.

    With ``below``, only units are left out whose trees all cost at least ``below`` and at least as much as
    the incumbent; that is given up where more than ``max_actions`` remain and the first cuts exclude hardly
    any.
    """
    with uncollected():
        reductions = {Reduction.DEAR, Reduction.BOUNDS} if below else ALL
        reducer = _Reducer(
            subproblem.problem,
            tuple(objectives),
            frozenset(reductions),
            expired,
            Listener(),
            subproblem.redundant,
            other_rules=True,
        )
        reducer.costs = reducer.coarse = costs
        if not isinstance(subproblem.remaining, range):  # other objectives may count no items
            reducer.relevant = {
                action for action in subproblem.remaining if action < len(reducer.graph.needs)
            }
        reducer.known_tree, reducer.below = subproblem.actions(known_tree), below
        reducer.rounds, reducer.many = _ROUNDS_AT_COSTS, max_actions
        if below:  # clingo gets the remaining actions with an incumbent
            reducer.small = _EASY
        return reducer.reduce(nullcontext)


class _Reducer:
    def __init__(
        self,
        problem: Problem,
        objectives: tuple[Objective, ...],
        reductions: frozenset[Reduction],
        expired: Callable[[], bool],
        listener: Listener,
        redundant: bool,
        other_rules: bool,
        extended: bool = False,
    ) -> None:
        self.problem, self.objectives, self.reductions = problem, objectives, reductions
        self.expired, self.listener, self.redundant, self.other_rules = (
            expired,
            listener,
            redundant,
            other_rules,
        )
        self.extended = extended  # costs of all actions are needed later
        self.rounds, self.effort, self.small = _ROUNDS, _EFFORT, _SMALL
        self.many = math.inf  # actions with which to give up if hardly any are left out
        self.extending = False  # whether trees were left out before there were cuts
        self.graph: GoalGraph = graph_of(problem, objectives)
        self.coarse: Callable[[int], int] = CoarseCosts(problem, objectives[0])
        self.thin = self.graph.thin(_ABLE, self.coarse)
        self.relevant: Collection[int] | None = None  # actions that can run and lead to a goal
        self.remaining: Collection[int]  # assigned before ``tree``
        self.tree: set[int] = set()
        self.known_tree: set[int] = set()  # a tree known from the start, if any
        self.below = 0  # trees that cost less count, even if they are no better than the incumbent
        self.costs: ExactCosts | None = None
        self.bound = 0
        self.cuts: Cuts | None = None
        self.subproblem: Subproblem | None = None
        self.shared: SharedCosts | None = None
        self.tight: Sequence[frozenset[int]] = ()  # cuts to begin optimal cost partitioning with
        self.once: dict[frozenset[int], None] = {}  # cuts tight at any time, in order
        self.chance = random.Random(0)
        self.cases: Cases = None
        self.brief = False  # whether only cuts are wanted
        self.proved = False  # whether the tree is optimal because its cost is optimal for the goals alone

    def reduce(self, guard: Callable[[], AbstractContextManager[object]]) -> Reduced:
        """Reduce the network in stages, from cheap to expensive, and return the result.

        The ``guard`` interrupts the longer stages.
        """
        ended = settled = hopeless = False
        try:
            h_values = self._by_extending(guard)
            if self.proved:
                return self._result(settled=True)
            with guard():
                h_values = h_values or self._near_goals() or self._whole()
                hopeless = h_values is None
                if h_values is not None and self.reductions:
                    if not self.extending:  # else the listener has it already
                        if self.known_tree:
                            self.tree = min(
                                self.tree, self.known_tree, key=lambda tree: sum(map(self.coarse, tree))
                            )
                        self._take(irredundant(self.graph, self.tree, self.coarse))
                    settled = self._reduce(h_values)
                ended = True
        except KeyboardInterrupt:
            if not (self.tree or hopeless):
                raise
        if hopeless:
            return Reduced(None, (), False, None, 0, None)
        result = self._result(settled)
        return result if ended else result._replace(interrupted=True)

    def _by_extending(self, guard: Callable[[], AbstractContextManager[object]]) -> dict[int, int] | None:
        """Keep the units of cheap trees for the goals alone, and of cheap extensions to the required sets.

        Every tree contains one for the goals alone, which costs no more; the other units cost at most the
        difference. A tree as cheap as the best one for the goals alone is optimal. Returns h-values of
        objects, or ``None`` where nothing is required or this relaxation does not help.
        """
        graph, restriction, limits = self.graph, self.problem.restriction, Reduction.DEAR in self.reductions
        if self.other_rules or restriction is None or not restriction.required or not limits:
            return None
        goals_only = _Reducer(
            replace(self.problem, restriction=replace(restriction, required=())),
            self.objectives,
            self.reductions,
            self.expired,
            Bounds(self.listener),
            self.redundant,
            self.other_rules,
            extended=True,
        )
        reduced = goals_only.reduce(guard)
        costs, subproblem = goals_only.costs, goals_only.subproblem
        if costs is None or subproblem is None:
            return None
        with guard():
            tree = extended(self.thin, goals_only.tree, costs, len(graph.needs) // 4)
            if tree is None:
                return None
            self.remaining = range(len(graph.needs))
            self._take(irredundant(graph, tree, costs))
            if reduced.interrupted:
                raise KeyboardInterrupt
            only_better, total = Reduction.BOUNDS in self.reductions, self._total(costs)
            optimal = (
                reduced.settled and self.tree == goals_only.tree if costs.doubt else total == reduced.bound
            )
            if only_better and optimal:
                self.costs, self.bound, self.cuts = costs, reduced.bound, reduced.cuts
                self.shared, self.cases, self.proved = reduced.shared, reduced.cases, True
                return None
            limit = total - only_better
            candidates = {*subproblem.actions_within(limit, self.expired), *self.tree}
            candidates |= extensions(
                graph, candidates, costs, limit - reduced.bound + costs.doubt, self.expired
            )
            if self.expired():
                raise KeyboardInterrupt
            derivations = derive(graph, candidates, self.coarse, h_add=False)
            self.remaining, self.extending = graph.cone(derivations.h_actions)[0], True
        return derivations.cost

    def _near_goals(self) -> dict[int, int] | None:
        """Find a first tree among the actions nearest to the goals, so that large networks are read lazily.

        Most of a large network is too far from the goals for a good tree, and is never looked at. Returns
        h-values of objects, or ``None`` where the network is small or no tree is found.
        """
        graph = self.graph
        size = len(graph.needs)
        if not self.reductions & {Reduction.BOUNDS, Reduction.DEAR} or size <= _LARGE:
            return None
        all_actions = range(size)
        candidates = neighbourhood(self.thin, all_actions, self.coarse, math.inf, enough=_FIRST)
        subproblem = (
            restricted_subproblem(self.thin, candidates, self.coarse, size // 4)
            if len(candidates) >= _FIRST
            else None
        )
        if subproblem is None:
            return None
        self.remaining = all_actions
        derivations, self.tree = subproblem
        return derivations.cost

    def _whole(self) -> dict[int, int] | None:
        """Keep the relevant actions that can run; return h-values of objects, ``None`` without a tree."""
        graph = self.graph
        cone = graph.cone()[0] if self.relevant is None else self.relevant
        derivations = derive(graph, cone, self.coarse, h_add=False)
        tree = derivations.tree(graph, graph.goals)
        if tree is None:
            return None
        self.remaining = derivations.h_actions
        if len(derivations.h_actions) < len(cone):  # others may lead only to actions that cannot run
            self.remaining, _ = graph.cone(derivations.h_actions)
        self.tree = self.tree or tree
        return derivations.cost

    def _reduce(self, h_values: dict[int, int]) -> bool:
        """Repeat bounds, heuristics and reductions up to a fixpoint; return whether optimality is proved."""
        with suppress(TooFineError):
            all_costs = range(len(self.graph.needs)) if self.redundant or self.extended else self.remaining
            self.costs = self.costs or ExactCosts(self.problem, self.objectives, all_costs)
        costs = self.costs
        if costs is not None and self.brief:
            self._bound(costs, h_values)
            return False
        if costs is not None and not isinstance(self.remaining, range) and len(self.remaining) > _EASY:
            self._follow_added(costs)
        if costs is not None and costs.limited:  # any tree below the limit will do
            self._improve(costs, Cuts(0, {}, []), thorough=False)
            if self._met(costs, Cuts(0, {}, [])):
                return True
        thorough = False  # as a last resort
        for turn in range(self.rounds):
            previous = len(self.remaining), self.tree
            if costs is not None and self.reductions & {Reduction.BOUNDS, Reduction.DEAR}:
                cuts = self._bound(costs, h_values)
                lazy = isinstance(self.remaining, range)  # most of it is not relevant, and goes anyway
                if not turn and self.below and not lazy and len(self.remaining) > self.many:
                    self._fix_by_reduced_cost(costs, cuts)  # the cutoff does not depend on the incumbent
                    if len(self.remaining) > max(self.many, _WORTH * previous[0]):
                        return False
                optimal = self._met(costs, cuts)
                if not optimal and not self.expired():
                    self._improve(costs, cuts, thorough)
                    optimal = self._met(costs, cuts)
                if optimal:
                    return True
                if Reduction.DEAR in self.reductions and not self.expired():
                    self._fix_by_reduced_cost(costs, cuts)
            if self.expired():
                break
            if isinstance(self.remaining, range):
                self._whole()
            if costs is not None and Reduction.DOMINATED in self.reductions:
                self.remaining = undominated(self.graph, self.remaining, costs)
            changed = (len(self.remaining), self.tree) != previous
            if not changed and Reduction.FORCED in self.reductions and len(self.remaining) <= _MANY:
                self.remaining = relevant_beside_landmarks(self.graph, self.remaining)
                changed = len(self.remaining) < previous[0]
            slow = len(self.remaining) > max(_MANY, _WORTH * previous[0])  # another turn would bring little
            if (slow or not changed) and costs is not None and not thorough:
                if self._share_costs(costs) or self._branch(costs):
                    return True
                changed = (len(self.remaining), self.tree) != previous
            if not changed and (thorough or len(self.remaining) <= _EASY):
                break
            thorough = not changed
            h_values = derive(self.graph, self.remaining, costs or self.coarse, h_add=False).cost
        return False

    def _branch(self, costs: ExactCosts) -> bool:
        """Branch and cut over the remaining actions, up to an effort; return whether optimality is proved.

        Where rounding may decide, and where rules restrict trees, branching is left to clingo.
        """
        if not self._branches(costs):
            return False
        total, (parts, enough) = self._total(costs), _BRANCHING_GAP
        if len(self.remaining) <= _SMALL or self.bound * parts < total * enough:
            return False
        self._improve_on(costs)
        total = self._total(costs)
        from foon_asp.hypergraph.branch_and_bound import Branching  # noqa: PLC0415 (few questions need it)

        graph, remaining = self.graph, self.remaining

        def on_bound(bound: int) -> None:
            if bound > self.bound:
                self.bound = bound
                self.listener.bound(costs, bound)

        cuts = [cut.objects for cut in self.cuts.cuts] if self.cuts else []
        cuts += [objects for objects, _ in self.shared.cuts] if self.shared else []
        branching = Branching(
            *(graph, graph.goals, remaining, costs, cuts, total),
            lambda shares, without: guessed(graph, remaining, costs, shares, without),
            *(self._take, on_bound),
        )
        settled = branching.search(self.effort, self.expired)
        self.effort = branching.effort
        if settled:
            self.cases = branching.cases()
            on_bound(self._total(costs))
            return True
        if self.shared is not None and self._total(costs) < total:
            self._apply(costs, self.shared)
        return False

    def _branches(self, costs: ExactCosts) -> bool:
        """Return whether branching may prove a tree optimal."""
        only_better = Reduction.BOUNDS in self.reductions and self._total(costs) >= self.below
        return only_better and not (costs.doubt or costs.limited or self.other_rules) and self.effort > 0

    def _share_costs(self, costs: ExactCosts) -> bool:
        """Reduce by optimal cost partitioning; return whether optimality is proved."""
        from foon_asp.hypergraph.cost_partition import share_costs  # noqa: PLC0415 (few questions need it)

        if not self.tight and self.cuts:
            min_members, ratio = _SPARSE
            dense = sum(len(cut.members) for cut in self.cuts.cuts) > _TWOFOLD * len(self.remaining)
            max_members = max(min_members, ratio * len(self.remaining)) if dense else math.inf
            self.tight = [cut.objects for cut in self.cuts.cuts if len(cut.members) <= max_members]
        before, settled, almost_closed = math.inf, False, False

        def on_solution(shared: "SharedCosts") -> int:
            nonlocal settled, almost_closed
            settled = self._followed(costs, shared, _TRIES)
            total = self._total(costs)
            almost_closed = self._branches(costs) and self.bound > total * _CLOSE
            return 0 if settled or almost_closed or len(self.remaining) < _WORTH * before else total

        while (
            not (settled or almost_closed)
            and self.small < len(self.remaining) < _WORTH * before
            and not self.expired()
        ):
            before = len(self.remaining)
            goals, total = self.graph.goals, self._total(costs)
            shared = share_costs(
                self.graph, goals, self.remaining, costs, self.tight, total, self.expired, on_solution
            )
            if shared is None:
                break
            self.tight = shared.tight
            settled = settled or self._followed(costs, shared, _THOROUGH)
        return settled

    def _followed(self, costs: ExactCosts, shared: "SharedCosts", tries: int) -> bool:
        """Look for a better tree by an LP solution, and reduce by it; return whether optimality is proved."""
        from foon_asp.hypergraph.cost_partition import PARTS  # noqa: PLC0415 (few questions need it)

        candidates = {action for action, share in shared.shares.items() if share > _USED} | self.tree
        for tree in following(self.graph, self.remaining, costs, shared):
            candidates |= tree
            self._take_better(tree, costs)
        least = -(-shared.bound // PARTS)
        if least < self._total(costs):
            if len(candidates) <= _AMONG * len(self.remaining):
                cuts, effort = [cut for cut, _ in shared.cuts], 2 * tries * len(self.remaining)
                self._search_among(candidates, costs, cuts, effort)
            else:
                tree = perturbation_search(
                    *(self.graph, self.remaining, self.tree, costs, least, self.expired),
                    *(shared.shares, self.chance.random, tries),
                )
                self._take_better(tree, costs)
        return self._apply(costs, shared)

    def _search_among(
        self, actions: Collection[int], costs: ExactCosts, cuts: Sequence[frozenset[int]], effort: int
    ) -> None:
        """Look for a better tree among a few actions, by branching up to an effort (sub-MIP heuristic)."""
        from foon_asp.hypergraph.branch_and_bound import Branching  # noqa: PLC0415 (few questions need it)

        graph = self.graph
        runnable = derive(graph, actions, costs, h_add=False).h_actions
        search = Branching(
            *(graph, graph.goals, runnable, costs, cuts, self._total(costs)),
            lambda shares, without: guessed(graph, runnable, costs, shares, without),
            lambda tree: self._take_better(irredundant(graph, tree, costs), costs),
            lambda _: None,
        )
        search.search(effort, self.expired)

    def _apply(self, costs: ExactCosts, shared: "SharedCosts") -> bool:
        """Apply the bound and the reduced costs of a cost partition; return whether optimality is proved.

        Costs of trees are whole, so bounds are rounded up.
        """
        from foon_asp.hypergraph.cost_partition import PARTS  # noqa: PLC0415 (few questions need it)

        total = self._total(costs)
        self.once.update(dict.fromkeys(shared.tight))
        bound = min(-(-shared.bound // PARTS), total)
        if bound > self.bound:
            self.bound, self.shared = bound, shared
            self.listener.bound(costs, bound)
        only_better = Reduction.BOUNDS in self.reductions
        if Reduction.DEAR in self.reductions:
            limit = (max(total, self.below) + costs.doubt - only_better) * PARTS - shared.bound
            self.remaining = reduced_cost_fixing(
                self.graph, self.remaining, shared.reduced_costs.__getitem__, limit, self.expired
            )
        if Reduction.DOMINATED in self.reductions:
            self.remaining = undominated(self.graph, self.remaining, costs)
        return only_better and not costs.doubt and bound == total >= self.below

    def _follow_added(self, costs: ExactCosts) -> None:
        """Make the tree that follows h_add the incumbent, if it is better."""
        tree = derive(self.graph, self.remaining, costs, h_add=True).tree(self.graph, self.graph.goals)
        self._take_better(irredundant(self.graph, tree or self.tree, costs), costs)

    def _bound(self, costs: ExactCosts, h_values: dict[int, int]) -> Cuts:
        """Compute landmark cuts and raise the bound; the remaining actions always contain a tree."""
        lazy = isinstance(self.remaining, range)  # h-values would have to look at all actions
        cuts = landmark_cuts(
            self.graph,
            self.graph.goals,
            self.remaining,
            costs,
            h_values,
            self.expired,
            None
            if lazy
            else lambda reduced_cost: derive(self.graph, self.remaining, reduced_cost, h_add=False).cost,
            math.inf if self.other_rules or self.brief else _DENSE * max(_EASY, len(self.remaining)),
        )
        if self.subproblem is None and not cuts.interrupted and not self.extending:  # no reduction so far
            self.subproblem = Subproblem(
                self.problem, self.graph, self.remaining, costs, cuts, self.redundant
            )
        if self.cuts is None or cuts.bound > self.cuts.bound:
            self.cuts = cuts
        bound = min(cuts.bound, self._total(costs))
        if bound > self.bound:
            self.bound = bound
            self.listener.bound(costs, bound)
        if cuts.interrupted:
            raise KeyboardInterrupt
        return cuts

    def _met(self, costs: ExactCosts, cuts: Cuts) -> bool:
        """Return whether cuts prove the incumbent optimal, and no tree below ``below`` is wanted."""
        enough = Reduction.BOUNDS in self.reductions and self._total(costs) >= self.below
        return enough and costs.met(cuts, self.tree)

    def _improve(self, costs: ExactCosts, cuts: Cuts, thorough: bool) -> None:
        """Look for better trees in the reduced-cost neighbourhood."""
        reduced_cost = reduced_costs_of(costs, cuts)
        candidates = neighbourhood(
            self.thin, self.remaining, reduced_cost, self._total(costs) - cuts.bound, enough=_MANY
        )
        better = improved(
            self.graph, candidates | self.tree, self.tree, costs, reduced_cost, self.expired, thorough
        )
        if better is not self.tree:
            self._take(better)

    def _improve_on(self, costs: ExactCosts) -> None:
        """Look thoroughly for better trees, again from each new incumbent, up to an effort."""
        effort, previous = _EFFORT, set[int]()
        while self.tree != previous and not self.expired():
            previous = self.tree
            effort -= len(previous) * len(self.remaining)
            if effort < 0:
                break
            self._improve(costs, self.cuts or Cuts(0, {}, []), thorough=True)

    def _fix_by_reduced_cost(self, costs: ExactCosts, cuts: Cuts) -> None:
        """Remove the actions above the cutoff by reduced-cost fixing."""
        limit = max(self._total(costs), self.below) - cuts.bound + costs.doubt
        if Reduction.BOUNDS in self.reductions:
            limit -= 1  # trees as good as the incumbent are not needed
        self.remaining = reduced_cost_fixing(
            self.graph, self.remaining, reduced_costs_of(costs, cuts), limit, self.expired
        )

    def _take(self, tree: set[int]) -> None:
        self.tree = tree
        self.listener.tree(self._units(tree))

    def _take_better(self, tree: set[int], costs: ExactCosts) -> None:
        if sum(map(costs, tree)) < self._total(costs):
            self._take(tree)

    def _total(self, costs: ExactCosts) -> int:
        return sum(map(costs, self.tree))

    def _units(self, actions: Collection[int]) -> frozenset[int]:
        return frozenset(a for a in actions if a < self.graph.units)

    def _result(self, settled: bool) -> Reduced:
        """Return the result of the reductions so far."""
        tree = self._units(self.tree)
        early = isinstance(self.remaining, range)  # time was up before any reduction
        units = tree if settled or early else tree | self._units(self.remaining)
        return Reduced(
            tree,
            tuple(sorted(units)),
            settled,
            self.costs,
            self.bound,
            self.cuts,
            early and not settled,
            self.subproblem,
            self.shared,
            self.cases,
            tuple(self.once),
        )
