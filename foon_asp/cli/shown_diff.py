"""Diffs of files on standard output."""

import sys

import click

from foon_asp.cli.output import write_data
from foon_asp.escapes import escaped
from foon_asp.report.line_diff import line_diff
from foon_asp.whole_file import utf_8


def show_diff(file: str, old_text: str, new_text: str) -> None:
    """Print the diff between two texts of a file.

    The name of the file is escaped. At a terminal, the texts are escaped, too; a program gets them unchanged.
    """
    text = line_diff(escaped(file), old_text, new_text)
    if sys.stdout.isatty():
        click.echo(text, nl=False)
    else:
        write_data(utf_8(text))
