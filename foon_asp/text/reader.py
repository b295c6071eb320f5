"""Reading FOON text files into a network."""

from collections.abc import Iterable, Iterator
from pathlib import Path

from foon_asp.network import Contents, Network, NetworkBuilder, ObjectNode, Relation, Source
from foon_asp.network.functional_unit import FunctionalUnit
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.line import Line, LineError, MotionLine, ObjectLine, Remark, StateLine, parse_line, parse_lines
from foon_asp.text.plain_file import read_plain_text

_VIDEO = "# Source:"


class FoonReader:
    """Reads any number of FOON text files; every distinct line and object block is parsed once.

    With ``lenient``, what cannot be understood is left out with a warning, and everything else is kept;
    otherwise it is an error. Diagnostics of all files read so far are in ``diagnostics``; ``left_out``
    counts the lines that ``lenient`` dropped.
    """

    def __init__(self, lenient: bool = False) -> None:
        self.diagnostics: list[Diagnostic] = []
        self.left_out = 0
        self._lenient = lenient
        self._lines: dict[str, Line | LineError] = {}
        self._nodes: dict[str, ObjectNode] = {}  # only blocks that need no remark

    def read_network(self, files: Iterable[Path]) -> Network:
        """Read and merge files; raises :class:`InputError` with all errors of all files."""
        builder = NetworkBuilder()
        for file in files:
            for motion, inputs, outputs, source in self.units(read_plain_text(file), str(file)):
                builder.add(motion, inputs, outputs, source)
        self.raise_errors()
        return builder.build()

    def read_tree(self, file: Path) -> list[tuple[FunctionalUnit, Source]]:
        """Read one file as units in listed order, copies kept; raises :class:`InputError`."""
        units = [
            (FunctionalUnit.of(motion, inputs, outputs), source)
            for motion, inputs, outputs, source in self.units(read_plain_text(file), str(file))
        ]
        self.raise_errors()
        return units

    def raise_errors(self) -> None:
        """Raise :class:`InputError` if anything read so far was an error."""
        errors = [d for d in self.diagnostics if d.severity is Severity.ERROR]
        if errors:
            raise InputError(errors)

    def units(
        self, text: str, file: str
    ) -> Iterator[tuple[str, list[ObjectNode], list[ObjectNode], Source]]:
        """Give the units of a text in order, as motion, inputs, outputs and source."""
        lines = text.replace("\r\n", "\n").split("\n")
        self._parse_new(lines)
        videos: tuple[str, ...] = ()
        header_open = True  # further "# Source:" lines add to the videos until a unit comes between
        start = 0
        for end, line in enumerate(lines):
            first = line[:1]
            if first == "#":
                if line.startswith(_VIDEO):
                    video = line[len(_VIDEO) :].strip()
                    videos = (*videos, video) if header_open else (video,)
                    header_open = True
            elif first == "/" and line.rstrip(" \t") == "//":
                unit = self._unit(lines, start, end, file, videos)
                if unit:
                    header_open = False
                    yield unit
                start = end + 1
        unit = self._unit(lines, start, len(lines), file, videos)
        if unit:
            last = next(i for i in reversed(range(len(lines))) if lines[i].strip())
            self._warn(
                "missing-separator",
                "the last unit is not closed by //",
                Source(file, last + 1, len(lines[last]) + 1),
                lines[last],
            )
            yield unit

    def _unit(
        self, lines: list[str], start: int, end: int, file: str, videos: tuple[str, ...]
    ) -> tuple[str, list[ObjectNode], list[ObjectNode], Source] | None:
        """Read the lines between two separators; ``None`` when they hold no unit."""
        motion: str | None = None
        inputs: list[ObjectNode] = []
        outputs: list[ObjectNode] = []
        side = inputs
        block: list[str] = []  # the open object block, which began on line block_start
        block_start = first_line = -1
        nodes = self._nodes

        def close_block() -> None:
            node = nodes.get("\n".join(block)) or self._node(block, lines, block_start, file)
            if node:
                side.append(node)
            block.clear()

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
                close_block()
            if letter == "O":
                block.append(line)
                block_start = index
                continue
            parsed = self._parse(line)
            if isinstance(parsed, MotionLine):
                self._remark(parsed.remarks, file, index, line)
                if motion is not None:
                    message = "found a second motion in one unit, expected an object line or //"
                    self._reject("second-motion", message, file, index, line)
                    continue
                if not inputs:
                    message = "found a motion line, expected an object line: the unit has no inputs"
                    self._reject("no-inputs", message, file, index, line, count=end - first_line)
                    return None
                motion, side = parsed.motion, outputs
            elif isinstance(parsed, LineError):
                self._reject("syntax", str(parsed), file, index, line, parsed.column)
            else:
                message = "found a state line, expected an object line before it"
                self._reject("state-without-object", message, file, index, line)
        if block:
            close_block()
        if first_line < 0:
            return None
        source = Source(file, first_line + 1, 1, videos)
        if motion is None:
            where = "the file ends" if end == len(lines) else "found //"
            self._reject(
                "no-motion",
                f"{where}, expected a motion line: the unit that starts on line {first_line + 1} has no motion",
                file,
                min(end, len(lines) - 1),
                lines[min(end, len(lines) - 1)],
                count=end - first_line,
            )
            return None
        if not outputs:
            self._warn(
                "no-outputs", f"the unit {motion!r} has no output objects", source, lines[first_line]
            )
        return motion, inputs, outputs, source

    def _node(self, block: list[str], lines: list[str], start: int, file: str) -> ObjectNode | None:
        """Build the node of an object line and the state lines under it, and remember it.

        The block begins at ``lines[start]``. ``None`` when the object line cannot be read; the state lines
        under it are then lost with it.
        """
        label = ""
        states: list[str] = []
        relations: list[Relation] = []
        contents: list[Contents] = []
        clean = True
        for line in block:
            parsed = self._parse(line)
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
            else:
                clean = False
                continue
            if parsed.remarks:
                clean = False
        if not clean:
            self._explain(block, lines, start, file)
            if not label:
                return None
        contents.sort()
        node = ObjectNode(label, frozenset(states), frozenset(relations), tuple(contents))
        if clean:
            self._nodes["\n".join(block)] = node
        return node

    def _explain(self, block: list[str], lines: list[str], start: int, file: str) -> None:
        """Say what is wrong with the lines of a block; comments may stand between them."""
        index = start - 1
        for line in block:
            index = lines.index(line, index + 1)
            parsed = self._parse(line)
            if not isinstance(parsed, LineError):
                self._remark(parsed.remarks, file, index, line)
            elif index == start:
                self._reject("syntax", str(parsed), file, index, line, parsed.column, count=len(block))
                return
            else:
                self._reject("syntax", str(parsed), file, index, line, parsed.column)

    def _parse_new(self, lines: list[str]) -> None:
        """Parse the lines not met before together; if one of them is at fault, each when it is its turn."""
        new = [line for line in dict.fromkeys(lines) if line[:1] in {"O", "S", "M"} and line not in self._lines]
        parsed = parse_lines(new)
        if parsed is not None:
            self._lines.update(zip(new, parsed, strict=True))

    def _parse(self, line: str) -> Line | LineError:
        parsed = self._lines.get(line)
        if parsed is None:
            try:
                parsed = parse_line(line)
            except LineError as error:
                parsed = error
            self._lines[line] = parsed
        return parsed

    def _remark(self, remarks: tuple[Remark, ...], file: str, index: int, line: str) -> None:
        for column, code, message in remarks:
            self._warn(code, message, Source(file, index + 1, column), line)

    def _warn(self, code: str, message: str, source: Source, line: str) -> None:
        self.diagnostics.append(Diagnostic(Severity.WARNING, code, message, source, line))

    def _reject(
        self, code: str, message: str, file: str, index: int, line: str, column: int = 1, count: int = 1
    ) -> None:
        """Note an error, or under ``lenient`` a warning that ``count`` lines were left out."""
        severity = Severity.ERROR
        if self._lenient:
            severity = Severity.WARNING
            message += "; left out"
            self.left_out += count
        source = Source(file, index + 1, column)
        self.diagnostics.append(Diagnostic(severity, code, message, source, line))
