"""``foon-asp clash``: which constraints cannot hold together, and which to drop."""

import click

from foon_asp.asp import Status
from foon_asp.cli.asked import Asked, asking
from foon_asp.cli.exit_code import ExitCode, of_status
from foon_asp.cli.progress import Progress
from foon_asp.cli.weighted_files import weighted_files
from foon_asp.errors import UserError
from foon_asp.explain.clash import Clash, find_clash
from foon_asp.report.clash import clash_json, clash_text


@click.command("clash")
@asking(
    click.option(
        "--weight",
        "weights",
        multiple=True,
        metavar="FILE.lp=WEIGHT",
        help="What it costs to drop a constraint of that file; else 1.",
    ),
)
def command(asked: Asked, weights: tuple[str, ...]) -> ExitCode:
    """Find a smallest set of constraints that cannot hold together, and the cheapest ones to drop.

    \b
    foon-asp clash --goal omelet --constraint mine.lp --constraint yours.lp
    foon-asp clash --goal omelet --constraint mine.lp --constraint yours.lp --weight mine.lp=10

    Every rule without a head (:- ...) is a constraint of its own; other rules of the files always hold. Both
    sets are proved: no smaller one clashes, and dropping nothing cheaper leaves a tree.

    Exits with 0 when the constraints can hold together; with 1 when they clash, or when there is no tree even
    without them; with 3 when stopped at a limit.
    """
    if not asked.settings.constraints:
        raise UserError("name constraints with --constraint; foon-asp why-not explains other reasons")
    of_file = weighted_files(weights, "--weight")
    problem = asked.problem(everything=True)
    with Progress() as progress:
        clash = find_clash(problem, asked.objectives, asked.settings, of_file, progress)
    click.echo({"text": clash_text, "json": clash_json}[asked.format_](clash), nl=False)
    if asked.format_ == "text" and not clash.makeable:
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
