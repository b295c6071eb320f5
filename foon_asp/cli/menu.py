"""``foon-asp menu``: several goals by one tree, beside a tree for each."""

import click

from foon_asp.asp import Status
from foon_asp.cli.asked import Asked, asking
from foon_asp.cli.exit_code import ExitCode, of_status
from foon_asp.cli.progress import Progress
from foon_asp.errors import UserError
from foon_asp.explain.menu import menu
from foon_asp.report.menu import menu_json, menu_text


@click.command("menu")
@asking()
def command(asked: Asked) -> ExitCode:
    """Solve several goals by one tree, and goal by goal, and say what is shared.

    \b
    foon-asp menu --goal macaroni --goal omelet
    foon-asp menu --goal macaroni --goal omelet --objective success

    Exits with 0 when all are proved, 1 when no tree makes all goals, 3 when
    a limit came first.
    """
    if len(asked.goals) < 2:
        raise UserError("a menu has several goals: name them with --goal, again and again")
    problem = asked.problem()
    with Progress() as progress:
        found = menu(problem, asked.objectives, asked.settings, progress)
    render = {"text": menu_text, "json": menu_json}[asked.format_]
    click.echo(render(found), nl=False)
    if any(outcome.status in {Status.FEASIBLE, Status.UNKNOWN} for outcome in found.separate):
        return ExitCode.LIMIT
    return of_status(found.together.status)
