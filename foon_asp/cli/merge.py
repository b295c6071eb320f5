"""``foon-asp merge``: many FOONs in one, every unit with its origins."""

import functools
from collections.abc import Iterator
from pathlib import Path

import click

from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.named_path import NamedPath
from foon_asp.cli.output import fitted, write_data
from foon_asp.cli.output_file import same_file
from foon_asp.errors import UserError
from foon_asp.network import Network, NetworkBuilder, counted
from foon_asp.report.unit_block import kept_apart_text
from foon_asp.report.whole_file import utf_8, write_whole
from foon_asp.text.data_folder import network_files
from foon_asp.text.diagnostics import summarize
from foon_asp.text.merged_network import merged_text
from foon_asp.text.reader import FoonReader
from foon_asp.text.unit_price_list import read_unit_prices


@click.command("merge")
@options.files_argument(required=True)
@options.output_option("FILE", "Where to write the merged network; stdout, if not given.")
@click.option(
    "--unit-prices",
    type=click.Path(path_type=NamedPath),
    metavar="FILE",
    help="Prices of single units, used when copies of a unit have different ones.",
)
@click.option("--report", is_flag=True, help="List units that nearly agree and were kept apart, on stderr.")
@options.lenient_option
@options.debug_option
def command(
    paths: tuple[Path, ...], output: Path | None, unit_prices: Path | None, report: bool, lenient: bool
) -> ExitCode:
    """Merge FOONs into a universal FOON: every distinct functional unit once.

    \b
    foon-asp merge recipes/ -o FOON.txt          all networks of a folder
    foon-asp merge FOON.txt new.txt -o out.txt   one more into a merged one
    foon-asp merge recipes/*.json -o FOON.txt    JSON, too

    Units are the same when they have the same motion, inputs and outputs; ids, motion flags and times do not
    count and are not written. Above each unit is a line for every copy of it:

    \b
    # From:→recipes/salad.txt:12→https://example.org/salad.mp4

    with the file, the line, and the videos that the file names. Merging again keeps these places, and every
    answer on the merged network shows them. In a folder, the networks are FOON.txt, or else all *.txt and
    *.json except kitchen, goals and tables; a warning names lists of objects with other names.

    --report also lists pairs of units that differ in one thing alone: the motion, a state, a relation, an
    ingredient, or a label with another letter, so that somebody can decide whether they are meant to be one.

    Prices of units (in JSON) are not written, since FOON text has no place for them; import keeps them.
    Copies of a unit with different prices are an error, unless a line of --unit-prices chooses one.

    The summary goes to stderr. Exits with 0, or with 2 when something is not understood.
    """
    for path in paths:
        if not path.exists():
            raise UserError(f"{path}: no such file or folder")
    files = list(dict.fromkeys(file for path in paths for file in network_files(path)))
    to_stdout = output is None or str(output) == "-"
    if output is not None and not to_stdout and any(same_file(output, file) for file in files):
        raise UserError(f"{output} is one of the files to merge: write to another")
    reader = FoonReader(lenient)
    builder = NetworkBuilder()
    copies = 0
    for file in files:
        for motion, inputs, outputs, sources in reader.file_units(file):
            builder.add(motion, inputs, outputs, *sources)
            copies += 1
    for warning in summarize(reader.diagnostics):
        click.echo(warning, err=True)
    reader.raise_errors()
    reader.prices.settled(read_unit_prices(unit_prices).units if unit_prices else {})
    network = builder.build()
    if not len(network):
        raise UserError("there is no functional unit in these files")
    of = counted(len(files), "file", ",")
    comment = f"Universal FOON: {counted(len(network), 'functional unit', ',')} from {of}"
    content = utf_8("".join(merged_text(network, comment)))
    if output is None or to_stdout:
        write_data(content)
    else:
        write_whole(output, content)
    if report:
        click.echo(fitted(functools.partial(kept_apart_text, network)), err=True, nl=False)
    click.echo(
        "\n".join(_summary(len(files), copies, network, len(reader.prices), reader.left_out)), err=True
    )
    return ExitCode.DONE


def _summary(files: int, copies: int, network: Network, prices: int, left_out: int) -> Iterator[str]:
    yield _row(files, "file")
    yield _row(copies, "unit") + " read"
    yield f"{copies - len(network):>8,}  of them duplicates"
    yield _row(len(network), "distinct unit")
    yield _row(len(network.objects), "object node")
    if prices:
        yield _row(prices, "price") + " of units, which are not in the result"
    if left_out:
        yield _row(left_out, "line") + f" that {'is' if left_out == 1 else 'are'} in no unit"


def _row(number: int, noun: str) -> str:
    return counted(number, f" {noun}", ">8,")
