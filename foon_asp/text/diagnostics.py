"""Diagnostics: errors, warnings and notes about places in input files."""

from collections import Counter
from collections.abc import Sequence
from enum import StrEnum
from shlex import quote
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.escapes import escaped
from foon_asp.network import Source, counted


class Severity(StrEnum):
    """The severity of a diagnostic: an error stops the reading, a warning says what was assumed.

    Notes come from linting alone, on lines that are unusual and may be intended.
    """

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


class Rename(NamedTuple):
    """A correction that replaces a name in the whole file.

    ``kind`` is ``object``, ``state``, ``relation`` or ``motion``.
    """

    kind: str
    old: str
    new: str


class Diagnostic(NamedTuple):
    """A remark about one place in an input file.

    ``code`` is the name of the kind of remark. ``excerpt`` is the line of the file that the remark is about,
    without its line end, or empty. ``fix`` is the corrected line, ``None`` where no correction is known. A
    fix does not change what is read, unless it is ``unsafe``. ``rename`` is a correction in the whole file,
    which always changes what is read.
    """

    severity: Severity
    code: str
    message: str
    source: Source
    excerpt: str = ""
    fix: str | None = None
    unsafe: bool = False
    rename: Rename | None = None

    def __str__(self) -> str:
        """Return ``file:line:column: severity: message`` and, where known, the line with a caret."""
        file, line, column, _ = self.source
        text = f"{escaped(file)}:{line}:{column}: {self.severity}: {escaped(self.message)}"
        if self.excerpt:
            text += "\n" + excerpt_with_caret(self.excerpt, column)
        return text


def excerpt_with_caret(line: str, column: int, width: int = 100) -> str:
    """Return a line of a file, and below it a caret under ``column`` (from 1).

    Tabs are drawn as ``→``, other unprintable letters as ``�``. A line longer than ``width`` letters is cut
    around the column.
    """
    start = max(0, column - 1 - width // 2) if len(line) > width else 0
    shown = line[start : start + width].replace("\t", "→")
    shown = "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in shown)
    return f"    {shown}\n    {' ' * (column - 1 - start)}^"


class InputError(UserError):
    """Input that could not be read: ``diagnostics`` has every error, and the message shows the first 40."""

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        lines = [str(diagnostic) for diagnostic in diagnostics[:40]]
        if len(diagnostics) > 40:
            others = counted(len(diagnostics) - 40, "more error")
            lines.append(f"... and {others}; foon-asp lint lists them all")
        super().__init__("\n".join(lines))
        self.diagnostics = tuple(diagnostics)


def brief_summary(diagnostics: Sequence[Diagnostic]) -> list[str]:
    """Return the texts of :func:`summarize` if they have at most six lines, otherwise one line of counts.

    The line of counts has the number of diagnostics of each code, and names their files.
    """
    summary = summarize(diagnostics)
    if sum(1 + text.count("\n") for text in summary) <= 6:
        return summary
    kinds = Counter(diagnostic.code for diagnostic in diagnostics)
    counts = ", ".join(f"{count} {code}" for code, count in kinds.most_common())
    files = " ".join(dict.fromkeys(quote(escaped(diagnostic.source.file)) for diagnostic in diagnostics))
    return [
        f"warning: {counted(len(diagnostics), 'remark')} on the data ({counts}); see foon-asp lint {files}"
    ]


def summarize(diagnostics: Sequence[Diagnostic], max_lines: int = 5) -> list[str]:
    """Return one text for all diagnostics of a file that have the same code.

    The text has the first diagnostic in full, the number of diagnostics, and the line numbers of up to
    ``max_lines`` others.
    """
    kinds: dict[tuple[str, str], list[Diagnostic]] = {}
    for diagnostic in diagnostics:
        kinds.setdefault((diagnostic.source.file, diagnostic.code), []).append(diagnostic)
    lines = []
    for (_, code), group in kinds.items():
        text = str(group[0])
        if len(group) > 1:
            others = ", ".join(str(d.source.line) for d in group[1 : max_lines + 1])
            ellipsis = ", ..." if len(group) > max_lines + 1 else ""
            text += f"\n    {len(group)} warnings of this kind ({code}); others on line {others}{ellipsis}"
        lines.append(text)
    return lines
