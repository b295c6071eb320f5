"""``foon-asp vocabulary``: the names that FOONs know, for ``foon-asp lint --vocabulary``."""

from pathlib import Path

import click

from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.output import write_data
from foon_asp.lint.linted_files import LintedFiles, with_tables
from foon_asp.lint.names import Names
from foon_asp.lint.vocabulary import Vocabulary
from foon_asp.report.whole_file import utf_8, write_whole
from foon_asp.text.folder_files import foon_files


@click.command("vocabulary")
@options.files_argument(required=True)
@options.output_option("FILE", "Write the vocabulary there, or with - to stdout, as without it.")
@options.debug_option
def command(paths: tuple[Path, ...], output: Path | None) -> ExitCode:
    """Learn the names of FOONs: objects, utensils, states, motions and relations.

    \b
    foon-asp vocabulary universal/ -o names.txt     learn from a folder
    foon-asp lint --vocabulary names.txt new.txt    and hold a recipe against it

    Everything in the files counts as spelt correctly, so learn from files that were looked through. The
    brackets of relations and what the units with a motion do are learned, too. docs/lint.md describes the
    file, which may be edited.
    """
    files = with_tables(paths, (file for file, _ in foon_files(paths)))
    linted = LintedFiles(files)
    linted.reader.raise_errors()
    text = utf_8(Vocabulary.of(Names(linted)).text())
    if output is None or str(output) == "-":
        write_data(text.decode())
    else:
        write_whole(output, text)
        click.echo(f"wrote {output}", err=True)
    return ExitCode.DONE
