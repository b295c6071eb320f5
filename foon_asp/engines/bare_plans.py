"""Plans in which items are used up, put to stock clingo as in :mod:`foon_asp.engines.bare_clingo`.

clingo has to be told how often each unit can be executed, or it would not come to an end. These numbers hold
of every plan that is as good as ours by the first objective. They are all that it takes from our search.
"""

from itertools import takewhile

from foon_asp.asp import Status
from foon_asp.asp.bare_program import bare_plans
from foon_asp.asp.used_up import order_that_runs
from foon_asp.encoding.facts import write_times
from foon_asp.engines.bare_clingo import NAME, Clingo
from foon_asp.engines.engine import Asked, DisagreementError, EngineAnswer, NotCheckedError
from foon_asp.problem import Objective, levels
from foon_asp.proof.replay import replay_for


def check_plan_with_bare_clingo(asked: Asked, seconds: float) -> tuple[Objective, ...]:
    """Hold a plan against clingo's own; return the objectives by which it agrees: those in whole numbers.

    Raises :class:`DisagreementError` where both cannot be right, and :class:`NotCheckedError` where nothing
    follows from what clingo says.
    """
    outcome, problem = asked.outcome, asked.outcome.problem
    if outcome.units is None or outcome.costs is None or outcome.status is not Status.OPTIMAL:
        raise NotCheckedError("without a plan, nothing says how often units can be executed")
    wanted = levels(outcome.objectives)
    whole = tuple(takewhile(lambda objective: objective.row.whole, wanted))
    if not whole:
        raise NotCheckedError(f"plans are compared by whole numbers, and {wanted[0]} is none")
    program, caps = bare_plans(outcome, whole, asked.settings)
    if program is None:
        raise NotCheckedError("nothing says how often units can be executed by a plan that is as good")
    clingo = Clingo(program, seconds, asked.settings.begun.memory)
    ours = tuple(int(outcome.costs.measure(objective)) for objective in whole)
    counts = {number: outcome.units.count(unit) for unit, (number, _) in caps.items()}
    same = clingo.best(write_times({number: (n, n) for number, n in counts.items()}), False)
    answer = EngineAnswer(NAME, whole, outcome.units, True)
    if same is None or same.costs != ours or sum(counts.values()) != len(outcome.units):
        says = None if same is None else same.costs
        raise DisagreementError(f"our plan costs {list(ours)}, clingo says {says}", answer)
    found = clingo.best(write_times({number: (0, most) for number, most in caps.values()}), False)
    if found is None:
        raise DisagreementError("we say a plan exists, clingo says no plan exists", answer)
    units = [unit for unit, (number, _) in caps.items() for _ in range(found.times.get(number, 0))]
    plan = order_that_runs(problem, units)
    answer = answer._replace(units=tuple(units))
    if plan is None or replay_for(problem, problem.tree(plan)).shortage is not None:
        raise DisagreementError("the plan of clingo does not run", answer)
    if found.costs != ours:
        better = found.costs < ours
        which = "ours is not the best" if better else "clingo calls a worse one the best"
        message = f"our plan costs {list(ours)}, the one of clingo {list(found.costs)}; {which}"
        raise DisagreementError(message, answer, better)
    return whole
