"""``foon-asp stats``: what is in a network."""

from functools import partial
from pathlib import Path
from typing import Any

import click

from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.output import fitted
from foon_asp.dataset.statistics import count_levels
from foon_asp.questions.contract import TABLES
from foon_asp.report.frame import document_text
from foon_asp.report.statistics_table import statistics_json, statistics_text


@click.command("stats")
@options.files_argument(required=False)
@options.format_option(*TABLES)
@options.network_options
def command(
    paths: tuple[Path, ...], format_: str, folder: Path | None, network: tuple[Path, ...], **data: Any
) -> ExitCode:
    """Count what is in a network, at the levels 1 to 3 of detail.

    \b
    foon-asp stats                           the bundled kitchen
    foon-asp stats my_foon                   a folder of data, or of recipes
    foon-asp stats one.txt two.json more/    networks, together

    Units, object nodes, motions and states; how many units make each node; cycles, parts, depth, and what
    cannot be made from the kitchen (or, without one, from the nodes that no unit makes); the most connected
    objects. Level 2 ignores contents, level 1 all but labels. docs/levels.md says exactly what is counted.

    A single folder is read as with --data: with its kitchen, if it has one.
    """
    networks = (*paths, *network)
    if len(paths) == 1 and paths[0].is_dir() and folder is None and not network:
        folder, networks = paths[0], ()
    dataset = options.read_dataset(folder=folder, network=networks, level=3, **data)
    read = dataset.data
    told = read.network, count_levels(read), bool(read.kitchen_items)
    if format_ == "text":
        click.echo(fitted(partial(statistics_text, *told)), nl=False)
    else:
        click.echo(document_text(statistics_json(*told), format_), nl=False)
    return ExitCode.DONE
