"""Files without what can be mended safely."""

import re
from codecs import BOM_UTF8
from collections.abc import Iterable

from foon_asp.text.diagnostics import Diagnostic

_LINE = re.compile(rb"([^\r\n]*)(\r\n|\r|\n|\Z)")


def mended(content: bytes, findings: Iterable[Diagnostic]) -> bytes:
    """Give the bytes of a file with the lines of findings as their ``fix`` has them.

    All other bytes stay: line ends, a byte order mark, lines without a fix, and lines that are not what they
    were when they were linted. A ``//`` that is missing behind the last unit gets the line end of that line,
    or else of the first.
    """
    fixes: dict[int, tuple[bytes, bytes]] = {}
    separated: set[int] = set()
    for finding in findings:
        if finding.code == "missing-separator":
            separated.add(finding.source.line)
        elif finding.fix is not None:
            fixes[finding.source.line] = finding.excerpt.encode(), finding.fix.encode()
    parts: list[bytes] = []
    for number, match in enumerate(_LINE.finditer(content), 1):
        text, end = match.groups()
        mark = BOM_UTF8 if number == 1 and text.startswith(BOM_UTF8) else b""
        before, after = fixes.get(number, (b"", b""))
        parts += (mark + after if number in fixes and text == mark + before else text, end)
        if number in separated:
            usual = end or parts[1] or b"\n"
            parts += (b"" if end else usual, b"//", usual)
    return b"".join(parts)
