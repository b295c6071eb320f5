"""``foon-asp assist``: the best success when a person does some of the units."""

from fractions import Fraction
from pathlib import Path

import click

from foon_asp.cli.asked import Asked, asking
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.named_path import NamedPath
from foon_asp.cli.progress import Progress
from foon_asp.errors import UserError
from foon_asp.explain.assist import Assistance, assist
from foon_asp.report.assist import assistance_json, assistance_text
from foon_asp.text import read_rates


@click.command("assist")
@asking(
    click.option(
        "--assist",
        "most",
        type=click.IntRange(min=0),
        metavar="M",
        help="How many units the person does at most.",
    ),
    click.option(
        "--reach",
        "reach",
        metavar="SUCCESS",
        help="The success that is wanted: the fewest units that reach it.",
    ),
    click.option(
        "--person",
        type=click.Path(path_type=NamedPath),
        metavar="FILE",
        help="Success rates of the motions that the person can do; without it all, never failing.",
    ),
    objective=None,
)
def command(asked: Asked, most: int | None, reach: str | None, person: Path | None) -> ExitCode:
    """Find the best success when a person does at most 0, 1, 2, ... units, and which.

    \b
    foon-asp assist --goal macaroni               for every number that makes a difference
    foon-asp assist --goal macaroni --assist 3    for 0 to 3, and the tree with 3
    foon-asp assist --goal macaroni --reach 0.8   up to the fewest that reach it, and the tree

    The person takes over only what has a greater rate than the robot's. Trees are compared exactly; of those
    that succeed as often one with the fewest units is given.

    Exits with 0 when every row is proved, 1 when there is no tree or the success is out of reach, 3 when a
    limit came first.
    """
    wanted = None if reach is None else _success(reach)
    problem = asked.problem()
    rates = None if person is None else read_rates(person)
    for motion in rates or ():
        if problem.rates is not None and motion not in problem.rates:
            click.echo(f"{person}: warning: the motion {motion!r} has no rate for the robot", err=True)
    # every number of units has programs of its own, which no other question can use
    settings = asked.settings._replace(session=None)
    with Progress() as progress:
        found = assist(problem, rates, most, wanted, settings, progress)
    with_tree = most is not None
    text = assistance_json(found) if asked.format_ == "json" else assistance_text(found, with_tree)
    click.echo(text, nl=False)
    return _code(found)


def _success(text: str) -> Fraction:
    try:
        wanted = Fraction(text)
    except (ValueError, ZeroDivisionError):
        wanted = Fraction(0)
    if not 0 < wanted <= 1:
        raise UserError(f"found {text!r} for --reach, expected a success above 0 and at most 1, such as 0.8")
    return wanted


def _code(found: Assistance) -> ExitCode:
    if not found.complete:
        return ExitCode.LIMIT
    if found.rows[-1].units is None or (found.wanted is not None and found.smallest is None):
        return ExitCode.NEGATIVE
    return ExitCode.DONE
