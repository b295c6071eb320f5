"""Answers that other engines checked: ``foon-asp solve --cross-check``."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from foon_asp.asp import Settings, Status
from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel
from foon_asp.engines import Asked, Check, DisagreementError, Engine, find_engines
from foon_asp.engines import cross_check as ask_engines
from foon_asp.errors import BugError
from foon_asp.problem import Problem
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.answer import Answer, answered
from foon_asp.questions.answer_and_more import AnswerAndMore
from foon_asp.questions.arguments import (
    Constants,
    Objectives,
    chosen_objectives,
    constraint_weights,
    limits,
    settings,
    whole,
)
from foon_asp.questions.certify import Certified
from foon_asp.questions.contract import described
from foon_asp.questions.in_hand import in_hand
from foon_asp.questions.options import LIMITS, OBJECTIVES, RULES, SOFT
from foon_asp.questions.solve_soft import SoftAnswer, softly_answered
from foon_asp.report.disagreement import write_disagreement
from foon_asp.rules.constraint import Constraint
from foon_asp.text.json_value import Json


@dataclass(frozen=True, repr=False)
class CrossChecked(AnswerAndMore[Answer | SoftAnswer | Certified]):
    """An ``answer``, and what other engines say about it.

    Each of the ``checks`` has the name of its ``engine``, the ``objectives`` by which that finds the same
    optimum, and the ``reason`` why it did not check the answer, or ``None``. An engine of another
    ``package`` may disagree and be ``refuted``. On the command line the answer may come with a certificate.

    Example:
        >>> checked = foon_asp.cross_check(foon_asp.load().problem("apple pie"))
        >>> checked.checks[0].engine, checked.checks[0].reason
        ('clingo', None)
        >>> checked.lines()[0].partition(" (")[0]
        'cross-check: clingo agrees that no tree exists'
    """

    checks: tuple[Check, ...]

    def lines(self) -> list[str]:
        """Say for each engine by what it agrees, or why it has not checked the answer."""
        return list(self._lines())

    def _lines(self) -> Iterator[str]:
        for check in self.checks:
            engine = check.engine if check.package is None else f"{check.engine} ({check.package})"
            if check.reason is not None:
                yield f"cross-check: {engine}: not checked: {check.reason}"
                continue
            if check.refuted is not None:
                yield f"cross-check: {engine} disagrees and is wrong: {check.refuted} ({check.seconds:.2f} s)"
                continue
            soft = isinstance(self.answer, SoftAnswer)
            by = ", ".join((*(("penalty",) if soft else ()), *check.objectives))
            none = _outcome(self.answer).status is Status.INFEASIBLE
            that = "that no tree exists" if none else f"by {by}"
            yield f"cross-check: {engine} agrees {that} ({check.seconds:.2f} s)"

    def json_dict(self) -> Json:
        """Give the answer with what each engine says of it.

        ``agrees_by`` is empty where it agrees that no tree exists.
        """
        rows = [
            {
                "engine": check.engine,
                "package": check.package,
                "checked": check.reason is None,
                "agrees_by": list(map(str, check.objectives)),
                "disagrees": check.refuted,
                "reason": check.reason,
                "seconds": round(check.seconds, 6),
            }
            for check in self.checks
        ]
        return self.answer.json_dict() | {"cross_check": rows}


@described(OBJECTIVES, SOFT, *RULES, *LIMITS)
@in_hand(takes_time=True)
def cross_check(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    soft: Mapping[File, int] | None = None,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> CrossChecked:
    """Solve a problem, and ask other engines the same question.

    Engines of other packages are asked too, each in a process of its own. Every engine has ``time_limit``
    seconds for itself, or a minute if there is no limit.

    Returns:
        The ``answer`` with its ``checks``: by which objectives each engine agrees, or why it did not check.

    Raises:
        BugError: if bare clingo or another built-in engine finds a different optimum.
        UserError: for a wrong argument or constraint.

    Example:
        >>> checked = foon_asp.cross_check(foon_asp.load().problem("ice"))
        >>> checked.checks[0].engine, checked.checks[0].reason
        ('clingo', None)
    """
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    weights = constraint_weights(soft or {})
    problem = whole(problem)
    engines = find_engines()
    answer = softly_answered(problem, chosen, how, weights) if weights else answered(problem, chosen, how)
    try:
        patience, _ = limits(time_limit, None)
        return CrossChecked(answer, tuple(ask_engines(_asked(answer, how, weights), patience, engines)))
    except DisagreementError as found:
        raise BugError(str(found)) from None


def checked_or_reported(
    answer: Answer | SoftAnswer | Certified,
    how: Settings,
    weights: Mapping[Constraint, int],
    engines: tuple[Engine, ...],
) -> CrossChecked:
    """Ask other engines about an answer, as the command does.

    Where one disagrees, writes all that is needed to look into it to a new folder and raises
    :class:`BugError`.
    """
    asked = _asked(answer, how, weights)
    try:
        return CrossChecked(answer, tuple(ask_engines(asked, engines=engines)))
    except DisagreementError as found:
        raise BugError(write_disagreement(asked, found)) from None


def _asked(
    answer: Answer | SoftAnswer | Certified, how: Settings, weights: Mapping[Constraint, int]
) -> Asked:
    penalty = answer.penalty if isinstance(answer, SoftAnswer) else None
    return Asked(_outcome(answer), how, weights, penalty)


def _outcome(answer: Answer | SoftAnswer | Certified) -> Answer:
    if isinstance(answer, SoftAnswer):
        return answer.outcome
    return answer.answer if isinstance(answer, Certified) else answer
