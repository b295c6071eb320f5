"""``foon-asp schema``: the JSON Schema of the output of a verb."""

import click

from foon_asp.cli import shared_options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.errors import UserError
from foon_asp.json_layout import json_text, schema_name
from foon_asp.results.schema_file import schema, schema_kinds

_DOCUMENT_KINDS = {"solve": "answer"}  # of verbs whose documents have another name


@click.command("schema")
@click.argument("verb", required=False, metavar="[VERB]")
@shared_options.debug_option
def command(verb: str | None) -> ExitCode:
    """Print the JSON Schema of what a verb prints with --format json; without a verb, list them.

    \b
    foon-asp schema
    foon-asp schema solve > answer.schema.json

    The schemas follow the draft 2020-12; each is complete in itself. batch-row and compare-row are the lines
    of the files that batch and compare write with --results. docs/json.md has an example of every document.
    """
    kinds = schema_kinds()
    if verb is None:
        for kind in kinds:
            click.echo(f"{schema_name(kind):<26} {schema(kind)['title']}")
        return ExitCode.DONE
    kind = _DOCUMENT_KINDS.get(verb, verb)
    if kind not in kinds:
        names = ", ".join(sorted({*kinds, *_DOCUMENT_KINDS}))
        raise UserError(f"found {verb!r}, expected a verb that has a schema: {names}")
    click.echo(json_text(schema(kind)), nl=False)
    return ExitCode.DONE
