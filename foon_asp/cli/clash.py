"""``foon-asp clash``: which constraints cannot hold together, and which to drop."""

from pathlib import Path

import click

from foon_asp.asp import Settings, Status
from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode, of_status
from foon_asp.cli.progress import Progress
from foon_asp.cli.weighted_files import weighted_files
from foon_asp.errors import UserError
from foon_asp.explain.clash import Clash, find_clash
from foon_asp.problem import parse_objectives
from foon_asp.report.clash import clash_json, clash_text


@click.command("clash")
@options.goal_option
@options.objective_option
@options.containers_option
@options.constraint_options
@options.constant_option
@click.option(
    "--weight",
    "weights",
    multiple=True,
    metavar="FILE.lp=WEIGHT",
    help="What it costs to drop a constraint of that file; else 1.",
)
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
    weights: tuple[str, ...],
    time_limit: float | None,
    format_: str,
    **data: object,
) -> ExitCode:
    """Find a smallest set of constraints that cannot hold together, and the cheapest ones to drop.

    \b
    foon-asp clash --goal omelet --constraint mine.lp --constraint yours.lp
    foon-asp clash --goal omelet --constraint mine.lp --constraint yours.lp --weight mine.lp=10

    Every rule without a head (:- ...) is a constraint of its own; other rules of the files always hold. Both
    sets are proved: no smaller one clashes, and dropping nothing cheaper leaves a tree.

    Exits with 0 when the constraints can hold together; with 1 when they clash, or when there is no tree even
    without them; with 3 when stopped at a limit.
    """
    if not constraints:
        raise UserError("name constraints with --constraint; foon-asp why-not explains other reasons")
    chosen = parse_objectives(objectives)
    of_file = weighted_files(weights, "--weight")
    question = options.read_question(**data)  # type: ignore[arg-type]
    problem = question.problem(question.goals(goals_named), containers, everything=True)
    settings = Settings(
        constraints, encodings, constants, time_limit=time_limit, session=options.session_here()
    )
    with Progress() as progress:
        clash = find_clash(problem, chosen, settings, of_file, progress)
    click.echo({"text": clash_text, "json": clash_json}[format_](clash), nl=False)
    if format_ == "text" and not clash.makeable:
        click.echo("foon-asp why-not says why")
    return code_of(clash)


def code_of(clash: Clash) -> ExitCode:
    """Give the exit code for what is known of a clash."""
    if not clash.tree_exists:
        return ExitCode.NEGATIVE
    if not clash.complete or clash.outcome is None:
        return ExitCode.LIMIT
    if clash.dropped:
        proved = clash.proved and clash.outcome.status is Status.OPTIMAL
        return ExitCode.NEGATIVE if proved else ExitCode.LIMIT
    return of_status(clash.outcome.status)
