"""``foon-asp fmt``: FOON files in canonical form."""

from pathlib import Path

import click

from foon_asp.cli import shared_options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.output import write_output
from foon_asp.errors import UserError
from foon_asp.escapes import escaped
from foon_asp.report.line_diff import line_diff
from foon_asp.text.diagnostics import Diagnostic, InputError
from foon_asp.text.folder_files import foon_files
from foon_asp.text.formats import format_of
from foon_asp.text.plain_file import protect_byte_order_mark, read_plain_text


@click.command("fmt")
@shared_options.files_argument
@click.option("--check", is_flag=True, help="Write nothing; show what would change, and exit with 1.")
@shared_options.output_option(
    "FILE", "Write the result for a single file there, or with - to stdout; the file stays as it is."
)
@click.option("--lenient", is_flag=True, help="Leave lines that are not understood as they are.")
@shared_options.debug_option
def command(paths: tuple[Path, ...], check: bool, output: Path | None, lenient: bool) -> ExitCode:
    """Rewrite FOON files in canonical form.

    \b
    foon-asp fmt recipe.txt             format one file
    foon-asp fmt recipes/               format a folder with all that is in it
    foon-asp fmt --check recipes/       show what would change
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
    changed_count = 0
    for file in files:
        try:
            text = read_plain_text(file)
            normalised = format_of(text, str(file)).canonical_text(text, str(file), lenient)
            formatted = protect_byte_order_mark(normalised).encode()
        except InputError as error:
            errors += error.diagnostics
            continue
        if output is not None:
            write_output(output, formatted)
        elif formatted != (old_content := file.read_bytes()):
            changed_count += 1
            if check:
                click.echo(line_diff(escaped(str(file)), old_content.decode(), formatted.decode()), nl=False)
            else:
                write_output(file, formatted)
    _report(len(files), changed_count, len({error.source.file for error in errors}), check)
    if errors:
        raise InputError(errors)
    return ExitCode.NEGATIVE if check and changed_count else ExitCode.DONE


def _report(file_count: int, changed_count: int, refused_count: int, check: bool) -> None:
    """Print to stderr how many files changed, were in canonical form, and were not understood.

    With ``check``, the first number is of files that would change. Nothing is printed for a single file.
    """
    if file_count < 2:
        return
    verb = "would change" if check else "changed"
    counts = [f"{changed_count} {verb}", f"{file_count - changed_count - refused_count} in canonical form"]
    if refused_count:
        counts.append(f"{refused_count} not understood")
    click.echo(f"{file_count} files: {', '.join(counts)}", err=True)
