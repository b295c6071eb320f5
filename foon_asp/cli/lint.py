"""``foon-asp lint``: what is wrong with FOON files, or worth a look."""

import dataclasses
import functools
import sys
from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from pathlib import Path

import click

from foon_asp import __version__
from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.named_path import NamedPath
from foon_asp.cli.output import fitted, write_data
from foon_asp.cli.shown_diff import show_diff
from foon_asp.errors import UserError
from foon_asp.lint.baseline import Baseline, baseline_json, read_baseline
from foon_asp.lint.catalog import CATALOG
from foon_asp.lint.linted_files import with_tables
from foon_asp.lint.linter import lint
from foon_asp.lint.mending import is_mendable, mended
from foon_asp.lint.settings import find_settings
from foon_asp.network import counted
from foon_asp.questions.contract import TABLES
from foon_asp.report.frame import document_text
from foon_asp.report.lint_findings import (
    lint_annotations,
    lint_json,
    lint_statistics,
    lint_summary,
    lint_text,
)
from foon_asp.report.lint_sarif import lint_sarif
from foon_asp.report.whole_file import utf_8, write_whole
from foon_asp.text.diagnostics import Diagnostic, Severity
from foon_asp.text.folder_files import foon_files
from foon_asp.text.json_value import json_text
from foon_asp.text.plain_file import plain_text, read_content


class _Code(click.Choice[str]):
    """The code of a rule; of a misspelt one the nearest is named, and not all sixty."""

    def get_invalid_choice_message(self, value: object, ctx: click.Context | None) -> str:
        """Say what was given, and what may be meant."""
        near = get_close_matches(str(value), self.choices, n=1)
        hint = f"did you mean {near[0]!r}?" if near else "docs/lint.md lists them"
        return f"{value!r} is no kind of finding; {hint}"


_CODE = _Code(list(CATALOG))
_STDIN = "-"


@click.command("lint")
@options.files_argument(required=True)
@click.option("--fix", is_flag=True, help="Repair what is safe to repair, in the files themselves.")
@click.option("--diff", is_flag=True, help="Show what --fix would change, and write nothing.")
@click.option(
    "--unsafe-fixes",
    is_flag=True,
    help="With --fix and --diff: repair also what changes the meaning, such as misspelt names.",
)
@click.option(
    "--select", multiple=True, type=_CODE, metavar="CODE", help="Report this kind only; repeatable."
)
@click.option("--ignore", multiple=True, type=_CODE, metavar="CODE", help="Leave this kind out; repeatable.")
@click.option(
    "--baseline",
    type=click.Path(path_type=NamedPath),
    metavar="FILE",
    help="Leave out the findings that this file knows.",
)
@click.option("--write-baseline", is_flag=True, help="Write the present findings into the --baseline file.")
@click.option("--statistics", is_flag=True, help="Count the findings of each kind instead of listing them.")
@click.option(
    "--stdin-filename",
    type=click.Path(path_type=NamedPath),
    metavar="FILE",
    help="What the text on standard input is the content of, if - is among the files.",
)
@click.option(
    "--vocabulary",
    type=click.Path(path_type=NamedPath, exists=True, dir_okay=False),
    metavar="FILE",
    help="Names that are spelt correctly, in place of ours; foon-asp vocabulary writes such a file.",
)
@options.format_option(*TABLES, "github", "sarif")
@options.debug_option
def command(
    paths: tuple[Path, ...],
    fix: bool,
    diff: bool,
    unsafe_fixes: bool,
    select: tuple[str, ...],
    ignore: tuple[str, ...],
    baseline: Path | None,
    write_baseline: bool,
    statistics: bool,
    stdin_filename: Path | None,
    vocabulary: Path | None,
    format_: str,
) -> ExitCode:
    """Find what is wrong with networks, kitchens and lists of goals.

    \b
    foon-asp lint recipe.txt                    one file
    foon-asp lint recipes/ kitchen.json         files that belong together
    foon-asp lint --diff recipes/               show what is safe to repair
    foon-asp lint --fix recipes/                repair it
    foon-asp lint --ignore near-name recipes/
    foon-asp lint --vocabulary names.txt recipes/
    foon-asp lint - --stdin-filename recipe.txt < recipe.txt

    Files are checked together: names are compared across all of them, and their units are one network. Every
    finding has a code, which docs/lint.md explains with an example. The text folds many findings of one kind
    in a file into one; the other formats list all.

    --fix corrects lines that were understood in spite of a slip: what the file says does not change, and
    neither does any other byte. --unsafe-fixes also corrects what changes the meaning: look at --diff first.

    A comment line "# noqa: CODE" silences a kind on the next line. The table [tool.foon-asp.lint] of a
    foon-asp.toml or pyproject.toml, in the folder of the files or above it, has select, ignore, per-file and
    severity. With --baseline FILE, only findings that FILE does not know count.

    Exits with 0 when there is nothing to report but notes, with 1 when there are errors or warnings (that
    --fix did not repair) or when --diff shows something, and with 2 when a file could not be opened.
    """
    _check(paths, fix, diff, unsafe_fixes, baseline, write_baseline, statistics, stdin_filename, format_)
    files, contents = _files(paths, stdin_filename)
    settings = find_settings(files)
    if select:
        settings = dataclasses.replace(settings, select=select, ignore=())
    settings = dataclasses.replace(settings, ignore=(*settings.ignore, *ignore))
    known = read_baseline(baseline) if baseline and not write_baseline else None
    all_findings = settings.applied(lint(files, contents, vocabulary))
    if baseline and write_baseline:
        write_whole(baseline, utf_8(json_text(baseline_json(baseline, all_findings))))
        click.echo(f"wrote {baseline}: {counted(len(all_findings), 'finding')}", err=True)
        return ExitCode.DONE
    findings = known.new(all_findings) if known else all_findings
    if diff:
        return _show(files, findings, contents, unsafe_fixes)
    count = 0
    if fix:
        count, fixed = _mend(files, findings, contents, unsafe_fixes)
        if count:
            all_findings = settings.applied(lint(files, fixed, vocabulary))
            findings = known.new(all_findings) if known else all_findings
        for content in fixed.values():  # the mended text of standard input
            write_data(content)
    _report(findings, len(files), count, statistics, format_, err=fix and bool(contents))
    if known:
        _say_known(known, all_findings, findings)
    bad = any(finding.severity is not Severity.NOTE for finding in findings)
    return ExitCode.NEGATIVE if bad else ExitCode.DONE


def _check(
    paths: Sequence[Path],
    fix: bool,
    diff: bool,
    unsafe_fixes: bool,
    baseline: Path | None,
    write_baseline: bool,
    statistics: bool,
    stdin_filename: Path | None,
    format_: str,
) -> None:
    """Refuse options that do not go together."""
    stdin = any(str(path) == _STDIN for path in paths)
    for wrong, words in (
        (fix and diff, "--fix repairs and --diff only shows: give one of them"),
        (unsafe_fixes and not (fix or diff), "--unsafe-fixes goes with --fix or --diff"),
        (write_baseline and not baseline, "--write-baseline needs --baseline FILE, the file to write"),
        (write_baseline and (fix or diff), "--write-baseline goes without --fix and --diff"),
        (statistics and format_ != "text", "--statistics is for --format text; json has the counts as codes"),
        (
            diff and (statistics or format_ != "text"),
            "--diff prints a diff: leave --statistics and --format out",
        ),
        (stdin_filename and not stdin, "--stdin-filename goes with -, standard input"),
        (fix and stdin and format_ != "text", "--fix prints the mended text of -: leave --format out"),
    ):
        if wrong:
            raise UserError(words)


def _files(paths: Sequence[Path], stdin_filename: Path | None) -> tuple[list[Path], Mapping[Path, bytes]]:
    """Give the files, and the content of the one that is on standard input, which stands for that on disk."""
    on_disk = [path for path in paths if str(path) != _STDIN]
    files = with_tables(on_disk, (file for file, _ in foon_files(on_disk)))
    if len(on_disk) == len(paths):
        return files, {}
    name = stdin_filename or Path("<stdin>")
    return list(dict.fromkeys([*files, name])), {name: sys.stdin.buffer.read()}


def _mend(
    files: Sequence[Path], findings: Sequence[Diagnostic], contents: Mapping[Path, bytes], unsafe: bool
) -> tuple[int, dict[Path, bytes]]:
    """Rewrite the files with repairs; count the repaired findings, and give what is not written to a file."""
    fixable = _fixable(findings, unsafe)
    given = {file: mended(content, fixable.get(str(file), ()), unsafe) for file, content in contents.items()}
    for file in files:
        if str(file) not in fixable or file in contents:
            continue
        if not file.is_file():
            raise UserError(f"{file}: not a file that can be written; --fix repairs files in place")
        content = file.read_bytes()
        new = mended(content, fixable[str(file)], unsafe)
        if new != content:
            write_whole(file, new)
            click.echo(f"wrote {file}", err=True)
    return sum(map(len, fixable.values())), given


def _show(
    files: Sequence[Path], findings: Sequence[Diagnostic], contents: Mapping[Path, bytes], unsafe: bool
) -> ExitCode:
    """Show what would be repaired."""
    fixable = _fixable(findings, unsafe)
    changed = 0
    for file in files:
        if str(file) in fixable:
            before = contents[file] if file in contents else read_content(file)
            after = mended(before, fixable[str(file)], unsafe)
            changed += before != after
            show_diff(str(file), plain_text(before, file), plain_text(after, file))
    would = f"would mend {counted(sum(map(len, fixable.values())), 'finding')} in {counted(changed, 'file')}"
    click.echo(would, err=True)
    return ExitCode.NEGATIVE if changed else ExitCode.DONE


def _fixable(findings: Sequence[Diagnostic], unsafe: bool) -> dict[str, list[Diagnostic]]:
    fixable: dict[str, list[Diagnostic]] = {}
    for finding in findings:
        if is_mendable(finding, unsafe):
            fixable.setdefault(finding.source.file, []).append(finding)
    return fixable


def _report(
    findings: Sequence[Diagnostic], files: int, count: int, statistics: bool, format_: str, err: bool
) -> None:
    if format_ == "github":
        write_data(lint_annotations(findings))
        return
    if format_ == "sarif":
        text = json_text(lint_sarif(findings, __version__))
    elif format_ != "text":
        text = document_text(lint_json(findings, files, count), format_)
    elif statistics:
        text = (
            f"{fitted(functools.partial(lint_statistics, findings))}{lint_summary(findings, files, count)}\n"
        )
    else:
        text = lint_text(findings, files, count)
    click.echo(text, nl=False, err=err)


def _say_known(known: Baseline, findings: Sequence[Diagnostic], new: Sequence[Diagnostic]) -> None:
    """Say how many findings the baseline left out, and how many in it are gone."""
    text = f"{counted(len(findings) - len(new), 'known finding')} left out"
    if gone := known.gone(findings):
        text += f"; {gone} in the baseline {'is' if gone == 1 else 'are'} gone: --write-baseline takes note"
    click.echo(text, err=True)
