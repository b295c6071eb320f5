"""Findings of linting for programs."""

import json
from collections import Counter
from collections.abc import Sequence

from foon_asp.text import Diagnostic, Severity


def lint_json(findings: Sequence[Diagnostic], files: int, mended: int) -> str:
    """Give every finding, with ``fix`` the line as it should be or ``null``, and the counts."""
    severities = Counter(finding.severity for finding in findings)
    result = {
        "files": files,
        "counts": {str(severity): severities[severity] for severity in Severity},
        "codes": dict(sorted(Counter(finding.code for finding in findings).items())),
        "mended": mended,
        "findings": [
            {
                "file": finding.source.file,
                "line": finding.source.line,
                "column": finding.source.column,
                "severity": str(finding.severity),
                "code": finding.code,
                "message": finding.message,
                "text": finding.excerpt,
                "fix": finding.fix,
            }
            for finding in findings
        ],
    }
    return json.dumps(result, indent=2, ensure_ascii=False) + "\n"
