"""Findings of linting as SARIF 2.1.0, which code hosts and editors show beside the files."""

import urllib.parse
from collections.abc import Sequence
from pathlib import Path

from foon_asp.linting.catalog import CATALOG
from foon_asp.text.diagnostics import Diagnostic, Severity
from foon_asp.text.json_value import Json

_SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"
_LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.NOTE: "note"}


def lint_sarif(findings: Sequence[Diagnostic], version: str) -> Json:
    """Give one run with every finding, and with the rules that they name; columns count code points."""
    codes = [code for code in CATALOG if any(finding.code == code for finding in findings)]
    rules = [
        {
            "id": code,
            "shortDescription": {"text": CATALOG[code].meaning},
            "defaultConfiguration": {"level": _LEVELS[CATALOG[code].severity]},
        }
        for code in codes
    ]
    driver = {"name": "foon-asp", "version": version, "rules": rules}
    results = [_result(finding, codes.index(finding.code)) for finding in findings]
    run = {"tool": {"driver": driver}, "columnKind": "unicodeCodePoints", "results": results}
    return {"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]}


def _result(finding: Diagnostic, rule: int) -> Json:
    region: Json = {"startLine": max(1, finding.source.line), "startColumn": max(1, finding.source.column)}
    if finding.excerpt:
        region["snippet"] = {"text": finding.excerpt}
    place = {"artifactLocation": {"uri": _uri(finding.source.file)}, "region": region}
    result: Json = {
        "ruleId": finding.code,
        "ruleIndex": rule,
        "level": _LEVELS[finding.severity],
        "message": {"text": finding.message},
        "locations": [{"physicalLocation": place}],
    }
    if finding.fix is not None and not finding.unsafe and finding.excerpt:
        whole = {"startLine": finding.source.line, "startColumn": 1, "endColumn": len(finding.excerpt) + 1}
        replacement = {"deletedRegion": whole, "insertedContent": {"text": finding.fix}}
        change = {"artifactLocation": place["artifactLocation"], "replacements": [replacement]}
        result["fixes"] = [{"artifactChanges": [change]}]
    return result


def _uri(file: str) -> str:
    path = Path(file)
    return path.as_uri() if path.is_absolute() else urllib.parse.quote(path.as_posix())
