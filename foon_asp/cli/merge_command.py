"""``foon-asp merge``: many FOONs in one, as text or as a store."""

from pathlib import Path

import click

from foon_asp.cli import shared_options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.named_path import WrittenPath
from foon_asp.cli.output import write_output
from foon_asp.cli.output_file import check_outputs
from foon_asp.cli.progress_line import bytes_bar
from foon_asp.errors import UserError
from foon_asp.questions.merge import merge_files
from foon_asp.results.table import blocks_text
from foon_asp.text.data_folder import find_data
from foon_asp.whole_file import utf_8


@click.command("merge")
@shared_options.sources_argument
@shared_options.output_option("FILE", "Where to write the merged network; stdout, if not given.")
@click.option(
    "--store",
    type=WrittenPath(),
    metavar="NAME.foon",
    help="Write a store instead; an old one is replaced once the new one is complete.",
)
@click.option("--report", is_flag=True, help="List units that nearly agree and were kept apart, on stderr.")
@shared_options.network_options
def command(
    sources: tuple[Path, ...],
    output: Path | None,
    store: Path | None,
    report: bool,
    folder: Path | None,
    network: tuple[Path, ...],
    lenient: bool,
    **tables: Path | None,
) -> ExitCode:
    """Merge FOONs into a universal FOON, in which every distinct functional unit stands once.

    \b
    foon-asp merge recipes/ -o FOON.txt          all networks of a folder
    foon-asp merge FOON.txt new.txt -o out.txt   one more into a merged one
    foon-asp merge recipes/*.json -o FOON.txt    JSON, too
    foon-asp merge recipes/ --store recipes.foon into a store, with the kitchen of the folder

    Units are the same when they have the same motion, inputs and outputs; ids, motion flags and times do not
    count and are not written. Above each unit is a line for every copy of it:

    \b
    # From:→recipes/salad.txt:12→https://example.org/salad.mp4

    with the file, the line, and the videos that the file names, and an amount that is not one is in a line
    "# Amount:" under its object. Merging again keeps these places, and every
    answer on the merged network shows them. In a folder, the networks are FOON.txt, or else all *.txt and
    *.json except kitchen, goals and tables; a warning names lists of objects with other names.

    --store is for networks too large to read for each question: every verb takes the store in place of a
    recipe, and reads only what can matter. It keeps the kitchen, rates, utensils, goals and prices that are
    named here or are in the folder; they hold unless others are given.

    --report also lists pairs of units that differ in one thing alone: the motion, a state, a relation, an
    ingredient, or a label with another letter, so that somebody can decide whether they are meant to be one.

    Prices of units (in JSON) are kept in a store, and FOON text has no place for them. Copies of a unit with
    different prices are an error, unless a line of --unit-prices chooses one.

    The counts go to stderr. Exits with 0, or with 2 when something is not understood.
    """
    check_outputs()
    folder, networks = shared_options.folder_and_networks(sources, folder, network)
    if folder is None and not networks:
        raise UserError("name the networks to merge, or a folder of data with --data")
    if store is not None and (output is not None or report):
        raise UserError("--store writes a store: leave out -o and --report")
    if store is None and any(tables[name] for name in tables.keys() - {"unit_prices", "unit_amounts"}):
        raise UserError("kitchen, rates, utensils and goals are kept in a store only: name one with --store")
    files = find_data(folder, networks, **tables)
    with bytes_bar("merging", files.network):
        merged = merge_files(files, store, lenient)
    for warning in merged.warnings:
        click.echo(warning, err=True)
    if store is not None:
        click.echo(merged.text(), nl=False)
        return ExitCode.DONE
    write_output(output, utf_8(merged.foon()))
    if report:
        click.echo(blocks_text(merged.kept_apart()), err=True, nl=False)
    click.echo(merged.text(), err=True, nl=False)
    return ExitCode.DONE
