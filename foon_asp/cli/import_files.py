"""``foon-asp import``: files into a store, from which a question reads only its part."""

from pathlib import Path
from typing import Any

import click

from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.named_path import NamedPath
from foon_asp.cli.progress import bytes_bar
from foon_asp.dataset.dataset import left_out
from foon_asp.errors import UserError
from foon_asp.network import counted
from foon_asp.store.import_files import import_files
from foon_asp.text.data_folder import find_data
from foon_asp.text.diagnostics import summarize


@click.command("import")
@options.files_argument(required=False)
@click.option(
    "--store",
    required=True,
    type=click.Path(path_type=NamedPath),
    metavar="NAME.foon",
    help="The store to write; an old one is replaced once the new one is complete.",
)
@options.network_options
def command(
    paths: tuple[Path, ...], store: Path, network: tuple[Path, ...], lenient: bool, **beside: Any
) -> ExitCode:
    """Merge networks into a store, for networks too large to read for each question.

    \b
    foon-asp import recipes/ --store recipes.foon
    foon-asp import --data my_foon --store my.foon
    foon-asp solve --network my.foon --goal macaroni

    The kitchen, rates, utensils, goals and prices named here are kept in the store, and used by every verb
    unless others are given. Every copy of a unit keeps its file, line and videos. Copies with different
    prices are an error, unless a line of --unit-prices chooses one.
    """
    if beside["folder"] is None and not paths and not network:
        raise UserError("name the networks to import, or a folder of data with --data")
    files = find_data(network=(*paths, *network), **beside)
    with bytes_bar("importing", files.network):
        imported = import_files(files, store, lenient)
    for text in (*summarize(imported.warnings), *imported.remarks):
        click.echo(text, err=True)
    if imported.left_out:
        click.echo(left_out(imported.left_out), err=True)
    size = store.stat().st_size / 1e6
    counts = f"{counted(imported.units, 'unit')} of {imported.copies} read"
    click.echo(f"{store}: {counts}, {counted(imported.objects, 'object node')}, {size:.1f} MB")
    return ExitCode.DONE
