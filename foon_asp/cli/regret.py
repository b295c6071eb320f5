"""``foon-asp regret``: what every unit of the optimal tree, and every item it takes, is worth."""

from pathlib import Path

import click

from foon_asp.asp import Settings, Status
from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode, of_status
from foon_asp.cli.progress import Progress
from foon_asp.errors import UserError
from foon_asp.explain.regret import regrets
from foon_asp.problem import parse_objectives
from foon_asp.report.regret import regrets_json, regrets_text


@click.command("regret")
@options.goal_option
@options.objective_option
@options.containers_option
@click.option(
    "--unit", "units", multiple=True, type=int, metavar="ID", help="Ask about this unit too; repeatable."
)
@options.constraint_options
@options.constant_option
@options.time_limit_option
@options.format_option("text", "json")
@options.data_options
def command(
    goals_named: tuple[str, ...],
    objectives: tuple[str, ...],
    containers: str,
    units: tuple[int, ...],
    constraints: tuple[Path, ...],
    encodings: Path | None,
    constants: tuple[str, ...],
    time_limit: float | None,
    format_: str,
    **data: object,
) -> ExitCode:
    """Find the optimum without each unit of the best tree, and without each kitchen item it takes.

    \b
    foon-asp regret --goal macaroni
    foon-asp regret --goal macaroni --objective success --unit 17

    What is missed most comes first. --time-limit is for each answer. Exits with 0 when every answer is
    proved, 1 when there is no tree at all, 3 when a limit came first.
    """
    chosen = parse_objectives(objectives)
    question = options.read_question(**data)  # type: ignore[arg-type]
    problem = question.problem(question.goals(goals_named), containers, everything=bool(units or constraints))
    asked = []
    for number in units:
        unit = problem.network.unit_of_number(number)
        if unit is None:
            raise UserError(f"there is no unit {number} in the network")
        asked.append(unit)
    settings = Settings(
        constraints, encodings, constants, time_limit=time_limit, session=options.session_here()
    )
    with Progress() as progress:
        found = regrets(problem, chosen, settings, asked, progress)
    render = {"text": regrets_text, "json": regrets_json}[format_]
    click.echo(render(found), nl=False)
    if any(regret.status in {Status.FEASIBLE, Status.UNKNOWN} for regret in found.regrets):
        return ExitCode.LIMIT
    return of_status(found.outcome.status)
