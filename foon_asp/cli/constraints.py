"""``foon-asp constraints``: the ready-made constraints and their parameters."""

import click

from foon_asp.asp.constraint_library import library_constraints
from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.report.constraint_list import constraints_json, constraints_text
from foon_asp.text.json_value import json_text


@click.command("constraints")
@options.format_option("text", "json")
@options.debug_option
def command(format_: str) -> ExitCode:
    """List the ready-made constraints: what each demands, and how to use it.

    Add the last line of an entry to solve, why-not, shopping-list or clash. A constraint is a file of a few
    lines; the docs (writing-constraints.md) teach writing one of your own.
    """
    listed = library_constraints()
    click.echo(
        json_text(constraints_json(listed)) if format_ == "json" else constraints_text(listed), nl=False
    )
    return ExitCode.DONE
