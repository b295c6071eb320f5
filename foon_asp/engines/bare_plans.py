"""Check by stock clingo of plans in which items are used up, as in :mod:`foon_asp.engines.bare_clingo`.

clingo needs an upper bound on the executions of each unit, since its grounding would not end otherwise. The
bounds hold for every plan that is as good as ours by the first objective. Nothing else is passed to clingo
from our search.
"""

from itertools import takewhile

from foon_asp.asp import Status
from foon_asp.asp.bare_program import bare_plan_program
from foon_asp.encoding.fact_writer import write_times
from foon_asp.engines.bare_clingo import BARE_CLINGO, Clingo
from foon_asp.engines.engine import ClaimedAnswer, DisagreementError, EngineAnswer, NotCheckedError
from foon_asp.plans.counting import order_that_runs
from foon_asp.problem import Objective, levels
from foon_asp.proof.replay import replay_for


def check_plan_with_bare_clingo(claim: ClaimedAnswer, seconds: float) -> tuple[Objective, ...]:
    """Have bare clingo look for an optimal plan; return the objectives by which it agrees.

    Both plans are executed, and compared by the objectives before the first one with fractions. All
    objectives that are compared are returned.

    Raises :class:`DisagreementError` if clingo says that our plan breaks rules, costs another amount, or is
    not optimal. Also raises it if clingo's plan does not run. Raises :class:`NotCheckedError` in these cases:

    - We have no optimal plan.
    - Nodes have amounts.
    - The first objective has fractions.
    - Nothing bounds the number of executions of a unit.
    - clingo does not finish within ``seconds``.
    """
    outcome, problem = claim.outcome, claim.outcome.problem
    if outcome.units is None or outcome.costs is None or outcome.status is not Status.OPTIMAL:
        raise NotCheckedError("without a plan, nothing says how often units can be executed")
    if problem.counts_amounts:
        raise NotCheckedError("amounts are not built for bare clingo")
    objectives = levels(outcome.objectives)
    whole = tuple(takewhile(lambda objective: objective.row.whole, objectives))
    if not whole:
        raise NotCheckedError(f"plans are compared by whole numbers, and {objectives[0]} is none")
    program, caps = bare_plan_program(outcome, whole, claim.settings)
    if program is None:
        raise NotCheckedError("nothing says how often units can be executed by a plan that is as good")
    clingo = Clingo(program, seconds, claim.settings.effective_deadline.memory)
    ours = tuple(int(outcome.costs.measure(objective)) for objective in whole)
    counts = {number: outcome.units.count(unit) for unit, (number, _) in caps.items()}
    our_plan = clingo.best_answer(write_times({number: (n, n) for number, n in counts.items()}), False)
    answer = EngineAnswer(BARE_CLINGO, whole, outcome.units, True)
    if our_plan is None or our_plan.costs != ours or sum(counts.values()) != len(outcome.units):
        costs = None if our_plan is None else our_plan.costs
        raise DisagreementError(f"our plan costs {list(ours)}, clingo says {costs}", answer)
    theirs = clingo.best_answer(
        write_times({number: (0, max_times) for number, max_times in caps.values()}), False
    )
    if theirs is None:
        raise DisagreementError("we say a plan exists, clingo says no plan exists", answer)
    units = [unit for unit, (number, _) in caps.items() for _ in range(theirs.times.get(number, 0))]
    plan = order_that_runs(problem, units)
    answer = answer._replace(units=tuple(units))
    if plan is None or replay_for(problem, problem.tree(plan)).shortage is not None:
        raise DisagreementError("the plan of clingo does not run", answer)
    if theirs.costs != ours:
        better = theirs.costs < ours
        verdict = "ours is not the best" if better else "clingo calls a worse one the best"
        message = f"our plan costs {list(ours)}, the one of clingo {list(theirs.costs)}; {verdict}"
        raise DisagreementError(message, answer, better)
    return whole
