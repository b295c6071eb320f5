"""Answers that other engines were asked about, too."""

from collections.abc import Mapping
from typing import NamedTuple

from foon_asp.api.solve import solve, solve_soft
from foon_asp.dataset.paths import File, Files
from foon_asp.engines import Asked, Check, DisagreementError
from foon_asp.engines import cross_check as ask_engines
from foon_asp.errors import BugError
from foon_asp.problem import Problem
from foon_asp.questions.answer import Answer, SoftAnswer
from foon_asp.questions.arguments import Constants, Objectives, file_weights, settings
from foon_asp.questions.result import Result
from foon_asp.report.answer import outcome_json, outcome_text
from foon_asp.report.cross_check import check_lines, checked_dict
from foon_asp.report.drawing import Drawing
from foon_asp.report.soft import soft_json, soft_text


class _CrossChecked(NamedTuple):
    answer: Answer | SoftAnswer
    checks: tuple[Check, ...]


class CrossChecked(Result, _CrossChecked):
    """An ``answer`` and what other engines say of it.

    Each of the ``checks`` has the name of its ``engine``, the ``objectives`` by which it finds the tree best,
    too, and the ``reason`` why it has not checked the answer, ``None`` where it has.
    """

    __slots__ = ()

    def text(self) -> str:
        """Give the answer, and a line for each engine."""
        answer = self.answer
        said = soft_text(answer) if isinstance(answer, SoftAnswer) else outcome_text(answer)
        return said + "".join(f"{line}\n" for line in check_lines(self._asked(), self.checks))

    def json_text(self) -> str:
        """Give the answer as ``foon-asp solve --cross-check --format json`` does."""
        more, answer = checked_dict(self.checks), self.answer
        return soft_json(answer, more) if isinstance(answer, SoftAnswer) else outcome_json(answer, more)

    def drawing(self) -> Drawing | None:
        """Give what the picture shows."""
        return self.answer.drawing()

    def _asked(self) -> Asked:
        answer = self.answer
        if not isinstance(answer, SoftAnswer):
            return Asked(answer)
        soft = {each.constraint.file: each.weight for each in answer.constraints}
        return Asked(answer.outcome, soft=soft, penalty=answer.penalty)


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
) -> CrossChecked:
    """Solve a problem, and ask other engines the same question.

    ``soft`` gives constraint files that may be broken, as for :func:`foon_asp.solve_soft`. Every engine has
    ``time_limit`` seconds of its own, or a minute. Raises :class:`BugError` where one says otherwise; the
    command ``foon-asp solve --cross-check`` then writes down all that is needed to look into it. Otherwise as
    :func:`foon_asp.solve`.
    """
    problem = problem.whole
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    if soft:
        found = solve_soft(
            problem,
            objectives,
            soft=soft,
            constraints=constraints,
            constants=constants,
            encodings=encodings,
            time_limit=time_limit,
            memory_limit=memory_limit,
        )
        asked = Asked(found.outcome, how, file_weights(soft), found.penalty)
        return CrossChecked(found, _checks(asked))
    answer = solve(
        problem,
        objectives,
        constraints=constraints,
        constants=constants,
        encodings=encodings,
        time_limit=time_limit,
        memory_limit=memory_limit,
    )
    return CrossChecked(answer, _checks(Asked(answer, how)))


def _checks(asked: Asked) -> tuple[Check, ...]:
    try:
        return tuple(ask_engines(asked))
    except DisagreementError as found:
        raise BugError(str(found)) from None
