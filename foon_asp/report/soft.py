"""Soft constraints that are broken, for people and for programs."""

import json
from collections.abc import Iterator, Mapping

from foon_asp.asp import Status
from foon_asp.asp.soft import SoftOutcome
from foon_asp.report.answer import counted, outcome_dict, outcome_text
from foon_asp.report.integrity_constraint import constraint_json, constraint_lines


def soft_text(soft: SoftOutcome) -> str:
    """Give the answer with what its tree breaks."""
    return outcome_text(soft.outcome, soft_lines(soft))


def soft_lines(soft: SoftOutcome) -> Iterator[str]:
    """Say what the tree breaks and what that costs."""
    if soft.penalty is None:
        return
    number = counted(len(soft.constraints), "soft constraint")
    broken = [each for each in soft.constraints if each.ways]
    if not broken:
        yield (
            f"penalty 0: all of {number} hold"
            if len(soft.constraints) != 1
            else "penalty 0: the soft constraint holds"
        )
        return
    least = "the least there is" if soft.outcome.status is Status.OPTIMAL else "not proved least"
    yield f"penalty {soft.penalty}, {least}: {len(broken)} of {number} broken"
    for each in broken:
        times = "" if each.ways == 1 else f", {each.ways} times"
        yield from constraint_lines(each.constraint, f"    (weight {each.weight}{times})")


def soft_json(soft: SoftOutcome, more: Mapping[str, object] | None = None) -> str:
    """Give the answer with the penalty, every soft constraint, and more keys after those."""
    return json.dumps(_soft_dict(soft) | dict(more or {}), indent=2, ensure_ascii=False) + "\n"


def _soft_dict(soft: SoftOutcome) -> dict[str, object]:
    constraints = [
        {**constraint_json(each.constraint), "weight": each.weight, "broken": each.ways}
        for each in soft.constraints
    ]
    return {**outcome_dict(soft.outcome), "penalty": soft.penalty, "soft_constraints": constraints}
