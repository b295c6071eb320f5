"""Findings of linting for people."""

from collections import Counter
from collections.abc import Sequence

from foon_asp.network import counted
from foon_asp.text.diagnostics import Diagnostic, Severity

_IN_FULL = 3  # findings of a kind in a file; the lines of the others are named
_LINES = 12


def lint_text(findings: Sequence[Diagnostic], files: int, mended: int) -> str:
    """Show sorted findings with their lines, fold what there are many of, and end with a line of counts.

    ``files`` counts the files that were linted, ``mended`` what was mended in them.
    """
    kinds: dict[tuple[str, str], list[Diagnostic]] = {}
    for finding in findings:
        kinds.setdefault((finding.source.file, finding.code), []).append(finding)
    shown: Counter[tuple[str, str]] = Counter()
    lines = []
    for finding in findings:
        kind = finding.source.file, finding.code
        shown[kind] += 1
        if shown[kind] > _IN_FULL:
            continue
        head, *excerpt = str(finding).split("\n")
        lines += [f"{head} [{finding.code}]", *excerpt]
        if shown[kind] == _IN_FULL and (others := kinds[kind][_IN_FULL:]):
            lines.append(_folded(others))
    lines.append(lint_summary(findings, files, mended))
    return "\n".join(lines) + "\n"


def lint_summary(findings: Sequence[Diagnostic], files: int, mended: int) -> str:
    """Give the counts in one line."""
    counts = Counter(finding.severity for finding in findings)
    parts = [counted(counts[severity], str(severity)) for severity in Severity if counts[severity]]
    text = f"{counted(files, 'file')}: {', '.join(parts) or 'nothing found'}"
    if mended:
        text += f"; {mended} mended"
    elif mendable := sum(1 for finding in findings if finding.fix is not None):
        text += f"; --fix would mend {mendable}"
    return text


def _folded(others: Sequence[Diagnostic]) -> str:
    numbers = list(dict.fromkeys(str(finding.source.line) for finding in others))
    places = ", ".join(numbers[:_LINES]) + (", ..." if len(numbers) > _LINES else "")
    on = "line" if len(numbers) == 1 else "lines"
    return f"    ... and {len(others)} more of this kind in this file, on {on} {places} [{others[0].code}]"
