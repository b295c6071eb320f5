"""FOON text as a format: object, state and motion lines, with ``//`` between units."""

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from foon_asp.network import NodePattern, Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.format import Dialect, Format, Writer
from foon_asp.text.line import Line, LineError, Mention, MotionLine, ObjectLine, line_names
from foon_asp.text.line_parser import read_line
from foon_asp.text.listed_unit import ListedUnit, ObjectBlock, ReadUnit
from foon_asp.text.plain_file import map_lines, split_lines, text_pieces, usual_line_end
from foon_asp.text.reading import Reading
from foon_asp.text.text_units import TextUnits
from foon_asp.text.writer import write_line

if TYPE_CHECKING:
    from foon_asp.text.conversion_ids import Numbering
    from foon_asp.text.renaming import Renaming

_BLANKS = {"outer-space", "space-for-tab"}

Rewrite = Callable[[Line, str], str]
"""A function that returns the new text of a line from the parsed line and its text."""


class FoonText(Format):
    """FOON text in any of its dialects; the format of every text that no other format recognises."""

    dialects: tuple[Dialect, ...] = (Dialect.PLAIN, Dialect.NO_IDS, Dialect.IDS)
    suffix = list_suffix = ".txt"
    has_comments = True
    piece_letters: ClassVar[int] = 1_000_000
    """The number of letters of a file that are read at a time."""

    def recognises(self, text: str, file: str) -> bool:
        """Return true, since any text may be FOON text."""
        return True

    def dialect(self, text: str) -> Dialect:
        """Return ``IDS`` if a line has an id, else ``NO_IDS`` if one has a flag or a time, else ``PLAIN``."""
        dialect = Dialect.PLAIN
        for line in self.lines(text):
            if line.id:
                return Dialect.IDS
            if isinstance(line, ObjectLine | MotionLine) and line.fields:
                dialect = Dialect.NO_IDS
        return dialect

    def lists_objects(self, text: str) -> bool:
        """Whether the text has object lines and no motion lines."""
        starts = {line[:1] for line in split_lines(text)}
        return "O" in starts and "M" not in starts

    def file_units(self, file: Path, reading: Reading) -> Iterator[ReadUnit]:
        """Yield the units of a file in order; the file is read in pieces of a million letters."""
        return TextUnits(text_pieces(file, self.piece_letters), str(file), reading).units()

    def units(self, text: str, file: str, reading: Reading) -> Iterator[ReadUnit]:
        """Yield the units of a text in order, without their lines but with their amounts.

        A node that a unit lists twice counts once, with the greatest of its amounts.
        """
        return _text_units(text, file, reading).units()

    def listed_units(self, text: str, file: str, reading: Reading) -> Iterator[ListedUnit]:
        """Yield the units of a text in order, with their lines as written."""
        return _text_units(text, file, reading).listed_units()

    def objects(self, text: str, file: str, reading: Reading) -> Iterator[tuple[ObjectBlock, NodePattern]]:
        """Yield the objects of a kitchen or of goals, each with a pattern that only its node matches."""
        for block in _text_units(text, file, reading).objects():
            yield block, NodePattern.of(block.node)

    def lines(self, text: str) -> Iterator[Line]:
        """Yield the object, state and motion lines that can be understood."""
        for written in split_lines(text):
            if written[:1] in {"O", "S", "M"} and not isinstance(line := read_line(written), LineError):
                yield line

    def canonical_text(self, text: str, file: str, lenient: bool = False) -> str:
        """Return a text in canonical form, line by line.

        If the reader remarks only on the blanks of a line, the blanks within it stay. Raises as
        :func:`rewrite_lines` does.
        """
        return rewrite_lines(text, file, lenient, _mend_line)

    def mentions(self, text: str, file: str) -> Iterator[Mention]:
        """Yield every mention of a name in lines that can be understood."""
        for line in self.lines(text):
            yield from line_names(line)

    def renamed_text(self, text: str, file: str, renaming: "Renaming") -> str:
        """Return a text with the new name; see :class:`~foon_asp.text.renaming.Renaming`."""
        return map_lines(text, renaming.line)

    def writer(self, target: Dialect, numbering: "Numbering") -> Writer:
        """Return a writer of FOON text in the dialect ``target``; ids come from ``numbering``."""
        from foon_asp.text.text_writer import TextWriter  # noqa: PLC0415 (only for conversions)

        return TextWriter(target, numbering)


def _text_units(text: str, file: str, reading: Reading) -> TextUnits:
    """Return the reader of the units of a text, whose line ends may be of any kind."""
    return TextUnits([text.replace("\r\n", "\n").replace("\r", "\n")], file, reading)


def rewrite_lines(text: str, file: str, lenient: bool, rewrite: Rewrite) -> str:
    """Return a text in which ``rewrite`` has rewritten each object, state and motion line.

    ``rewrite`` is called once for equal lines. Comments and the order of lines stay, also where lines form no
    unit. Blank lines become empty, and blanks after ``//`` are removed. All lines get the most frequent line
    end. A last unit without ``//`` gets it.

    Raises one :class:`InputError` with all lines that cannot be understood; if ``lenient``, these stay
    unchanged.
    """
    lines = split_lines(text)
    errors: list[Diagnostic] = []
    rewritten_lines: dict[str, str] = {}
    new_lines: list[str] = []
    for number, line in enumerate(lines, 1):
        new_line = rewritten_lines.get(line)
        if new_line is None:
            new_line, error = _rewrite_line(line, rewrite)
            if error and not lenient:
                source = Source(file, number, error.column)
                errors.append(Diagnostic(Severity.ERROR, "syntax", str(error), source, line))
            else:
                rewritten_lines[line] = new_line
        new_lines.append(new_line)
    if errors:
        raise InputError(errors)
    last_line = len(new_lines) - 1
    while last_line >= 0 and not new_lines[last_line]:
        last_line -= 1
    if _ends_in_open_unit(lines):
        new_lines.insert(last_line + 1, "//")
    if new_lines[-1]:
        new_lines.append("")
    return usual_line_end(text).join(new_lines)


def _mend_line(line: Line, written: str) -> str:
    """Return the canonical form of a line.

    If all remarks on a line are about blanks, the line keeps the blanks within it. The published universal
    FOON has such blanks: ``{jelly, peanut butter}``, and a space for the tab before a bracket. Linting
    reports them.
    """
    if all(remark.code in _BLANKS for remark in line.remarks):
        return written.rstrip(" \t")
    return write_line(line)


def _rewrite_line(line: str, rewrite: Rewrite) -> tuple[str, LineError | None]:
    """Return a line as ``rewrite`` writes it, and its error, which is ``None`` for most lines.

    A line that cannot be understood has an error, and stays unchanged. Comments stay, too. Blanks are removed
    from blank lines and behind ``//``.
    """
    if line[:1] == "#":
        return line, None
    if not line or line.isspace():
        return "", None
    if line.rstrip(" \t") == "//":
        return "//", None
    parsed = read_line(line)
    if isinstance(parsed, LineError):
        return line, parsed
    return rewrite(parsed, line), None


def _ends_in_open_unit(lines: list[str]) -> bool:
    """Whether the lines after the last ``//`` form a unit: they have one motion, and an object before it."""
    start = len(lines)
    while start > 0 and not re.fullmatch(r"//[ \t]*", lines[start - 1]):
        start -= 1
    parsed_lines = [read_line(line) for line in lines[start:] if line[:1] in {"O", "M"}]
    motions = [index for index, line in enumerate(parsed_lines) if isinstance(line, MotionLine)]
    return len(motions) == 1 and any(isinstance(line, ObjectLine) for line in parsed_lines[: motions[0]])
