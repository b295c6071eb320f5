"""Mending of files: the fixes and renames of findings are applied."""

import re
from codecs import BOM_UTF8
from collections.abc import Iterable

from foon_asp.text.diagnostics import Diagnostic, Rename
from foon_asp.text.formats import format_of
from foon_asp.text.renaming import Renaming

_LINE = re.compile(rb"([^\r\n]*)(\r\n|\r|\n|\Z)")


def is_mendable(finding: Diagnostic, unsafe: bool = False) -> bool:
    """Whether a finding has a safe fix, which does not change what is read. With ``unsafe``, any fix counts.

    A rename is an unsafe fix.
    """
    if finding.rename is not None:
        return unsafe
    return finding.fix is not None and (unsafe or not finding.unsafe)


def mend(content: bytes, findings: Iterable[Diagnostic], unsafe: bool = False) -> bytes:
    """Return the bytes of a file with the fixes of findings applied.

    With ``unsafe``, fixes that change what is read are applied, too. Renames then follow in the whole file.

    All other bytes stay: line ends, a byte order mark, and lines without a fix. A line that has changed since
    it was linted stays, too. A ``//`` that is added below the last unit gets the line end of the line above
    it. If that line has no line end, the ``//`` gets the one of the first line.
    """
    fixes: dict[int, tuple[bytes, bytes]] = {}
    unclosed_lines: set[int] = set()
    renames: list[Rename] = []
    for finding in findings:
        if not is_mendable(finding, unsafe):
            continue
        if finding.rename is not None:
            renames.append(finding.rename)
        elif finding.code == "missing-separator":
            unclosed_lines.add(finding.source.line)
        else:
            fixes[finding.source.line] = finding.excerpt.encode(), (finding.fix or "").encode()
    parts: list[bytes] = []
    for number, match in enumerate(_LINE.finditer(content), 1):
        text, line_break = match.groups()
        mark = BOM_UTF8 if number == 1 and text.startswith(BOM_UTF8) else b""
        excerpt, fix = fixes.get(number, (b"", b""))
        parts += (mark + fix if number in fixes and text == mark + excerpt else text, line_break)
        if number in unclosed_lines:
            line_end = line_break or parts[1] or b"\n"
            parts += (b"" if line_break else line_end, b"//", line_end)
    content = b"".join(parts)
    if not renames:
        return content
    mark = BOM_UTF8 if content.startswith(BOM_UTF8) else b""
    text = content.removeprefix(mark).decode()
    for rename in renames:
        renaming = Renaming(rename)
        format_ = format_of(text)
        renaming.learn(format_.mentions(text, ""))
        text = format_.renamed_text(text, "", renaming)
    return mark + text.encode()
