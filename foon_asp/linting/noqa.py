"""Comments above a line that silence its findings: ``# noqa: near-name``, or ``# noqa`` for all codes."""

import re
from collections.abc import Iterator
from typing import NamedTuple

from foon_asp.linting.context import Context
from foon_asp.linting.rule import RULES, WARNING, rule
from foon_asp.linting.sheet import Sheet
from foon_asp.text.diagnostics import Diagnostic

_COMMENT = re.compile(r"#\s*noqa\b\s*(?P<colon>:?)(?P<codes>.*)", re.IGNORECASE)


class _Comment(NamedTuple):
    """A comment: its index, the number of the line that it is about, and its codes, empty for all codes."""

    at: int
    line: int
    codes: tuple[str, ...]

    def silences(self, finding: Diagnostic) -> bool:
        """Whether a finding in the same file is left out."""
        return finding.source.line == self.line and (not self.codes or finding.code in self.codes)


def silencing(code: str) -> str:
    """Return the comment that silences a code on the next line."""
    return f"# noqa: {code}"


def unsilenced(context: Context) -> Iterator[Diagnostic]:
    """Yield the findings that no comment silences."""
    comments = {sheet.file: _comments(sheet) for sheet in _commented(context)}
    for finding in context.findings:
        if not any(comment.silences(finding) for comment in comments.get(finding.source.file, ())):
            yield finding


@rule("noqa", WARNING, "a noqa comment that silences nothing")
def noqa(context: Context) -> Iterator[Diagnostic]:
    """The finding that it silenced is gone, or the code is misspelt.

    A comment is about the next line that is neither blank nor a comment, and about findings whose place is
    that line.
    """
    for sheet in _commented(context):
        sheet_findings = [finding for finding in context.findings if finding.source.file == sheet.file]
        for comment in _comments(sheet):
            for code in comment.codes:
                if code not in RULES:
                    message = f"there is no code {code!r}; this comment does not silence it"
                    yield sheet.finding(message, comment.at, code)
            known_codes = sorted(RULES.keys() & comment.codes)
            if (known_codes or not comment.codes) and not any(map(comment.silences, sheet_findings)):
                silenced = f"no {' or '.join(known_codes)}" if known_codes else "nothing"
                message = f"there is {silenced} to silence on line {comment.line}; leave the comment out"
                yield sheet.finding(message, comment.at)


def _commented(context: Context) -> Iterator[Sheet]:
    """Yield the sheets and tables that can have comments; JSON has none."""
    for sheet in (*context.sheets, *context.files.tables):
        if any(line.startswith("#") and _COMMENT.match(line) for line in sheet.lines):
            yield sheet


def _comments(sheet: Sheet) -> list[_Comment]:
    """Return the comments of a sheet; comments after the last content are about the last line."""
    comments: list[_Comment] = []
    following = len(sheet.lines)
    for index in range(len(sheet.lines) - 1, -1, -1):
        line = sheet.lines[index]
        if not line.startswith("#") and line.strip():
            following = index + 1
        elif match := _COMMENT.match(line):
            codes = re.findall(r"[^\s,]+", match["codes"]) if match["colon"] else []
            comments.insert(0, _Comment(index, following, tuple(codes)))
    return comments
