"""Sheets: the lines of one file as FOON text, whatever its format."""

import json
import re
from bisect import bisect_left
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from pathlib import Path
from typing import NamedTuple

from foon_asp.network import Contents, NodePattern, ObjectNode, Relation, Source
from foon_asp.text.diagnostics import Diagnostic, Severity
from foon_asp.text.line import Line, LineError, ObjectLine, StateLine
from foon_asp.text.listed_unit import node_of
from foon_asp.text.reader import FoonReader

_LETTERS = {"O", "S", "M"}
_SHEET_NAME = re.compile(r"[^\t\[\]{},]+")
# An unclosed quote is matched too, so that its text is not searched again from each quote in it.
_QUOTED = re.compile(r'"((?:[^"\\]|\\(?:["\\/bfnrt]|u[0-9a-fA-F]{4}))*+)("?)')


class Entry(NamedTuple):
    """An entry of a kitchen or of a list of goals.

    ``object_index`` is the index of its object line. ``amount`` is the stated amount; ``None`` without one.
    """

    pattern: NodePattern
    object_index: int
    amount: int | None


class WrittenLine(NamedTuple):
    """A line of a sheet, parsed; equal lines are one.

    ``first_index`` is the index of the first of the equal lines, ``occurrences`` is how many there are.
    """

    line: Line
    first_index: int
    occurrences: int


class WrittenBlock(NamedTuple):
    """An object as it is written in a sheet.

    ``object_index`` is the index of its object line. ``attributes`` are the states, relations and contents on
    the lines below, each with the index of its line.
    """

    object_index: int
    label: str
    attributes: list[tuple[int, str | Relation | Contents]]


@dataclass
class Sheet:
    """A file as lines of FOON text, with indices from 0.

    ``lines``: the lines; for a JSON file, equivalent lines of FOON text.
    ``places``: for each line of a JSON file, the place in the file where its unit or entry begins. ``None``
    for a file that is text.
    ``entries``: the entries of a kitchen or of a list of goals; ``None`` for a network.
    ``source_lines``: the lines of a JSON file as they are written.
    """

    file: str
    lines: Sequence[str]
    reader: FoonReader
    places: Sequence[Source] | None = None
    entries: list[Entry] | None = None
    source_lines: Sequence[str] = field(default=(), repr=False)

    @property
    def lists_goals(self) -> bool:
        """Whether the file is a list of goals: a list of objects with ``goal`` in its name."""
        return self.entries is not None and "goal" in Path(self.file).name.lower()

    @cached_property
    def distinct_lines(self) -> list[WrittenLine]:
        """All different lines that can be parsed, in order; comments and separators are left out."""
        counts, first = Counter(self.lines), dict[str, int]()
        for index, line in enumerate(self.lines):
            first.setdefault(line, index)
        return [
            WrittenLine(parsed, first[line], occurrences)
            for line, occurrences in counts.items()
            if line[:1] in _LETTERS and not isinstance(parsed := self.reader.parse(line), LineError)
        ]

    def object_nodes(self, start: int) -> Iterator[tuple[int, ObjectNode]]:
        """Yield the object nodes of a unit, each with the index of its object line.

        ``start`` is the index of the first line of the unit.
        """
        for block in self.written_blocks(start):
            if block is None:
                return
            yield (
                block.object_index,
                node_of(block.label, (attribute for _, attribute in block.attributes)),
            )

    @cached_property
    def _parsed(self) -> dict[str, Line]:
        """The parsed lines by their text."""
        return {self.lines[first]: line for line, first, _ in self.distinct_lines}

    @cached_property
    def longer_blocks(self) -> list[WrittenBlock]:
        """The objects of the sheet, as they are written, that have two attributes or more."""
        return [block for block in self.written_blocks(0) if block and len(block.attributes) > 1]

    def written_blocks(self, start: int) -> Iterator[WrittenBlock | None]:
        """Yield the objects from a line on, as they are written, and ``None`` at each ``//``.

        ``start`` is the index of the line. States without an object line above them are left out, as are
        states below a line that cannot be parsed.
        """
        block: WrittenBlock | None = None
        for number in range(start, len(self.lines)):
            text = self.lines[number]
            line = self._parsed.get(text)
            if isinstance(line, StateLine):
                if block is not None:
                    block.attributes.append((number, line.attribute))
                continue
            if text.startswith("#") or not text.strip():
                continue
            if block is not None:
                yield block
            block = WrittenBlock(number, line.label, []) if isinstance(line, ObjectLine) else None
            if text.startswith("//"):
                yield None
        if block is not None:
            yield block

    def line_name(self, index: int, current_sheet: "Sheet | None" = None) -> str:
        """Return the name of a line for messages: ``line 7`` in ``current_sheet``, else with its file."""
        line = self.source_of(index).line
        return f"line {line}" if current_sheet is self else str(Source(self.file, line))

    def source_of(self, index: int, column: int = 1) -> Source:
        """Return the place of a line in the file.

        For JSON, this is where the unit or entry of the line begins, whatever the column.
        """
        return self.places[index] if self.places is not None else Source(self.file, index + 1, column)

    def finding(self, message: str, index: int, name: str = "", column: int = 1) -> Diagnostic:
        """Return a finding about the line at an index; the rule adds its code and severity.

        The column is that of ``name`` in the line; without a name it is ``column``, from 1. For JSON, the
        place is that of the quoted name, or else where the unit or entry begins.
        """
        if self.places is not None:
            source, line = self._quoted_place(index, name)
        else:
            line = self.lines[index]
            source = self.source_of(index, _column_of_name(line, name) if name else column)
        return Diagnostic(Severity.NOTE, "", message, source, line)

    def _quoted_place(self, index: int, name: str) -> tuple[Source, str]:
        """Find a quoted name in JSON from the unit or entry of a line on; return its place and its line.

        If the name does not follow, return where the unit or entry begins, and an empty line.
        """
        start = self.source_of(index)
        positions = self._quoted_positions.get(name, [])
        number = bisect_left(positions, (start.line, start.column))
        if number == len(positions):
            return start, ""
        line, column = positions[number]
        return start._replace(line=line, column=column), self.source_lines[line - 1]

    @cached_property
    def _quoted_positions(self) -> dict[str, list[tuple[int, int]]]:
        """By quoted text, its positions in a JSON file, each a line and a column from 1."""
        positions: dict[str, list[tuple[int, int]]] = {}
        for number, line in enumerate(self.source_lines, 1):
            for match in _QUOTED.finditer(line):
                text, closed = match.groups()
                if not closed:
                    continue
                if "\\" in text:
                    text = json.loads(match[0], strict=False)
                positions.setdefault(text, []).append((number, match.start() + 2))
        return positions


def _column_of_name(line: str, name: str) -> int:
    """Return the column of a name in a line, from 1; 1 if the line does not have the name.

    Whole names come first: ``rice`` is not found within ``rice vinegar`` if it also stands alone.
    """
    return _columns_by_name(line).get(name) or max(0, line.find(name, line.find("\t") + 1)) + 1


@lru_cache(1)  # a long list is not searched anew for each of its names
def _columns_by_name(line: str) -> dict[str, int]:
    """Return the columns of all whole names in a line, from 1; of a repeated name, the first."""
    columns: dict[str, int] = {}
    for match in _SHEET_NAME.finditer(line, line.find("\t") + 1):
        columns.setdefault(match[0].strip(), match.end() - len(match[0].lstrip()) + 1)
    return columns
