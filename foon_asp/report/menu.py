"""Several goals together and one by one, for people and for programs."""

import json
from collections.abc import Iterator
from fractions import Fraction

from foon_asp.explain.menu import Menu
from foon_asp.problem import multiplies
from foon_asp.report.answer import counted, fraction_json, headline, outcome_dict, steps, success_text


def menu_text(menu: Menu) -> str:
    """Give the costs together and one by one, what is shared, and the tree for all."""
    return "\n".join(_lines(menu)) + "\n"


def menu_json(menu: Menu) -> str:
    """Give all answers, the sum of the separate ones, and which goals each unit serves."""
    network = menu.together.problem.network
    first = menu.together.objectives[0]
    total = menu.sum_of_separate(first)
    return (
        json.dumps(
            {
                "together": outcome_dict(menu.together),
                "separate": [outcome_dict(outcome) for outcome in menu.separate],
                "sum_of_separate": fraction_json(total) if isinstance(total, Fraction) else total,
                "serves": [
                    {"unit": network.unit_number(unit), "goals": [str(network.objects[o]) for o in goals]}
                    for unit, goals in menu.serves.items()
                ],
            },
            indent=2,
            ensure_ascii=False,
        )
        + "\n"
    )


def _lines(menu: Menu) -> Iterator[str]:
    problem = menu.together.problem
    objects = problem.network.objects
    for goal, outcome in zip(problem.goals, menu.separate, strict=True):
        yield f"{objects[goal]}"
        yield f"  {headline(outcome)}"
    yield f"all {len(problem.goals)} by one tree"
    yield f"  {headline(menu.together)}"
    if menu.together.costs is None or menu.together.units is None:
        return
    first = menu.together.objectives[0]
    total = menu.sum_of_separate(first)
    if total is not None:
        ours = menu.together.costs.measure(first)
        if multiplies(first):
            shown = f"one by one {success_text(Fraction(total))}, together {success_text(Fraction(ours))}"
        else:
            shown = f"one by one {total} {first}, together {ours}"
        yield f"{shown}; {counted(len(menu.shared), 'unit')} shared"
    for unit in menu.shared:
        names = ", ".join(objects[goal].label for goal in menu.serves[unit])
        yield f"  {problem.network.motions[unit]}    [{problem.network.sources[unit][0]}] for {names}"
    yield ""
    yield from steps(problem, menu.together.units)
