"""The files that are linted together. What cannot be read in them is left out."""

import re
from collections.abc import Iterable, Mapping
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from foon_asp.linting.sheet import Entry, Sheet
from foon_asp.network import Network, NetworkBuilder, NodePattern, ObjectNode, Source
from foon_asp.text.diagnostics import Diagnostic, Severity
from foon_asp.text.format import Format
from foon_asp.text.formats import format_of
from foon_asp.text.json_list import JsonList
from foon_asp.text.json_object import read_objects
from foon_asp.text.line import Line
from foon_asp.text.plain_file import split_lines
from foon_asp.text.reader import FoonReader
from foon_asp.text.side_table import TABLES
from foon_asp.text.writer import write_line

_LINE_BREAK = re.compile(r"[\r\n]")


def with_tables(paths: Iterable[Path], files: Iterable[Path]) -> list[Path]:
    """Return ``files``, and then the tables in the folders among ``paths``, each file once.

    Tables are files with a name such as ``motion.txt`` (rates) or ``utensils.txt``. Subfolders are searched,
    too.
    """
    folders = [path for path in paths if path.is_dir()]
    tables = [file for folder in folders for file in sorted(folder.rglob("*.txt")) if file.name in TABLES]
    return list(dict.fromkeys([*files, *tables]))


class Copy(NamedTuple):
    """A copy of a unit in a file.

    ``sheet``: the index of its sheet.
    ``first_index``: the index of its first line in the sheet.
    ``inputs``, ``outputs``: how many nodes it lists as inputs and as outputs.
    """

    sheet: int
    first_index: int
    inputs: int
    outputs: int


class LintedFiles:
    """The files that are linted together: their sheets, their tables, and the network of all their units.

    ``sheets``: the networks, kitchens and lists of goals, in the order read.
    ``tables``: the files with the name of a table.
    ``copies[u]``: the copies of unit ``u`` of the network, in the order read.
    ``remarks``: those of the reader.

    An error does not end the reading of a file: lines that cannot be understood are left out.
    """

    def __init__(self, files: Iterable[Path], contents: Mapping[Path, bytes] = MappingProxyType({})) -> None:
        """Read all files, and merge their units into one network.

        ``contents`` are the bytes of files that are not to be read from disk.
        """
        self._contents = contents
        self.reader = FoonReader()
        self.sheets: list[Sheet] = []
        self.tables: list[Sheet] = []
        self.copies: list[list[Copy]] = []
        self.remarks: list[Diagnostic] = []
        self._builder = NetworkBuilder()
        for file in files:
            if file.name in TABLES:
                text = self.reader.text(file, self._contents.get(file))
                self.tables.append(Sheet(str(file), split_lines(text), self.reader))
            else:
                self._read_file(file)
        self.network: Network = self._builder.build()
        self.remarks += self.reader.diagnostics

    @cached_property
    def copies_by_sheet(self) -> list[list[tuple[Copy, int]]]:
        """For each sheet, the copies of units in it, in their order, each with the id of its unit."""
        by_sheet: list[list[tuple[Copy, int]]] = [[] for _ in self.sheets]
        for unit, copies in enumerate(self.copies):
            for copy in copies:
                by_sheet[copy.sheet].append((copy, unit))
        return [sorted(copies) for copies in by_sheet]

    def _read_file(self, file: Path) -> None:
        """Read a file as a sheet, and add its units to the network.

        A kitchen or a list of goals has no units; its entries are added to the sheet.
        """
        text = self.reader.text(file, self._contents.get(file))
        lines = split_lines(text)
        format_ = format_of(text, str(file))
        if not format_.has_comments:
            self._read_json(text, file, format_, lines)
            return
        sheet = Sheet(str(file), lines, self.reader)
        self.sheets.append(sheet)
        if format_.lists_objects(text):
            sheet.entries = [
                Entry(NodePattern.of(block.node), block.source.line - 1, block.amount)
                for block in self.reader.object_blocks(text, str(file))
            ]
        elif "# From:" in text:  # units of a merged file name the places that they come from
            for unit in self.reader.listed_units(text, str(file)):
                self._add_unit(unit.motion.motion, unit.sides, unit.inputs[0].source.line - 1)
        else:
            for motion, inputs, outputs, sources, _ in self.reader.units(text, str(file)):
                self._add_unit(motion, (inputs, outputs), sources[0].line - 1)

    def _read_json(self, text: str, file: Path, format_: Format, source_lines: list[str]) -> None:
        """Read a JSON file as a sheet of equivalent lines of FOON text, and add its units to the network.

        ``source_lines`` are the lines of the file itself. A list of objects, such as a kitchen or goals, has
        entries instead of units. In such a list, errors and values without a meaning become remarks.
        """
        lines: list[str] = []
        sources: list[Source] = []
        sheet = Sheet(str(file), lines, self.reader, sources, source_lines=source_lines)
        self.sheets.append(sheet)

        def append_lines(parsed: Iterable[Line], source: Source, *extra: str) -> None:
            """Append lines of FOON text to the sheet, all with one place in the JSON file."""
            texts = [*map(_write_on_one_line, parsed), *extra]
            lines.extend(texts)
            sources.extend([source] * len(texts))

        if not format_.lists_objects(text):
            for unit in self.reader.listed_units(text, str(file)):
                self._add_unit(unit.motion.motion, unit.sides, len(lines))
                inputs, outputs = (
                    [line for block in blocks for line in block.lines]
                    for blocks in (unit.inputs, unit.outputs)
                )
                append_lines([*inputs, unit.motion, *outputs], unit.motion_source, "//")
            return
        elements = JsonList(text, file)
        sheet.entries = []
        for block, pattern, unknown in read_objects(elements):
            self.remarks += [
                Diagnostic(Severity.WARNING, "json-value", message, block.source) for message in unknown
            ]
            sheet.entries.append(Entry(pattern, len(lines), block.amount))
            container = [] if pattern.container is None else [f"S\tin\t[{pattern.container}]"]
            append_lines(block.lines, block.source, *container)
        self.remarks += elements.errors

    def _add_unit(self, motion: str, sides: tuple[list[ObjectNode], list[ObjectNode]], index: int) -> None:
        """Add a unit of the last sheet to the network, and record it as a copy of that unit.

        ``sides`` are the inputs and outputs, ``index`` is the index of the first line of the unit.
        """
        unit = self._builder.add(motion, *sides)
        if unit == len(self.copies):
            self.copies.append([])
        self.copies[unit].append(Copy(len(self.sheets) - 1, index, *map(len, sides)))


def _write_on_one_line(line: Line) -> str:
    """Write a line read from JSON as FOON text; line breaks in its names become blanks."""
    return _LINE_BREAK.sub(" ", write_line(line))
