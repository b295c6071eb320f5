"""Findings of linting as text, as annotations that GitHub shows beside a change, and as SARIF."""

import urllib.parse
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

from foon_asp.escapes import UNSAFE, escaped
from foon_asp.json_layout import Json
from foon_asp.linting.catalog import CATALOG
from foon_asp.linting.finding import Finding
from foon_asp.network import counted
from foon_asp.results.table import Block, Table
from foon_asp.text.diagnostics import Severity

_COMMANDS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.NOTE: "notice"}
_SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"


def finding_lines(findings: Sequence[Finding], max_in_full: int = 3, max_lines: int = 12) -> Iterator[Block]:
    """Yield the lines of findings, which are sorted by file and line.

    For each kind of finding in a file, the first ``max_in_full`` are shown. The others are counted, with at
    most ``max_lines`` of their line numbers.
    """
    kinds: dict[tuple[str, str], list[Finding]] = {}
    for finding in findings:
        kinds.setdefault((finding.file, finding.code), []).append(finding)
    shown_counts = Counter[tuple[str, str]]()
    for finding in findings:
        kind = finding.file, finding.code
        shown_counts[kind] += 1
        if shown_counts[kind] <= max_in_full:
            yield from str(finding).split("\n")
        if shown_counts[kind] == max_in_full and (others := kinds[kind][max_in_full:]):
            numbers = list(dict.fromkeys(str(other.line) for other in others))
            lines = ", ".join(numbers[:max_lines]) + (", ..." if len(numbers) > max_lines else "")
            lines = f"line {lines}" if len(numbers) == 1 else f"lines {lines}"
            yield f"    ... and {len(others)} more of this kind in this file, on {lines} [{finding.code}]"


def summary_line(findings: Sequence[Finding], files: int, mended: int) -> str:
    """Return one line with the numbers of files, of findings by severity, and of fixes.

    ``mended`` is how many fixes were made. If it is 0, the line says how many fixes ``--fix`` would make, and
    how many ``--unsafe-fixes`` would add.
    """
    counts = Counter(finding.severity for finding in findings)
    parts = [counted(counts[severity], str(severity)) for severity in Severity if counts[severity]]
    text = f"{counted(files, 'file')}: {', '.join(parts) or 'nothing found'}"
    if mended:
        return f"{text}; {mended} mended"
    safe = sum(finding.mendable for finding in findings)
    unsafe = sum(finding.unsafe for finding in findings)
    if safe:
        text += f"; --fix would mend {safe}"
    if unsafe:
        text += f"; --unsafe-fixes {unsafe}{' more' if safe else ''}"
    return text


def code_table(findings: Sequence[Finding]) -> Table:
    """Return a table with a row for each code, the most frequent first.

    A row has the number of findings, severity, code, numbers of safe and unsafe fixes, and meaning. Without
    findings, the table is empty and has no headings.
    """
    rows = []
    for code, count in Counter(finding.code for finding in findings).most_common():
        alike = [finding for finding in findings if finding.code == code]
        safe, unsafe = sum(finding.mendable for finding in alike), sum(finding.unsafe for finding in alike)
        mends = [f"{safe} safely"] * bool(safe) + [f"{unsafe} unsafely"] * bool(unsafe)
        rows.append((str(count), str(alike[0].severity), code, ", ".join(mends), CATALOG[code].meaning))
    headings = "count", "severity", "code", "mends", "meaning"
    return Table(headings, rows, left_aligned=frozenset({1, 2, 3, 4}), headed=bool(rows))


def github_annotations(findings: Sequence[Finding]) -> str:
    """Return a workflow command for each finding: ``::warning file=...,line=...,col=...,title=...::...``.

    The characters that would end a command or a property are escaped as GitHub's own toolkit does.
    """
    lines = []
    for finding in findings:
        file, title = _escape_property(finding.file), _escape_property(finding.code)
        location = f"file={file},line={finding.line},col={finding.column},title={title}"
        lines.append(f"::{_COMMANDS[finding.severity]} {location}::{_escape_message(finding.message)}\n")
    return "".join(lines)


def _escape_message(text: str) -> str:
    """Return a text as a message of a workflow command, with control characters escaped."""
    written = text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")
    return UNSAFE.sub(lambda match: escaped(match[0]), written)


def _escape_property(text: str) -> str:
    """Return a text as a property of a workflow command, with colons and commas escaped, too."""
    return _escape_message(text).replace(":", "%3A").replace(",", "%2C")


def sarif_log(findings: Sequence[Finding], version: str) -> Json:
    """Return findings as plain values in the format SARIF 2.1.0, with the rules that they are about.

    Code hosts and editors read it, and show findings beside the files. Columns count code points.
    """
    codes = [code for code in CATALOG if any(finding.code == code for finding in findings)]
    rules = [
        {
            "id": code,
            "shortDescription": {"text": CATALOG[code].meaning},
            "defaultConfiguration": {"level": str(CATALOG[code].severity)},
        }
        for code in codes
    ]
    driver = {"name": "foon-asp", "version": version, "rules": rules}
    results = [_sarif_result(finding, codes.index(finding.code)) for finding in findings]
    run = {"tool": {"driver": driver}, "columnKind": "unicodeCodePoints", "results": results}
    return {"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]}


def _sarif_result(finding: Finding, rule: int) -> Json:
    """Return a finding as a result of SARIF, with its fix if that is safe.

    ``rule`` is the index of its rule, from 0. The fix replaces the whole line; if the text of the line is not
    known, the fix is left out.
    """
    region: Json = {"startLine": max(1, finding.line), "startColumn": max(1, finding.column)}
    if finding.text:
        region["snippet"] = {"text": finding.text}
    path = Path(finding.file)
    uri = path.as_uri() if path.is_absolute() else urllib.parse.quote(path.as_posix())
    location = {"artifactLocation": {"uri": uri}, "region": region}
    result: Json = {
        "ruleId": finding.code,
        "ruleIndex": rule,
        "level": str(finding.severity),
        "message": {"text": finding.message},
        "locations": [{"physicalLocation": location}],
    }
    if finding.mendable and finding.text:
        line_region = {"startLine": finding.line, "startColumn": 1, "endColumn": len(finding.text) + 1}
        replacement = {"deletedRegion": line_region, "insertedContent": {"text": finding.fix}}
        change = {"artifactLocation": location["artifactLocation"], "replacements": [replacement]}
        result["fixes"] = [{"artifactChanges": [change]}]
    return result
