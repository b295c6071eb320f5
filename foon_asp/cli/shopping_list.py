"""``foon-asp shopping-list``: what to add to the kitchen so that there is a tree."""

from pathlib import Path

import click

from foon_asp.asp import Status
from foon_asp.cli.asked import Asked, asking
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.named_path import NamedPath
from foon_asp.cli.progress import Progress
from foon_asp.explain.shopping_list import priced, shopping_list
from foon_asp.report.shopping import shopping_json, shopping_text
from foon_asp.text import read_prices


@click.command("shopping-list")
@asking(
    click.option(
        "--prices",
        "price_file",
        type=click.Path(path_type=NamedPath),
        metavar="FILE",
        help="Buy only what has a price: lines of an object node, a tab and a price.",
    ),
    click.option(
        "--lists", type=click.IntRange(min=1), default=3, show_default=True, help="How many lists at most."
    ),
)
def command(asked: Asked, price_file: Path | None, lists: int) -> ExitCode:
    """Find the fewest or cheapest object nodes to add to the kitchen so that a task tree exists.

    \b
    foon-asp shopping-list --goal 'hot cocoa'
    foon-asp shopping-list --goal 'hot cocoa' --goal omelet --prices prices.txt

    For sale is what no unit makes, and what has no state and holds at most one ingredient, unless it is a
    product of some unit. The dish itself is proposed only when nothing else is left. A line of a price list
    is an object node in one-line notation, or a label, then a tab and a price. Every list is proved to be the
    cheapest of those that do not hold all of one before it.

    Exits with 0 when there is a list, proved; with 1 when no list helps, proved; with 3 when stopped at a
    limit.
    """
    problem = asked.problem(everything=True)
    with Progress() as progress:
        prices = None
        if price_file is not None:
            prices = priced(problem, read_prices(price_file), progress.warning)
        shopping = shopping_list(problem, asked.objectives, asked.settings, prices, lists, progress)
    render = {"text": shopping_text, "json": shopping_json}[asked.format_]
    click.echo(render(shopping), nl=False)
    if not shopping.lists:
        return ExitCode.NEGATIVE if shopping.complete else ExitCode.LIMIT
    proved = all(found.proved for found in shopping.lists)
    solved = shopping.outcome is not None and shopping.outcome.status is Status.OPTIMAL
    return ExitCode.DONE if proved and solved else ExitCode.LIMIT
