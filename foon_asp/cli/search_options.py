"""Options of the searches, for the verbs that run them."""

import functools

import click

from foon_asp.cli.options import Command
from foon_asp.search import Count, Ties

_OPTIONS = (
    click.option(
        "--ties",
        type=click.Choice([str(ties) for ties in Ties]),
        default="first",
        show_default=True,
        help="Which of equally good units is taken, in file order.",
    ),
    click.option(
        "--count",
        type=click.Choice([str(count) for count in Count]),
        default="ingredients",
        show_default=True,
        help="What greedy-inputs counts: input nodes with their ingredients, or nodes alone.",
    ),
    click.option(
        "--depth-limit",
        type=click.IntRange(min=0),
        metavar="N",
        help="How deep ids looks before it gives up.",
    ),
)


def search_options(command: Command) -> Command:
    """Add the options of the searches."""
    return functools.reduce(lambda f, option: option(f), reversed(_OPTIONS), command)
