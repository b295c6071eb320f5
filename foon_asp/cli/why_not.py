"""``foon-asp why-not``: why there is no tree."""

import json

import click

from foon_asp.cli.asked import Asked, asking
from foon_asp.cli.clash import code_of
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.progress import Progress
from foon_asp.explain.clash import find_clash
from foon_asp.explain.why_not import why_not
from foon_asp.problem import Objective
from foon_asp.report.answer import goal_lines
from foon_asp.report.clash import clash_dict, clash_lines
from foon_asp.report.explanation import explanation_dict, explanation_text


@click.command("why-not")
@asking(
    objective=None,
)
def command(asked: Asked) -> ExitCode:
    """Explain why there is no task tree.

    \b
    foon-asp why-not --goal 'apple pie'
    foon-asp why-not --goal omelet --constraint mine.lp

    What cannot be made is shown as a tree from the goals to what is behind it: an object node that is missing
    in the kitchen, or a cycle of nodes that can only be made from each other. A missing node is compared
    with what is at hand and with kitchen entries that match nothing: its name may be one edit away. Where the
    constraints are the reason, it is said which of them clash.

    Exits with 1 when there is no tree, 0 when there is one, 3 when stopped at a limit.
    """
    problem = asked.problem(everything=True)
    explanation = why_not(problem, asked.dataset.data.kitchen_items)
    found = explanation_dict(explanation)
    if explanation.goals:
        lines = [explanation_text(explanation).rstrip("\n")]
        lines.append("foon-asp shopping-list with the same options says what to add to the kitchen")
        code = ExitCode.NEGATIVE
    elif asked.by_users_rules:
        with Progress() as progress:
            clash = find_clash(problem, (Objective.UNITS,), asked.settings, reporter=progress)
        found["clash"] = clash_dict(clash)
        lines = [*goal_lines(problem), *clash_lines(clash)]
        code = code_of(clash)
    else:
        lines = [
            *goal_lines(problem),
            f"there is a task tree ({problem.conditions}); foon-asp solve finds the best",
        ]
        code = ExitCode.DONE
    click.echo(
        json.dumps(found, indent=2, ensure_ascii=False) if asked.format_ == "json" else "\n".join(lines)
    )
    return code
