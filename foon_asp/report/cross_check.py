"""What other engines say of an answer: a line and a JSON object for each."""

from collections.abc import Iterator, Sequence

from foon_asp.asp import Status
from foon_asp.engines import Asked, Check


def check_lines(asked: Asked, checks: Sequence[Check]) -> Iterator[str]:
    """Say for each engine by what it agrees, or why it has not checked the answer."""
    for check in checks:
        if check.reason is not None:
            yield f"cross-check: {check.engine}: not checked: {check.reason}"
            continue
        by = ", ".join((*(("penalty",) if asked.soft else ()), *check.objectives))
        that = "that no tree exists" if asked.outcome.status is Status.INFEASIBLE else f"by {by}"
        yield f"cross-check: {check.engine} agrees {that} ({check.seconds:.2f} s)"


def checked_dict(checks: Sequence[Check]) -> dict[str, object]:
    """Give the key of an answer with what each engine says of it.

    ``agrees_by`` is empty where it agrees that no tree exists.
    """
    rows = [
        {
            "engine": check.engine,
            "checked": check.reason is None,
            "agrees_by": list(map(str, check.objectives)),
            "reason": check.reason,
            "seconds": round(check.seconds, 6),
        }
        for check in checks
    ]
    return {"cross_check": rows}
