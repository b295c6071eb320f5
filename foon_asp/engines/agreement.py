"""Holding the answers of all engines against each other: one question, one answer."""

import math
from collections.abc import Callable
from typing import NamedTuple

from foon_asp.asp import Outcome, Status
from foon_asp.engines import fast_downward, highs
from foon_asp.engines.engine import EngineAnswer
from foon_asp.problem import Costs, Objective, Problem, executable_order, levels, multiplies
from foon_asp.proof import Verdict, simulate_for

Solve = Callable[[Problem, tuple[Objective, ...], frozenset[int], float], EngineAnswer]


class Engine(NamedTuple):
    """A second engine: its name, whether it is installed, and how it is asked."""

    name: str
    installed: Callable[[], bool]
    solve: Solve


ENGINES = (
    Engine(highs.NAME, highs.installed, highs.solve_with_highs),
    Engine(fast_downward.NAME, fast_downward.installed, fast_downward.solve_with_fast_downward),
)

# Engines compute logarithms of rates in floats or in millionths: closer than this for each unit is equal.
_CLOSE = 2e-6


class DisagreementError(Exception):
    """Two engines give answers that cannot both be right: a bug, here or there."""

    def __init__(self, message: str, answer: EngineAnswer) -> None:
        super().__init__(message)
        self.answer = answer


def cross_check(
    outcome: Outcome, forbidden: frozenset[int], seconds: float, engines: tuple[Engine, ...] = ENGINES
) -> list[EngineAnswer]:
    """Ask every engine that is installed what an answer says, each for at most so many seconds.

    The answer has to be ``optimal`` or ``infeasible``; ``forbidden`` are the units that its constraints rule
    out. Raises :class:`DisagreementError` at the first that says otherwise.
    """
    wanted = levels(outcome.objectives)
    answers: list[EngineAnswer] = []
    for engine in engines:
        if engine.installed():
            answers.append(engine.solve(outcome.problem, wanted, forbidden, seconds))
            agree(outcome, answers[-1])
    return answers


def agree(outcome: Outcome, answer: EngineAnswer) -> None:
    """Raise :class:`DisagreementError` where an engine's answer and ours cannot both be right.

    Costs are computed anew from the units, as rational numbers. Where rates are multiplied, an engine that
    works in floats may take a tree for the best that is so by less than it can tell.
    """
    if not answer.finished:
        return
    if (answer.units is None) != (outcome.status is Status.INFEASIBLE):
        sides = ("a tree exists", "no tree exists")
        none = answer.units is None
        raise DisagreementError(f"we say {sides[not none]}, {answer.engine} says {sides[none]}", answer)
    if answer.units is None or outcome.costs is None:
        return
    problem = outcome.problem
    order = executable_order(problem, answer.units)
    if order is None or simulate_for(problem, problem.tree(order)).verdict is not Verdict.AS_LISTED:
        raise DisagreementError(f"the tree of {answer.engine} does not execute", answer)
    costs = problem.costs(order)
    for objective in answer.objectives:
        ours, theirs = outcome.costs.measure(objective), costs.measure(objective)
        if ours == theirs:
            continue
        better = theirs > ours if multiplies(objective) else theirs < ours
        if not better and multiplies(objective) and _close(outcome.costs, costs):
            return  # what it then finds for the objectives after this one is about other trees
        raise DisagreementError(
            f"by {objective} our tree has {ours}, the one of {answer.engine} {theirs}; "
            + ("ours is not the best" if better else f"{answer.engine} calls a worse one the best"),
            answer,
        )


def _close(one: Costs, other: Costs) -> bool:
    first, second = (costs.success or 0 for costs in (one, other))
    if not first or not second:
        return False
    difference = math.log(first.numerator * second.denominator) - math.log(
        first.denominator * second.numerator
    )
    return abs(difference) <= _CLOSE * (1 + one.units + other.units)
