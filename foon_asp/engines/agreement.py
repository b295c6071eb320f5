"""Holding the answers of all engines against each other: one question, one answer."""

import math
import time
from fractions import Fraction
from typing import Final, NamedTuple

from foon_asp.asp import Outcome, Status
from foon_asp.certificate import coverage
from foon_asp.deadline import Deadline, LimitError
from foon_asp.engines import bare_clingo, bare_plans, fast_downward, highs
from foon_asp.engines.engine import (
    Asked,
    DisagreementError,
    Engine,
    EngineAnswer,
    NotCheckedError,
    check_tree,
    differing,
)
from foon_asp.engines.offered_engine import offered_engine
from foon_asp.offered.offer import find_offers, offers_by_name
from foon_asp.problem import Costs, Objective, levels, multiplies

# Engines compute logarithms of rates in floats or in millionths: closer than this for each unit is equal.
_CLOSE = 2e-6
PATIENCE = 60.0  # seconds for each engine, where no time limit says otherwise
_LATE = 0.1  # seconds, after which what an engine did not end by itself is ended
_EXTRA = "it is not installed (pip install 'foon-asp[cross-check]')"


ENTRY_POINTS: Final = "foon_asp.engines"
ENGINES: Final = (
    Engine(highs.NAME, lambda: True, highs.solve_with_highs),
    Engine(fast_downward.NAME, fast_downward.installed, fast_downward.solve_with_fast_downward),
)
"""The built-in engines that are asked besides bare clingo."""


def find_engines() -> tuple[Engine, ...]:
    """Return all engines that are asked besides bare clingo, the built-in ones first.

    Raises :class:`UserError` where a package offers one by a name that is taken.
    """
    taken = ["foon-asp", bare_clingo.NAME, *(engine.name for engine in ENGINES)]
    offers = offers_by_name(find_offers(ENTRY_POINTS), taken)
    return (*ENGINES, *map(offered_engine, offers.values()))


class Check(NamedTuple):
    """What came of asking an engine: it agrees, or has not checked the answer; to disagree is an exception.

    ``objectives`` are those by which it finds our tree best, in the order of the list; ``reason`` says why it
    has checked nothing, and is ``None`` where it agrees. An engine of another ``package`` may also disagree
    and be wrong: then ``refuted`` says in what.
    """

    engine: str
    objectives: tuple[Objective, ...]
    reason: str | None
    seconds: float
    package: str | None = None
    refuted: str | None = None


def cross_check(
    asked: Asked, seconds: float | None = None, engines: tuple[Engine, ...] = ENGINES
) -> list[Check]:
    """Ask every engine about an answer, each for at most ``seconds``.

    Without ``seconds``, each has its part of what is left to the question, or a minute.
    Bare clingo is asked under whatever rules there are; ``engines`` where all rules are ours, or rule units
    out one by one. From ctrl-C on nothing else is checked. Raises :class:`DisagreementError` at the first
    that says otherwise. An engine of another package that does so is wrong, which our tree shows, or its own
    that is none; only where its tree shows that we are wrong is it raised, too.
    """
    if seconds is None:
        left = asked.settings.begun.left
        seconds = PATIENCE if left is None else left / (1 + len(engines))  # bare clingo is one more
    checks: list[Check] = []
    interrupted = False
    others = () if asked.outcome.problem.items is not None else engines  # they know no items that are used up
    for engine in (None, *others):
        name, package = (bare_clingo.NAME, None) if engine is None else (engine.name, engine.package)
        began = time.monotonic()
        objectives: tuple[Objective, ...] = ()
        reason: str | None = None
        refuted: str | None = None
        try:
            if interrupted:
                raise NotCheckedError("interrupted")
            if asked.outcome.status not in {Status.OPTIMAL, Status.INFEASIBLE}:
                raise NotCheckedError("nothing is proved, so there is nothing to check")
            with Deadline(seconds + _LATE).watched("asking another engine"):
                objectives = _ask_clingo(asked, seconds) if engine is None else _ask(engine, asked, seconds)
        except NotCheckedError as error:
            reason = str(error)
        except LimitError:
            reason = f"{name} did not finish within {seconds:g} s"
        except KeyboardInterrupt:
            interrupted, reason = True, "interrupted"
        except DisagreementError as error:
            if package is None or error.ours:
                raise
            refuted = str(error)
        checks.append(Check(name, objectives, reason, time.monotonic() - began, package, refuted))
    return checks


def _ask_clingo(asked: Asked, seconds: float) -> tuple[Objective, ...]:
    if asked.outcome.problem.items is not None:
        return bare_plans.check_plan_with_bare_clingo(asked, seconds)
    bare_clingo.check_with_bare_clingo(asked, seconds)
    return () if asked.outcome.units is None else levels(asked.outcome.objectives)


def _ask(engine: Engine, asked: Asked, seconds: float) -> tuple[Objective, ...]:
    """Ask another engine than clingo, which knows no rules but units that are ruled out."""
    problem, covered = asked.outcome.problem, coverage(asked.settings)
    unknown = [*covered.beyond(), *(name.partition(" ")[0] for name in covered.not_covered)]
    if unknown := [*unknown, *(file.name for file in asked.soft)]:
        raise NotCheckedError(f"it knows no rules such as {', '.join(unknown)}")
    if not engine.installed():
        raise NotCheckedError(_EXTRA)
    forbidden = covered.forbids(problem)
    answer = engine.solve(problem, levels(asked.outcome.objectives), forbidden, seconds)
    if not forbidden.isdisjoint(answer.units or ()):
        raise DisagreementError(f"the tree of {answer.engine} has a unit that the rules forbid", answer)
    return agree(asked.outcome, answer)


def agree(outcome: Outcome, answer: EngineAnswer) -> tuple[Objective, ...]:
    """Return the objectives by which an engine finds our tree best, too.

    Costs are computed anew from the units, as rational numbers. Where costs are fractions or rates, an engine
    that works in floats may take a tree for the best that is so by less than it can tell: then nothing is
    said of that objective, nor of those after it. Raises :class:`DisagreementError` where both answers cannot
    be right, and :class:`NotCheckedError` where nothing follows from the other.
    """
    if not answer.finished:
        raise NotCheckedError("it found no answer in time")
    if answer.units is None and outcome.status is not Status.INFEASIBLE:
        raise DisagreementError(f"we say a tree exists, {answer.engine} says no tree exists", answer)
    if answer.units is None:
        return ()
    costs = outcome.problem.costs(check_tree(outcome.problem, answer))
    if outcome.costs is None:
        raise DisagreementError(
            f"we say no tree exists, {answer.engine} says a tree exists", answer, ours=True
        )
    agreed: list[Objective] = []
    for objective in answer.objectives:
        ours, theirs = outcome.costs.measure(objective), costs.measure(objective)
        if ours != theirs:
            difference = differing(str(objective), ours, theirs, answer, multiplies(objective))
            if difference.ours or not _is_close(objective, outcome.costs, costs):
                raise difference
            break  # what it then finds for the objectives after this one is about other trees
        agreed.append(objective)
    if not agreed:
        raise NotCheckedError("its floats cannot tell our tree from a slightly worse one")
    return tuple(agreed)


def _is_close(objective: Objective, one: Costs, other: Costs) -> bool:
    """Whether floats may take a tree for as good as another one."""
    first, second = Fraction(one.measure(objective)), Fraction(other.measure(objective))
    close = _CLOSE * (1 + one.units + other.units)
    if not multiplies(objective):
        return not objective.row.whole and abs(first - second) <= close * (1 + abs(first))
    if not first or not second:
        return False
    ratio = first / second
    return abs(math.log(ratio.numerator) - math.log(ratio.denominator)) <= close
