"""Cross-check of an answer by all second engines: their trees and costs are compared with it."""

import math
import time
from fractions import Fraction
from typing import Final, NamedTuple

from foon_asp.asp import Outcome, Status
from foon_asp.certificate import coverage
from foon_asp.deadline import Deadline, LimitError
from foon_asp.engines import bare_clingo, bare_plans, fast_downward, highs
from foon_asp.engines.engine import (
    ClaimedAnswer,
    DisagreementError,
    Engine,
    EngineAnswer,
    NotCheckedError,
    check_tree,
    difference_error,
)
from foon_asp.engines.offered_engine import offered_engine
from foon_asp.offered.offer import find_offers, offers_by_name
from foon_asp.problem import Costs, Objective, levels, multiplies

_NOT_INSTALLED = "it is not installed (pip install 'foon-asp[cross-check]')"


ENTRY_POINTS: Final = "foon_asp.engines"
ENGINES: Final = (
    Engine(highs.HIGHS, lambda: True, highs.solve_with_highs),
    Engine(fast_downward.FAST_DOWNWARD, fast_downward.is_installed, fast_downward.solve_with_fast_downward),
)
"""The built-in engines besides bare clingo."""


def find_engines() -> tuple[Engine, ...]:
    """Return all engines except bare clingo: first the built-in ones, then the engines of installed packages.

    Raises :class:`UserError` if a package offers an engine whose name another engine or foon-asp itself has,
    ignoring case.
    """
    reserved = ["foon-asp", bare_clingo.BARE_CLINGO, *(engine.name for engine in ENGINES)]
    offers = offers_by_name(find_offers(ENTRY_POINTS), reserved)
    return (*ENGINES, *map(offered_engine, offers.values()))


class Check(NamedTuple):
    """The verdict of an engine: it agrees, has checked nothing, or is refuted.

    An engine that disagrees, and may be right, raises :class:`DisagreementError` and has no verdict.

    Attributes:
        engine: The name of the engine.
        objectives: The objectives by which the engine finds our tree optimal, the most important first. Empty
            if both say that no tree exists, or if the engine does not agree.
        reason: Why the engine has checked nothing; ``None`` if it agrees or is refuted.
        seconds: The time that the engine took.
        package: The distribution that offers the engine; ``None`` for a built-in engine.
        refuted: The claim of an engine of another package that was found wrong; ``None`` unless the engine is
            refuted.
    """

    engine: str
    objectives: tuple[Objective, ...]
    reason: str | None
    seconds: float
    package: str | None = None
    refuted: str | None = None


def cross_check(
    claim: ClaimedAnswer, seconds: float | None = None, engines: tuple[Engine, ...] = ENGINES
) -> list[Check]:
    """Have bare clingo and then each of the ``engines`` check an answer; return their verdicts in this order.

    ``seconds``: the time limit of each engine. With ``None``, the engines share the remaining time of the
    question equally; if the question has no time limit, each engine has a minute.

    Bare clingo checks answers under any rules. The ``engines`` check answers only if all rules are ready-made
    ones that do nothing but forbid units. If items are used up, only bare clingo is asked, and the result has
    one verdict. An answer that is not proved is not checked. An engine that does not end in time, or does not
    know such a question, has checked nothing. Ctrl-C is caught: the verdicts of the interrupted engine and of
    all later ones say ``interrupted``.

    Raises :class:`DisagreementError` for the first engine whose answer differs. For an engine of another
    package, it is raised only if the engine's tree is valid and better than ours. Otherwise, the engine is
    wrong, and its claim is in :attr:`Check.refuted`.
    """
    if seconds is None:
        remaining = claim.settings.effective_deadline.remaining_seconds
        seconds = 60.0 if remaining is None else remaining / (1 + len(engines))  # one more: bare clingo
    checks: list[Check] = []
    interrupted = False
    others = () if claim.outcome.problem.items is not None else engines  # they cannot model consumption
    for engine in (None, *others):
        name, package = (bare_clingo.BARE_CLINGO, None) if engine is None else (engine.name, engine.package)
        began = time.monotonic()
        objectives: tuple[Objective, ...] = ()
        reason: str | None = None
        refuted: str | None = None
        try:
            if interrupted:
                raise NotCheckedError("interrupted")
            if claim.outcome.status not in {Status.OPTIMAL, Status.INFEASIBLE}:
                raise NotCheckedError("nothing is proved, so there is nothing to check")
            # an engine that does not stop by itself is stopped a little later
            with Deadline(seconds + 0.1).watched("asking another engine"):
                objectives = (
                    _check_by_clingo(claim, seconds)
                    if engine is None
                    else _check_by_engine(engine, claim, seconds)
                )
        except NotCheckedError as error:
            reason = str(error)
        except LimitError:
            reason = f"{name} did not finish within {seconds:g} s"
        except KeyboardInterrupt:
            interrupted, reason = True, "interrupted"
        except DisagreementError as error:
            if package is None or error.is_our_bug:
                raise
            refuted = str(error)
        checks.append(Check(name, objectives, reason, time.monotonic() - began, package, refuted))
    return checks


def _check_by_clingo(claim: ClaimedAnswer, seconds: float) -> tuple[Objective, ...]:
    """Return the objectives by which bare clingo agrees; an empty tuple if there is no tree.

    Raises what :func:`check_with_bare_clingo` or, for plans, :func:`check_plan_with_bare_clingo` raises.
    """
    if claim.outcome.problem.items is not None:
        return bare_plans.check_plan_with_bare_clingo(claim, seconds)
    bare_clingo.check_with_bare_clingo(claim, seconds)
    return () if claim.outcome.units is None else levels(claim.outcome.objectives)


def _check_by_engine(engine: Engine, claim: ClaimedAnswer, seconds: float) -> tuple[Objective, ...]:
    """Return the objectives by which an engine other than bare clingo agrees with an answer.

    Raises :class:`NotCheckedError` in three cases: a rule does not merely forbid units, there are soft
    constraints, or the engine is not installed. Raises :class:`DisagreementError` if the engine's tree has a
    forbidden unit. Also raises what :func:`agreed_objectives` raises.
    """
    problem, covered = claim.outcome.problem, coverage(claim.settings)
    unsupported = [*covered.rules_beyond_removal(), *(name.partition(" ")[0] for name in covered.not_covered)]
    if unsupported := [*unsupported, *(file.name for file in claim.soft)]:
        raise NotCheckedError(f"it knows no rules such as {', '.join(unsupported)}")
    if not engine.installed():
        raise NotCheckedError(_NOT_INSTALLED)
    forbidden = covered.forbidden_units(problem)
    answer = engine.solve(problem, levels(claim.outcome.objectives), forbidden, seconds)
    if not forbidden.isdisjoint(answer.units or ()):
        raise DisagreementError(f"the tree of {answer.engine} has a unit that the rules forbid", answer)
    return agreed_objectives(claim.outcome, answer)


def agreed_objectives(outcome: Outcome, answer: EngineAnswer) -> tuple[Objective, ...]:
    """Return the objectives by which an engine finds our tree optimal, the most important first.

    Costs are computed anew from the units, as rational numbers. The engine's tree may cost more than ours by
    an objective, but by less than the engine's precision. Then neither this objective nor a less important
    one is in the result. The result is empty if we and the engine say that there is no tree.

    Raises :class:`DisagreementError` if the two answers contradict each other, or the engine's tree does not
    execute. Raises :class:`NotCheckedError` if the engine found no answer in time, or its precision is too
    low for the first objective.
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
            f"we say no tree exists, {answer.engine} says a tree exists", answer, is_our_bug=True
        )
    agreed: list[Objective] = []
    for objective in answer.objectives:
        ours, theirs = outcome.costs.measure(objective), costs.measure(objective)
        if ours != theirs:
            difference = difference_error(str(objective), ours, theirs, answer, multiplies(objective))
            if difference.is_our_bug or not _is_within_float_error(objective, outcome.costs, costs):
                raise difference
            break  # it optimized the less important objectives over other trees
        agreed.append(objective)
    if not agreed:
        raise NotCheckedError("its floats cannot tell our tree from a slightly worse one")
    return tuple(agreed)


def _is_within_float_error(objective: Objective, ours: Costs, theirs: Costs) -> bool:
    """Return whether rounding in floats can explain that two trees cost different amounts by an objective.

    The tolerance is two millionths for each unit of both trees, since an engine may round logarithms to
    millionths. The tolerance is relative to the cost. For rates, it applies to the logarithm of their ratio.
    A greater tolerance would hide wrong answers, and a smaller one would report rounding as a bug. Return
    ``False`` for an objective in whole numbers, and if a rate is 0.
    """
    our_cost, their_cost = Fraction(ours.measure(objective)), Fraction(theirs.measure(objective))
    tolerance = 2e-6 * (1 + ours.units + theirs.units)
    if not multiplies(objective):
        return not objective.row.whole and abs(our_cost - their_cost) <= tolerance * (1 + abs(our_cost))
    if not our_cost or not their_cost:
        return False
    ratio = our_cost / their_cost
    return abs(math.log(ratio.numerator) - math.log(ratio.denominator)) <= tolerance
