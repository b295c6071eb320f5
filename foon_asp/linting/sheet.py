"""Sheets: one file as lines of FOON text, whatever its format."""

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
    """An entry of a kitchen or of a list of goals, the index of its object line, and its amount."""

    pattern: NodePattern
    at: int
    amount: int | None


class WrittenLine(NamedTuple):
    """A distinct line of a sheet, parsed: the index of its first copy, and the number of copies."""

    line: Line
    first: int
    often: int


class WrittenBlock(NamedTuple):
    """An object as it is written: the index of its object line, its label, and the lines under it."""

    at: int
    label: str
    attributes: list[tuple[int, str | Relation | Contents]]


@dataclass
class Sheet:
    """The lines of a file, from index 0.

    ``lines``: the lines; for a JSON file, the equivalent lines of FOON text.
    ``places``: for each line of a JSON file, the place in the file where its unit or entry begins, else
    ``None``.
    ``entries``: the objects of a kitchen or of goals; ``None`` for a network.
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
        """Whether the file is a list of goals, by its name, such as ``goal_nodes.json``."""
        return self.entries is not None and "goal" in Path(self.file).name.lower()

    @cached_property
    def distinct_lines(self) -> list[WrittenLine]:
        """Every distinct line that can be parsed, in order."""
        counts, first = Counter(self.lines), dict[str, int]()
        for index, line in enumerate(self.lines):
            first.setdefault(line, index)
        return [
            WrittenLine(parsed, first[line], often)
            for line, often in counts.items()
            if line[:1] in _LETTERS and not isinstance(parsed := self.reader.parse(line), LineError)
        ]

    def blocks(self, start: int) -> Iterator[tuple[int, ObjectNode]]:
        """Yield the object nodes of the unit from a line on, each with the index of its object line."""
        for block in self.written_blocks(start):
            if block is None:
                return
            yield block.at, node_of(block.label, (attribute for _, attribute in block.attributes))

    @cached_property
    def _parsed(self) -> dict[str, Line]:
        """The parsed lines by their text."""
        return {self.lines[first]: line for line, first, _ in self.distinct_lines}

    @cached_property
    def longer_blocks(self) -> list[WrittenBlock]:
        """The objects of the sheet as they are written, with two lines or more under them."""
        return [block for block in self.written_blocks(0) if block and len(block.attributes) > 1]

    def written_blocks(self, start: int) -> Iterator[WrittenBlock | None]:
        """Yield the objects from a line on, as they are written, and ``None`` where a unit ends."""
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

    def where(self, index: int, current_sheet: "Sheet | None" = None) -> str:
        """Name a line for a message: by its number, and by its file unless that is ``current_sheet``."""
        line = self.source_of(index).line
        return f"line {line}" if current_sheet is self else str(Source(self.file, line))

    def source_of(self, index: int, column: int = 1) -> Source:
        """Return the place of a line in the file."""
        return self.places[index] if self.places is not None else Source(self.file, index + 1, column)

    def finding(self, message: str, index: int, name: str = "", column: int = 1) -> Diagnostic:
        """Return a finding about a line, or a name or column in the line; its code is added by the rule."""
        if self.places is not None:
            source, line = self._in_json(index, name)
        else:
            line = self.lines[index]
            source = self.source_of(index, _column(line, name) if name else column)
        return Diagnostic(Severity.NOTE, "", message, source, line)

    def _in_json(self, index: int, name: str) -> tuple[Source, str]:
        """Return the place and line of a quoted name in JSON, within its unit or entry."""
        start = self.source_of(index)
        positions = self._quoted.get(name, [])
        number = bisect_left(positions, (start.line, start.column))
        if number == len(positions):
            return start, ""
        line, column = positions[number]
        return start._replace(line=line, column=column), self.source_lines[line - 1]

    @cached_property
    def _quoted(self) -> dict[str, list[tuple[int, int]]]:
        """The lines and columns of all quoted texts in a JSON file."""
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


def _column(line: str, name: str) -> int:
    """Return the column of a whole name in a line: ``rice`` is not where ``rice vinegar`` is."""
    return _columns(line).get(name) or max(0, line.find(name, line.find("\t") + 1)) + 1


@lru_cache(1)  # a long list is not searched anew for each of its names
def _columns(line: str) -> dict[str, int]:
    columns: dict[str, int] = {}
    for match in _SHEET_NAME.finditer(line, line.find("\t") + 1):
        columns.setdefault(match[0].strip(), match.end() - len(match[0].lstrip()) + 1)
    return columns
