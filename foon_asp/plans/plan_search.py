"""Search for the best plan: counts of executions by branch and bound, an order of them, and the proof."""

import time
from collections.abc import Sequence

from foon_asp.asp.outcome import Outcome, Proof, Status
from foon_asp.asp.reporter import Reporter
from foon_asp.asp.settings import Settings
from foon_asp.plans.conditions import Measure
from foon_asp.plans.count_bound import BetterError
from foon_asp.plans.counting import Counting
from foon_asp.plans.plan_question import Plan, PlanQuestion
from foon_asp.plans.whole_program import Stopped
from foon_asp.problem import Objective, Problem, multiplies

_CLINGO_NOT_ASKED = (
    "clingo has no statistics: the plan and its order were found and proved without its search"
)


def solve_used_up(
    problem: Problem,
    objectives: Sequence[Objective] = (Objective.UNITS,),
    settings: Settings | None = None,
    reporter: Reporter | None = None,
) -> Outcome:
    """Find the best plan under a lexicographic list of objectives, and prove it; return the outcome.

    The outcome says how far this was done when the deadline in ``settings`` passed. Raises
    :class:`UserError` naming a feature that plans do not support.
    """
    question = PlanQuestion(problem, objectives, settings or Settings(), reporter or Reporter())
    return solve_question(question)


def solve_question(question: PlanQuestion) -> Outcome:
    """Return the outcome of a question: its best plan, as far as it is found and proved.

    An interrupt from the keyboard ends the search like the end of time, and is recorded in the deadline. If
    statistics are asked for and clingo did not run, the missing run is reported.
    """
    try:
        with question.deadline.watched("cutting the network", late=True):
            outcome = _solve(question)
    except (Stopped, KeyboardInterrupt) as stop:
        if isinstance(stop, KeyboardInterrupt):
            question.deadline.interrupt()
        status = Status.UNKNOWN if question.best is None else Status.FEASIBLE
        outcome = question.outcome(status, None)
    if question.settings.asks_for_statistics and not question.searched:
        question.reporter.statistics(_CLINGO_NOT_ASKED)
    return outcome


def _solve(question: PlanQuestion) -> Outcome:
    """Apply the rules, restrict the network to units that can matter, and search; return the outcome.

    If the rules allow no plan, or a goal cannot be reached even if items last, nothing is searched.
    """
    start_time = time.perf_counter()
    if not question.apply_rules():
        return question.outcome(Status.INFEASIBLE, Proof.SOLVER)
    question.deadline.doing = "cutting the network"
    units = question.relevant_units()
    question.add_seconds("cut", start_time)
    return question.outcome(Status.INFEASIBLE, Proof.CUTS) if units is None else _search(question, units)


def _search(question: PlanQuestion, units: list[int]) -> Outcome:
    """Search for the best plan of ``units``, and prove it; return the outcome.

    First, counts of least cost are searched for. An order of them becomes the first incumbent. If no plan is
    found in this way, the search tries to prove that no plan exists. With an incumbent, counts of lower cost
    are searched until the incumbent is proved the best. Raises :class:`Stopped` if time is up.
    """
    counting = Counting(question, units)
    if not units:  # every goal is available: only the empty plan is irredundant
        needs_check = not question.program.is_built_in or question.problem.counts_amounts
        if needs_check and counting.find_order({}) is None:
            return question.outcome(Status.INFEASIBLE, Proof.SOLVER)
        return question.outcome(
            Status.OPTIMAL if question.try_incumbent(()) else Status.INFEASIBLE, Proof.CUTS
        )
    start_time = time.perf_counter()
    measures = [counting.measure(objective) for objective in question.levels]
    with question.deadline.watched("counting executions"):
        plan = _plan_by_equation(question, counting, measures)
        counts = counting.bound.cheapest_counts(measures) if plan is None else None
    question.add_seconds("bound", start_time)
    if plan is None and counts is None and counting.bound.is_infeasible():
        return question.outcome(Status.INFEASIBLE, Proof.COUNTS)
    if counts is not None:
        plan = counting.find_order(counts)
        if plan is None or not question.allows(plan):
            plan = counting.find_plan_beyond(counts)
    if plan is not None and question.try_incumbent(plan):
        counting.bound.derivation = _executed_indices(units, plan)
        counting = _without_expensive_units(question, counting, plan)
    elif question.has_no_lasting_tree():
        return question.outcome(Status.INFEASIBLE, Proof.SOLVER)
    elif counting.prove_infeasible():
        return question.outcome(Status.INFEASIBLE, Proof.COUNTS)
    while True:
        try:
            start_time = time.perf_counter()
            with question.deadline.watched("counting executions"):
                counting.prove()
            return question.outcome(Status.OPTIMAL, Proof.COUNTS)
        except BetterError:
            continue
        finally:
            question.bounds = counting.proved_bounds()
            question.add_seconds("bound", start_time)


def _executed_indices(units: Sequence[int], plan: Plan) -> list[int]:
    """Return the indices in ``units``, ascending, of the units that a plan executes."""
    executed = set(plan)
    return [a for a, unit in enumerate(units) if unit in executed]


def _plan_by_equation(question: PlanQuestion, counting: Counting, measures: Sequence[Measure]) -> Plan | None:
    """Return a plan with the cheapest counts of the state equation, if they have an order.

    Return ``None`` if there are no such counts, or if no allowed order of them is found.
    """
    counts = counting.bound.cheapest_counts_by_equation(measures)
    try:
        plan = None if counts is None else counting.find_order(counts)
    except Stopped:
        return None
    return plan if plan is not None and question.allows(plan) else None


def _without_expensive_units(question: PlanQuestion, counting: Counting, plan: Plan) -> Counting:
    """Return a :class:`Counting` without units that cost more than a whole plan by the first objective.

    The plan becomes its derivation. Return ``counting`` itself if costs are counted exactly. Also return it
    if no unit or every unit costs more than the plan.
    """
    objective = question.levels[0]
    if multiplies(objective) or counting.measure(objective).exact is None:
        return counting
    plan_cost = question.problem.costs(plan).measure(objective)
    units = [unit for unit in counting.units if question.problem.figure(objective, unit) <= plan_cost]
    if not units or len(units) == len(counting.units):
        return counting
    smaller = Counting(question, units)
    smaller.bound.derivation = _executed_indices(units, plan)
    return smaller
