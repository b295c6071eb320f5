"""Findings of linting for programs."""

from collections import Counter
from collections.abc import Sequence

from foon_asp.document.json_document import document
from foon_asp.text.diagnostics import Diagnostic, Severity
from foon_asp.text.json_value import Json

_LONGEST = 1000  # letters: thousands of findings on one line would repeat it thousands of times


def lint_json(findings: Sequence[Diagnostic], files: int, mended: int) -> Json:
    """Give every finding, and the counts.

    ``text`` is the line and ``fix`` the line as it should be, where it can be mended. Both are ``null`` where
    the line is longer than a thousand letters; ``mendable`` says in any case whether there is a fix.
    """
    severities = Counter(finding.severity for finding in findings)
    return document(
        "lint",
        files=files,
        counts={str(severity): severities[severity] for severity in Severity},
        codes=dict(sorted(Counter(finding.code for finding in findings).items())),
        mended=mended,
        findings=[
            {
                "file": finding.source.file,
                "line": finding.source.line,
                "column": finding.source.column,
                "severity": str(finding.severity),
                "code": finding.code,
                "message": finding.message,
                "text": _short(finding.excerpt),
                "fix": _short(finding.fix),
                "mendable": finding.fix is not None,
            }
            for finding in findings
        ],
    )


def _short(line: str | None) -> str | None:
    return line if line is not None and len(line) <= _LONGEST else None
