"""The best tree under rules that may ask for units of a large store that lead to no goal.

Besides what was read near the goals, units elsewhere are read that may matter. Let c be the least cost of the
relaxed question of :class:`~foon_asp.dataset.nearby.Nearby` without rules. A tree that has a unit v from
elsewhere has what leads to the goals, which costs at least c, and what leads to v. The outline of the store
tells, for all units at once, what the dearest way to a unit costs besides all that was read. So a tree that
costs less than some q has no unit with which this and c come to q or more. Where all others were read that
rules may ask for, and all that leads to what they ask for, near the goals as well, then what was read of such
a tree is one of the relaxed question that keeps to the rules: so nothing is better than the best of these, or
than q.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import count

from foon_asp.asp import Outcome, Proof, Reporter, Settings, Status
from foon_asp.asp.assembly import ReachOfRules, program_of, reach_of_rules, varying_available
from foon_asp.asp.optimum import solve
from foon_asp.dataset.nearby import Nearby
from foon_asp.dataset.nearby_optimum import least_with_more, near_goals, solve_nearby
from foon_asp.problem import Costs, Objective, Problem, levels
from foon_asp.reduce import reduce
from foon_asp.store.elsewhere import Elsewhere, most_cost
from foon_asp.store.outline import FAR, Mask

_MOST = 30_000  # units, beyond which it is not worth reading them one by one
_TRIED = (100, 0), (1_000, 2), (10_000, 6)  # so many units that are asked for, how much dearer than the first


def solve_nearby_under(
    problem: Problem, objectives: Sequence[Objective], how: Settings, reporter: Reporter
) -> Outcome | None:
    """Solve a question to a large store under rules, as far as what is near the goals tells.

    Without a proof, the tree is one of which it is not known whether it is the best; only at a limit,
    ``stopped`` says so. ``None`` where there is none, or nothing was asked.
    """
    if not how.constraints or reach_of_rules(how) is ReachOfRules.ALL:
        return None
    plain = how._replace(constraints=(), constants=())
    near = near_goals(problem, objectives, plain)
    free = None if near is None else solve_nearby(near, objectives, plain)
    if near is None or free is None or (free.units is None and not free.stopped):
        return None
    program_of(near.problem, how, reporter.warning)
    if free.status is not Status.OPTIMAL:
        return _unknown(near, free)
    search = _Search(near, free, how, reporter)
    try:
        found = search.result()
    except KeyboardInterrupt:  # a limit, too
        how.begun.interrupt()
        return search.best._replace(stopped=how.begun.stopped)
    if found is None or (found.units is None and not found.stopped and found.proof is None):
        return None
    return found


class _Search:
    """A search for a tree that is proved to be the best, where ``free`` is the best without rules."""

    def __init__(self, near: Nearby, free: Outcome, how: Settings, reporter: Reporter) -> None:
        self._near, self._free, self._how, self._reporter = near, free, how, reporter
        self._order = levels(free.objectives)
        self.best = _unknown(near, free)  # that was found so far, without a proof

    def result(self) -> Outcome | None:
        """Return it, or what a limit left of it; ``None`` where what matters elsewhere cannot be told.

        Raises :class:`LimitError`.
        """
        how, near = self._how, self._near
        rules = varying_available(how)
        if rules is None or not rules.local:
            return None
        with how.begun.watched("reading"):
            first = self._order[0]
            elsewhere = near.elsewhere(first if first is Objective.SUCCESS else Objective.UNITS)
            if elsewhere is None:
                return None
            asked = rules.wanted
            wanted = None if asked is None else [elsewhere.wanted(each.rows) for each in asked]
        if asked is None or wanted is None:  # only the units of a tree say whether it keeps to the rules
            tree = self._solved(near.problem)
        else:
            tree = self._some_tree(elsewhere, wanted, [each.always for each in asked])
            if tree.status is Status.INFEASIBLE:
                return tree
        problem = None if tree.stopped else self._enough(tree, elsewhere, wanted)
        if problem is None:
            return self.best._replace(stopped=tree.stopped)
        found = self._solved(problem)
        if found.status is not Status.OPTIMAL:
            return self.best._replace(stopped=found.stopped)
        return self._proved(found)

    def _solved(self, problem: Problem) -> Outcome:
        """Solve a part of the question, and remember the tree."""
        found = solve(problem, self._free.objectives, self._how)
        if found.units is not None:
            self.best = self.best._replace(
                problem=problem, status=Status.FEASIBLE, units=found.units, costs=found.costs
            )
        return found

    def _some_tree(self, elsewhere: Elsewhere, wanted: Sequence[Mask], always: Sequence[bool]) -> Outcome:
        """Find a tree that keeps to the rules: the best without them, and units asked for that are near it.

        Its status is ``infeasible`` where nothing that can execute is what is asked for, and else unknown
        where none was found.
        """
        tree = _numbers(self._free)
        for most, more in _TRIED:
            with self._how.begun.watched("reading"):
                units, costs = elsewhere.nearest(wanted, tree, most, more)
                problem = self._near.among({*tree, *units})
            found = self._solved(problem)
            if found.units is not None or found.stopped:
                return found
            if any(cost >= FAR and each for cost, each in zip(costs, always, strict=True)):
                return found
        return found._replace(status=Status.UNKNOWN)

    def _enough(self, tree: Outcome, elsewhere: Elsewhere, wanted: Sequence[Mask] | None) -> Problem | None:
        """Read all that a better tree than one that was found can have, or a tree as good as that.

        ``None`` where that is too much.
        """
        if tree.costs is None or tree.units is None:
            return None
        within = self._within(tree.costs)
        with self._how.begun.watched("reading"):
            kept = self._kept(tree.costs)
            others = [] if kept is None else elsewhere.mattering(wanted, kept, within)
            if kept is None or len(others) > _MOST:
                return None
            return self._near.among({*kept, *others, *_numbers(tree)})

    def _kept(self, costs: Costs) -> set[int] | None:
        """Read on until all is there that trees for the goals have which cost no more than this.

        Gives these units, by number, and maybe more; ``None`` where that are too many.
        """
        near, deadline = self._near, self._how.begun
        while near.units <= _MOST:
            relaxed = near.relaxed
            wide = reduce(relaxed, self._order, expired=lambda: deadline.passed, brief=True).wide
            if wide is None:
                return None
            kept = wide.units_within(wide.costs.of(costs), lambda: deadline.passed)
            deadline.check()
            missing = near.open_to(kept)
            if not missing:
                return {*map(relaxed.network.unit_number, kept)}
            near.grow(missing, quickly=True)
        return None

    def _within(self, costs: Costs) -> int:
        """Return what a unit elsewhere may cost in a tree that is better than one that costs this."""
        order, least = self._order, self._free.costs
        assert least is not None
        key = costs.key(order)
        if order[0] is Objective.SUCCESS:
            rates = costs.measure(order[0]), least.measure(order[0])
            return most_cost(Fraction(rates[0]) / rates[1])
        if key[: order.index(Objective.UNITS)] > least.key(order)[: order.index(Objective.UNITS)]:
            return FAR - 1
        return next(more for more in count() if key <= least_with_more(least, order, more + 1))

    def _proved(self, found: Outcome) -> Outcome:
        assert found.costs is not None
        self._reporter.tree(found.costs)
        proofs = self._free.proof, found.proof
        proof = next((each for each in proofs if each is not Proof.CUTS), Proof.CUTS)
        return found._replace(proof=proof, cuts=(), cases=None)


def _numbers(found: Outcome) -> list[int]:
    return [*map(found.problem.network.unit_number, found.units or ())]


def _unknown(near: Nearby, free: Outcome) -> Outcome:
    """Return the bound of the best tree without rules, and no tree."""
    first = levels(free.objectives)[0]
    bounds = {each: bound for each, bound in free.bounds.items() if each == first}
    blank = free._replace(status=Status.UNKNOWN, units=None, costs=None, proof=None, cuts=(), cases=None)
    return blank._replace(problem=near.problem, bounds=bounds)
