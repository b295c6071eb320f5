"""The canonical form of FOON files: what ``foon-asp fmt`` writes."""

import re
from collections.abc import Callable

from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.json_layout import check_json, lay_out, on_one_line
from foon_asp.text.line import Line, LineError, MotionLine, ObjectLine
from foon_asp.text.plain_file import is_json, is_neutral, split_lines
from foon_asp.text.reader import FoonReader
from foon_asp.text.writer import write_line

_LINE_END = re.compile(r"\r\n|\r|\n")
_MARK = "\ufeff"
_BLANKS = {"outer-space", "space-for-tab"}

Rewrite = Callable[[Line, str], str]
"""What becomes of a line, given what it says and how it is written."""


def mend(line: Line, written: str) -> str:
    """Give the canonical form of a line: itself, unless there is a remark on more than blanks in it.

    Blanks within a line stay, as the published universal FOON has them: ``{jelly, peanut butter}``, and a
    space for the tab before a bracket. Linting remarks on them.
    """
    if all(remark.code in _BLANKS for remark in line.remarks):
        return written.rstrip(" \t")
    return write_line(line)


def format_text(
    text: str, file: str, lenient: bool = False, rewrite: Rewrite = mend, reader: FoonReader | None = None
) -> str:
    """Bring a text into canonical form, line by line; it means the same before and after.

    Blanks at the end of lines go, every line ends in the way that most do, a last unit is closed by ``//``.
    Comments, blank lines and the order of everything stay, whether or not the lines make up units. In JSON
    only the layout changes. Raises :class:`InputError` with every line that cannot be understood; with
    ``lenient`` those stay as they are. ``rewrite`` says what becomes of the others; ``reader`` remembers
    lines from one text to the next.
    """
    if is_neutral(text, file):
        return _format_neutral(text, file, lenient)
    if is_json(text):
        return _format_json(text, file, lenient)
    ends = _LINE_END.findall(text)
    end = _usual(ends)
    lines = split_lines(text)
    reader = reader or FoonReader()
    errors: list[Diagnostic] = []
    written: dict[str, str] = {}
    new: list[str] = []
    for number, line in enumerate(lines, 1):
        found = written.get(line)
        if found is None:
            found, error = _format_line(line, reader, rewrite)
            if error and not lenient:
                place = Source(file, number, error.column)
                errors.append(Diagnostic(Severity.ERROR, "syntax", str(error), place, line))
            else:
                written[line] = found
        new.append(found)
    if errors:
        raise InputError(errors)
    last = len(new) - 1
    while last >= 0 and not new[last]:
        last -= 1
    if _is_open_unit(lines, reader):
        new.insert(last + 1, "//")
    if new[-1]:
        new.append("")
    return end.join(new)


def with_own_mark(text: str) -> str:
    """Return what to write for a text: a byte order mark that begins it would be lost in reading."""
    return _MARK + text if text.startswith(_MARK) else text


def _format_line(line: str, reader: FoonReader, rewrite: Rewrite) -> tuple[str, LineError | None]:
    if line[:1] == "#":
        return line, None
    if not line or line.isspace():
        return "", None
    if line.rstrip(" \t") == "//":
        return "//", None
    parsed = reader.parse(line)
    if isinstance(parsed, LineError):
        return line, parsed
    return rewrite(parsed, line), None


def _is_open_unit(lines: list[str], reader: FoonReader) -> bool:
    """Whether the lines after the last separator are a whole unit: inputs, and one motion."""
    start = len(lines)
    while start > 0 and not (lines[start - 1][:1] == "/" and lines[start - 1].rstrip(" \t") == "//"):
        start -= 1
    rest = [reader.parse(line) for line in lines[start:] if line[:1] in {"O", "M"}]
    motions = [index for index, line in enumerate(rest) if isinstance(line, MotionLine)]
    return len(motions) == 1 and any(isinstance(line, ObjectLine) for line in rest[: motions[0]])


def _format_json(text: str, file: str, lenient: bool) -> str:
    """Lay out JSON anew; the line end behind the last bracket is there or not, as before."""
    try:
        check_json(text, file)
    except InputError:
        if not lenient:
            raise
        return text
    end = _usual(_LINE_END.findall(text))
    laid_out = lay_out(text) + ("\n" if text.rstrip(" \t")[-1:] in {"\r", "\n"} else "")
    return laid_out.replace("\n", end)


def _format_neutral(text: str, file: str, lenient: bool) -> str:
    """Lay out each line of the neutral form anew; a line that cannot be understood stays if ``lenient``."""
    from foon_asp.text.neutral_units import read_neutral_units  # noqa: PLC0415 (most files are none)

    lines = split_lines(text.removeprefix(_MARK))
    diagnostics: list[Diagnostic] = []
    understood = {unit.source.line for unit in read_neutral_units(lines, file, diagnostics, lenient)}
    errors = [found for found in diagnostics if found.severity is Severity.ERROR]
    if errors:
        raise InputError(errors)
    new = [on_one_line(line) if number in understood else line for number, line in enumerate(lines, 1)]
    if new[-1]:
        new.append("")
    end = _usual(_LINE_END.findall(text))
    return end.join(new)


def _usual(ends: list[str]) -> str:
    """Give the line end that most lines have."""
    return max(("\n", "\r\n", "\r"), key=ends.count)
