"""Linting of FOON files: errors and doubtful places."""

import dataclasses
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from msgspec import structs

from foon_asp.argument_checks import typed
from foon_asp.dataset.paths import File, as_path
from foon_asp.errors import UserError
from foon_asp.json_layout import Json, json_text, schema_name
from foon_asp.linting import linter
from foon_asp.linting.baseline import read_baseline
from foon_asp.linting.catalog import CATALOG, unknown_code_message
from foon_asp.linting.finding import Finding, SeverityCounts
from foon_asp.linting.lint_settings import find_settings
from foon_asp.linting.linted_files import with_tables
from foon_asp.questions.ending import Ending
from foon_asp.questions.result import Result
from foon_asp.report.lint_findings import (
    code_table,
    finding_lines,
    github_annotations,
    sarif_log,
    summary_line,
)
from foon_asp.results.plain_values import plain
from foon_asp.results.table import Block, blocks_text
from foon_asp.results.table_columns import flat_row
from foon_asp.text.diagnostics import Diagnostic, Severity
from foon_asp.text.folder_files import foon_files


class Linted(Result, frozen=True, kw_only=True, tag=schema_name("lint")):
    r"""The findings of the linter in FOON files.

    Attributes:
        files: How many files were linted.
        counts: How many findings there are of each severity.
        codes: How many findings there are of each code.
        mended: How many findings --fix mended before these were found.
        known: How many findings a baseline left out.
        gone: How many findings of a baseline were not found any more.
        findings: The findings, by file and line.

    Example:
        >>> found = foon_asp.lint(contents={"egg.txt": b"//\nO\tegg\nM\tfry\nO\tegg\nS\tfried\n//\n"})
        >>> found.text()
        '1 file: nothing found\n'
    """

    ROWS = "findings"

    files: int
    counts: SeverityCounts
    codes: dict[str, int]
    mended: int
    known: int
    gone: int
    findings: tuple[Finding, ...]

    @property
    def ending(self) -> Ending:
        """``NEGATIVE`` if there are errors or warnings; notes do not count."""
        bad = self.counts.error + self.counts.warning
        return Ending.NEGATIVE if bad else Ending.DONE

    def show(self) -> Iterator[Block]:
        """Yield the findings with their lines, and a line of counts.

        Of each kind of finding in a file, the first three are shown, and the others counted.
        """
        yield from finding_lines(self.findings)
        yield self._summary()

    def statistics(self, width: int | None = None) -> str:
        """Return a table that counts the findings of each code, and a line of counts.

        Parameters:
            width: The number of columns that lines are wrapped to; ``None`` for no wrapping.
        """
        return blocks_text([code_table(self.findings), self._summary()], width)

    def _summary(self) -> str:
        """Return a line of counts."""
        return summary_line(self.findings, self.files, self.mended)

    def json_dict(self) -> Json:
        """Return the findings and the counts as plain values.

        The text or fix of a line of more than 1000 characters is null.
        """
        shortened = [
            structs.replace(finding, text=_unless_long(finding.text), fix=_unless_long(finding.fix))
            for finding in self.findings
        ]
        values: Json = plain(structs.replace(self, findings=tuple(shortened)))
        return values

    def table_rows(self) -> Iterator[Json]:
        """Return a row for each finding."""
        return map(flat_row, self.json_dict()["findings"])

    def github(self) -> str:
        """Return a workflow command of GitHub for each finding, which shows it beside its line."""
        return github_annotations(self.findings)

    def sarif(self) -> str:
        """Return the findings as SARIF 2.1.0, which code hosts and editors read."""
        from importlib.metadata import version  # noqa: PLC0415 (seldom asked for)

        return json_text(sarif_log(self.findings, version("foon-asp")))


def _unless_long(line: str | None, max_letters: int = 1000) -> str | None:
    """Return a line, or ``None`` if it has over ``max_letters``: thousands of findings might repeat it."""
    return line if line is not None and len(line) <= max_letters else None


class Findings(NamedTuple):
    """Findings in files, with their fixes.

    ``baselined``: how many findings a baseline left out.
    ``gone``: how many findings of the baseline are not found any more.
    """

    files: Sequence[Path]
    findings: list[Diagnostic]
    baselined: int = 0
    gone: int = 0

    def linted(self, mended: int = 0) -> Linted:
        """Return the findings as a result; ``mended`` is the number of findings already repaired."""
        severities = Counter(finding.severity for finding in self.findings)
        codes = Counter(finding.code for finding in self.findings)
        return Linted(
            files=len(self.files),
            counts=SeverityCounts(**{str(severity): severities[severity] for severity in Severity}),
            codes=dict(sorted(codes.items())),
            mended=mended,
            known=self.baselined,
            gone=self.gone,
            findings=tuple(map(Finding.of, self.findings)),
        )


@typed
def lint(
    *paths: File,
    select: Iterable[str] = (),
    ignore: Iterable[str] = (),
    baseline: File | None = None,
    vocabulary: File | None = None,
    contents: Mapping[str, bytes] | Mapping[Path, bytes] = MappingProxyType({}),
) -> Linted:
    r"""Find what is wrong or doubtful in networks, kitchens and lists of objects.

    Files are checked together: names are compared across all of them, and their units are one network. The
    settings of the nearest ``foon-asp.toml`` or ``pyproject.toml`` hold.

    Parameters:
        paths: Files, and folders of files.
        select: The codes to report; all by default.
        ignore: Codes to leave out.
        baseline: A file of known findings, which are left out.
        vocabulary: A file of names that are spelt correctly, in place of the bundled one.
        contents: The content of files that are not to be read from disk, by path.

    Returns:
        The findings, by file and line.

    Raises:
        UserError: for a file that cannot be read, and an unknown code.

    Example:
        >>> recipe = b"//\nO\tegg\nM\tfry\nO\tegg \nS\tfried\n//\n"
        >>> found = foon_asp.lint(contents={"egg.txt": recipe})
        >>> [(finding.line, finding.code) for finding in found.findings]
        [(4, 'outer-space')]
    """
    texts = {as_path(file): content for file, content in contents.items()}
    return find_findings(
        map(as_path, paths),
        texts,
        tuple(select),
        tuple(ignore),
        None if baseline is None else as_path(baseline),
        None if vocabulary is None else as_path(vocabulary),
    ).linted()


def find_findings(
    paths: Iterable[Path],
    contents: Mapping[Path, bytes],
    select: Sequence[str],
    ignore: Sequence[str],
    baseline: Path | None,
    vocabulary: Path | None,
) -> Findings:
    """Return the findings of :func:`lint`, with their fixes and the counts of the ``baseline``.

    ``select`` replaces the codes that settings select or ignore; ``ignore`` is added to the ignored codes.
    Raises :class:`UserError` for an unknown code, and without a file to lint.
    """
    for code in (*select, *ignore):
        if code not in CATALOG:
            raise UserError(unknown_code_message(code))
    files = linted_files(paths, contents)
    if not files:
        raise UserError("name the files to lint")
    settings = find_settings(files)
    if select:
        settings = dataclasses.replace(settings, select=tuple(select), ignore=())
    settings = dataclasses.replace(settings, ignore=(*settings.ignore, *ignore))
    baselined = None if baseline is None else read_baseline(baseline)
    findings = settings.apply(linter.lint(files, contents, vocabulary))
    if baseline is None or baselined is None:
        return Findings(files, findings)
    new, gone = baselined.compare_with(baseline, findings)
    return Findings(files, new, len(findings) - len(new), gone)


def linted_files(paths: Iterable[Path], contents: Iterable[Path] = ()) -> Sequence[Path]:
    """Return all files to lint, each once: files in ``paths``, files in their folders, and ``contents``.

    Tables in the folders are among the files. ``contents`` are the paths of files whose content is not read
    from disk.
    """
    path_list = list(paths)
    on_disk = with_tables(path_list, (file for file, _ in foon_files(path_list)))
    return list(dict.fromkeys([*on_disk, *contents]))
