"""Plans in which items are used up, put to stock clingo as in :mod:`foon_asp.engines.bare_clingo`.

clingo has to be told how often each unit can be executed, or it would not come to an end. These numbers hold
of every plan that is as good as ours by the first objective. They are all that it takes from our search.
"""

import re
from collections.abc import Mapping
from typing import Any

from foon_asp.asp import Status
from foon_asp.asp.bare_program import bare_plans
from foon_asp.asp.used_up import order_that_runs
from foon_asp.encoding.facts import write_times
from foon_asp.engines.bare_clingo import NAME, Clingo
from foon_asp.engines.engine import Asked, DisagreementError, EngineAnswer, NotCheckedError
from foon_asp.problem import Objective, levels
from foon_asp.proof.replay import replay_for

_TIMES = re.compile(r"times\((\d+),(\d+)\)")


def check_plan_with_bare_clingo(asked: Asked, seconds: float) -> tuple[Objective, ...]:
    """Hold a plan against clingo's own; give the objectives by which it agrees: those that are whole numbers.

    Raises :class:`DisagreementError` where both cannot be right, and :class:`NotCheckedError` where nothing
    follows from what clingo says.
    """
    outcome, problem = asked.outcome, asked.outcome.problem
    if outcome.units is None or outcome.costs is None or outcome.status is not Status.OPTIMAL:
        raise NotCheckedError("without a plan, nothing says how often units can be executed")
    asked_for = levels(outcome.objectives)
    whole = asked_for[: next((n for n, each in enumerate(asked_for) if not each.row.whole), None)]
    if not whole:
        raise NotCheckedError(f"plans are compared by whole numbers, and {asked_for[0]} is none")
    program, caps = bare_plans(outcome, whole, asked.settings)
    if program is None:
        raise NotCheckedError("nothing says how often units can be executed by a plan that is as good")
    clingo = Clingo(program, seconds, asked.settings.begun.memory)
    ours = tuple(int(outcome.costs.measure(objective)) for objective in whole)
    counts = {number: outcome.units.count(unit) for unit, (number, _) in caps.items()}
    same = clingo.run(write_times({number: (n, n) for number, n in counts.items()}))
    answer = EngineAnswer(NAME, whole, outcome.units, True)
    if _costs(same) != ours or sum(counts.values()) != len(outcome.units):
        raise DisagreementError(f"our plan costs {list(ours)}, clingo says {_costs(same)}", answer)
    found = clingo.run(write_times({number: (0, most) for number, most in caps.values()}))
    theirs = _costs(found)
    if theirs is None:
        raise DisagreementError("we say a plan exists, clingo says no plan exists", answer)
    times = dict(_times(found))
    units = [unit for unit, (number, _) in caps.items() for _ in range(times.get(number, 0))]
    plan = order_that_runs(problem, units)
    answer = answer._replace(units=tuple(units))
    if plan is None or replay_for(problem, problem.tree(plan)).shortage is not None:
        raise DisagreementError("the plan of clingo does not run", answer)
    if theirs != ours:
        better = theirs < ours
        said = "ours is not the best" if better else "clingo calls a worse one the best"
        message = f"our plan costs {list(ours)}, the one of clingo {list(theirs)}; {said}"
        raise DisagreementError(message, answer, better)
    return whole


def _costs(found: Mapping[str, Any]) -> tuple[int, ...] | None:
    """Give the costs of the best answer, ``None`` where there is none."""
    if found["Result"] == "UNSATISFIABLE":
        return None
    if found["Result"] != "OPTIMUM FOUND":
        raise NotCheckedError(f"clingo ended with {found['Result']!r}")
    return tuple(_last(found)["Costs"])


def _times(found: Mapping[str, Any]) -> list[tuple[int, int]]:
    matches = map(_TIMES.fullmatch, _last(found)["Value"])
    return [(int(match[1]), int(match[2])) for match in matches if match]


def _last(found: Mapping[str, Any]) -> Mapping[str, Any]:
    witnesses = [each for call in found["Call"] for each in call.get("Witnesses", ()) if "Value" in each]
    last: Mapping[str, Any] = witnesses[-1]
    return last
