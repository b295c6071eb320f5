"""``foon-asp alternatives``: the other trees, optimal ones or next best, and what all have in common."""

from fractions import Fraction

import click

from foon_asp.cli.asked import Asked, asking
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.progress import Progress
from foon_asp.errors import UserError
from foon_asp.explain.alternatives import all_optimal, best_trees, most_different
from foon_asp.report.alternatives import alternatives_json, alternatives_text


@click.command("alternatives")
@asking(
    click.option("--best", type=click.IntRange(min=1), metavar="K", help="The K best trees, in order."),
    click.option(
        "--different",
        type=click.IntRange(min=2),
        metavar="K",
        help="K trees that differ most from each other.",
    ),
    click.option(
        "--within",
        type=click.IntRange(min=0),
        default=0,
        show_default=True,
        metavar="PERCENT",
        help="With --different: how much worse by the first objective a tree may be.",
    ),
    click.option(
        "--limit",
        type=click.IntRange(min=1),
        default=100,
        show_default=True,
        metavar="N",
        help="Trees to look at, at most.",
    ),
)
def command(asked: Asked, best: int | None, different: int | None, within: int, limit: int) -> ExitCode:
    """List other trees: all that are optimal, the next best, or those that differ most.

    \b
    foon-asp alternatives --goal macaroni             every optimal tree, and what all of them have
    foon-asp alternatives --goal macaroni --best 5
    foon-asp alternatives --goal macaroni --different 3 --within 20

    A tree that holds all the units of another one that is listed, and some to spare, is not listed. Trees are
    found one by one in order of their costs, which are compared exactly.

    Exits with 0 when none is left out of what was asked for, 1 when there is no tree, 3 when a limit came
    first.
    """
    if best is not None and different is not None:
        raise UserError("--best and --different ask for different things; give one of them")
    if within and different is None:
        raise UserError("--within goes with --different")
    problem = asked.problem()
    objectives, settings = asked.objectives, asked.settings
    with Progress() as progress:
        if best is not None:
            found = best_trees(problem, objectives, settings, best, progress)
        elif different is not None:
            worse = Fraction(within, 100)
            found = most_different(problem, objectives, settings, different, worse, limit, progress)
        else:
            found = all_optimal(problem, objectives, settings, limit, progress)
    render = {"text": alternatives_text, "json": alternatives_json}[asked.format_]
    click.echo(render(found), nl=False)
    if not found.complete:
        return ExitCode.LIMIT
    return ExitCode.DONE if found.trees else ExitCode.NEGATIVE
