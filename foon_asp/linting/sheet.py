"""One file as lines, whatever it is written in."""

import json
import re
from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

from foon_asp.linting.catalog import CATALOG
from foon_asp.network import NodePattern, ObjectNode, Source
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.line import Line, LineError, ObjectLine, StateLine
from foon_asp.text.listed_unit import node_of
from foon_asp.text.reader import FoonReader

_LETTERS = {"O", "S", "M"}
_NAME = re.compile(r"[^\t\[\]{},]+")
# What opens and is not closed is matched too, so that it is not looked through again from each quote in it.
_QUOTED = re.compile(r'"((?:[^"\\]|\\(?:["\\/bfnrt]|u[0-9a-fA-F]{4}))*+)("?)')


class Entry(NamedTuple):
    """One object of a kitchen or of a list of goals, and the index of its object line."""

    pattern: NodePattern
    at: int


class WrittenLine(NamedTuple):
    """A distinct line of a sheet: what it says, the index where it stands first, and how often it stands."""

    line: Line
    first: int
    often: int


@dataclass
class Sheet:
    """The lines of a file, from index 0.

    Of JSON these are the lines that the same would have in FOON text, and ``places`` says for each line where
    in the file its unit or entry begins. ``entries`` are the objects of a kitchen or of goals; a network has
    ``None``.
    """

    file: str
    lines: Sequence[str]
    reader: FoonReader
    places: Sequence[Source] | None = None
    entries: list[Entry] | None = None
    source_lines: Sequence[str] = field(default=(), repr=False)
    _columns: tuple[int, dict[str, int]] = field(default_factory=lambda: (-1, {}), repr=False)

    @property
    def lists_goals(self) -> bool:
        """Whether it is a list of goals: its name says so, as that of ``goal_nodes.json`` does."""
        name = self.file.replace("\\", "/").rsplit("/", 1)[-1]
        return self.entries is not None and "goal" in name.lower()

    @cached_property
    def distinct_lines(self) -> list[WrittenLine]:
        """Every distinct line that says something, in order."""
        lines = self.lines
        first = dict(zip(reversed(lines), range(len(lines) - 1, -1, -1), strict=True))
        counts: dict[str, int] = {}
        for line in lines:
            counts[line] = counts.get(line, 0) + 1
        found = []
        for line, count in counts.items():
            if line[:1] in _LETTERS and not isinstance(parsed := self.reader.parse(line), LineError):
                found.append(WrittenLine(parsed, first[line], count))
        return found

    def blocks(self, start: int) -> Iterator[tuple[int, ObjectNode]]:
        """Give the object nodes of the unit whose first line has that index, each with its object line."""
        index, attributes = -1, []
        label = ""
        for number in range(start, len(self.lines)):
            text = self.lines[number]
            line = self.reader.parse(text) if text[:1] in _LETTERS else None
            if isinstance(line, StateLine):
                attributes.append(line.attribute)
                continue
            if text[:1] == "#" or not text.strip():
                continue
            if index >= 0:
                yield index, node_of(label, attributes)
            index, attributes = -1, []
            if isinstance(line, ObjectLine):
                index, label = number, line.label
            elif text[:2] == "//":
                return
        if index >= 0:
            yield index, node_of(label, attributes)

    def line_of(self, node: ObjectNode, start: int) -> int:
        """Give the index of the object line of a node in the unit that begins there."""
        return next((index for index, found in self.blocks(start) if found == node), start)

    def where(self, index: int, beside: "Sheet | None" = None) -> str:
        """Name a line for a message: by its number, and by its file where that is another than ``beside``."""
        line = self.place(index).line
        return f"line {line}" if beside is self else str(Source(self.file, line))

    def place(self, index: int, column: int = 1) -> Source:
        """Give the place of a line in the file."""
        return self.places[index] if self.places is not None else Source(self.file, index + 1, column)

    def finding(self, code: str, message: str, index: int, name: str = "", column: int = 1) -> Diagnostic:
        """Make a finding about a line, or about a name or a column of it."""
        severity = CATALOG[code].severity
        if self.places is not None:
            source, line = self._in_json(index, name)
            return Diagnostic(severity, code, message, source, line)
        column = self._column(index, name) if name else column
        return Diagnostic(severity, code, message, self.place(index, column), self.lines[index])

    def _column(self, index: int, name: str) -> int:
        """Give the column of a whole name in a line: ``rice`` is not where ``rice vinegar`` is.

        The columns of the last line are kept: a long list is not searched anew for each of its names.
        """
        line = self.lines[index]
        start = line.find("\t") + 1
        if self._columns[0] != index:
            columns: dict[str, int] = {}
            for match in _NAME.finditer(line, start):
                text = match[0]
                columns.setdefault(text.strip(), match.end() - len(text.lstrip()) + 1)
            self._columns = index, columns
        return self._columns[1].get(name) or max(0, line.find(name, start)) + 1

    def _in_json(self, index: int, name: str) -> tuple[Source, str]:
        """Give the place and line of a name, in quotes, behind the place where its unit or entry begins."""
        start = self.place(index)
        places = self._quoted.get(name, [])
        number = bisect_left(places, (start.line, start.column))
        if number == len(places):
            return start, ""
        line, column = places[number]
        return start._replace(line=line, column=column), self.source_lines[line - 1]

    @cached_property
    def _quoted(self) -> dict[str, list[tuple[int, int]]]:
        """Lines and columns of everything in quotes in a JSON file."""
        found: dict[str, list[tuple[int, int]]] = {}
        for number, line in enumerate(self.source_lines, 1):
            for match in _QUOTED.finditer(line):
                text, closed = match.groups()
                if not closed:
                    continue
                if "\\" in text:
                    text = json.loads(match[0], strict=False)
                found.setdefault(text, []).append((number, match.start() + 2))
        return found
