"""A question made small before it is searched: a good tree, a lower bound, and what is left between them."""

import math
import random
from collections.abc import Callable, Collection, Sequence
from contextlib import AbstractContextManager, nullcontext, suppress
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from foon_asp.bounds.landmark_cuts import Cuts, landmark_cuts
from foon_asp.garbage import uncollected
from foon_asp.problem import Objective, Problem
from foon_asp.reduce.derivation import derive
from foon_asp.reduce.dominance import undominated
from foon_asp.reduce.exact_costs import CoarseCosts, ExactCosts, TooFineError
from foon_asp.reduce.extension import extended, extensions
from foon_asp.reduce.forced import beside_forced
from foon_asp.reduce.graph import Graph, graph_of
from foon_asp.reduce.narrow import narrow
from foon_asp.reduce.near import near
from foon_asp.reduce.reductions import ALL, Reduction
from foon_asp.reduce.upper_bound import following, guessed, improved, varied, without_spare
from foon_asp.reduce.wide import Wide, dear_left_out, rests

if TYPE_CHECKING:  # few questions need it
    from foon_asp.bounds.lower_bound import Cases
    from foon_asp.bounds.shared_costs import SharedCosts

_LARGE = 40_000  # actions from which on it pays not to look at all of them
_FIRST = 4000  # actions nearest to the goals, among which a tree is looked for before all others count
_ABLE = 50  # units of a required set that count while trees are looked for
_MANY = 2000  # actions among which better trees are looked for
_EASY = 600  # actions that clingo chooses from faster than better trees are looked for here
_SMALL = 200  # actions that clingo chooses from faster than costs are shared out among all cuts
_ROUNDS = 24  # of cuts, trees and what they leave
_FEW = 6  # of these, where other costs are tried
_EFFORT = 3_000_000  # actions looked at while branching, before clingo is asked: some 20 s of a processor
_NEAR = 4, 3  # of so many parts of what the tree costs, those that a bound has to reach for branching to pay
_TRIES, _THOROUGH = 10, 40  # times all actions, looked at for better trees: by chance, or twice among few
_DENSE = 20  # members of landmarks for each action, after which relaxations tell more than greedy cuts
_SPARSE = 50, 0.01  # members, or of the actions: landmarks of more make relaxations slow, and say little
_TWOFOLD = 2  # members of landmarks for each action: with more, sparse ones are begun with
_CLOSE = 0.98  # of what the tree costs: from such a bound on, branching tells sooner than more cuts
_AMONG = 0.2  # of the actions are few enough to be searched among; of more, chance finds better trees
_TAKEN = 1e-4  # of an action, from which share on a relaxed solution takes some of it
_WORTH = 0.9  # of the actions may be left for another time to be worth it


class Reduced(NamedTuple):
    """What is left of a question.

    ``tree`` are the units of a tree, or ``None`` where there is none. ``units`` are those that a better tree
    can have and those of the tree, ascending. ``settled`` says that the tree is proved optimal. ``costs``
    compares trees exactly and ``bound`` is a lower bound by it on every tree; ``None`` and 0 where there is
    none. ``cuts`` are the weighted cuts of the greatest sum, over the units left at the time. ``interrupted``
    says that ctrl-C ended it, or that time was up before anything was left out: ``units`` says nothing then.
    ``wide`` tells which units trees up to a cost can have, whatever rules leave of these trees. ``shared``
    are the cuts among which costs were shared out as well as can be, where the others left too much.
    ``cases`` are those that a proof by branching tells apart. ``tight`` are cuts of all relaxed solutions by
    which something was left out, over the units left at the time.
    """

    tree: frozenset[int] | None
    units: tuple[int, ...]
    settled: bool
    costs: ExactCosts | None
    bound: int
    cuts: Cuts | None
    interrupted: bool = False
    wide: Wide | None = None
    shared: "SharedCosts | None" = None
    cases: "Cases" = None
    tight: Collection[frozenset[int]] = ()


class Listener:
    """Hears of trees and bounds as they are found; override what you want to know."""

    def tree(self, units: frozenset[int]) -> None:
        """Receive a tree that is better than the one before."""

    def bound(self, costs: ExactCosts, bound: int) -> None:
        """Receive a lower bound on all trees."""


class Bounds(Listener):
    """Passes on bounds alone: trees found on the way may not keep to all rules."""

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
    spare: bool = False,
    rest: bool = False,
    brief: bool = False,
) -> Reduced:
    """Leave of a problem what a search for the best tree still has to look at.

    ``objectives`` is the list as it is optimized, ``units`` being in it, so that every unit costs
    something. Without reductions that is what can be made from the kitchen and the goals can need.
    ``expired`` is asked now and then; what takes longer is interrupted, as by ctrl-C, by the ``guard``.
    ``rest`` says that trees have to keep to more than is known here, which ``wide`` is needed for; ``spare``
    that those may have units that lead to no goal. ``brief`` asks for any tree, and for ``wide`` alone.
    """
    with uncollected():
        with guard():
            reducer = _Reducer(
                problem,
                tuple(objectives),
                frozenset(reductions),
                expired,
                listener or Listener(),
                spare,
                rest,
            )
            reducer.brief = brief
        return reducer.reduce(guard)


def at_costs(
    wide: Wide,
    objectives: Sequence[Objective],
    costs: ExactCosts,
    expired: Callable[[], bool],
    in_hand: Collection[int] = (),
    below: int = 0,
    many: float = math.inf,
) -> Reduced:
    """Ask the same for other costs; ``in_hand`` is a tree.

    With ``below``, only units are left out that only trees have that cost as much, and no less than the tree
    found. That is given up where the first cuts leave out hardly any, and more than ``many``.
    """
    with uncollected():
        reductions = {Reduction.DEAR, Reduction.BOUNDS} if below else ALL
        reducer = _Reducer(
            wide.problem, tuple(objectives), frozenset(reductions), expired, Listener(), wide.spare, rest=True
        )
        reducer.costs = reducer.coarse = costs
        if not isinstance(wide.left, range):  # other objectives may count no items
            reducer.known = {action for action in wide.left if action < len(reducer.graph.needs)}
        reducer.in_hand, reducer.below = wide.actions(in_hand), below
        reducer.rounds, reducer.many = _FEW, many
        if below:  # what is left goes to clingo with a tree in hand
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
        spare: bool,
        rest: bool,
        extended: bool = False,
    ) -> None:
        self.problem, self.objectives, self.reductions = problem, objectives, reductions
        self.expired, self.listener, self.spare, self.rest = expired, listener, spare, rest
        self.extended = extended  # so costs of all actions are asked for later
        self.rounds, self.effort, self.small = _ROUNDS, _EFFORT, _SMALL
        self.many = math.inf  # are too many where hardly any are left out
        self.extending = False  # some trees were left out before there were cuts
        self.graph: Graph = graph_of(problem, objectives)
        self.coarse: Callable[[int], int] = CoarseCosts(problem, objectives[0])
        self.thin = self.graph.thin(_ABLE, self.coarse)
        self.known: Collection[int] | None = None  # what can run and leads to a goal
        self.left: Collection[int]  # there before a tree is
        self.tree: set[int] = set()
        self.in_hand: set[int] = set()  # a tree, where one is known
        self.below = 0  # what is cheaper counts, though it is no cheaper than the tree in hand
        self.costs: ExactCosts | None = None
        self.bound = 0
        self.cuts: Cuts | None = None
        self.wide: Wide | None = None
        self.shared: SharedCosts | None = None
        self.tight: Sequence[frozenset[int]] = ()  # cuts to share costs out among
        self.once: dict[frozenset[int], None] = {}  # cuts that were, at any time
        self.chance = random.Random(0)
        self.cases: Cases = None
        self.brief = False  # whether cuts alone are wanted
        self.proved = False  # whether the tree is the best, as there is none better for the goals alone

    def reduce(self, guard: Callable[[], AbstractContextManager[object]]) -> Reduced:
        ended = settled = hopeless = False
        try:
            guide = self._by_extending(guard)
            if self.proved:
                return self._result(settled=True)
            with guard():
                guide = guide or self._near_goals() or self._whole()
                hopeless = guide is None
                if guide is not None and self.reductions:
                    if not self.extending:  # else it was heard of
                        if self.in_hand:
                            self.tree = min(
                                self.tree, self.in_hand, key=lambda tree: sum(map(self.coarse, tree))
                            )
                        self._take(without_spare(self.graph, self.tree, self.coarse))
                    settled = self._narrow(guide)
                ended = True
        except KeyboardInterrupt:
            if not (self.tree or hopeless):
                raise
        if hopeless:
            return Reduced(None, (), False, None, 0, None)
        result = self._result(settled)
        return result if ended else result._replace(interrupted=True)

    def _by_extending(self, guard: Callable[[], AbstractContextManager[object]]) -> dict[int, int] | None:
        """Leave what cheap trees for the goals alone can have, and what else leads to required sets.

        Of a tree, some units are one for the goals alone. These cost no more than it does, and the others no
        more than what is then left of its cost. A tree as cheap as the best one for the goals alone is the
        best. Gives how dear objects are, or ``None`` where nothing is required, or that does not help.
        """
        graph, restriction, limits = self.graph, self.problem.restriction, Reduction.DEAR in self.reductions
        if self.rest or restriction is None or not restriction.required or not limits:
            return None
        alone = _Reducer(
            replace(self.problem, restriction=replace(restriction, required=())),
            self.objectives,
            self.reductions,
            self.expired,
            Bounds(self.listener),
            self.spare,
            self.rest,
            extended=True,
        )
        found = alone.reduce(guard)
        costs, wide = alone.costs, alone.wide
        if costs is None or wide is None:
            return None
        with guard():
            tree = extended(self.thin, alone.tree, costs, len(graph.needs) // 4)
            if tree is None:
                return None
            self.left = range(len(graph.needs))
            self._take(without_spare(graph, tree, costs))
            if found.interrupted:
                raise KeyboardInterrupt
            only_better, total = Reduction.BOUNDS in self.reductions, self._total(costs)
            as_good = found.settled and self.tree == alone.tree if costs.doubt else total == found.bound
            if only_better and as_good:
                self.costs, self.bound, self.cuts = costs, found.bound, found.cuts
                self.shared, self.cases, self.proved = found.shared, found.cases, True
                return None
            limit = total - only_better
            among = {*wide.actions_within(limit, self.expired), *self.tree}
            among |= extensions(graph, among, costs, limit - found.bound + costs.doubt, self.expired)
            if self.expired():
                raise KeyboardInterrupt
            made = derive(graph, among, self.coarse, added=False)
            self.left, self.extending = graph.cone(made.before)[0], True
        return made.cost

    def _near_goals(self) -> dict[int, int] | None:
        """Find a tree among the actions nearest to the goals, with all others still to be counted in.

        Most of a large network is too far from the goals for a good tree, and never looked at then. Gives how
        dear objects are, or ``None`` where that does not help.
        """
        graph = self.graph
        size = len(graph.needs)
        if not self.reductions & {Reduction.BOUNDS, Reduction.DEAR} or size <= _LARGE:
            return None
        everything = range(size)
        few = near(self.thin, everything, self.coarse, math.inf, most=_FIRST)
        found = narrow(self.thin, few, self.coarse, size // 4) if len(few) >= _FIRST else None
        if found is None:
            return None
        self.left = everything
        made, self.tree = found
        return made.cost

    def _whole(self) -> dict[int, int] | None:
        """Leave all that can be made and that the goals can need; gives how dear objects are.

        ``None`` where there is no tree.
        """
        graph = self.graph
        cone = graph.cone()[0] if self.known is None else self.known
        made = derive(graph, cone, self.coarse, added=False)
        tree = made.tree(graph, graph.goals)
        if tree is None:
            return None
        self.left = made.before
        if len(made.before) < len(cone):  # what cannot run may have been all that some others are for
            self.left, _ = graph.cone(made.before)
        self.tree = self.tree or tree
        return made.cost

    def _narrow(self, guide: dict[int, int]) -> bool:
        """Go around until nothing changes; whether the tree is proved optimal."""
        with suppress(TooFineError):
            all_costs = range(len(self.graph.needs)) if self.spare or self.extended else self.left
            self.costs = self.costs or ExactCosts(self.problem, self.objectives, all_costs)
        costs = self.costs
        if costs is not None and self.brief:
            self._bound(costs, guide)
            return False
        if costs is not None and not isinstance(self.left, range) and len(self.left) > _EASY:
            self._follow_added(costs)
        if costs is not None and costs.limited:  # a cheap tree is all that is asked for
            self._improve(costs, Cuts(0, {}, []), thorough=False)
            if self._met(costs, Cuts(0, {}, [])):
                return True
        thorough = False  # as a last resort
        for turn in range(self.rounds):
            before = len(self.left), self.tree
            if costs is not None and self.reductions & {Reduction.BOUNDS, Reduction.DEAR}:
                cuts = self._bound(costs, guide)
                lazy = isinstance(self.left, range)  # so most of it leads to no goal, and is left out anyway
                if not turn and self.below and not lazy and len(self.left) > self.many:
                    self._drop_dear(costs, cuts)  # what is dear does not depend on the trees found
                    if len(self.left) > max(self.many, _WORTH * before[0]):
                        return False
                met = self._met(costs, cuts)
                if not met and not self.expired():
                    self._improve(costs, cuts, thorough)
                    met = self._met(costs, cuts)
                if met:
                    return True
                if Reduction.DEAR in self.reductions and not self.expired():
                    self._drop_dear(costs, cuts)
            if self.expired():
                break
            if isinstance(self.left, range):
                self._whole()
            if costs is not None and Reduction.DOMINATED in self.reductions:
                self.left = undominated(self.graph, self.left, costs)
            changed = (len(self.left), self.tree) != before
            if not changed and Reduction.FORCED in self.reductions and len(self.left) <= _MANY:
                self.left = beside_forced(self.graph, self.left)
                changed = len(self.left) < before[0]
            slow = len(self.left) > max(_MANY, _WORTH * before[0])  # another turn would bring little
            if (slow or not changed) and costs is not None and not thorough:
                if self._share_costs(costs) or self._branch(costs):
                    return True
                changed = (len(self.left), self.tree) != before
            if not changed and (thorough or len(self.left) <= _EASY):
                break
            thorough = not changed
            guide = derive(self.graph, self.left, costs or self.coarse, added=False).cost
        return False

    def _branch(self, costs: ExactCosts) -> bool:
        """Branch over what cuts leave, up to an effort; whether the tree is proved optimal.

        Where rounding may decide, and where rules decide what counts as a tree, that is left to clingo.
        """
        if not self._branches(costs):
            return False
        total, (parts, enough) = self._total(costs), _NEAR
        if len(self.left) <= _SMALL or self.bound * parts < total * enough:
            return False
        self._improve_on(costs)
        total = self._total(costs)
        from foon_asp.bounds.branching import Branching  # noqa: PLC0415 (few questions need it)

        graph, left = self.graph, self.left

        def bounded(bound: int) -> None:
            if bound > self.bound:
                self.bound = bound
                self.listener.bound(costs, bound)

        known = [cut.objects for cut in self.cuts.cuts] if self.cuts else []
        known += [objects for objects, _ in self.shared.cuts] if self.shared else []
        branching = Branching(
            *(graph, graph.goals, left, costs, known, total),
            lambda shares, without: guessed(graph, left, costs, shares, without),
            *(self._take, bounded),
        )
        settled = branching.search(self.effort, self.expired)
        self.effort = branching.effort
        if settled:
            self.cases = branching.cases()
            bounded(self._total(costs))
            return True
        if self.shared is not None and self._total(costs) < total:
            self._shared(costs, self.shared)
        return False

    def _branches(self, costs: ExactCosts) -> bool:
        """Whether branching may tell which tree is the best."""
        only_better = Reduction.BOUNDS in self.reductions and self._total(costs) >= self.below
        return only_better and not (costs.doubt or costs.limited or self.rest) and self.effort > 0

    def _share_costs(self, costs: ExactCosts) -> bool:
        """Share costs out among all cuts at once, and leave out more; whether the tree is proved optimal."""
        from foon_asp.bounds.shared_costs import share_costs  # noqa: PLC0415 (few questions need it)

        if not self.tight and self.cuts:
            few, part = _SPARSE
            dense = sum(len(cut.members) for cut in self.cuts.cuts) > _TWOFOLD * len(self.left)
            most = max(few, part * len(self.left)) if dense else math.inf
            self.tight = [cut.objects for cut in self.cuts.cuts if len(cut.members) <= most]
        before, settled, near = math.inf, False, False

        def heard(shared: "SharedCosts") -> int:
            nonlocal settled, near
            settled = self._followed(costs, shared, _TRIES)
            total = self._total(costs)
            near = self._branches(costs) and self.bound > total * _CLOSE
            return 0 if settled or near or len(self.left) < _WORTH * before else total

        while not (settled or near) and self.small < len(self.left) < _WORTH * before and not self.expired():
            before = len(self.left)
            goals, total = self.graph.goals, self._total(costs)
            shared = share_costs(self.graph, goals, self.left, costs, self.tight, total, self.expired, heard)
            if shared is None:
                break
            self.tight = shared.tight
            settled = settled or self._followed(costs, shared, _THOROUGH)
        return settled

    def _followed(self, costs: ExactCosts, shared: "SharedCosts", tries: int) -> bool:
        """Look for a better tree by a relaxed solution, and leave out more; whether it is proved optimal."""
        from foon_asp.bounds.shared_costs import PARTS  # noqa: PLC0415 (few questions need it)

        among = {action for action, share in shared.shares.items() if share > _TAKEN} | self.tree
        for tree in following(self.graph, self.left, costs, shared):
            among |= tree
            self._take_better(tree, costs)
        least = -(-shared.bound // PARTS)
        if least < self._total(costs):
            if len(among) <= _AMONG * len(self.left):
                known, effort = [cut for cut, _ in shared.cuts], 2 * tries * len(self.left)
                self._search_among(among, costs, known, effort)
            else:
                tree = varied(
                    *(self.graph, self.left, self.tree, costs, least, self.expired),
                    *(shared.shares, self.chance.random, tries),
                )
                self._take_better(tree, costs)
        return self._shared(costs, shared)

    def _search_among(
        self, actions: Collection[int], costs: ExactCosts, known: Sequence[frozenset[int]], effort: int
    ) -> None:
        """Look for a better tree among a few actions, by branching up to an effort."""
        from foon_asp.bounds.branching import Branching  # noqa: PLC0415 (few questions need it)

        graph = self.graph
        able = derive(graph, actions, costs, added=False).before
        search = Branching(
            *(graph, graph.goals, able, costs, known, self._total(costs)),
            lambda shares, without: guessed(graph, able, costs, shares, without),
            lambda found: self._take_better(without_spare(graph, found, costs), costs),
            lambda _: None,
        )
        search.search(effort, self.expired)

    def _shared(self, costs: ExactCosts, shared: "SharedCosts") -> bool:
        """Record a bound, and leave out what is dear by it; whether the tree is proved optimal.

        What trees cost is whole, so a part of 1 more than the next smaller cost is enough.
        """
        from foon_asp.bounds.shared_costs import PARTS  # noqa: PLC0415 (few questions need it)

        total = self._total(costs)
        self.once.update(dict.fromkeys(shared.tight))
        bound = min(-(-shared.bound // PARTS), total)
        if bound > self.bound:
            self.bound, self.shared = bound, shared
            self.listener.bound(costs, bound)
        only_better = Reduction.BOUNDS in self.reductions
        if Reduction.DEAR in self.reductions:
            limit = (max(total, self.below) + costs.doubt - only_better) * PARTS - shared.bound
            self.left = dear_left_out(
                self.graph, self.left, shared.reduced_costs.__getitem__, limit, self.expired
            )
        if Reduction.DOMINATED in self.reductions:
            self.left = undominated(self.graph, self.left, costs)
        return only_better and not costs.doubt and bound == total >= self.below

    def _follow_added(self, costs: ExactCosts) -> None:
        """Take the tree to which estimates lead that add needs up, if it is better than the one in hand."""
        found = derive(self.graph, self.left, costs, added=True).tree(self.graph, self.graph.goals)
        self._take_better(without_spare(self.graph, found or self.tree, costs), costs)

    def _bound(self, costs: ExactCosts, guide: dict[int, int]) -> Cuts:
        """Find cuts, and with them a bound: what is left always has a tree."""
        lazy = isinstance(self.left, range)  # a guide to all of them would have to look at all of them
        cuts = landmark_cuts(
            self.graph,
            self.graph.goals,
            self.left,
            costs,
            guide,
            self.expired,
            None if lazy else lambda rest: derive(self.graph, self.left, rest, added=False).cost,
            math.inf if self.rest or self.brief else _DENSE * max(_EASY, len(self.left)),
        )
        if self.wide is None and not cuts.interrupted and not self.extending:  # nothing was left out so far
            self.wide = Wide(self.problem, self.graph, self.left, costs, cuts, self.spare)
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
        """Whether cuts prove that nothing is better than the tree in hand, and nothing else is wanted."""
        enough = Reduction.BOUNDS in self.reductions and self._total(costs) >= self.below
        return enough and costs.met(cuts, self.tree)

    def _improve(self, costs: ExactCosts, cuts: Cuts, thorough: bool) -> None:
        """Look for better trees near what cuts leave."""
        rest = rests(costs, cuts)
        few = near(self.thin, self.left, rest, self._total(costs) - cuts.bound, most=_MANY)
        better = improved(self.graph, few | self.tree, self.tree, costs, rest, self.expired, thorough)
        if better is not self.tree:
            self._take(better)

    def _improve_on(self, costs: ExactCosts) -> None:
        """Look thoroughly for better trees, again from each that is found, up to an effort."""
        effort, before = _EFFORT, set[int]()
        while self.tree != before and not self.expired():
            before = self.tree
            effort -= len(before) * len(self.left)
            if effort < 0:
                break
            self._improve(costs, self.cuts or Cuts(0, {}, []), thorough=True)

    def _drop_dear(self, costs: ExactCosts, cuts: Cuts) -> None:
        """Leave out what only trees have that are no better than the one in hand."""
        limit = max(self._total(costs), self.below) - cuts.bound + costs.doubt
        if Reduction.BOUNDS in self.reductions:
            limit -= 1  # what is as good is not looked for
        self.left = dear_left_out(self.graph, self.left, rests(costs, cuts), limit, self.expired)

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
        tree = self._units(self.tree)
        early = isinstance(self.left, range)  # nothing was left out, and there is no time to begin with it
        left = tree if settled or early else tree | self._units(self.left)
        return Reduced(
            tree,
            tuple(sorted(left)),
            settled,
            self.costs,
            self.bound,
            self.cuts,
            early and not settled,
            self.wide,
            self.shared,
            self.cases,
            tuple(self.once),
        )
