"""Bounds on how often units are executed in plans that are as good as the best."""

from collections.abc import Sequence

from foon_asp.asp.outcome import Outcome, Status
from foon_asp.asp.reporter import Reporter
from foon_asp.asp.settings import Settings
from foon_asp.errors import UserError
from foon_asp.plans.counting import Counting
from foon_asp.plans.plan_question import PlanQuestion
from foon_asp.plans.plan_search import solve_question
from foon_asp.problem import Objective, Problem


def most_executions(
    problem: Problem, objectives: Sequence[Objective], settings: Settings
) -> dict[int, tuple[int, int]]:
    """Return bounds on the executions of each unit that can matter: ``(0, most)`` by unit id.

    They hold for all plans with at most as many executions as the best plan. If there is no plan, every unit
    of the network has ``(0, 1)``. Raises :class:`UserError` if neither a best plan nor the absence of plans
    is proved.
    """
    question = PlanQuestion(problem, objectives, settings, Reporter())
    outcome = solve_question(question)
    if outcome.status is Status.INFEASIBLE:
        return dict.fromkeys(range(len(problem.network)), (0, 1))
    if outcome.status is not Status.OPTIMAL or outcome.costs is None:
        raise UserError("no plan is proved the best, so nothing bounds how often units are executed")
    units = question.relevant_units() or []
    counting = Counting(question, units)
    caps = counting.bound.max_counts(counting.level(Objective.UNITS, outcome.costs))
    return {u: (0, outcome.costs.units if cap is None else cap) for u, cap in zip(units, caps, strict=True)}


def executions_as_good(outcome: Outcome, settings: Settings) -> dict[int, int] | None:
    """Return the most executions of each unit in plans as good as an outcome by its first objective.

    The bounds are by unit id; units that cannot matter are omitted. Return ``None`` if some unit has no
    bound, or if the outcome has no plan.
    """
    question = PlanQuestion(outcome.problem, outcome.objectives, settings, Reporter())
    if outcome.costs is None or not question.apply_rules():
        return None
    units = question.relevant_units() or []
    counting = Counting(question, units)
    caps = counting.bound.max_counts(counting.level(question.levels[0], outcome.costs)) if units else []
    caps_by_unit = {unit: cap for unit, cap in zip(units, caps, strict=True) if cap is not None}
    return caps_by_unit if len(caps_by_unit) == len(units) else None
