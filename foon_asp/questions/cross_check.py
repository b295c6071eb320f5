"""Answers that other engines checked: ``foon-asp solve --cross-check``."""

from collections.abc import Mapping, Sequence

from msgspec import UNSET

from foon_asp.asp import Settings, Status
from foon_asp.engines import Check, ClaimedAnswer, DisagreementError, Engine
from foon_asp.engines import cross_check as ask_engines
from foon_asp.errors import BugError
from foon_asp.questions.answer import Answer, EngineCheck
from foon_asp.questions.caller import is_python
from foon_asp.questions.disagreement import write_disagreement
from foon_asp.rules.passed_constraint import Constraint


def cross_check_answer(
    answer: Answer, settings: Settings, weights: Mapping[Constraint, int], engines: Sequence[Engine]
) -> Answer:
    """Check an answer with other engines; return it with a note and an :class:`EngineCheck` for each.

    Parameters:
        answer: The answer.
        settings: The settings under which the answer was found.
        weights: The weights of its soft constraints.
        engines: The engines to ask besides bare clingo.

    Raises:
        BugError: where an engine disagrees; a command writes what is needed to reproduce it to a new file.
    """
    penalty = answer.penalty if isinstance(answer.penalty, int) else None
    request = ClaimedAnswer(answer.outcome, settings, weights, penalty)
    try:
        checks = ask_engines(request, engines=tuple(engines))
    except DisagreementError as disagreement:
        raise BugError(
            str(disagreement) if is_python() else write_disagreement(request, disagreement)
        ) from None
    return answer.having(
        [f"cross-check: {_check_line(answer, check)}" for check in checks],
        cross_check=tuple(
            EngineCheck(
                check.engine,
                check.package,
                check.reason is None,
                check.objectives,
                check.refuted,
                check.reason,
                round(check.seconds, 6),
            )
            for check in checks
        ),
    )


def _check_line(answer: Answer, check: Check) -> str:
    """Return a line on an engine: that it agrees, that its own answer is wrong, or why it did not check."""
    engine = check.engine if check.package is None else f"{check.engine} ({check.package})"
    if check.reason is not None:
        return f"{engine}: not checked: {check.reason}"
    if check.refuted is not None:
        return f"{engine} disagrees and is wrong: {check.refuted} ({check.seconds:.2f} s)"
    by = ", ".join((*(() if answer.penalty is UNSET else ("penalty",)), *check.objectives))
    agreement = "that no tree exists" if answer.status is Status.INFEASIBLE else f"by {by}"
    return f"{engine} agrees {agreement} ({check.seconds:.2f} s)"
