"""Reading FOON text files into a network."""

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from foon_asp.network import Contents, FunctionalUnit, Network, NetworkBuilder, ObjectNode, Relation, Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.line import (
    Line,
    LineError,
    MotionLine,
    ObjectLine,
    Remark,
    StateLine,
    parse_line,
    parse_lines,
)
from foon_asp.text.plain_file import read_plain_text

_VIDEO = "# Source:"


class ReadUnit(NamedTuple):
    """One copy of a unit as it stands in a file, nodes in the order listed."""

    motion: str
    inputs: list[ObjectNode]
    outputs: list[ObjectNode]
    source: Source


class FoonReader:
    """Reads any number of FOON text files; every distinct line and object block is parsed once.

    With ``lenient``, what cannot be understood is left out with a warning, and everything else is kept;
    otherwise it is an error. Diagnostics of all files read so far are in ``diagnostics``; ``left_out``
    counts the lines that ``lenient`` dropped.
    """

    def __init__(self, lenient: bool = False) -> None:
        self.lenient = lenient
        self.diagnostics: list[Diagnostic] = []
        self.left_out = 0
        self.nodes: dict[str, ObjectNode] = {}  # by object block; only those without a remark
        self._lines: dict[str, Line | LineError] = {}

    def read_network(self, files: Iterable[Path]) -> Network:
        """Read and merge files; raises :class:`InputError` with all errors of all files."""
        builder = NetworkBuilder()
        earlier = len(self.diagnostics)
        for file in files:
            for unit in self.units(read_plain_text(file), str(file)):
                builder.add(*unit)
        self.raise_errors(earlier)
        return builder.build()

    def read_tree(self, file: Path) -> list[tuple[FunctionalUnit, Source]]:
        """Read one file as units in listed order, copies kept; raises :class:`InputError`."""
        earlier = len(self.diagnostics)
        units = [
            (FunctionalUnit.of(unit.motion, unit.inputs, unit.outputs), unit.source)
            for unit in self.units(read_plain_text(file), str(file))
        ]
        self.raise_errors(earlier)
        return units

    def raise_errors(self, earlier: int = 0) -> None:
        """Raise :class:`InputError` if anything but the ``earlier`` diagnostics was an error."""
        errors = [d for d in self.diagnostics[earlier:] if d.severity is Severity.ERROR]
        if errors:
            raise InputError(errors)

    def units(self, text: str, file: str) -> Iterator[ReadUnit]:
        """Give the units of a text in order; ``file`` is the name used in messages and sources."""
        return _FileReading(self, text, file).units()

    def parse_new(self, lines: Sequence[str]) -> None:
        """Parse the lines not met before together; if one is at fault, each is parsed in its turn."""
        known = self._lines
        new = [line for line in dict.fromkeys(lines) if line[:1] in {"O", "S", "M"} and line not in known]
        parsed = parse_lines(new)
        if parsed is not None:
            known.update(zip(new, parsed, strict=True))

    def parse(self, line: str) -> Line | LineError:
        """Parse a line, or remember what came of it."""
        parsed = self._lines.get(line)
        if parsed is None:
            try:
                parsed = parse_line(line)
            except LineError as error:
                parsed = error
            self._lines[line] = parsed
        return parsed


class _FileReading:
    """One pass over the lines of one file."""

    def __init__(self, reader: FoonReader, text: str, file: str) -> None:
        self.reader = reader
        self.file = file
        self.lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
        self.videos: tuple[str, ...] = ()
        self.rejected = 0  # how often something was, so far
        reader.parse_new(self.lines)

    def units(self) -> Iterator[ReadUnit]:
        lines = self.lines
        header_open = True  # further "# Source:" lines add to the videos until a unit comes between
        start = 0
        for index, line in enumerate(lines):
            first = line[:1]
            if first == "#":
                if line.startswith(_VIDEO):
                    video = line[len(_VIDEO) :].strip()
                    self.videos = (*(self.videos if header_open else ()), *([video] if video else []))
                    header_open = True
            elif first == "/" and line.rstrip(" \t") == "//":
                unit = self._unit(start, index)
                if unit:
                    header_open = False
                    yield unit
                start = index + 1
        unit = self._unit(start, len(lines))
        if unit:
            last = next(i for i in reversed(range(len(lines))) if lines[i].strip())
            self._warn("missing-separator", "the last unit is not closed by //", last, len(lines[last]) + 1)
            yield unit

    def _unit(self, start: int, end: int) -> ReadUnit | None:
        """Read the lines between two separators; ``None`` when they hold no unit."""
        lines = self.lines
        motion: str | None = None
        inputs: list[ObjectNode] = []
        outputs: list[ObjectNode] = []
        side = inputs
        block: list[str] = []  # the open object block, which began on line block_start
        block_start = first_line = -1
        rejected_before = self.rejected, self.reader.left_out
        for index in range(start, end):
            line = lines[index]
            letter = line[:1]
            if letter == "S" and block:
                block.append(line)
                continue
            if letter == "#" or not letter or line.isspace():
                continue
            if first_line < 0:
                first_line = index
            if block:
                self._close(block, block_start, side)
            if letter == "O":
                block.append(line)
                block_start = index
            elif letter == "M" and motion is None:
                motion = self._motion(index)
                side = outputs
            else:
                self._misplaced(index)
        if block:
            self._close(block, block_start, side)
        if first_line < 0:
            return None
        if motion is None or not inputs:
            self._drop(first_line, end, motion is not None, rejected_before)
            return None
        if not outputs:
            self._warn("no-outputs", f"the unit {motion!r} has no output objects", first_line)
        return ReadUnit(motion, inputs, outputs, Source(self.file, first_line + 1, 1, self.videos))

    def _drop(self, first_line: int, end: int, has_motion: bool, before: tuple[int, int]) -> None:
        """Reject the lines of a unit that is none; where a line of it was, that already says why."""
        meaningful = [i for i in range(first_line, end) if self.lines[i].strip() and self.lines[i][0] != "#"]
        rejected, left_out = before
        if self.rejected == rejected or self.reader.lenient:
            at_end = end == len(self.lines)
            found = "the file ends" if at_end else "found //"
            code, expected, lacks = "no-motion", "a motion line", "has no motion"
            if has_motion:
                code, expected, lacks = (
                    "no-inputs",
                    "an object line before the motion",
                    "has no input objects",
                )
            message = f"{found}, expected {expected}: the unit of line {first_line + 1} {lacks}"
            count = len(meaningful) - (self.reader.left_out - left_out)
            self._reject(code, message, meaningful[-1] if at_end else end, count=count)

    def _motion(self, index: int) -> str | None:
        parsed = self.reader.parse(self.lines[index])
        if isinstance(parsed, MotionLine):
            self._remark(parsed.remarks, index)
            return parsed.motion
        if isinstance(parsed, LineError):
            self._reject("syntax", str(parsed), index, parsed.column)
        return None

    def _misplaced(self, index: int) -> None:
        """Reject a line that is not understood or cannot stand where it does."""
        parsed = self.reader.parse(self.lines[index])
        if isinstance(parsed, LineError):
            self._reject("syntax", str(parsed), index, parsed.column)
        elif isinstance(parsed, StateLine):
            message = "found a state line, expected an object line before it"
            self._reject("state-without-object", message, index)
        else:
            message = "found a second motion in one unit, expected an object line or //"
            self._reject("second-motion", message, index)

    def _close(self, block: list[str], start: int, side: list[ObjectNode]) -> None:
        node = self.reader.nodes.get("\n".join(block)) or self._node(block, start)
        if node:
            side.append(node)
        block.clear()

    def _node(self, block: list[str], start: int) -> ObjectNode | None:
        """Build the node of an object line and the state lines under it, and remember it.

        ``None`` when the object line cannot be read; the state lines under it are then lost with it.
        """
        label = ""
        states: list[str] = []
        relations: list[Relation] = []
        contents: list[Contents] = []
        clean = True
        for line in block:
            parsed = self.reader.parse(line)
            if isinstance(parsed, StateLine):
                attribute = parsed.attribute
                if isinstance(attribute, str):
                    states.append(attribute)
                elif isinstance(attribute, Relation):
                    relations.append(attribute)
                else:
                    contents.append(attribute)
            elif isinstance(parsed, ObjectLine):
                label = parsed.label
            if isinstance(parsed, LineError) or parsed.remarks:
                clean = False
        if not clean:
            self._explain(block, start)
            if not label:
                return None
        contents.sort()
        node = ObjectNode(label, frozenset(states), frozenset(relations), tuple(contents))
        if clean:
            self.reader.nodes["\n".join(block)] = node
        return node

    def _explain(self, block: list[str], start: int) -> None:
        """Say what is wrong with the lines of a block; comments may stand between them."""
        index = start - 1
        for line in block:
            index = self.lines.index(line, index + 1)
            parsed = self.reader.parse(line)
            if not isinstance(parsed, LineError):
                self._remark(parsed.remarks, index)
            elif index == start:
                self._reject("syntax", str(parsed), index, parsed.column, count=len(block))
                return
            else:
                self._reject("syntax", str(parsed), index, parsed.column)

    def _remark(self, remarks: tuple[Remark, ...], index: int) -> None:
        for column, code, message in remarks:
            self._warn(code, message, index, column)

    def _warn(self, code: str, message: str, index: int, column: int = 1) -> None:
        source = Source(self.file, index + 1, column)
        self.reader.diagnostics.append(Diagnostic(Severity.WARNING, code, message, source, self.lines[index]))

    def _reject(self, code: str, message: str, index: int, column: int = 1, count: int = 1) -> None:
        """Note an error, or under ``lenient`` a warning that ``count`` lines were left out."""
        reader = self.reader
        self.rejected += 1
        severity = Severity.ERROR
        if reader.lenient:
            severity = Severity.WARNING
            message += "; left out"
            reader.left_out += count
        source = Source(self.file, index + 1, column)
        reader.diagnostics.append(Diagnostic(severity, code, message, source, self.lines[index]))
