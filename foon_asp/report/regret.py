"""What the parts of a question are worth, for people and for programs."""

import json
from collections.abc import Iterator
from fractions import Fraction

from foon_asp.asp import Status
from foon_asp.explain.regret import Part, Regret, Regrets
from foon_asp.problem import multiplies
from foon_asp.report.answer import (
    costs_json,
    costs_text,
    fraction_json,
    goal_lines,
    headline,
    outcome_dict,
    success_text,
)


def regrets_text(found: Regrets) -> str:
    """Give the optimum, and under it what is missed most first."""
    outcome = found.outcome
    lines = [*goal_lines(outcome.problem), headline(outcome)]
    for part, title in ((Part.UNIT, "without the unit"), (Part.ITEM, "without from the kitchen")):
        regrets = [regret for regret in found.regrets if regret.part is part]
        if regrets:
            lines += ["", title, *(line for regret in regrets for line in _regret_lines(found, regret))]
    return "\n".join(lines) + "\n"


def regrets_json(found: Regrets) -> str:
    """Give the answer and the regrets."""
    return (
        json.dumps(
            {
                "answer": outcome_dict(found.outcome),
                "regrets": [_regret_json(found, regret) for regret in found.regrets],
            },
            indent=2,
            ensure_ascii=False,
        )
        + "\n"
    )


def _regret_lines(found: Regrets, regret: Regret) -> Iterator[str]:
    network = found.outcome.problem.network
    if regret.part is Part.UNIT:
        name = f"{network.unit_number(regret.id)}  {network.motions[regret.id]}"
        name += f"    [{network.sources[regret.id][0]}]"
    else:
        name = str(network.objects[regret.id])
    yield f"  {_loss(found, regret)}    {name}"
    if regret.costs is not None and found.outcome.costs is not None and regret.costs != found.outcome.costs:
        yield f"       the best is then {costs_text(regret.costs)}"


def _loss(found: Regrets, regret: Regret) -> str:
    if regret.status is Status.INFEASIBLE:
        return "no tree "
    if regret.status is not Status.OPTIMAL:
        return "unknown "
    first = found.outcome.objectives[0]
    assert found.outcome.costs is not None
    loss = regret.loss(found.outcome.costs, first)
    if not loss:
        return "nothing "
    if multiplies(first):
        text = success_text(Fraction(loss * 100))
        return f"≈ -{text[2:]} %" if text.startswith("≈") else f"-{text} %"
    return f"{int(loss):+} {first}"  # less by ``kitchen`` where an item is made that is not at hand


def _regret_json(found: Regrets, regret: Regret) -> dict[str, object]:
    network = found.outcome.problem.network
    best = found.outcome.costs
    assert best is not None
    losses = {}
    if regret.status is Status.OPTIMAL:
        for objective in found.outcome.objectives:
            loss = regret.loss(best, objective)
            losses[str(objective)] = fraction_json(loss) if isinstance(loss, Fraction) else loss
    return {
        "part": str(regret.part),
        "id": network.unit_number(regret.id)
        if regret.part is Part.UNIT
        else network.object_number(regret.id),
        "name": network.motions[regret.id] if regret.part is Part.UNIT else str(network.objects[regret.id]),
        "status": str(regret.status),
        "costs": costs_json(regret.costs),
        "loss": losses or None,
    }
