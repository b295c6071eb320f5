"""What is wrong in FOON files, or doubtful."""

import dataclasses
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

from foon_asp.dataset.paths import File, as_path
from foon_asp.errors import UserError
from foon_asp.linting import linter
from foon_asp.linting.baseline import read_baseline
from foon_asp.linting.catalog import CATALOG, unknown_code
from foon_asp.linting.linted_files import with_tables
from foon_asp.linting.settings import find_settings
from foon_asp.questions.result import Ending, Result
from foon_asp.report.lint_findings import (
    lint_annotations,
    lint_json,
    lint_statistics,
    lint_summary,
    lint_text,
)
from foon_asp.report.lint_sarif import lint_sarif
from foon_asp.results.plain import flat_row
from foon_asp.results.table import rendered
from foon_asp.text.diagnostics import Diagnostic, Severity
from foon_asp.text.folder_files import foon_files
from foon_asp.text.json_value import Json, json_text, schema_name
from foon_asp.typed import typed


class Linted(Result, frozen=True, tag=schema_name("lint")):
    r"""The ``findings`` in ``files``, by file and line.

    Each finding has a ``severity``, ``code``, ``message`` and ``source``, and where the line can be repaired,
    ``fix``. Of a baseline, ``known`` counts the findings that it left out, and ``gone`` those of its own that
    were not found any more. ``mended`` counts findings that were repaired before.

    Example:
        >>> found = foon_asp.lint(contents={"egg.txt": b"//\nO\tegg\nM\tfry\nO\tegg\nS\tfried\n//\n"})
        >>> found.text()
        '1 file: nothing found\n'
    """

    findings: tuple[Diagnostic, ...]
    files: tuple[Path, ...]
    known: int = 0
    gone: int = 0
    mended: int = 0

    @property
    def ending(self) -> Ending:
        """How it ended: negative where there are errors or warnings, for which notes do not count."""
        bad = any(finding.severity is not Severity.NOTE for finding in self.findings)
        return Ending.NEGATIVE if bad else Ending.DONE

    def text(self) -> str:
        """Return the findings with their lines, those of one kind in a file folded, and a line of counts."""
        return lint_text(self.findings, len(self.files), self.mended)

    def statistics(self, width: int | None = None) -> str:
        """Return a table that counts the findings of each code, and a line of counts.

        Parameters:
            width: The columns of a terminal; without it, lines are as long as they are.
        """
        summary = lint_summary(self.findings, len(self.files), self.mended)
        return rendered([lint_statistics(self.findings), summary], width)

    def json_dict(self) -> Json:
        """Return every finding, and the counts, as plain values."""
        return lint_json(self.findings, len(self.files), self.mended)

    def table_rows(self) -> Iterator[Json]:
        """Return a row for each finding."""
        return map(flat_row, self.json_dict()["findings"])

    def github(self) -> str:
        """Return a workflow command of GitHub for each finding, which shows it beside its line."""
        return lint_annotations(self.findings)

    def sarif(self) -> str:
        """Return the findings as SARIF 2.1.0, which code hosts and editors read."""
        from importlib.metadata import version  # noqa: PLC0415 (seldom asked for)

        return json_text(lint_sarif(self.findings, version("foon-asp")))


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
        vocabulary: A file of names that are spelt correctly, in place of ours.
        contents: The content of files that are not to be read from disk, by path.

    Returns:
        The findings, by file and line.

    Raises:
        UserError: for a file that cannot be read, and a code that is none.

    Example:
        >>> recipe = b"//\nO\tegg\nM\tfry\nO\tegg \nS\tfried\n//\n"
        >>> found = foon_asp.lint(contents={"egg.txt": recipe})
        >>> [(finding.source.line, finding.code) for finding in found.findings]
        [(4, 'outer-space')]
    """
    selected, ignored = tuple(select), tuple(ignore)
    for code in (*selected, *ignored):
        if code not in CATALOG:
            raise UserError(unknown_code(code))
    texts = {as_path(file): content for file, content in contents.items()}
    files = linted_files(map(as_path, paths), texts)
    if not files:
        raise UserError("name the files to lint")
    settings = find_settings(files)
    if selected:
        settings = dataclasses.replace(settings, select=selected, ignore=())
    settings = dataclasses.replace(settings, ignore=(*settings.ignore, *ignored))
    known = None if baseline is None else read_baseline(as_path(baseline))
    names = None if vocabulary is None else as_path(vocabulary)
    found = settings.applied(linter.lint(files, texts, names))
    if known is None:
        return Linted(tuple(found), tuple(files))
    new = tuple(known.new(found))
    return Linted(new, tuple(files), len(found) - len(new), known.gone(found))


def linted_files(paths: Iterable[Path], contents: Iterable[Path] = ()) -> Sequence[Path]:
    """Return the files that are linted for these paths: those of folders, tables, and what is not on disk."""
    named = list(paths)
    on_disk = with_tables(named, (file for file, _ in foon_files(named)))
    return list(dict.fromkeys([*on_disk, *contents]))
