"""The files that are linted together, read as far as they can be read."""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from foon_asp.linting.catalog import CATALOG
from foon_asp.linting.sheet import Entry, Sheet
from foon_asp.network import Network, NetworkBuilder, NodePattern, ObjectNode, Source
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.format import Format
from foon_asp.text.formats import format_of
from foon_asp.text.json_list import JsonList
from foon_asp.text.json_object import read_objects
from foon_asp.text.line import Line, LineError
from foon_asp.text.listed_unit import ListedUnit
from foon_asp.text.plain_file import split_lines
from foon_asp.text.reader import FoonReader
from foon_asp.text.writer import write_line

_TABLES = {"durations.txt", "motion.txt", "tools.txt", "unit_prices.txt", "utensils.txt"}
_LINE_BREAK = re.compile(r"[\r\n]")


def with_tables(paths: Iterable[Path], files: Iterable[Path]) -> list[Path]:
    """Give files, and the tables of rates, utensils and the like in the folders among the paths."""
    folders = [path for path in paths if path.is_dir()]
    tables = [file for folder in folders for file in sorted(folder.rglob("*.txt")) if file.name in _TABLES]
    return list(dict.fromkeys([*files, *tables]))


class Copy(NamedTuple):
    """One copy of a unit: the number of its sheet, the index of its first line, and the nodes it lists."""

    sheet: int
    at: int
    inputs: int
    outputs: int


class LintedFiles:
    """All sheets, the network that their units make up, the tables beside, and what the reader remarked on.

    ``copies[u]`` are the places where unit ``u`` of the network stands, in the order read. Files are read
    independently of errors in them: what cannot be understood is left out. ``contents`` are the bytes of
    files that are not to be read from disk.
    """

    def __init__(self, files: Iterable[Path], contents: Mapping[Path, bytes] = MappingProxyType({})) -> None:
        self._contents = contents
        self.reader = FoonReader()
        self.sheets: list[Sheet] = []
        self.tables: list[Sheet] = []
        self.copies: list[list[Copy]] = []
        self._remarks: list[Diagnostic] = []
        self._builder = NetworkBuilder()
        for file in files:
            if file.name in _TABLES:
                text = self.reader.text(file, self._contents.get(file))
                self.tables.append(Sheet(str(file), split_lines(text), self.reader))
            else:
                self._read(file)
        self.network: Network = self._builder.build()
        self._remarks += self.reader.diagnostics

    def remarks(self) -> list[Diagnostic]:
        """Give what the reader has to say, with the severity of the catalog and only fixes that mend."""
        return [
            remark._replace(severity=CATALOG[remark.code].severity, fix=mending_fix(remark, self.reader))
            for remark in self._remarks
        ]

    def _read(self, file: Path) -> None:
        text = self.reader.text(file, self._contents.get(file))
        format_ = format_of(text, str(file))
        if not format_.has_comments:
            self._read_json(text, file, format_)
            return
        sheet = Sheet(str(file), split_lines(text), self.reader)
        self.sheets.append(sheet)
        if format_.lists_objects(text):
            sheet.entries = [
                Entry(NodePattern.of(block.node), block.source.line - 1)
                for block in self.reader.object_blocks(text, str(file))
            ]
        elif "# From:" in text:  # units of a merged file name the places that they come from
            for unit in self.reader.listed_units(text, str(file)):
                self._add(unit, unit.inputs[0].source.line - 1)
        else:
            for motion, inputs, outputs, sources in self.reader.units(text, str(file)):
                self._add_nodes(motion, inputs, outputs, sources[0].line - 1)

    def _read_json(self, text: str, file: Path, format_: Format) -> None:
        lines: list[str] = []
        places: list[Source] = []
        sheet = Sheet(str(file), lines, self.reader, places, source_lines=split_lines(text))
        self.sheets.append(sheet)
        if format_.lists_objects(text):
            sheet.entries = self._read_json_list(text, file, lines, places)
            return
        for unit in self.reader.listed_units(text, str(file)):
            self._add(unit, len(lines))
            inputs = [line for block in unit.inputs for line in block.lines]
            new = [*inputs, unit.motion, *(line for block in unit.outputs for line in block.lines)]
            lines += [*map(_written, new), "//"]
            places += [unit.motion_source] * (len(new) + 1)

    def _read_json_list(self, text: str, file: Path, lines: list[str], places: list[Source]) -> list[Entry]:
        elements = JsonList(text, file)
        entries = []
        for block, pattern, left_out in read_objects(elements):
            self._remarks += [
                Diagnostic(CATALOG["json-value"].severity, "json-value", message, block.source)
                for message in left_out
            ]
            entries.append(Entry(pattern, len(lines)))
            written = [*map(_written, block.lines)]
            written += [f"S\tin\t[{pattern.container}]"] if pattern.container is not None else []
            lines += written
            places += [block.source] * len(written)
        self._remarks += elements.errors
        return entries

    def _add(self, unit: ListedUnit, index: int) -> None:
        self._add_nodes(unit.motion.motion, *unit.sides, index)

    def _add_nodes(
        self, motion: str, inputs: list[ObjectNode], outputs: list[ObjectNode], index: int
    ) -> None:
        unit = self._builder.add(motion, inputs, outputs)
        if unit == len(self.copies):
            self.copies.append([])
        self.copies[unit].append(Copy(len(self.sheets) - 1, index, len(inputs), len(outputs)))


def mending_fix(remark: Diagnostic, reader: FoonReader) -> str | None:
    """Give the mended line; a line is written anew as a whole, which need not mend every remark on it."""
    if remark.code == "missing-separator":
        return f"{remark.excerpt}\n//"
    if remark.fix is None or remark.fix == "//":
        return remark.fix
    mended = reader.parse(remark.fix)
    left = [] if isinstance(mended, LineError) else [message for _, _, message in mended.remarks]
    return remark.fix if remark.message not in left else None


def _written(line: Line) -> str:
    """Write a line of JSON as one; names there may hold anything."""
    return _LINE_BREAK.sub(" ", write_line(line))
