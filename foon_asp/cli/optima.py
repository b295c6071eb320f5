"""``foon-asp optima``: the optimum of every goal under every objective, in one table."""

import click

from foon_asp.asp import Outcome, Settings, Status, solve
from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode, of_status
from foon_asp.cli.output import console
from foon_asp.cli.progress import Progress
from foon_asp.deadline import Deadline
from foon_asp.errors import UserError
from foon_asp.problem import parse_objectives
from foon_asp.report.optima_table import optima_json, print_optima


@click.command("optima")
@options.goal_option
@click.option(
    "--objective",
    "objectives",
    multiple=True,
    default=("units", "inputs", "success"),
    show_default=True,
    metavar="LIST",
    help="An objective, or a list by commas of which the first counts most; one row each.",
)
@options.containers_option
@options.each_limit_options
@options.format_option("text", "json")
@options.data_options
def command(
    goals_named: tuple[str, ...],
    objectives: tuple[str, ...],
    containers: str,
    time_limit: float | None,
    memory_limit: int | None,
    format_: str,
    **data: object,
) -> ExitCode:
    """Solve every goal of the goals file under several objectives and compare the optimal trees.

    The limits are for each answer. Exits with 0 when every answer is proved, a goal without a tree
    included, and with 3 when one was stopped at the limit.
    """
    lists = [parse_objectives([text]) for text in objectives]
    dataset = options.read_dataset(**data)  # type: ignore[arg-type]
    goals = list(dict.fromkeys(dataset.each_goal(goals_named)))
    if not goals:
        raise UserError("there are no goals: name some with --goal, or a file of them with --goals")
    outcomes: list[Outcome] = []
    # limits are for each answer, ctrl-C is for all of them
    settings = Settings(time_limit=time_limit, memory_limit=memory_limit, deadline=Deadline())
    with Progress() as progress:
        for goal in goals:
            problem = dataset.problem((goal,), containers)
            for chosen in lists:
                outcome = solve(problem, chosen, settings, progress)
                outcomes.append(outcome)
    if format_ == "json":
        click.echo(optima_json(outcomes), nl=False)
    else:
        print_optima(outcomes, console())
    if any(outcome.status in {Status.FEASIBLE, Status.UNKNOWN} for outcome in outcomes):
        return of_status(Status.UNKNOWN)
    return ExitCode.DONE
