"""``foon-asp lint``: findings in FOON files, their fixes, and the baseline of known ones."""

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import click

from foon_asp.cli import shared_options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.named_path import NamedPath
from foon_asp.cli.output import terminal_width_and_colour, write_data, write_output, write_parts
from foon_asp.cli.output_file import check_outputs, refuse_inputs
from foon_asp.cli.shown_diff import show_diff
from foon_asp.errors import UserError
from foon_asp.json_layout import json_text
from foon_asp.linting.baseline import Baseline, check_replaceable
from foon_asp.linting.catalog import CATALOG, unknown_code_message
from foon_asp.linting.context import Context
from foon_asp.linting.example import read_example
from foon_asp.linting.linted_files import LintedFiles
from foon_asp.linting.mending import is_mendable, mend
from foon_asp.linting.vocabulary import Vocabulary
from foon_asp.network import counted
from foon_asp.questions.ending import Ending
from foon_asp.questions.lint import Findings, Linted, find_findings, linted_files
from foon_asp.questions.question import TABLES
from foon_asp.report.rule_page import rule_page
from foon_asp.results.plain_values import plain
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.plain_file import plain_text, read_content
from foon_asp.whole_file import utf_8, write_whole


def _complete_code(_: click.Context, __: click.Parameter, incomplete: str) -> list[str]:
    """Return the codes of the linter that begin with an incomplete word."""
    return [code for code in CATALOG if code.startswith(incomplete)]


def _explain(context: click.Context, _: click.Parameter, code: str | None) -> None:
    """Print the explanation of a code, and end the command; without a code, do nothing.

    Raises :class:`UserError` for an unknown code.
    """
    if code is None or context.resilient_parsing:
        return
    if code not in CATALOG:
        raise UserError(unknown_code_message(code))
    write_parts(rule_page(CATALOG[code], read_example(code)))
    context.exit()


_STDIN = "-"


@click.command("lint")
@shared_options.files_argument
@click.option("--fix", is_flag=True, help="Repair what is safe to repair, in the files themselves.")
@click.option("--diff", is_flag=True, help="Show what --fix would change, and write nothing.")
@click.option(
    "--unsafe-fixes",
    is_flag=True,
    help="With --fix and --diff: repair also what changes the meaning, such as misspelt names.",
)
@click.option(
    "--select",
    multiple=True,
    shell_complete=_complete_code,
    metavar="CODE",
    help="Report only this kind; repeatable.",
)
@click.option(
    "--ignore",
    multiple=True,
    shell_complete=_complete_code,
    metavar="CODE",
    help="Leave this kind out; repeatable.",
)
@click.option(
    "--baseline",
    type=click.Path(path_type=NamedPath),
    metavar="FILE",
    help="Leave out the findings that this file lists.",
)
@click.option("--write-baseline", is_flag=True, help="Write the present findings into the --baseline file.")
@click.option("--statistics", is_flag=True, help="Count the findings of each kind instead of listing them.")
@click.option(
    "--stdin-filename",
    type=click.Path(path_type=NamedPath),
    metavar="FILE",
    help="The name of the file whose text is on standard input, if - is among the files.",
)
@click.option(
    "--vocabulary",
    type=click.Path(path_type=NamedPath, exists=True, dir_okay=False),
    metavar="FILE",
    help="Names that are spelt correctly, in place of the built-in ones; --learn writes such a file.",
)
@click.option(
    "--explain",
    callback=_explain,
    expose_value=False,
    is_eager=True,
    shell_complete=_complete_code,
    metavar="CODE",
    help="Show what a code means, with an example, and lint nothing.",
)
@click.option("--learn", is_flag=True, help="Collect the names that lint checks other files against.")
@shared_options.output_option("FILE", "Where to write the names with --learn; stdout, if not given.")
@shared_options.format_option(*TABLES, "github", "sarif")
@shared_options.debug_option
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
    learn: bool,
    output: Path | None,
    format_: str,
) -> ExitCode:
    """Find errors and doubtful places in networks, kitchens and lists of goals.

    \b
    foon-asp lint recipe.txt                    one file
    foon-asp lint recipes/ kitchen.json         files that belong together
    foon-asp lint --diff recipes/               show what is safe to repair
    foon-asp lint --fix recipes/                repair it
    foon-asp lint --ignore near-name recipes/
    foon-asp lint --explain near-name
    foon-asp lint --learn universal/ -o names.txt
    foon-asp lint --vocabulary names.txt recipes/
    foon-asp lint - --stdin-filename recipe.txt < recipe.txt

    Files are checked together: names are compared across all of them, and their units are one network. Every
    finding has a code, which --explain explains with an example. The text folds many findings of one kind
    in a file into one; the other formats list all.

    --fix corrects lines that were understood in spite of a slip: what the file says does not change, and
    neither does any other byte. --unsafe-fixes also corrects what changes the meaning: look at --diff first.

    A comment line "# noqa: CODE" silences a kind on the next line. The table [tool.foon-asp.lint] of a
    foon-asp.toml or pyproject.toml, in the folder of the files or above it, has select, ignore, per-file and
    severity. With --baseline FILE, only findings that FILE does not list count.

    --learn collects the names of objects, utensils, states, motions and relations, the brackets of relations
    and what the units with a motion do, from files that were checked: all in them counts as spelt correctly.
    docs/lint.md describes the file, which may be edited.

    Exits with 0 when there is nothing to report but notes, with 1 when there are errors or warnings (that
    --fix did not repair) or when --diff shows something, and with 2 when a file could not be opened.
    """
    on_disk = [path for path in paths if str(path) != _STDIN]
    stdin = len(on_disk) < len(paths)
    if output is not None:
        check_outputs(linted_files(on_disk))
    for misused, message in (
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
        (output and not learn, "-o FILE goes with --learn"),
        (
            learn and (stdin or fix or diff or baseline or statistics or format_ != "text"),
            "--learn FILE|DIR... -o FILE collects names: leave out all other options",
        ),
    ):
        if misused:
            raise UserError(message)
    if learn:
        return _write_vocabulary(linted_files(on_disk), output)
    contents = {stdin_filename or Path("<stdin>"): sys.stdin.buffer.read()} if stdin else {}
    if baseline and write_baseline:
        refuse_inputs(baseline, [*linted_files(on_disk, contents), *filter(None, [vocabulary])])
        check_replaceable(baseline)
        findings = find_findings(on_disk, contents, select, ignore, None, vocabulary).findings
        write_whole(baseline, utf_8(json_text(plain(Baseline.of(baseline, findings)))))
        click.echo(f"wrote {baseline}: {counted(len(findings), 'finding')}", err=True)
        return ExitCode.DONE
    found = find_findings(on_disk, contents, select, ignore, baseline, vocabulary)
    mendable_count = 0
    if fix or diff:
        repaired = _repair(found, contents, unsafe_fixes)
        mendable_count = sum(is_mendable(finding, unsafe_fixes) for finding in found.findings)
        if diff:
            return _show_repairs(repaired, mendable_count)
        contents = _write_repairs(repaired, contents)
        found = find_findings(on_disk, contents, select, ignore, baseline, vocabulary)
        for content in contents.values():  # the mended text of standard input
            write_data(content)
    linted = found.linted(mended=mendable_count)
    _report(linted, statistics, format_, err=fix and stdin)
    if baseline:
        _report_baseline(linted)
    return ExitCode.NEGATIVE if linted.ending is Ending.NEGATIVE else ExitCode.DONE


def _write_vocabulary(files: Sequence[Path], output: Path | None) -> ExitCode:
    """Write the names in files as a vocabulary, which ``--vocabulary`` reads.

    ``output``: ``None`` for stdout. Raises :class:`UserError` for files with errors.
    """
    linted = LintedFiles(files)
    linted.reader.raise_errors()
    context = Context(linted)
    write_output(output, utf_8(Vocabulary.of(context.names, context.habits).text()))
    return ExitCode.DONE


_Repaired = Mapping[Path, tuple[bytes, bytes]]  # the content of a file before and after


def _repair(found: Findings, contents: Mapping[Path, bytes], unsafe: bool) -> _Repaired:
    """Return the content before and after the repair, for each file with a finding that can be repaired.

    ``contents`` are the contents of files that are not read from disk. ``unsafe`` adds fixes that change the
    meaning. Nothing is written. Raises :class:`UserError` for a path that is no file.
    """
    fixes: dict[str, list[Diagnostic]] = {}
    for finding in found.findings:
        if is_mendable(finding, unsafe):
            fixes.setdefault(finding.source.file, []).append(finding)
    repaired = {}
    for file in (file for file in found.files if str(file) in fixes):
        if file not in contents and not file.is_file():
            raise UserError(f"{file}: not a file that can be written; --fix repairs files in place")
        old_content = contents[file] if file in contents else read_content(file)
        repaired[file] = old_content, mend(old_content, fixes[str(file)], unsafe)
    return repaired


def _write_repairs(repaired: _Repaired, contents: Mapping[Path, bytes]) -> dict[Path, bytes]:
    """Write the repaired files that changed; return ``contents`` after the repair.

    Files in ``contents`` are not written. Each written file is reported on stderr.
    """
    for file, (old_content, new_content) in repaired.items():
        if old_content != new_content and file not in contents:
            write_whole(file, new_content)
            click.echo(f"wrote {file}", err=True)
    return {file: repaired[file][1] if file in repaired else content for file, content in contents.items()}


def _show_repairs(repaired: _Repaired, finding_count: int) -> ExitCode:
    """Print the diff of the repairs; return ``NEGATIVE`` if a file would change, else ``DONE``.

    ``finding_count`` is the number of findings that would be repaired, which is printed to stderr.
    """
    for file, (old_content, new_content) in repaired.items():
        show_diff(str(file), plain_text(old_content, file), plain_text(new_content, file))
    changed = sum(old_content != new_content for old_content, new_content in repaired.values())
    click.echo(f"would mend {counted(finding_count, 'finding')} in {counted(changed, 'file')}", err=True)
    return ExitCode.NEGATIVE if changed else ExitCode.DONE


def _report(linted: Linted, statistics: bool, format_: str, err: bool) -> None:
    """Print the findings in a format, or with ``statistics`` a text with their counts by code.

    If ``err``, formats other than ``github`` and ``json`` are printed to standard error. The format
    ``github`` is printed without escapes, since a program reads it.
    """
    if format_ == "github":
        write_data(linted.github())
    elif format_ == "json":
        click.echo(linted.json_text(), nl=False)
    else:
        text = linted.statistics(terminal_width_and_colour()[0]) if statistics else getattr(linted, format_)()
        click.echo(text, nl=False, err=err)


def _report_baseline(linted: Linted) -> None:
    """Print to stderr how many findings the baseline left out, and how many in it no longer occur."""
    text = f"{counted(linted.known, 'known finding')} left out"
    if linted.gone:
        text += f"; {linted.gone} in the baseline {'is' if linted.gone == 1 else 'are'} gone: "
        text += "--write-baseline takes note"
    click.echo(text, err=True)
