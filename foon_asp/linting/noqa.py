"""Comments that silence linting: ``# noqa: near-name`` above a line, or ``# noqa`` for everything there."""

import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from foon_asp.linting.catalog import CATALOG
from foon_asp.linting.sheet import Sheet
from foon_asp.text.diagnostics import Diagnostic

_COMMENT = re.compile(r"#\s*noqa\b\s*(?P<colon>:?)(?P<codes>.*)", re.IGNORECASE)


class _Silence(NamedTuple):
    """A comment: its index, the number of the line it is about, and the codes, none for all."""

    at: int
    line: int
    codes: frozenset[str]


def silencing(code: str) -> str:
    """Give the comment that silences a code on the next line."""
    return f"# noqa: {code}"


def unsilenced(findings: Iterable[Diagnostic], sheets: Iterable[Sheet]) -> Iterator[Diagnostic]:
    """Leave out what comments silence, and give a finding for a comment that silences nothing or no code.

    A comment is about the next line that is neither blank nor a comment. JSON has no comments.
    """
    silences: dict[tuple[str, int], list[_Silence]] = {}
    for sheet in sheets:
        if sheet.places is None:
            for silence, unknown in _silences(sheet):
                silences.setdefault((sheet.file, silence.line), []).append(silence)
                for code in unknown:
                    message = f"there is no code {code!r}; this comment does not silence it"
                    yield sheet.finding("noqa", message, silence.at, code)
    used: set[_Silence] = set()
    for finding in findings:
        here = silences.get((finding.source.file, finding.source.line), ())
        by = {silence for silence in here if not silence.codes or finding.code in silence.codes}
        used |= by
        if not by:
            yield finding
    for sheet in sheets:
        for silence in (s for (file, _), listed in silences.items() if file == sheet.file for s in listed):
            known = silence.codes & CATALOG.keys()
            if silence not in used and (known or not silence.codes):
                what = f"no {' or '.join(sorted(known))}" if known else "nothing"
                message = f"there is {what} to silence on line {silence.line}; leave the comment out"
                yield sheet.finding("noqa", message, silence.at)


def _silences(sheet: Sheet) -> Iterator[tuple[_Silence, list[str]]]:
    """Give every comment, with the codes in it that there are not."""
    waiting: list[tuple[int, list[str]]] = []
    for index, line in enumerate(sheet.lines):
        if match := _COMMENT.match(line) if line[:1] == "#" else None:
            codes = re.findall(r"[^\s,]+", match["codes"]) if match["colon"] else []
            waiting.append((index, codes))
        elif waiting and line[:1] != "#" and line.strip():
            for at, codes in waiting:
                yield _Silence(at, index + 1, frozenset(codes)), [c for c in codes if c not in CATALOG]
            waiting = []
    for at, codes in waiting:  # at the end of the file there is nothing it could be about
        yield _Silence(at, len(sheet.lines), frozenset(codes)), [c for c in codes if c not in CATALOG]
