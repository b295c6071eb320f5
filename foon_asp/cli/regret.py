"""``foon-asp regret``: what every unit of the optimal tree, and every item it takes, is worth."""

import click

from foon_asp.asp import Status
from foon_asp.cli.asked import Asked, asking
from foon_asp.cli.exit_code import ExitCode, of_status
from foon_asp.cli.progress import Progress
from foon_asp.errors import UserError
from foon_asp.explain.regret import regrets
from foon_asp.report.regret import regrets_json, regrets_text


@click.command("regret")
@asking(
    click.option(
        "--unit", "units", multiple=True, type=int, metavar="ID", help="Ask about this unit too; repeatable."
    ),
)
def command(asked: Asked, units: tuple[int, ...]) -> ExitCode:
    """Find the optimum without each unit of the best tree, and without each kitchen item it takes.

    \b
    foon-asp regret --goal macaroni
    foon-asp regret --goal macaroni --objective success --unit 17

    What is missed most comes first. Exits with 0 when every answer is
    proved, 1 when there is no tree at all, 3 when a limit came first.
    """
    problem = asked.problem(everything=bool(units))
    ids = []
    for number in units:
        unit = problem.network.unit_of_number(number)
        if unit is None:
            raise UserError(f"there is no unit {number} in the network")
        ids.append(unit)
    with Progress() as progress:
        found = regrets(problem, asked.objectives, asked.settings, ids, progress)
    render = {"text": regrets_text, "json": regrets_json}[asked.format_]
    click.echo(render(found), nl=False)
    if any(regret.status in {Status.FEASIBLE, Status.UNKNOWN} for regret in found.regrets):
        return ExitCode.LIMIT
    return of_status(found.outcome.status)
