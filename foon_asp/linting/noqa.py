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
    """A ``# noqa`` comment.

    ``comment_index`` is its index in the lines of the sheet. ``line`` is the number, from 1, of the line that
    it is about. ``codes`` are the codes that it silences; empty for all codes.
    """

    comment_index: int
    line: int
    codes: tuple[str, ...]

    def silences(self, finding: Diagnostic) -> bool:
        """Whether the comment silences a finding of the same file."""
        return finding.source.line == self.line and (not self.codes or finding.code in self.codes)


def silencing_comment(code: str) -> str:
    """Return the comment that silences a code on the next line: ``# noqa: near-name``."""
    return f"# noqa: {code}"


def unsilenced_findings(context: Context) -> Iterator[Diagnostic]:
    """Yield the findings of the context that no comment silences."""
    comments = {sheet.file: _noqa_comments(sheet) for sheet in _commented_sheets(context)}
    for finding in context.findings:
        if not any(comment.silences(finding) for comment in comments.get(finding.source.file, ())):
            yield finding


@rule("noqa", WARNING, "a noqa comment that silences nothing")
def find_useless_comments(context: Context) -> Iterator[Diagnostic]:
    """The comment silences nothing: the finding that it silenced is gone, or its code is misspelt.

    A comment is about the next line that is neither blank nor a comment. It silences findings at that line.
    """
    for sheet in _commented_sheets(context):
        sheet_findings = [finding for finding in context.findings if finding.source.file == sheet.file]
        for comment in _noqa_comments(sheet):
            for code in comment.codes:
                if code not in RULES:
                    message = f"there is no code {code!r}; this comment does not silence it"
                    yield sheet.finding(message, comment.comment_index, code)
            known_codes = sorted(RULES.keys() & comment.codes)
            if (known_codes or not comment.codes) and not any(map(comment.silences, sheet_findings)):
                silenced = f"no {' or '.join(known_codes)}" if known_codes else "nothing"
                message = f"there is {silenced} to silence on line {comment.line}; leave the comment out"
                yield sheet.finding(message, comment.comment_index)


def _commented_sheets(context: Context) -> Iterator[Sheet]:
    """Yield the sheets and tables that have noqa comments."""
    for sheet in (*context.sheets, *context.files.tables):
        if any(line.startswith("#") and _COMMENT.match(line) for line in sheet.lines):
            yield sheet


def _noqa_comments(sheet: Sheet) -> list[_Comment]:
    """Return the noqa comments of a sheet, in order.

    Comments below the last line with content are about the last line of the sheet. Without a colon after
    ``noqa``, a comment silences all codes.
    """
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
