"""Constraints that cannot hold together, and soft ones that are broken, for people and for programs."""

import json
from collections.abc import Iterator, Mapping

from foon_asp.asp import Status
from foon_asp.asp.integrity import IntegrityConstraint
from foon_asp.asp.soft import SoftOutcome
from foon_asp.explain.clash import Clash
from foon_asp.report.answer import counted, goal_lines, headline, outcome_dict, outcome_text


def clash_text(clash: Clash) -> str:
    """Say which constraints clash and which to drop."""
    return "\n".join([*goal_lines(clash.problem), *clash_lines(clash)]) + "\n"


def clash_lines(clash: Clash) -> Iterator[str]:
    """Give the same without the goals."""
    rule = clash.problem.conditions
    if not clash.tree_exists and clash.makeable:
        yield f"no task tree is left whatever is dropped: proved ({rule})"
        yield "other rules of the files rule it out"
        return
    if not clash.tree_exists:
        yield f"no task tree exists even without the constraints: proved ({rule})"
        return
    if not clash.complete:
        yield f"unknown: stopped at a limit before it was known whether the constraints clash ({rule})"
        if clash.dropped:
            yield "without these there is a task tree; a cheaper set may do, or nothing need be dropped"
            for constraint in clash.dropped:
                yield from _constraint_lines(constraint)
        return
    number = counted(len(clash.constraints), "constraint")
    if not clash.constraints:
        yield f"there is a task tree ({rule}); foon-asp solve finds the best"
        return
    if not clash.dropped:
        yield f"no clash: the {number} can hold{' together' * (len(clash.constraints) > 1)} ({rule})"
        if clash.outcome is not None:
            yield headline(clash.outcome)
        return
    if clash.proved:
        size = len(clash.smallest)
        if len(clash.constraints) == 1:
            yield f"1 constraint leaves no task tree: proved ({rule})"
        elif size == 1:
            yield f"1 of the {number} leaves no task tree by itself: proved ({rule})"
        else:
            yield f"{size} of the {number} cannot hold together, and no fewer do not: proved ({rule})"
        for constraint in clash.smallest:
            yield from _constraint_lines(constraint)
    else:
        yield f"the {number} cannot hold together ({rule}); the smallest clash was not found within the limit"
    weight = sum(clash.weights[constraint.number] for constraint in clash.dropped)
    at = "" if set(clash.weights.values()) == {1} else f", weight {weight}"
    yield f"cheapest to drop: {counted(len(clash.dropped), 'constraint')}{at}"
    for constraint in clash.dropped:
        yield from _constraint_lines(constraint)
    if clash.outcome is not None and clash.outcome.status is not Status.UNKNOWN:
        yield f"without {'it' if len(clash.dropped) == 1 else 'them'}: {headline(clash.outcome)}"


def clash_dict(clash: Clash) -> dict[str, object]:
    """Give all that is known of a clash."""
    objects = clash.problem.network.objects
    return {
        "goals": [str(objects[goal]) for goal in clash.problem.goals],
        "containers": str(clash.problem.containers),
        "level": clash.problem.network.level,
        "complete": clash.complete,
        "tree_exists_without_constraints": clash.tree_exists,
        "clash": bool(clash.dropped),
        "constraints": [
            {**constraint_json(constraint), "weight": clash.weights[constraint.number]}
            for constraint in clash.constraints
        ],
        "smallest_clash": [constraint_json(constraint) for constraint in clash.smallest],
        "smallest_proved": clash.proved,
        "cheapest_to_drop": [constraint_json(constraint) for constraint in clash.dropped],
        "answer": None if clash.outcome is None else outcome_dict(clash.outcome),
    }


def clash_json(clash: Clash) -> str:
    """Give :func:`clash_dict` as JSON."""
    return json.dumps(clash_dict(clash), indent=2, ensure_ascii=False) + "\n"


def constraint_json(constraint: IntegrityConstraint) -> dict[str, object]:
    """Give a constraint with its place and text."""
    return {
        "number": constraint.number,
        "file": constraint.source.file,
        "line": constraint.source.line,
        "text": constraint.text,
        "constants": list(constraint.constants),
    }


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
        yield from _constraint_lines(each.constraint, f"    (weight {each.weight}{times})")


def soft_json(soft: SoftOutcome, more: Mapping[str, object] | None = None) -> str:
    """Give the answer with the penalty, every soft constraint, and more keys after those."""
    return json.dumps(_soft_dict(soft) | dict(more or {}), indent=2, ensure_ascii=False) + "\n"


def _soft_dict(soft: SoftOutcome) -> dict[str, object]:
    constraints = [
        {**constraint_json(each.constraint), "weight": each.weight, "broken": each.ways}
        for each in soft.constraints
    ]
    return {**outcome_dict(soft.outcome), "penalty": soft.penalty, "soft_constraints": constraints}


def _constraint_lines(constraint: IntegrityConstraint, remark: str = "") -> Iterator[str]:
    given = "".join(f"    -c {setting}" for setting in constraint.constants)
    yield f"  {constraint.source}{remark}{given}"
    yield f"      {constraint.text}"
