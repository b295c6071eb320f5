"""Holding the answers of all engines against each other: one question, one answer."""

import math
import time
from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Final, NamedTuple

from foon_asp.asp import Outcome, Status
from foon_asp.certificate import Coverage, coverage
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
    """Give all engines that are asked besides bare clingo, the built-in ones first.

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
    for name, package, ask in _engines(asked, seconds, engines):
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
                objectives = ask()
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


def _engines(
    asked: Asked, seconds: float, engines: tuple[Engine, ...]
) -> Iterator[tuple[str, str | None, Callable[[], tuple[Objective, ...]]]]:
    """Give every engine by name and package, with a function that asks it and gives by what it agrees."""
    outcome = asked.outcome
    wanted = levels(outcome.objectives)

    def ask_clingo() -> tuple[Objective, ...]:
        if outcome.problem.items is not None:
            return bare_plans.check_plan_with_bare_clingo(asked, seconds)
        bare_clingo.check_with_bare_clingo(asked, seconds)
        return () if outcome.units is None else wanted

    yield bare_clingo.NAME, None, ask_clingo
    if outcome.problem.items is not None:
        return  # others know nothing of items that are used up
    covered = coverage(asked.settings)

    def ask(engine: Engine) -> tuple[Objective, ...]:
        foreign = _foreign(asked, covered)
        if foreign:
            raise NotCheckedError(f"it knows no rules such as {', '.join(foreign)}")
        if not engine.installed():
            raise NotCheckedError(_EXTRA)
        forbidden = covered.forbids(outcome.problem)
        answer = engine.solve(outcome.problem, wanted, forbidden, seconds)
        if not forbidden.isdisjoint(answer.units or ()):
            raise DisagreementError(f"the tree of {answer.engine} has a unit that the rules forbid", answer)
        return agree(outcome, answer)

    for engine in engines:
        yield engine.name, engine.package, lambda engine=engine: ask(engine)  # type: ignore[misc]


def _foreign(asked: Asked, covered: Coverage) -> list[str]:
    """Name the rules that only clingo can read."""
    others = [name.partition(" ")[0] for name in covered.not_covered]
    return [*covered.beyond(), *others, *(file.name for file in asked.soft)]


def agree(outcome: Outcome, answer: EngineAnswer) -> tuple[Objective, ...]:
    """Give the objectives by which an engine finds our tree best, too.

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
    if outcome.status is Status.INFEASIBLE or outcome.costs is None:
        raise DisagreementError(
            f"we say no tree exists, {answer.engine} says a tree exists", answer, ours=True
        )
    agreed: list[Objective] = []
    for objective in answer.objectives:
        ours, theirs = outcome.costs.measure(objective), costs.measure(objective)
        if ours == theirs:
            agreed.append(objective)
            continue
        better = theirs > ours if multiplies(objective) else theirs < ours
        if not better and _close(objective, outcome.costs, costs):
            break  # what it then finds for the objectives after this one is about other trees
        raise differing(str(objective), ours, theirs, better, answer)
    if not agreed:
        raise NotCheckedError("its floats cannot tell our tree from a slightly worse one")
    return tuple(agreed)


def _close(objective: Objective, one: Costs, other: Costs) -> bool:
    """Whether floats may take a tree for as good as another one."""
    first, second = Fraction(one.measure(objective)), Fraction(other.measure(objective))
    units = 1 + one.units + other.units
    if not multiplies(objective):
        return not objective.row.whole and abs(first - second) <= _CLOSE * units * (1 + abs(first))
    if not first or not second:
        return False
    difference = math.log(first.numerator * second.denominator) - math.log(
        first.denominator * second.numerator
    )
    return abs(difference) <= _CLOSE * units
