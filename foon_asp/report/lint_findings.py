"""Findings of linting for people, for programs, and as annotations that GitHub shows beside a change."""

from collections import Counter
from collections.abc import Iterator, Sequence

from foon_asp.document.json_document import document
from foon_asp.escapes import UNSAFE, escaped
from foon_asp.linting.catalog import CATALOG
from foon_asp.linting.example import Example
from foon_asp.linting.mending import is_mendable
from foon_asp.linting.rule import Rule
from foon_asp.network import counted
from foon_asp.results.table import Part, Table
from foon_asp.text.diagnostics import Diagnostic, Severity
from foon_asp.text.json_value import Json

_IN_FULL = 3  # findings of a kind in a file; the lines of the others are named
_LINES = 12
_LONGEST = 1000  # letters: thousands of findings on one line would repeat it thousands of times
_COMMANDS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.NOTE: "notice"}


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
        lines.append(_with_code(finding))
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
        return text
    safe = sum(is_mendable(finding) for finding in findings)
    unsafe = sum(is_mendable(finding, unsafe=True) for finding in findings) - safe
    if safe:
        text += f"; --fix would mend {safe}"
    if unsafe:
        text += f"; --unsafe-fixes {unsafe}{' more' if safe else ''}"
    return text


def lint_statistics(findings: Sequence[Diagnostic]) -> Table:
    """Return the number of findings of each code, most of them first, and of those that can be mended."""
    rows = []
    for code, count in Counter(finding.code for finding in findings).most_common():
        of_code = [finding for finding in findings if finding.code == code]
        safe = sum(is_mendable(finding) for finding in of_code)
        unsafe = sum(is_mendable(finding, unsafe=True) for finding in of_code) - safe
        mends = [f"{safe} safely"] * bool(safe) + [f"{unsafe} unsafely"] * bool(unsafe)
        rows.append((str(count), str(of_code[0].severity), code, ", ".join(mends), CATALOG[code].meaning))
    headings = "count", "severity", "code", "mends", "meaning"
    return Table(headings, rows, left=frozenset({1, 2, 3, 4}), headed=bool(rows))


def explained(rule: Rule, example: Example) -> Iterator[Part]:
    """Return what a rule means, its example with tabs drawn as ``→``, and what it finds there."""
    yield f"{rule.code}: {rule.severity}: {rule.meaning}"
    for paragraph in rule.explanation.split("\n\n"):
        yield from ("", paragraph.replace("\n", " "))
    for name, text in example_texts(example):
        yield from ("", f"{name}:", *(f"    {line}" for line in text.splitlines()))
    yield ""
    yield from example_findings(example).splitlines()


def example_texts(example: Example) -> Iterator[tuple[str, str]]:
    """Yield the name and the text of each file of an example, with tabs drawn as ``→``."""
    for file, content in example.files.items():
        yield str(file), content.decode(errors="replace").replace("\t", "→")


def example_findings(example: Example) -> str:
    """Return what is found in an example, as :func:`lint_text` shows it."""
    return "".join(f"{_with_code(finding)}\n" for finding in example.findings)


def _with_code(finding: Diagnostic) -> str:
    head, *excerpt = str(finding).split("\n")
    return "\n".join([f"{head} [{finding.code}]", *excerpt])


def _folded(others: Sequence[Diagnostic]) -> str:
    numbers = list(dict.fromkeys(str(finding.source.line) for finding in others))
    places = ", ".join(numbers[:_LINES]) + (", ..." if len(numbers) > _LINES else "")
    on = "line" if len(numbers) == 1 else "lines"
    return f"    ... and {len(others)} more of this kind in this file, on {on} {places} [{others[0].code}]"


def lint_json(findings: Sequence[Diagnostic], files: int, mended: int) -> Json:
    """Give every finding, and the counts.

    ``text`` is the line and ``fix`` the line as it should be, where it can be mended. Both are ``null`` where
    the line is longer than a thousand letters; ``mendable`` says in any case whether --fix mends the
    finding, and ``unsafe`` whether only --unsafe-fixes does.
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
                "mendable": is_mendable(finding),
                "unsafe": is_mendable(finding, unsafe=True) and not is_mendable(finding),
            }
            for finding in findings
        ],
    )


def _short(line: str | None) -> str | None:
    return line if line is not None and len(line) <= _LONGEST else None


def lint_annotations(findings: Sequence[Diagnostic]) -> str:
    """Give a workflow command for each finding: ``::warning file=...,line=...,col=...,title=...::...``.

    The characters that would end a command or a property are escaped as GitHub's own toolkit does.
    """
    lines = []
    for severity, code, message, source, *_ in findings:
        place = f"file={_property(source.file)},line={source.line},col={source.column}"
        lines.append(f"::{_COMMANDS[severity]} {place},title={_property(code)}::{_data(message)}\n")
    return "".join(lines)


def _data(text: str) -> str:
    written = text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")
    return UNSAFE.sub(lambda found: escaped(found[0]), written)


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
