"""Ranking of plans where items are used up, by costs; no plan contains another."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from foon_asp.asp.outcome import Status
from foon_asp.asp.reporter import Reporter
from foon_asp.asp.settings import Bounded, Settings
from foon_asp.plans.conditions import Counts
from foon_asp.plans.counting import Counting
from foon_asp.plans.plan_question import Plan, PlanQuestion
from foon_asp.plans.plan_search import solve_question, solve_used_up
from foon_asp.plans.whole_program import Stopped
from foon_asp.problem import Costs, Objective, Problem


class RankedPlans:
    """The plans of a question, the best first, under a lexicographic list of objectives.

    A plan is excluded if it executes every unit at least as often as an earlier plan.

    ``complete``: whether the iteration ended because there are no more plans.
    ``pending``: if the iteration ended for another reason, a list with the best plan found and its costs.
    This plan is not proved the best. The list is empty if no plan was found.
    """

    def __init__(
        self, problem: Problem, objectives: Sequence[Objective], settings: Settings, reporter: Reporter
    ) -> None:
        """Start the time limit of ``settings``, which all plans share; nothing is searched yet."""
        self._problem, self._objectives = problem, tuple(objectives)
        self._settings, self._reporter = settings._replace(deadline=settings.effective_deadline), reporter
        self.complete = False
        self.pending: list[tuple[Plan, Costs]] = []

    def __iter__(self) -> Iterator[tuple[Plan, Costs]]:
        """Yield plans with their costs. Each is proved the best among the plans that contain no earlier one.

        Only the search for the first plan is reported. An empty plan is the last one, since every other plan
        contains it.
        """
        yielded: list[Mapping[int, int]] = []
        while True:
            settings = self._settings._replace(bounded=Bounded(incomparable=tuple(yielded)))
            reporter = Reporter() if yielded else self._reporter
            outcome = solve_used_up(self._problem, self._objectives, settings, reporter)
            plan, costs = outcome.units, outcome.costs
            if plan is None or costs is None or outcome.status is not Status.OPTIMAL:
                self.complete = outcome.status is Status.INFEASIBLE
                self.pending = [] if plan is None or costs is None else [(plan, costs)]
                return
            yield plan, costs
            if not plan:  # every other plan contains it
                self.complete = True
                return
            yielded.append(Counter(plan))


def best_plans(
    problem: Problem,
    objectives: Sequence[Objective],
    settings: Settings,
    reporter: Reporter,
    max_plans: int,
) -> tuple[list[tuple[Plan, Costs]], bool, bool]:
    """Return a list of best plans, whether they are proved the best, and whether there are no others.

    The list has at most ``max_plans`` plans with different counts of executions, each with its costs. If no
    plan is proved the best, the list has the best plan found, if any. If it is proved that there is no plan,
    the last value is true. If time is up before all plans are found, the last value is false. Ctrl-C ends the
    search like the end of time, and is recorded in the deadline.
    """
    question = PlanQuestion(problem, objectives, settings, reporter)
    outcome = solve_question(question)
    if outcome.units is None or outcome.costs is None or outcome.status is not Status.OPTIMAL:
        incumbents = (
            [] if outcome.units is None or outcome.costs is None else [(outcome.units, outcome.costs)]
        )
        return incumbents, False, outcome.status is Status.INFEASIBLE
    units, best = question.relevant_units() or [], outcome.costs
    counting = Counting(question, units)
    counting.bound.derivation = [a for a, unit in enumerate(units) if unit in outcome.units]
    plans_by_counts = {frozenset(Counter(outcome.units).items()): outcome.units}

    def add_plan(counts: Counts) -> None:
        """Add a plan with these counts to the result if some order of them is a plan as good as the best.

        Raises :class:`Stopped` once there are more than ``max_plans`` plans.
        """
        plan = counting.find_order(counts)
        if plan is not None and problem.costs(plan).key(question.levels) == best.key(question.levels):
            plans_by_counts.setdefault(frozenset(Counter(plan).items()), plan)
            if len(plans_by_counts) > max_plans:
                raise Stopped

    complete = True
    try:
        if units:
            counting.bound.visit_counts(
                [counting.level(objective, best) for objective in question.levels], add_plan
            )
    except (Stopped, KeyboardInterrupt) as stop:
        complete = False
        if isinstance(stop, KeyboardInterrupt):
            question.deadline.interrupt()
    return (
        [(plan, problem.costs(plan)) for plan in list(plans_by_counts.values())[:max_plans]],
        True,
        complete,
    )
