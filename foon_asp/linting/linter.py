"""All findings about files that belong together."""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from pathlib import Path
from types import MappingProxyType

from foon_asp.linting.block_rules import block_findings
from foon_asp.linting.bracket_rules import bracket_findings, without_doubtful_fixes
from foon_asp.linting.change_rules import change_findings
from foon_asp.linting.cycle_rules import cycle_findings
from foon_asp.linting.flag_rules import flag_findings
from foon_asp.linting.flow_rules import flow_findings
from foon_asp.linting.goal_rules import goal_findings
from foon_asp.linting.id_rules import id_findings
from foon_asp.linting.letter_rules import letter_findings
from foon_asp.linting.linted_files import LintedFiles
from foon_asp.linting.name_rules import name_findings
from foon_asp.linting.names import Names
from foon_asp.linting.noqa import unsilenced
from foon_asp.linting.place_rules import place_findings
from foon_asp.linting.table_rules import table_findings
from foon_asp.linting.time_rules import time_findings
from foon_asp.linting.unit_rules import unit_findings
from foon_asp.linting.vocabulary import Vocabulary, read_vocabulary
from foon_asp.resources import bundled_vocabulary
from foon_asp.text.diagnostics import Diagnostic


def lint(
    files: Iterable[Path],
    contents: Mapping[Path, bytes] = MappingProxyType({}),
    vocabulary: Path | None = None,
) -> list[Diagnostic]:
    """Lint networks, kitchens and lists of goals together; findings by file, line and column.

    ``contents`` are the bytes of files that are not to be read from disk. What ``# noqa`` comments silence is
    left out.

    Names are compared over all files, and with those of a ``vocabulary`` or of the bundled one; the units of
    all files are one network. The severity of a finding is that of its code in the catalog; ``fix`` is the
    mended line where mending changes nothing of what is understood. Raises
    :class:`foon_asp.errors.UserError` for a file that cannot be opened.
    """
    return lint_names(Names(LintedFiles(files, contents)), vocabulary)


def lint_names(names: Names, vocabulary: Path | None = None) -> list[Diagnostic]:
    """Return the findings about files that were read, as :func:`lint` does."""
    linted = names.files
    known = read_vocabulary(vocabulary or bundled_vocabulary())
    findings: list[Diagnostic] = []
    for rule in _RULES:
        findings += rule(linted)
    findings += flow_findings(names)
    findings += place_findings(names)
    findings += name_findings(names, known)
    findings += table_findings(names, known)
    findings += cycle_findings(names, known)
    known.add(Vocabulary.of(names))
    findings += without_doubtful_fixes(linted.remarks(), known, linted.reader)
    findings += bracket_findings(names, known)
    findings += change_findings(names, known)
    findings = list(unsilenced(findings, [*linted.sheets, *linted.tables]))
    order = {sheet.file: number for number, sheet in enumerate([*linted.sheets, *linted.tables])}
    return sorted(
        findings, key=lambda f: (order.get(f.source.file, 0), f.source.line, f.source.column, f.code)
    )


def _sheet_by_sheet(files: LintedFiles) -> Iterator[Diagnostic]:
    for sheet in files.sheets:
        yield from flag_findings(sheet)
        yield from block_findings(sheet)
        yield from id_findings(sheet)


_RULES: Collection[Callable[[LintedFiles], Iterator[Diagnostic]]] = (
    _sheet_by_sheet,
    letter_findings,
    time_findings,
    unit_findings,
    goal_findings,
)
