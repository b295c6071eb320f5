"""The table of optima: one row for each tree that is best by something."""

import itertools
from collections.abc import Iterator, Sequence
from fractions import Fraction

from rich.box import SIMPLE_HEAD
from rich.table import Table
from rich.text import Text

from foon_asp.asp import Outcome, Status
from foon_asp.escapes import escaped
from foon_asp.network import ObjectNode
from foon_asp.problem import Objective
from foon_asp.report.answer import figure_text
from foon_asp.report.stackable import Stackable

_ALWAYS = (Objective.UNITS, Objective.INPUTS, Objective.SUCCESS)  # columns; others where they are asked for

_STYLES = {
    Status.OPTIMAL: "green",
    Status.FEASIBLE: "yellow",
    Status.INFEASIBLE: "red",
    Status.UNKNOWN: "yellow",
}


def optima_table(outcomes: Sequence[Outcome]) -> Stackable:
    """Lay out the table; outcomes of one goal stand together, and equal trees share a row."""
    problem = outcomes[0].problem
    trees, tree = ("task trees", "tree") if problem.items is None else ("plans", "plan")
    meanings = {
        Status.OPTIMAL: "optimal: proved best by the objective named",
        Status.INFEASIBLE: f"infeasible: proved that no {tree} exists",
    }
    found = {outcome.status for outcome in outcomes}
    table = Table(
        title=f"The best {trees} ({problem.conditions})",
        caption="\n".join(meaning for status, meaning in meanings.items() if status in found) or None,
        box=SIMPLE_HEAD,
        pad_edge=False,
        show_edge=False,
        padding=0,
        title_justify="left",
        caption_justify="left",
        title_style="bold",
    )
    table.add_column("goal", style="bold", no_wrap=True)
    table.add_column("best by")
    asked = list(dict.fromkeys(outcome.objectives for outcome in outcomes))
    more = [each for each in dict.fromkeys(itertools.chain(*asked)) if each not in _ALWAYS]
    for heading in (*_ALWAYS, *more):
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("  status", no_wrap=True)
    table.add_column("seconds", justify="right", no_wrap=True)
    for goal, rows in _by_goal(outcomes):
        for place, row in enumerate(rows):
            table.add_row(Text(escaped(goal) if place == 0 else ""), *_cells(row, asked, more))
    return Stackable(table)


def _by_goal(outcomes: Sequence[Outcome]) -> Iterator[tuple[str, list[list[Outcome]]]]:
    """Group outcomes by goal, and within a goal those of the same status and costs."""
    goals: dict[tuple[ObjectNode, ...], dict[object, list[Outcome]]] = {}
    for outcome in outcomes:
        rows = goals.setdefault(outcome.problem.goal_nodes, {})
        rows.setdefault((outcome.status, outcome.costs), []).append(outcome)
    for rows in goals.values():
        problem = next(iter(rows.values()))[0].problem
        labels = [problem.network.objects[goal].label for goal in problem.goals]
        yield " + ".join(labels), list(rows.values())


def _cells(row: list[Outcome], every: list[tuple[Objective, ...]], more: list[Objective]) -> list[Text | str]:
    status, costs = row[0].status, row[0].costs
    seconds = f"{sum(sum(outcome.seconds.values()) for outcome in row):.2f}"
    names = [" then ".join(outcome.objectives) for outcome in row]
    shown = Text("  ").append(status, style=_STYLES[status])
    if costs is None:
        return ["", *("" for _ in (*_ALWAYS, *more)), shown, seconds]
    asked = {outcome.objectives[0] for outcome in row}

    def figure(text: str, objective: Objective) -> Text:
        return Text(text, style="bold green" if objective in asked and status is Status.OPTIMAL else "")

    return [
        "all" if len(names) == len(every) > 1 else ", ".join(names),
        figure(str(costs.units), Objective.UNITS),
        figure(str(costs.inputs), Objective.INPUTS),
        "–" if costs.success is None else figure(_rate(costs.success), Objective.SUCCESS),
        *(
            figure(figure_text(each, costs.measures[each]), each) if each in costs.measures else "–"
            for each in more
        ),
        shown,
        seconds,
    ]


def _rate(success: Fraction) -> str:
    return f"{float(success):.4f}" if success >= Fraction(1, 1000) else f"{float(success):.3e}"
