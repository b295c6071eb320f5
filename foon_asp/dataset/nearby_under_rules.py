"""Optimal trees under rules that may require units of a large store that lead to no goal.

Units read for the goals are called near, and all others far. Let c be the optimum of the relaxation of
:class:`~foon_asp.dataset.nearby.Nearby` without rules. A tree with a far unit v has units for the goals,
which cost at least c, and units that lead to v. These cost at least the distance of v from the near units;
the outline of the store has the distances of all units. So a tree that costs less than q has only far units
whose distance is less than q - c.

All such units that rules may require are read, with all units that lead to them. In any tree that costs less
than q, the units that were read are then a tree of the relaxation that keeps the rules. So no tree is better
than both the optimum of that relaxation and q.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import count
from typing import NamedTuple

from foon_asp.asp import Outcome, Proof, Reporter, Settings, Status
from foon_asp.asp.assembly import ReachOfRules, program_of, reach_of_rules, rules_for_varying_kitchens
from foon_asp.asp.optimum import solve
from foon_asp.dataset.nearby import Nearby
from foon_asp.dataset.nearby_optimum import REFINEMENT, least_with_more, near_goals, solve_nearby
from foon_asp.hypergraph import BOUND, reduce_under_rules
from foon_asp.problem import Costs, Objective, Problem, levels
from foon_asp.store.outline import FAR, Mask
from foon_asp.store.unit_distances import UnitDistances, greatest_cost


class NearbyTuning(NamedTuple):
    """How much of a large store is read one by one.

    ``max_units``: the greatest number of units read one by one, near the goals or far from them. For more,
    reading the whole store is faster.
    ``widths``: limits on the units read for a first tree, tried in order. Each is a pair: the number of units
    of a kind, and how many steps farther they may be than the nearest unit of the farthest kind.
    """

    max_units: int = 30_000
    widths: Sequence[tuple[int, int]] = ((100, 0), (1_000, 2), (10_000, 6))


NEARBY = NearbyTuning()


def solve_nearby_under(
    problem: Problem, objectives: Sequence[Objective], settings: Settings, reporter: Reporter
) -> Outcome | None:
    """Solve a problem of a large store under rules, reading units near the goals and units for the rules.

    Return one of the following outcomes:
    - a proved optimum, or a proof that no tree keeps the rules,
    - at a limit or ctrl-C, the best tree so far or an outcome without a tree, with ``stopped`` set,
    - a tree that may not be optimal.
    Without a proof, the bound is the optimum without rules.

    Return ``None`` if no tree was found or the method does not apply: the caller then reads all units.

    ``reporter`` receives warnings about the rules, and of the trees only one that is proved optimal.
    """
    if not settings.constraints or reach_of_rules(settings) is ReachOfRules.ALL:
        return None
    settings_without_rules = settings._replace(constraints=(), constants=())
    nearby = near_goals(problem, objectives, settings_without_rules)
    unconstrained = None if nearby is None else solve_nearby(nearby, objectives, settings_without_rules)
    if nearby is None or unconstrained is None or (unconstrained.units is None and not unconstrained.stopped):
        return None
    program_of(nearby.problem, settings, reporter.warning)
    if unconstrained.status is not Status.OPTIMAL:
        return _outcome_without_tree(nearby, unconstrained)
    search = _Search(nearby, unconstrained, settings, reporter)
    try:
        outcome = search.result()
    except KeyboardInterrupt:  # a limit, too
        settings.effective_deadline.interrupt()
        return search.best._replace(stopped=settings.effective_deadline.stopped)
    if outcome is None or (outcome.units is None and not outcome.stopped and outcome.proof is None):
        return None
    return outcome


class _Search:
    """A search for a proved optimum under rules.

    ``unconstrained``: the outcome without rules, which is optimal.
    ``best``: the incumbent; it has no tree at first, and its bound is the optimum without rules.

    A *request* is a constraint that at least one unit of a set is in the tree. The *kind* of a request is the
    mask of the units of the store that may be in its set.
    """

    def __init__(
        self, nearby: Nearby, unconstrained: Outcome, settings: Settings, reporter: Reporter
    ) -> None:
        """Start with an incumbent without a tree, whose bound is the optimum without rules."""
        self._nearby, self._unconstrained = nearby, unconstrained
        self._settings, self._reporter = settings, reporter
        self._order = levels(unconstrained.objectives)
        self.best = _outcome_without_tree(nearby, unconstrained)  # the incumbent, without a proof

    def result(self) -> Outcome | None:
        """Return the optimum, or the incumbent if a limit is reached or optimality is not proved.

        If no tree keeps the rules, return an outcome that proves this. Return ``None`` if the rules depend on
        more than the units of a tree and its kitchen. Also return ``None`` if the distances of units are not
        known. Raises :class:`LimitError` at a limit while the store is read.
        """
        settings, nearby = self._settings, self._nearby
        rules = rules_for_varying_kitchens(settings)
        if rules is None or not rules.local:
            return None
        with settings.effective_deadline.watched("reading"):
            first_objective = self._order[0]
            distances = nearby.unit_distances(
                first_objective if first_objective is Objective.SUCCESS else Objective.UNITS
            )
            if distances is None:
                return None
            requests = rules.wanted
            kinds = (
                None if requests is None else [distances.units_matching(request.rows) for request in requests]
            )
        if requests is None or kinds is None:  # the rules depend only on the units of a tree
            first_outcome = self._solve_part(nearby.problem)
        else:
            first_outcome = self._find_tree(distances, kinds, [request.always for request in requests])
            if first_outcome.status is Status.INFEASIBLE:
                return first_outcome
        problem = (
            None if first_outcome.stopped else self._problem_of_better_trees(first_outcome, distances, kinds)
        )
        if problem is None:
            return self.best._replace(stopped=first_outcome.stopped)
        outcome = self._solve_part(problem)
        if outcome.status is not Status.OPTIMAL:
            return self.best._replace(stopped=outcome.stopped)
        return self._as_proved(outcome)

    def _solve_part(self, problem: Problem) -> Outcome:
        """Solve the problem of a part of the network; if it has a tree, make this tree the incumbent."""
        outcome = solve(problem, self._unconstrained.objectives, self._settings)
        if outcome.units is not None:
            self.best = self.best._replace(
                problem=problem, status=Status.FEASIBLE, units=outcome.units, costs=outcome.costs
            )
        return outcome

    def _find_tree(
        self, distances: UnitDistances, kinds: Sequence[Mask], is_required: Sequence[bool]
    ) -> Outcome:
        """Search for a tree that keeps the rules, first among few units, then among more.

        The units are those of the optimum without rules, and the nearest units of each kind. ``is_required``:
        for each kind, whether the rules always require a unit of it.

        The search ends at the first tree, which becomes the incumbent, or at a limit. Without a tree, the
        status is ``infeasible`` if a required kind has no unit that can execute. Otherwise it is ``unknown``.
        Raises :class:`LimitError` at a limit while the store is read.
        """
        unconstrained_units = _whole_unit_ids(self._unconstrained)
        for max_units, max_steps in NEARBY.widths:
            with self._settings.effective_deadline.watched("reading"):
                units, least_distances = distances.nearest_units(
                    kinds, unconstrained_units, max_units, max_steps
                )
                problem = self._nearby.problem_of_units({*unconstrained_units, *units})
            outcome = self._solve_part(problem)
            if outcome.units is not None or outcome.stopped:
                return outcome
            if any(
                least_distance >= FAR and required
                for least_distance, required in zip(least_distances, is_required, strict=True)
            ):
                return outcome
        return outcome._replace(status=Status.UNKNOWN)

    def _problem_of_better_trees(
        self, best_outcome: Outcome, distances: UnitDistances, kinds: Sequence[Mask] | None
    ) -> Problem | None:
        """Return the problem over the units of the incumbent and all units that can be in a better tree.

        ``best_outcome``: has the incumbent.
        ``kinds``: the kinds of requests; ``None`` if the rules may require any unit.

        Return ``None`` if ``best_outcome`` has no tree. Also return ``None`` if more than
        :attr:`NearbyTuning.max_units` units lead to the goals, or if the other units are more than that
        number. Raises :class:`LimitError` at a limit.
        """
        if best_outcome.costs is None or best_outcome.units is None:
            return None
        max_cost = self._max_far_cost(best_outcome.costs)
        with self._settings.effective_deadline.watched("reading"):
            near_units = self._read_near_units(best_outcome.costs)
            far_units = [] if near_units is None else distances.relevant_units(kinds, near_units, max_cost)
            if near_units is None or len(far_units) > NEARBY.max_units:
                return None
            return self._nearby.problem_of_units({*near_units, *far_units, *_whole_unit_ids(best_outcome)})

    def _read_near_units(self, costs: Costs) -> set[int] | None:
        """Read all units for the goals that can be in a tree that costs at most ``costs``.

        Return their ids in the whole network, maybe with a few more units. Return ``None`` if more than
        :attr:`NearbyTuning.max_units` units were read, or if the relaxation gives no lower bound. Raises
        :class:`LimitError` at a limit.
        """
        nearby, deadline = self._nearby, self._settings.effective_deadline
        while nearby.unit_count <= NEARBY.max_units:
            relaxation = nearby.relaxation
            reduced = reduce_under_rules(
                relaxation, self._order, expired=lambda: deadline.passed, course=BOUND
            )
            subproblem = reduced.subproblem
            if subproblem is None:
                return None
            units = subproblem.units_within(subproblem.costs.combined_cost(costs), lambda: deadline.passed)
            deadline.check()
            open_nodes = nearby.open_nodes_needed(units)
            if not open_nodes:
                return {*map(relaxation.network.unit_number, units)}
            nearby.grow(open_nodes, REFINEMENT.wide_step)
        return None

    def _max_far_cost(self, costs: Costs) -> int:
        """Return the greatest distance that a far unit can have in a tree better than ``costs``.

        A far unit is one that leads to no goal. The distance is a number of units, or for ``success`` a
        scaled logarithm; see :class:`UnitDistances`. If a better tree can have any number of units, return
        ``FAR - 1``. Then all units that can execute count.
        """
        order, least_costs = self._order, self._unconstrained.costs
        assert least_costs is not None
        key = costs.key(order)
        if order[0] is Objective.SUCCESS:
            rates = costs.measure(order[0]), least_costs.measure(order[0])
            return greatest_cost(Fraction(rates[0]) / rates[1])
        if key[: order.index(Objective.UNITS)] > least_costs.key(order)[: order.index(Objective.UNITS)]:
            return FAR - 1
        return next(extra for extra in count() if key <= least_with_more(least_costs, order, extra + 1))

    def _as_proved(self, outcome: Outcome) -> Outcome:
        """Return the outcome as proved for the whole network, and report its tree.

        Its proof is by cuts only if the proofs with and without rules are both by cuts. The cuts and cases of
        the proof are omitted, because they hold only for a part of the network.
        """
        assert outcome.costs is not None
        self._reporter.tree(outcome.costs)
        proofs = self._unconstrained.proof, outcome.proof
        proof = next((proof for proof in proofs if proof is not Proof.CUTS), Proof.CUTS)
        return outcome._replace(proof=proof, cuts=(), cases=None)


def _whole_unit_ids(outcome: Outcome) -> list[int]:
    """Return the units of the tree of an outcome, by id in the whole network; empty without a tree."""
    return [*map(outcome.problem.network.unit_number, outcome.units or ())]


def _outcome_without_tree(nearby: Nearby, unconstrained: Outcome) -> Outcome:
    """Return the outcome ``unconstrained`` without its tree and proof, for the problem of ``nearby``.

    Its status is unknown. It keeps only the bound on the first objective, and the limit that stopped it, if
    any.
    """
    first_objective = levels(unconstrained.objectives)[0]
    bounds = {
        objective: bound for objective, bound in unconstrained.bounds.items() if objective == first_objective
    }
    without_tree = unconstrained._replace(
        status=Status.UNKNOWN, units=None, costs=None, proof=None, cuts=(), cases=None
    )
    return without_tree._replace(problem=nearby.problem, bounds=bounds)
