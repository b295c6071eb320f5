"""``foon-asp lsp``: a language server for editors."""

import click

from foon_asp.cli import shared_options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.editor.language_server import serve_editor


@click.command("lsp")
@shared_options.debug_option
def command() -> ExitCode:
    """Serve an editor that edits FOON text, over standard input and output (the Language Server Protocol).

    Findings of `lint` while typing, with quick fixes; completion of objects, states, motions and ids; hovers
    with the units that make and need a node, and whether it is available; jumps to the unit that makes it;
    renaming; an outline of the units; folding and formatting. docs/editor.md says how to set up an editor.

    Exits with 0 when the editor ends it, and with 1 when it sends exit before shutdown.
    """
    return ExitCode.DONE if serve_editor() else ExitCode.NEGATIVE
