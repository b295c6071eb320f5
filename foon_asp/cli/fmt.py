"""``foon-asp fmt``: FOON files in canonical form."""

from pathlib import Path

import click

from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.output import write_data
from foon_asp.errors import UserError
from foon_asp.network import counted
from foon_asp.report.whole_file import write_whole
from foon_asp.text.diagnostics import Diagnostic, InputError
from foon_asp.text.folder_files import foon_files
from foon_asp.text.formatter import Change, format_text
from foon_asp.text.plain_file import read_plain_text


@click.command("fmt")
@options.files_argument(required=True)
@click.option(
    "--check", is_flag=True, help="Write nothing; list the files that would change, and exit with 1."
)
@options.output_option(
    "FILE", "Write the result for a single file there, or with - to stdout; the file stays as it is."
)
@click.option("--lenient", is_flag=True, help="Leave lines that are not understood as they are.")
@options.debug_option
def command(paths: tuple[Path, ...], check: bool, output: Path | None, lenient: bool) -> ExitCode:
    """Bring FOON files into canonical form; each file is rewritten.

    \b
    foon-asp fmt recipe.txt             format one file
    foon-asp fmt recipes/               format a folder with all that is in it
    foon-asp fmt --check recipes/       list the files that are not in canonical form
    foon-asp fmt recipe.txt -o -        print the result

    Common slips of annotators are repaired if it is clear what was meant: an open bracket or one of the wrong
    kind, an empty ingredient, a flag 00, a time such as 1:35]. Blanks at the end of a line are removed, and
    so is a byte order mark. Every line ends like most lines of its file; a missing last line end and a
    missing // after the last unit are added. Everything else stays: ids, flags, times, comments, blank lines,
    the order of lines, and blanks within a line, on which `lint` remarks. The network read from the file is
    the same before and after, and formatting twice changes nothing more. In JSON only the layout changes.

    A file with lines that are not understood stays as it is; these lines are listed. Exits with 0 when all
    files are in canonical form now, with 1 when --check found one that is not, and with 2 when a file could
    not be read.
    """
    files = [file for file, _ in foon_files(paths)]
    if output is not None and (check or len(files) > 1):
        raise UserError("-o is for a single file" + (" without --check" if check else ""))
    errors: list[Diagnostic] = []
    changed = 0
    for file in files:
        try:
            formatted = format_text(read_plain_text(file), str(file), lenient)
        except InputError as error:
            errors += error.diagnostics
            continue
        if output is not None:
            _write(output, formatted.content)
        elif formatted.content != file.read_bytes():
            changed += 1
            if check:
                click.echo(_summary(file, formatted.changes))
            else:
                _write(file, formatted.content)
    _report(len(files), changed, len({error.source.file for error in errors}), check)
    if errors:
        raise InputError(errors)
    return ExitCode.NEGATIVE if check and changed else ExitCode.DONE


def _write(file: Path, content: bytes) -> None:
    if str(file) == "-":
        write_data(content)
    else:
        write_whole(file, content)
        click.echo(f"wrote {file}", err=True)


def _summary(file: Path, changes: tuple[Change, ...]) -> str:
    """Count the lines that would change, and show the first."""
    if not changes:
        return f"{file}:1: would lose its byte order mark"
    line, before, after = changes[0]
    text = f"{file}:{line}: {counted(len(changes), 'line')} would change" + (
        ", first this one:" if len(changes) > 1 else ":"
    )
    if before == after:
        return f"{text} its line end"
    return f"{text}\n  - {_shown(before)}" + "".join(f"\n  + {_shown(part)}" for part in after.split("\n"))


def _shown(line: str, width: int = 100) -> str:
    """Show a line with visible tabs and final blanks."""
    bare = line.rstrip(" ")
    shown = (bare + "·" * (len(line) - len(bare))).replace("\t", "→")
    shown = shown if len(shown) <= width else shown[:width] + "..."
    return "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in shown)


def _report(files: int, changed: int, refused: int, check: bool) -> None:
    if files < 2:
        return
    verb = "would change" if check else "changed"
    parts = [f"{changed} {verb}", f"{files - changed - refused} in canonical form"]
    if refused:
        parts.append(f"{refused} not understood")
    click.echo(f"{files} files: {', '.join(parts)}", err=True)
