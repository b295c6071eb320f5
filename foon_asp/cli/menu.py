"""``foon-asp menu``: several goals by one tree, beside a tree for each."""

from pathlib import Path

import click

from foon_asp.asp import Settings, Status
from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode, of_status
from foon_asp.cli.progress import Progress
from foon_asp.errors import UserError
from foon_asp.explain.menu import menu
from foon_asp.problem import parse_objectives
from foon_asp.report.menu import menu_json, menu_text


@click.command("menu")
@options.goal_option
@options.objective_option
@options.containers_option
@options.constraint_options
@options.constant_option
@options.time_limit_option
@options.format_option("text", "json")
@options.data_options
def command(
    goals_named: tuple[str, ...],
    objectives: tuple[str, ...],
    containers: str,
    constraints: tuple[Path, ...],
    encodings: Path | None,
    constants: tuple[str, ...],
    time_limit: float | None,
    format_: str,
    **data: object,
) -> ExitCode:
    """Solve several goals by one tree, and goal by goal, and say what is shared.

    \b
    foon-asp menu --goal macaroni --goal omelet
    foon-asp menu --goal macaroni --goal omelet --objective success

    --time-limit is for each answer. Exits with 0 when all are proved, 1 when no tree makes all goals, 3 when
    a limit came first.
    """
    chosen = parse_objectives(objectives)
    question = options.read_question(**data)  # type: ignore[arg-type]
    goals = question.goals(goals_named)
    if len(goals) < 2:
        raise UserError("a menu has several goals: name them with --goal, again and again")
    problem = question.problem(goals, containers, everything=bool(constraints or encodings))
    settings = Settings(
        constraints, encodings, constants, time_limit=time_limit, session=options.session_here()
    )
    with Progress() as progress:
        found = menu(problem, chosen, settings, progress)
    render = {"text": menu_text, "json": menu_json}[format_]
    click.echo(render(found), nl=False)
    if any(outcome.status in {Status.FEASIBLE, Status.UNKNOWN} for outcome in found.separate):
        return ExitCode.LIMIT
    return of_status(found.together.status)
