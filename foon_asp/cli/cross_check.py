"""``--cross-check``: the answer held against other engines before it is given out."""

from collections.abc import Iterator
from pathlib import Path

from foon_asp.asp import Outcome, Settings, Status
from foon_asp.certificate import Coverage, coverage
from foon_asp.engines import ENGINES, DisagreementError, cross_check
from foon_asp.errors import BugError, UserError
from foon_asp.report.disagreement import disagreement_files, disagreement_name
from foon_asp.report.whole_file import write_whole

_PATIENCE = 60.0  # seconds for each engine, where no time limit says otherwise


def checkable(settings: Settings) -> Coverage:
    """Give what constraints rule out; other engines know of no other rules.

    Raises :class:`UserError` for constraints that say more.
    """
    covered = coverage(settings)
    if covered.not_covered:
        raise UserError(
            "--cross-check knows of no rules but forbid_motion and forbid_object, and here are also "
            + ", ".join(name.partition(" ")[0] for name in covered.not_covered)
        )
    return covered


def check_across(outcome: Outcome, covered: Coverage, time_limit: float | None) -> list[str]:
    """Ask the other engines and say what they answer, a line for each.

    Where one disagrees, writes all that is needed to look into it to a new folder and raises
    :class:`BugError`.
    """
    if outcome.status not in {Status.OPTIMAL, Status.INFEASIBLE}:
        return ["cross-check: nothing is proved, so there is nothing to check"]
    try:
        answers = cross_check(
            outcome, covered.forbids(outcome.problem.network), _PATIENCE if time_limit is None else time_limit
        )
    except DisagreementError as found:
        folder = Path(disagreement_name(outcome))
        folder.mkdir(exist_ok=True)
        for name, content in disagreement_files(outcome, covered, found).items():
            write_whole(folder / name, content.encode())
        raise BugError(f"{found}; data, question and answers are in {folder}/ (see report.json)") from None

    def lines() -> Iterator[str]:
        for answer in answers:
            said = (
                f"agrees by {', '.join(answer.objectives)}" if answer.finished else "found no answer in time"
            )
            yield f"cross-check: {answer.engine} {said} ({answer.seconds:.2f} s)"
        for engine in ENGINES:
            if not engine.installed():
                yield f"cross-check: {engine.name} is not installed (pip install 'foon-asp[cross-check]')"

    return list(lines())
