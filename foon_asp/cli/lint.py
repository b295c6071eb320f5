"""``foon-asp lint``: what is wrong with FOON files, or worth a look."""

from collections.abc import Sequence
from pathlib import Path

import click

from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.output import write_data
from foon_asp.errors import UserError
from foon_asp.lint.catalog import CATALOG
from foon_asp.lint.linter import lint
from foon_asp.lint.mending import mended
from foon_asp.questions.contract import TABLES
from foon_asp.report.frame import document_text
from foon_asp.report.lint_findings import lint_annotations, lint_json, lint_text
from foon_asp.report.whole_file import write_whole
from foon_asp.text.diagnostics import Diagnostic, Severity
from foon_asp.text.folder_files import foon_files

_CODE = click.Choice(list(CATALOG))


@click.command("lint")
@options.files_argument(required=True)
@click.option("--fix", is_flag=True, help="Repair what is safe to repair, in the files themselves.")
@click.option(
    "--select", multiple=True, type=_CODE, metavar="CODE", help="Report this kind only; repeatable."
)
@click.option("--ignore", multiple=True, type=_CODE, metavar="CODE", help="Leave this kind out; repeatable.")
@options.format_option(*TABLES, "github")
@options.debug_option
def command(
    paths: tuple[Path, ...], fix: bool, select: tuple[str, ...], ignore: tuple[str, ...], format_: str
) -> ExitCode:
    """Find what is wrong with networks, kitchens and lists of goals.

    \b
    foon-asp lint recipe.txt                    one file
    foon-asp lint recipes/ kitchen.json         files that belong together
    foon-asp lint --fix recipes/                repair what is safe to repair
    foon-asp lint --ignore shared-unit recipes/

    Files are checked together: names are compared across all of them, and their units are one network. Every
    finding has a code, which docs/lint.md explains with an example. The text folds many findings of one kind
    in a file into one; json and github list all.

    --fix corrects lines that were understood in spite of a slip: what the file says does not change, and
    neither does any other byte.

    Exits with 0 when there is nothing to report but notes, with 1 when there are errors or warnings (that
    --fix did not repair), and with 2 when a file could not be opened.
    """
    files = [file for file, _ in foon_files(paths)]
    wanted = {code for code in select or CATALOG if code not in ignore}
    findings = _findings(files, wanted)
    count = 0
    if fix:
        count = _mend(files, findings)
        if count:
            findings = _findings(files, wanted)
    if format_ == "github":
        write_data(lint_annotations(findings))
    else:
        told = findings, len(files), count
        text = lint_text(*told) if format_ == "text" else document_text(lint_json(*told), format_)
        click.echo(text, nl=False)
    bad = any(finding.severity is not Severity.NOTE for finding in findings)
    return ExitCode.NEGATIVE if bad else ExitCode.DONE


def _findings(files: Sequence[Path], wanted: set[str]) -> list[Diagnostic]:
    return [finding for finding in lint(files) if finding.code in wanted]


def _mend(files: Sequence[Path], findings: Sequence[Diagnostic]) -> int:
    """Rewrite the files with repairs, and count the repaired findings."""
    fixable: dict[str, list[Diagnostic]] = {}
    for finding in findings:
        if finding.fix is not None:
            fixable.setdefault(finding.source.file, []).append(finding)
    for file in files:
        if str(file) not in fixable:
            continue
        if not file.is_file():
            raise UserError(f"{file}: not a file that can be written; --fix repairs files in place")
        content = file.read_bytes()
        new = mended(content, fixable[str(file)])
        if new != content:
            write_whole(file, new)
            click.echo(f"wrote {file}", err=True)
    return sum(map(len, fixable.values()))
