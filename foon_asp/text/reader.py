"""Reading FOON files into a network: FOON text of every dialect, and JSON."""

from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import chain
from pathlib import Path
from typing import NamedTuple, cast

from foon_asp.network import Contents, FunctionalUnit, Network, NetworkBuilder, ObjectNode, Relation, Source
from foon_asp.text.bytes_read import told
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.line import Line, LineError, MotionLine, ObjectLine, StateLine
from foon_asp.text.line_parser import parse_line, parse_lines
from foon_asp.text.listed_unit import ListedUnit, ObjectBlock, node_of
from foon_asp.text.plain_file import (
    before_json,
    is_json,
    is_neutral,
    is_neutral_file,
    plain_text,
    read_plain_text,
    split_lines,
    text_pieces,
)
from foon_asp.text.provenance import is_video, read_copy, read_video
from foon_asp.text.repeated_node import RepeatedNode, repeated_node
from foon_asp.text.stated_prices import StatedPrices
from foon_asp.text.writer import write_line

_AHEAD = 65_536  # letters looked ahead for new lines, so that they go to the parser together
_PIECE = 1_000_000  # letters of a file read at a time
_REMEMBERED = 50_000  # lines, and object blocks: what comes again mostly comes soon
_LONGEST = 1_000_000  # letters of a line: no FOON line means more


class ReadUnit(NamedTuple):
    """One copy of a unit: what makes its identity, nodes in the order listed, and where it was read.

    ``sources`` has one entry, unless a merged file says from which copies the unit came.
    """

    motion: str
    inputs: list[ObjectNode]
    outputs: list[ObjectNode]
    sources: tuple[Source, ...]

    @property
    def source(self) -> Source:
        """The place of the first copy."""
        return self.sources[0]


class FoonReader:
    r"""Reads any number of FOON files; each distinct line and object block is parsed once.

    With ``lenient``, what is not understood is left out with a warning; otherwise it is an error.
    ``diagnostics`` has the findings in all files read so far. ``left_out`` counts the lines that are in no
    unit because they were not understood or make none; ``prices`` are those that copies of units state.
    ``marked`` are the nodes with the goal mark ``!``, each with its first place. ``last_units`` are the last
    unit of each file that makes anything, by id and with its place, for a network read in one go.
    ``repeated`` are the nodes that a copy of a unit lists twice.

    Example:
        >>> from pathlib import Path
        >>> reader = foon_asp.FoonReader()
        >>> reader.read_network([Path("data/kitchen/FOON.txt")])
        <Network: 220 units, 418 object nodes, level 3>
        >>> next(reader.file_units(Path("data/kitchen/FOON.txt"))).motion
        'turn on'
        >>> text = reader.text(Path("data/kitchen/FOON.txt"))
        >>> next(reader.units(text, "FOON.txt")).motion, next(reader.listed_units(text, "FOON.txt")).motion.id
        ('turn on', '')
        >>> len(reader.tree_units(text, "FOON.txt")), reader.raise_errors()
        (220, None)
        >>> [str(block.node) for block in reader.object_blocks("O\ttea\nS\thot", "kitchen.txt")]
        ['tea; hot']
        >>> reader.parse("S\thot").attribute
        'hot'
    """

    def __init__(self, lenient: bool = False) -> None:
        self.lenient = lenient
        self.diagnostics: list[Diagnostic] = []
        self.left_out = 0
        self.prices = StatedPrices()
        self.marked: dict[ObjectNode, Source] = {}
        self.last_units: dict[int, Source] = {}
        self.repeated: list[RepeatedNode] = []
        # By text without the first letter, and only what there is no remark on.
        self.nodes: dict[str, ObjectNode] = {}
        self.motions: dict[str, str] = {}
        self.same_node: dict[ObjectNode, ObjectNode] = {}  # one object for each node: quick to compare
        self.labels: dict[str, str] = {}  # what object lines say
        self.goal_lines: set[str] = set()  # those of object lines with the goal mark
        # By the whole line.
        self.attributes: dict[str, str | Relation | Contents] = {}  # what state lines say
        self._lines: dict[str, Line | LineError] = {}
        self._plain: set[str] = set()  # files in the neutral form and in JSON

    def read_network(self, files: Iterable[Path]) -> Network:
        """Read files and merge them into one network.

        Parameters:
            files: The paths of the files.

        Raises:
            InputError: with all errors of all files.
        """
        builder = NetworkBuilder()
        earlier = len(self.diagnostics)
        for file in files:
            last: tuple[int, Source] | None = None
            for motion, inputs, outputs, sources in self.file_units(file):
                unit = builder.add(motion, inputs, outputs, *sources)
                last = (unit, sources[0]) if outputs else last
            if last:
                self.last_units.setdefault(*last)
        self.raise_errors(earlier)
        return builder.build()

    def tree_units(self, text: str, file: str) -> list[tuple[FunctionalUnit, Source]]:
        """Give the units of a text in listed order, copies included.

        Parameters:
            text: The FOON text.
            file: The name of the file, for messages and sources.

        Raises:
            InputError: with all errors of the text.
        """
        earlier = len(self.diagnostics)
        units = [
            (FunctionalUnit.of(unit.motion, unit.inputs, unit.outputs), unit.source)
            for unit in self.units(text, file)
        ]
        self.raise_errors(earlier)
        return units

    def file_units(self, file: Path) -> Iterator[ReadUnit]:
        """Give the units of a file in order; one in the neutral form is read line by line.

        Parameters:
            file: The path of the file.
        """
        for unit in self._units_of(file):
            node = repeated_node(unit.inputs, unit.outputs)
            if node:
                self.repeated.append(RepeatedNode(str(node), unit.source, str(file) in self._plain))
            yield unit

    def _units_of(self, file: Path) -> Iterator[ReadUnit]:
        if not is_neutral_file(file):
            yield from self._text_units(file)
            return
        from foon_asp.text.neutral_units import lines_of  # noqa: PLC0415 (most networks are none)

        try:
            yield from self._neutral_units(lines_of(file), str(file))
        except InputError as error:
            self.diagnostics += error.diagnostics

    def _text_units(self, file: Path) -> Iterator[ReadUnit]:
        """Give the units of a file, of which some pieces at a time are in memory where it is FOON text."""
        pieces: Iterator[str] = iter(())
        if file.is_file():  # a pipe can be read only once
            pieces = text_pieces(file, _PIECE)
        try:
            first = next(pieces, "")
        except InputError as error:
            self.diagnostics += error.diagnostics
            return
        if not first or is_json(first):
            yield from self.units(self.text(file), str(file))
        else:
            yield from self._reading(first, pieces, str(file)).units()

    def text(self, file: Path, content: bytes | None = None) -> str:
        """Give the text of a file; it is empty, and an error is noted, if the file is not text.

        Parameters:
            file: The path of the file.
            content: Its bytes, if they are known and the file is not to be read.
        """
        try:
            return read_plain_text(file) if content is None else plain_text(content, file)
        except InputError as error:
            self.diagnostics += error.diagnostics
            return ""

    def raise_errors(self, earlier: int = 0) -> None:
        """Raise the errors found, if any.

        Parameters:
            earlier: The number of diagnostics, from the first on, to ignore.

        Raises:
            InputError: if another diagnostic is an error.
        """
        errors = [d for d in self.diagnostics[earlier:] if d.severity is Severity.ERROR]
        if errors:
            raise InputError(errors)

    def units(self, text: str, file: str) -> Iterator[ReadUnit]:
        """Give the units of a text in order.

        Parameters:
            text: The FOON text.
            file: The name of the file, for messages and sources.
        """
        if is_neutral(text, file):
            return self._neutral_units(split_lines(text), file)
        if is_json(text):
            return map(_identity, self._json_units(text, file))
        return self._reading(text, (), file).units()

    def listed_units(self, text: str, file: str) -> Iterator[ListedUnit]:
        """Give the units of a text in order, with their lines as written.

        Parameters:
            text: The FOON text.
            file: The name of the file, for messages and sources.
        """
        if is_neutral(text, file):
            return self._neutral_listed(text, file)
        if is_json(text):
            return self._json_units(text, file)
        return self._reading(text, (), file).listed_units()

    def object_blocks(self, text: str, file: str) -> list[ObjectBlock]:
        """Give the object nodes of a text that lists them without motions: a kitchen, or goals.

        Parameters:
            text: The text.
            file: The name of the file, for messages and sources.
        """
        return self._reading(text, (), file).object_blocks()

    def _reading(self, first: str, pieces: Iterable[str], file: str) -> "_FileReading":
        """Return the reading of a text; where something stands before JSON, that is the only error."""
        message = before_json(first)
        if not message:
            return _FileReading(self, chain([first], pieces), file)
        line = first[: len(first) - len(first.lstrip())].count("\n") + 1
        excerpt = split_lines(first.lstrip())[0]
        severity = Severity.WARNING if self.lenient else Severity.ERROR
        message += "; left out" if self.lenient else ""
        self.diagnostics.append(Diagnostic(severity, "json", message, Source(file, line, 1), excerpt))
        return _FileReading(self, (), file)

    def _json_units(self, text: str, file: str) -> Iterator[ListedUnit]:
        # most networks are none
        from foon_asp.text.exact_price import read_price  # noqa: PLC0415
        from foon_asp.text.json_units import read_json_units  # noqa: PLC0415

        self._plain.add(file)
        for unit in read_json_units(text, file, self.diagnostics, self.lenient):
            if unit.price:
                copy = FunctionalUnit.of(unit.motion.motion, *unit.sides)
                self.prices.add(copy, read_price(unit.price), unit.motion_source)
            yield unit

    def _neutral_units(self, lines: Iterable[str], file: str) -> Iterator[ReadUnit]:
        from foon_asp.text.exact_price import read_price  # noqa: PLC0415 (most networks are none)
        from foon_asp.text.neutral_units import read_neutral_units  # noqa: PLC0415

        self._plain.add(file)
        nodes: dict[str, ObjectNode] = {}
        prices: dict[str, Fraction] = {}
        for id_, *sides, price, source in read_neutral_units(lines, file, self.diagnostics, self.lenient):
            inputs, outputs = (
                [nodes.get(name) or nodes.setdefault(name, ObjectNode(name)) for name in side]
                for side in sides
            )
            if price:
                if price not in prices:
                    prices[price] = read_price(price)
                self.prices.add_least(FunctionalUnit.of(id_, inputs, outputs), prices[price])
            yield ReadUnit(id_, inputs, outputs, (source,))

    def _neutral_listed(self, text: str, file: str) -> Iterator[ListedUnit]:
        from foon_asp.text.neutral_units import read_neutral_units  # noqa: PLC0415

        lines = split_lines(text)
        for id_, *sides, price, source in read_neutral_units(lines, file, self.diagnostics, self.lenient):
            inputs, outputs = (
                tuple(ObjectBlock(ObjectLine(name), (), source) for name in side) for side in sides
            )
            yield ListedUnit(MotionLine(id_), inputs, outputs, (source,), source, price)

    def parse_new(self, lines: Iterable[str]) -> None:
        """Parse all lines not met before, together, which is faster than one by one.

        Of many lines and object blocks that were met, all are forgotten first.

        Parameters:
            lines: The lines.
        """
        if len(self.nodes) >= _REMEMBERED:
            self.nodes.clear()
            self.same_node.clear()
        if len(self._lines) >= _REMEMBERED:
            for known_before in (self._lines, self.labels, self.attributes, self.goal_lines):
                known_before.clear()
        known = self._lines
        new = [
            line
            for line in dict.fromkeys(lines)
            if line[:1] in {"O", "S", "M"} and line not in known and len(line) <= _LONGEST
        ]
        for line, parsed in zip(new, parse_lines(new), strict=True):
            known[line] = parsed
            if isinstance(parsed, StateLine):
                if not parsed.remarks:
                    self.attributes[line] = parsed.attribute
            elif isinstance(parsed, ObjectLine) and not parsed.remarks:
                self.labels[line[1:]] = parsed.label
                if parsed.is_goal:
                    self.goal_lines.add(line[1:])

    def parse(self, line: str) -> Line | LineError:
        """Give what a line says, or its error; each distinct line is parsed once.

        Parameters:
            line: The line.
        """
        parsed = self._lines.get(line)
        if parsed is None:
            try:
                if len(line) > _LONGEST:
                    found = f"a line of {len(line)} letters"
                    raise LineError(_LONGEST + 1, found, (f"at most {_LONGEST}",))
                parsed = parse_line(line)
            except LineError as error:
                parsed = error.kept()
            self._lines[line] = parsed
        return parsed


def _identity(unit: ListedUnit) -> ReadUnit:
    return ReadUnit(unit.motion.motion, *unit.sides, unit.sources)


class _FileReading:
    """One pass over the text of one file.

    A unit whose object blocks were all met before, with nothing in it to remark on, is read by looking
    the blocks up; every other one is read line by line.
    """

    def __init__(self, reader: FoonReader, pieces: Iterable[str], file: str) -> None:
        self.reader = reader
        self.file = file
        self.pieces_to_come = iter(pieces)
        self.text = ""  # what is being read of it
        self.lines_before = 0  # of what was read
        self.videos: tuple[str, ...] = ()
        self.header_open = True  # further "# Source:" lines add to the videos until a unit comes between
        self.start = 0  # of the piece being read, in the text
        self.looked_ahead = 0  # how far new lines have been parsed
        self.lines: list[str] = []  # of that piece, when it is read line by line
        self.number = 1  # of its first line
        self.objects: list[ObjectBlock] = []  # of units without a motion
        self.is_object_list = False
        self.pieces = 0  # between separators, with anything in them, so far

    def units(self) -> Iterator[ReadUnit]:
        for chunk, number, last in self._chunks():
            unit = None if last else self._look_up(chunk, number)
            if unit:
                self.header_open = False
                self.pieces += 1
                yield unit
            else:
                yield from map(_identity, self._line_by_line(chunk, number, last))

    def listed_units(self) -> Iterator[ListedUnit]:
        for chunk, number, last in self._chunks():
            yield from self._line_by_line(chunk, number, last)

    def object_blocks(self) -> list[ObjectBlock]:
        self.is_object_list = True
        for _ in self.listed_units():
            pass
        return self.objects

    def _chunks(self) -> Iterator[tuple[str, int, bool]]:
        """Cut the text at the separators; give each piece, its line number, and whether it is the last."""
        number = 1
        tell, untold = told(), 0
        more = True
        while more:
            while (end := self.text.find("\n//\n", self.start)) >= 0:
                chunk = self.text[self.start : end]
                yield chunk, number, False
                number += chunk.count("\n") + 2
                self.start = end + 4
                if tell and self.start - untold >= _AHEAD:
                    tell(len(self.text[untold : self.start].encode()))
                    untold = self.start
            if tell and self.start > untold:
                tell(len(self.text[untold : self.start].encode()))
            untold = 0
            more = self._read_more()
        yield self.text, number, True
        if tell and self.text:
            tell(len(self.text.encode()))

    def _read_more(self) -> bool:
        """Leave out of the text what was read, and add what follows; whether anything does.

        It is at least as much as is left, so that a text without separators takes time linear in its length.
        """
        rest = self.text[self.start :]
        self.lines_before += self.text.count("\n", 0, self.start)
        self.looked_ahead -= self.start
        self.start = 0
        pieces, added = [rest], 0
        while added <= len(rest) and (piece := next(self.pieces_to_come, "")):
            pieces.append(piece.replace("\r\n", "\n").replace("\r", "\n") if "\r" in piece else piece)
            added += len(piece)
        self.text = "".join(pieces)
        return len(pieces) > 1

    def _look_ahead(self, length: int) -> None:
        """Parse the new lines of the piece at hand, of that length, and of those that follow."""
        if self.start + length > self.looked_ahead:
            end = self.text.find("\n", self.start + max(length, _AHEAD))
            self.looked_ahead = len(self.text) if end < 0 else end
            self.reader.parse_new(self.text[self.start : self.looked_ahead].split("\n"))

    def _look_up(self, chunk: str, number: int) -> ReadUnit | None:
        """Read a unit by its object blocks; ``None`` when one of them cannot be taken as it is."""
        first, sources = number, []
        while chunk[:1] == "#":
            comment, line_end, chunk = chunk.partition("\n")
            copy = read_copy(comment)
            if not copy or not line_end:
                return None
            sources.append(copy)
            first += 1
        if chunk[:1] != "O":
            return None
        head, _, tail = chunk.partition("\nM")
        motion_line, _, tail = tail.partition("\nO")
        known, learn = self.reader.nodes.get, self._learn
        motion = self.reader.motions.get(motion_line) or self._learn_motion(motion_line, len(chunk))
        inputs = [known(block) or learn(block, len(chunk)) for block in head[1:].split("\nO")]
        outputs = [known(block) or learn(block, len(chunk)) for block in tail.split("\nO")]
        if not (motion and all(inputs) and all(outputs)):
            return None
        nodes = cast(tuple[list[ObjectNode], list[ObjectNode]], (inputs, outputs))
        return ReadUnit(motion, *nodes, tuple(sources) or (Source(self.file, first, 1, self.videos),))

    def _learn(self, block: str, length: int) -> ObjectNode | None:
        """Build the node of a block not met before, and remember it; ``None`` if there is anything to say."""
        self._look_ahead(length)
        reader = self.reader
        first, *rest = block.split("\n")
        try:
            node = node_of(reader.labels[first], [reader.attributes[line] for line in rest])
        except KeyError:
            return None
        node = reader.nodes[block] = reader.same_node.setdefault(node, node)
        if first in reader.goal_lines:
            line = self.text.count("\n", 0, self.text.index(f"O{block}", self.start)) + 1 + self.lines_before
            reader.marked.setdefault(node, Source(self.file, line))
        return node

    def _learn_motion(self, text: str, length: int) -> str | None:
        if "\n" in text:  # what stands between the motion and the outputs
            return None
        self._look_ahead(length)
        parsed = self.reader.parse("M" + text)
        if not isinstance(parsed, MotionLine) or parsed.remarks:
            return None
        self.reader.motions[text] = parsed.motion
        return parsed.motion

    def _line_by_line(self, chunk: str, number: int, last: bool) -> Iterator[ListedUnit]:
        """Read a piece of the text that may hold anything, separators with blanks behind them included."""
        self._look_ahead(len(chunk))
        self.lines = lines = chunk.split("\n")
        self.number = number
        start = 0
        for index, line in enumerate(lines):
            first = line[:1]
            if first == "#" and is_video(line):
                video = read_video(line)
                self.videos = (*(self.videos if self.header_open else ()), *([video] if video else []))
                self.header_open = True
            elif first == "/" and line.rstrip(" \t") == "//":
                unit = self._unit(start, index, closed=True)
                if line != "//":
                    self._warn("outer-space", "blanks after // left out", index, 3, "//")
                if unit:
                    self.header_open = False
                    yield unit
                start = index + 1
        unit = self._unit(start, len(lines), closed=not last)
        if unit:
            self.header_open = False
            if last:
                end = next(i for i in reversed(range(len(lines))) if lines[i].strip())
                message = "the last unit is not closed by //"
                self._warn("missing-separator", message, end, len(lines[end]) + 1)
            yield unit

    def _unit(self, start: int, end: int, closed: bool) -> ListedUnit | None:
        """Read the lines between two separators; ``None`` when they hold no unit."""
        piece = _Piece(end, closed, self.reader.left_out)
        for index in range(start, end):
            line = self.lines[index]
            letter = line[:1]
            if letter == "#":
                copy = read_copy(line)
                piece.copies += [copy] if copy else []
            elif letter and not line.isspace():
                if piece.first < 0:
                    piece.first = index
                self._line(piece, index)
        if piece.first < 0:
            return None
        self.pieces += 1
        if self.is_object_list:
            self.objects += _settled(piece.inputs + piece.outputs)
            return None
        if len(piece.motions) != 1 or not piece.inputs:
            self._no_unit(piece)
            return None
        index, motion = piece.motions[0]
        if not piece.outputs:
            self._warn("no-outputs", f"the unit {motion.motion!r} has no output objects", piece.first)
        for block in (*piece.inputs, *piece.outputs):
            if block.object.is_goal:
                node = node_of(block.object.label, (state.attribute for state in block.states))
                self.reader.marked.setdefault(node, block.source)
        sources = tuple(piece.copies) or (self._place(piece.first)._replace(videos=self.videos),)
        return ListedUnit(
            motion, _settled(piece.inputs), _settled(piece.outputs), sources, self._place(index)
        )

    def _line(self, piece: "_Piece", index: int) -> None:
        """Put a line where it belongs, or say why it belongs nowhere."""
        parsed = self.reader.parse(self.lines[index])
        if isinstance(parsed, LineError):
            self._reject("syntax", str(parsed), index, parsed.column)
            letter = self.lines[index][0]
            piece.lost = piece.lost or letter == "O"
            piece.blamed = piece.blamed or letter != "S"
            return
        self._remark(parsed, index)
        if isinstance(parsed, StateLine):
            if piece.lost:
                self.reader.left_out += self.reader.lenient
            elif piece.states is None:
                message = "found a state line, expected an object line before it"
                self._reject("state-without-object", message, index)
                piece.blamed = True
            else:
                piece.states.append(parsed)
            return
        piece.lost = False
        if isinstance(parsed, ObjectLine):
            piece.states = []
            side = piece.outputs if piece.motions else piece.inputs
            side.append(ObjectBlock(parsed, cast(tuple[StateLine, ...], piece.states), self._place(index)))
            return
        piece.states = None
        piece.motions.append((index, parsed))
        if self.is_object_list:
            message = "found a motion, expected a list of objects without motions"
            self._reject("motion-in-list", message, index)
        elif len(piece.motions) > 1:
            message = "found a second motion in one unit, expected an object line or //"
            self._reject("second-motion", message, index)
            piece.blamed = True

    def _no_unit(self, piece: "_Piece") -> None:
        """Say that lines are no unit, unless an error among them already says why."""
        if piece.blamed and not self.reader.lenient:
            return
        lines, first = self.lines, piece.first
        meaningful = [i for i in range(first, piece.end) if lines[i].strip() and lines[i][0] != "#"]
        self.reader.left_out = piece.left_out + len(meaningful)
        unit = f"the unit of line {self.number + first}"
        if len(piece.motions) > 1:
            self._warn("second-motion", f"{unit} has {len(piece.motions)} motions; left out", first)
        elif piece.motions:
            message = f"found a motion, expected an object line before it: {unit} has no input objects"
            self._warn("no-inputs", message + "; left out", piece.motions[0][0])
        elif not piece.closed and self.pieces == 1:
            listed = "one object" if len(piece.inputs) == 1 else f"{len(piece.inputs)} objects"
            message = f"{listed} and no motion: a list such as a kitchen or goals, without units"
            self._warn("no-motion", message, first)
        else:
            found = "found //" if piece.closed else "the file ends"
            message = f"{found}, expected a motion line: {unit} has no motion; left out"
            self._warn("no-motion", message, piece.end if piece.closed else meaningful[-1])

    def _place(self, index: int, column: int = 1) -> Source:
        return Source(self.file, self.number + index, column)

    def _remark(self, line: Line, index: int) -> None:
        if line.remarks:
            mended = write_line(line)
            fix = mended if mended != self.lines[index] else None
            for column, code, message in line.remarks:
                self._warn(code, message, index, column, fix)

    def _warn(self, code: str, message: str, index: int, column: int = 1, fix: str | None = None) -> None:
        line = self.lines[index] if index < len(self.lines) else "//"
        self.reader.diagnostics.append(
            Diagnostic(Severity.WARNING, code, message, self._place(index, column), line, fix)
        )

    def _reject(self, code: str, message: str, index: int, column: int = 1) -> None:
        """Note an error, or under ``lenient`` a warning that the line was left out."""
        reader = self.reader
        severity = Severity.ERROR
        if reader.lenient:
            severity = Severity.WARNING
            message += "; left out"
            reader.left_out += 1
        place = self._place(index, column)
        reader.diagnostics.append(Diagnostic(severity, code, message, place, self.lines[index]))


class _Piece:
    """The lines between two separators, while they are read one by one; places are indices of lines.

    ``states`` are those under the object line at hand, ``None`` before the first; ``lost`` says that this
    object line cannot be read, and that the states under it go with it. ``blamed`` says that an error among
    the lines can be why a motion or an object is missing. ``left_out`` is the count of before.
    """

    def __init__(self, end: int, closed: bool, left_out: int) -> None:
        self.end, self.closed, self.left_out = end, closed, left_out
        self.first = -1
        self.motions: list[tuple[int, MotionLine]] = []
        self.inputs: list[ObjectBlock] = []
        self.outputs: list[ObjectBlock] = []
        self.copies: list[Source] = []
        self.states: list[StateLine] | None = None
        self.lost = self.blamed = False


def _settled(blocks: list[ObjectBlock]) -> tuple[ObjectBlock, ...]:
    return tuple(block._replace(states=tuple(block.states)) for block in blocks)
