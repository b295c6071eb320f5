"""The best success by how many units a person does, for people and for programs."""

import json
from collections.abc import Iterator
from fractions import Fraction

from foon_asp.asp import Status
from foon_asp.explain.assist import Assistance, Assisted
from foon_asp.report.answer import (
    costs_json,
    costs_text,
    counted,
    fraction_json,
    goal_lines,
    goals_stand_for_json,
    steps,
    success_text,
    unit_json,
)


def assistance_text(found: Assistance, with_tree: bool) -> str:
    """Give a row for each number of units, and what was reached.

    The tree of the last row is given ``with_tree``, and where it is the one that reaches what is wanted.
    """
    shown = with_tree or found.smallest is not None
    return "\n".join([*goal_lines(found.problem), *_lines(found, shown)]) + "\n"


def assistance_json(found: Assistance) -> str:
    """Give all rows with their trees, and who does each unit."""
    problem = found.problem
    return (
        json.dumps(
            {
                "goals": [str(problem.network.objects[goal]) for goal in problem.goals],
                **goals_stand_for_json(problem),
                "containers": str(problem.containers),
                "level": problem.network.level,
                "person": None
                if found.person is None
                else {motion: fraction_json(rate) for motion, rate in found.person.items()},
                "complete": found.complete,
                "greatest_success": fraction_json(found.greatest),
                "more_help_changes_nothing": found.exhausted,
                "reach": fraction_json(found.wanted),
                "smallest": found.smallest,
                "rows": [_row_json(found, row) for row in found.rows],
            },
            indent=2,
            ensure_ascii=False,
        )
        + "\n"
    )


def _lines(found: Assistance, with_tree: bool) -> Iterator[str]:
    rule = found.problem.conditions
    last = found.rows[-1]
    if last.status is Status.INFEASIBLE and found.greatest is None and found.complete:
        yield f"infeasible: proved that no task tree exists, with help or without ({rule})"
        return
    never = "who never fails" if found.person is None else "at rates of the person's own"
    claim = (
        "each row is proved" if found.complete else "stopped at a limit: not every row is there and proved"
    )
    yield f"best success with a person's help, {never} ({rule}); {claim}"
    yield ""
    yield from _table(found)
    yield ""
    yield from _remarks(found)
    if with_tree and last.units is not None and last.costs is not None:
        yield ""
        yield f"with {counted(len(last.helped), 'unit')} done by the person: {costs_text(last.costs)}"
        yield from steps(found.problem, last.units, helped=last.helped)


def _table(found: Assistance) -> Iterator[str]:
    """Give what every row adds to the one before: the whole would be most of a tree, again and again."""
    yield "helped     success  units  the person takes"
    before: frozenset[int] = frozenset()
    for row in found.rows:
        figures = f"{row.most:>6}  "
        if row.costs is None or row.success is None:
            yield figures + ("no tree" if row.status is Status.INFEASIBLE else "no tree found yet")
            continue
        figures += f"{success_text(row.success):>10}  {row.costs.units:>5}"
        taken = [f"- {_name(found, unit)}" for unit in sorted(before - row.helped)]
        taken += [f"+ {_name(found, unit)}" for unit in sorted(row.helped - before)]
        if row.status is Status.FEASIBLE:
            known = "" if row.bound is None else f" (at most {success_text(row.bound)})"
            taken.append(f"not proved best{known}")
        yield f"{figures}  {', '.join(taken)}".rstrip()
        before = row.helped


def _remarks(found: Assistance) -> Iterator[str]:
    last, wanted, greatest = found.rows[-1], found.wanted, found.greatest
    if wanted is not None and found.smallest is not None:
        fewer = ", and not with fewer" if found.smallest else ""
        yield f"{_plain(wanted)} is reached with help for {counted(found.smallest, 'unit')}{fewer}: proved"
    elif wanted is not None and greatest is not None and greatest < wanted:
        yield f"{_plain(wanted)} is out of reach: {success_text(greatest)} is the most with any help: proved"
    elif wanted is not None and found.complete:
        yield f"{_plain(wanted)} is not reached with help for {counted(last.most, 'unit')}: proved"
    if found.exhausted:
        yield "more help changes nothing"
    elif greatest is not None:
        yield f"with any help: {success_text(greatest)}"


def _plain(wanted: Fraction) -> str:
    """Give the number that was asked for as a decimal where it is a short one."""
    text = success_text(wanted)
    return str(wanted) if text.startswith("≈") else text


def _name(found: Assistance, unit: int) -> str:
    network = found.problem.network
    return f"{network.unit_number(unit)} {network.motions[unit]}"


def _row_json(found: Assistance, row: Assisted) -> dict[str, object]:
    network = found.problem.network
    return {
        "most": row.most,
        "status": str(row.status),
        "costs": costs_json(row.costs),
        "bound": fraction_json(row.bound),
        "by_person": sorted(map(network.unit_number, row.helped)),
        "units": None
        if row.units is None
        else [
            {**unit_json(network, unit), "by": "person" if unit in row.helped else "robot"}
            for unit in row.units
        ],
    }
