"""The linter: all findings of all rules about files that belong together."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from types import MappingProxyType

from foon_asp.linting.catalog import CATALOG
from foon_asp.linting.context import Context
from foon_asp.linting.linted_files import LintedFiles
from foon_asp.linting.noqa import unsilenced_findings
from foon_asp.text.diagnostics import Diagnostic

_ABOUT_FINDINGS = "noqa"


def lint(
    files: Iterable[Path],
    contents: Mapping[Path, bytes] = MappingProxyType({}),
    vocabulary: Path | None = None,
) -> list[Diagnostic]:
    """Lint networks, kitchens and lists of goals together; return findings by file, line and column.

    ``contents`` are the bytes of files that are not to be read from disk. ``vocabulary`` is the vocabulary
    file; for ``None``, the bundled one is read.

    The units of all files form one network. Names are compared over all files, and with those of the
    vocabulary. Findings that a ``# noqa`` comment silences are left out. The severity of a finding is that of
    its rule. ``fix`` is the mended line where mending does not change what is read. Raises
    :class:`foon_asp.errors.UserError` for a file that cannot be opened.
    """
    return lint_context(Context(LintedFiles(files, contents), vocabulary))


def lint_context(context: Context) -> list[Diagnostic]:
    """Return the findings about files that were read; they are sorted and silenced as in :func:`lint`.

    The findings of all rules but ``noqa`` are also added to ``context.findings``, including silenced ones.
    """
    for rule in CATALOG.values():
        if rule.code != _ABOUT_FINDINGS:
            context.findings += rule.findings(context)
    findings = [*unsilenced_findings(context), *CATALOG[_ABOUT_FINDINGS].findings(context)]
    order = {sheet.file: number for number, sheet in enumerate([*context.sheets, *context.files.tables])}

    def sort_key(finding: Diagnostic) -> tuple[int, int, int, str]:
        """Return the position of the file of a finding, its line, its column, and its code."""
        source = finding.source
        return order.get(source.file, 0), source.line, source.column, finding.code

    return sorted(findings, key=sort_key)
