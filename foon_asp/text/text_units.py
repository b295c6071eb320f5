"""Reading of FOON text: its units, or the objects of a list without motions.

A well-formed unit is read by its object blocks, and each distinct block is parsed once. Any other unit is
read line by line, with remarks.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import chain
from typing import cast

from foon_asp.network import ObjectNode, Source
from foon_asp.text.amount_mark import is_amount, read_amount
from foon_asp.text.json_list import fault_before_json
from foon_asp.text.line import Line, LineError, MotionLine, ObjectLine, StateLine
from foon_asp.text.line_parser import read_line
from foon_asp.text.listed_unit import ListedUnit, ObjectBlock, ReadUnit, node_of
from foon_asp.text.plain_file import split_lines
from foon_asp.text.provenance import is_video, read_copy, read_video
from foon_asp.text.reading import REPORT_BYTES, Reading, progress_report
from foon_asp.text.writer import write_line

_SEPARATOR = "\n//\n"


@dataclass(slots=True)
class _OpenBlock:
    """An object block to which lines may still be added."""

    line: ObjectLine
    states: list[StateLine]
    source: Source
    amount: int | None = None


@lru_cache(50_000)  # of the 11,625 object blocks of the universal FOON, 4,361 are different
def _node_of_clean_block(block: str) -> ObjectNode | None:
    """Return the node of a well-formed object block, given without its first ``O``; results are cached.

    Return ``None`` for a block with faults or remarks, and for a goal, whose source has to be recorded.
    """
    head, line_end, states = block.partition("\n")
    line = read_line(f"O{head}")
    if not isinstance(line, ObjectLine) or line.remarks or line.is_goal:
        return None
    if not line_end:
        return ObjectNode(line.label)
    node = _unlabelled_node_of_clean_states(states)
    return None if node is None else ObjectNode(line.label, *node[1:])


@lru_cache(50_000)  # the states under very many objects are the same
def _unlabelled_node_of_clean_states(states: str) -> ObjectNode | None:
    """Return a node with an empty label and the attributes of state lines; results are cached.

    Return ``None`` if a line has a remark or is no state line.
    """
    lines = map(read_line, states.split("\n"))
    attributes = [line.attribute for line in lines if isinstance(line, StateLine) and not line.remarks]
    return node_of("", attributes) if len(attributes) == states.count("\n") + 1 else None


def _nodes_of_clean_blocks(blocks: str) -> list[ObjectNode] | None:
    """Return the nodes of object blocks, given without the first ``O``.

    Return ``None`` if one of the blocks is not well-formed, or is a goal.
    """
    nodes = list(map(_node_of_clean_block, blocks.split("\nO")))
    return cast(list[ObjectNode], nodes) if all(nodes) else None


class TextUnits:
    """A reader of one FOON text, given in pieces; only one of its methods can be called, and only once.

    All line ends in the text have to be line feeds. ``file`` is the name of the file in sources. Diagnostics
    and goal marks are recorded in ``reading``.
    """

    def __init__(self, pieces: Iterable[str], file: str, reading: Reading) -> None:
        self.reading = reading
        self.file = file
        self._pieces = iter(pieces)
        self._videos: tuple[str, ...] = ()
        self._header_open = True  # further "# Source:" lines add to the videos until a unit comes between
        self._lines: list[str] = []  # of the chunk that is read line by line
        self._number = 1  # of the first line of the chunk
        self._objects: list[ObjectBlock] | None = None  # a list without motions is read
        self._sections = 0  # between separators, with anything in them, so far

    def units(self) -> Iterator[ReadUnit]:
        """Yield the units in order, without their lines but with their amounts.

        A node that a unit lists twice has the greatest of its amounts.
        """
        for chunk, last in self._chunks():
            unit = None if last else self._clean_unit(chunk)
            if unit:
                self._header_open = False
                self._sections += 1
                yield unit
            else:
                yield from map(_without_lines, self._units_line_by_line(chunk, last))

    def listed_units(self) -> Iterator[ListedUnit]:
        """Yield the units in order, with their lines as written."""
        for chunk, last in self._chunks():
            yield from self._units_line_by_line(chunk, last)

    def objects(self) -> list[ObjectBlock]:
        """Return the object blocks of a kitchen or of goals; a motion is recorded as a fault."""
        self._objects = []
        for _ in self.listed_units():
            pass
        return self._objects

    def _chunks(self) -> Iterator[tuple[str, bool]]:
        """Yield the chunks of the text between lines ``//``, each with whether it is the last.

        A line ``//`` with blanks behind it ends no chunk. ``_number`` is set to the number of the first line
        of each chunk. Progress is reported. If the text is JSON behind other text, this fault is recorded,
        and there are no chunks.
        """
        report, unreported = progress_report(), 0
        pieces = [next(self._pieces, "")]
        if message := fault_before_json(pieces[0]):
            self._reject_text_before_json(message, pieces[0])
            return
        for piece in chain(self._pieces, [""]):
            pieces.append(piece)
            # doubling: the time for a text without separators stays linear
            if piece and sum(map(len, pieces)) < 2 * len(pieces[0]):
                continue
            *chunks, remainder = "".join(pieces).split(_SEPARATOR)
            pieces = [remainder]
            for chunk in chunks:
                yield chunk, False
                self._number += chunk.count("\n") + 2
                if report:
                    unreported += len(chunk.encode()) + len(_SEPARATOR)
                    if unreported >= REPORT_BYTES:
                        report(unreported)
                        unreported = 0
        yield pieces[0], True
        if report:
            report(unreported + len(pieces[0].encode()))

    def _reject_text_before_json(self, message: str, text: str) -> None:
        """Record ``message`` as the only fault of the file, at its first line that is not blank."""
        content = text.lstrip()
        line = text[: len(text) - len(content)].count("\n") + 1
        self.reading.reject("json", message, Source(self.file, line, 1), split_lines(content)[0])

    def _clean_unit(self, chunk: str) -> ReadUnit | None:
        """Return the unit of a well-formed chunk, read block by block; ``None`` for any other chunk.

        A well-formed chunk has no amounts and no goals. Its only comments are lines ``# From:`` at its
        beginning.
        """
        first_line, copies = self._number, []
        while chunk[:1] == "#":
            comment, line_end, chunk = chunk.partition("\n")
            copy = read_copy(comment)
            if not copy or not line_end:
                return None
            copies.append(copy)
            first_line += 1
        if chunk[:1] != "O":
            return None
        input_blocks, _, motion_and_outputs = chunk.partition("\nM")
        motion_line, _, output_blocks = motion_and_outputs.partition("\nO")
        if not (motion_line and output_blocks) or "\n" in motion_line:
            return None
        motion = read_line(f"M{motion_line}")
        if not isinstance(motion, MotionLine) or motion.remarks:
            return None
        inputs, outputs = _nodes_of_clean_blocks(input_blocks[1:]), _nodes_of_clean_blocks(output_blocks)
        if inputs is None or outputs is None:
            return None
        sources = tuple(copies) or (Source(self.file, first_line, 1, self._videos),)
        return ReadUnit(motion.motion, inputs, outputs, sources)

    def _units_line_by_line(self, chunk: str, last: bool) -> Iterator[ListedUnit]:
        """Yield the units of a chunk, read line by line; remarks and faults are recorded.

        A chunk has several units if some line ``//`` has blanks behind it. ``last`` is true for the last
        chunk of a file; a unit without ``//`` at its end then causes a warning. Lines ``# Source:`` name the
        videos of all units up to the next such lines.
        """
        self._lines = lines = chunk.split("\n")
        start = 0
        for index, line in enumerate(lines):
            letter = line[:1]
            if letter == "#" and is_video(line):
                video = read_video(line)
                self._videos = (*(self._videos if self._header_open else ()), *([video] if video else []))
                self._header_open = True
            elif letter == "/" and line.rstrip(" \t") == "//":
                unit = self._read_unit(start, index, closed=True)
                if line != "//":
                    self._warn("outer-space", "blanks after // left out", index, 3, "//")
                if unit:
                    self._header_open = False
                    yield unit
                start = index + 1
        unit = self._read_unit(start, len(lines), closed=not last)
        if unit:
            self._header_open = False
            if last:
                end = next(i for i in reversed(range(len(lines))) if lines[i].strip())
                message = "the last unit is not closed by //"
                self._warn("missing-separator", message, end, len(lines[end]) + 1)
            yield unit

    def _read_unit(self, start: int, end: int, closed: bool) -> ListedUnit | None:
        """Return the unit in the lines from index ``start`` to before ``end``; ``None`` if they are no unit.

        ``closed`` is true if ``//`` follows. Goal marks, warnings and faults are recorded. In a list without
        motions, the objects are collected, and ``None`` is returned.
        """
        section = _Section(end, closed, self.reading.left_out)
        for index in range(start, end):
            line = self._lines[index]
            letter = line[:1]
            if letter == "#":
                copy = read_copy(line)
                section.copies += [copy] if copy else []
                if is_amount(line):
                    self._add_amount(section, index)
            elif letter and not line.isspace():
                if section.first_index < 0:
                    section.first_index = index
                self._add_line(section, index)
        if section.first_index < 0:
            return None
        self._sections += 1
        if self._objects is not None:
            self._objects += _closed_blocks(section.inputs + section.outputs)
            return None
        if len(section.motions) != 1 or not section.inputs:
            self._warn_of_no_unit(section)
            return None
        index, motion = section.motions[0]
        if not section.outputs:
            self._warn("no-outputs", f"the unit {motion.motion!r} has no output objects", section.first_index)
        inputs, outputs = _closed_blocks(section.inputs), _closed_blocks(section.outputs)
        for block in (*inputs, *outputs):
            if block.object.is_goal:
                self.reading.marked.setdefault(block.node, block.source)
        sources = tuple(section.copies) or (self._source(section.first_index)._replace(videos=self._videos),)
        return ListedUnit(motion, inputs, outputs, sources, self._source(index))

    def _add_amount(self, section: "_Section", index: int) -> None:
        """Set the amount of the current object to that in a comment line, or record the line as a fault.

        If the object could not be read, its amount is dropped, and the line counts as left out if
        ``lenient``.
        """
        if section.object_unreadable:
            self.reading.left_out += self.reading.lenient
            return
        if section.block is None or section.block.amount is not None:
            found = "a second amount" if section.block else "an amount"
            message = f"found {found}, expected one under an object line, for that object"
            self._reject("amount", message, index)
            return
        try:
            section.block.amount = read_amount(self._lines[index])
        except LineError as error:
            self._reject("amount", str(error), index, error.column)

    def _add_line(self, section: "_Section", index: int) -> None:
        """Add an object, state or motion line to its section.

        A line that is broken or out of place is recorded as a fault. Slips in any line are recorded as
        warnings.
        """
        line = self._lines[index]
        parsed = read_line(line)
        if isinstance(parsed, LineError):
            self._reject("syntax", str(parsed), index, parsed.column)
            section.object_unreadable = section.object_unreadable or line[0] == "O"
            section.has_error = section.has_error or line[0] != "S"
            return
        self._report_remarks(parsed, index)
        if isinstance(parsed, StateLine):
            if section.object_unreadable:
                self.reading.left_out += self.reading.lenient
            elif section.block is None:
                message = "found a state line, expected an object line before it"
                self._reject("state-without-object", message, index)
                section.has_error = True
            else:
                section.block.states.append(parsed)
            return
        section.object_unreadable = False
        if isinstance(parsed, ObjectLine):
            section.block = _OpenBlock(parsed, [], self._source(index))
            (section.outputs if section.motions else section.inputs).append(section.block)
            return
        section.block = None
        section.motions.append((index, parsed))
        if self._objects is not None:
            message = "found a motion, expected a list of objects without motions"
            self._reject("motion-in-list", message, index)
        elif len(section.motions) > 1:
            message = "found a second motion in one unit, expected an object line or //"
            self._reject("second-motion", message, index)
            section.has_error = True

    def _warn_of_no_unit(self, section: "_Section") -> None:
        """Warn that the lines of a section are no unit, and count them as left out.

        If an error that was recorded before explains this, nothing is done. If ``lenient``, faults are no
        errors, so the warning is always given.
        """
        if section.has_error and not self.reading.lenient:
            return
        lines, first = self._lines, section.first_index
        meaningful = [i for i in range(first, section.end) if lines[i].strip() and lines[i][0] != "#"]
        self.reading.left_out = section.left_out + len(meaningful)
        unit = f"the unit of line {self._number + first}"
        if len(section.motions) > 1:
            self._warn("second-motion", f"{unit} has {len(section.motions)} motions; left out", first)
        elif section.motions:
            message = f"found a motion, expected an object line before it: {unit} has no input objects"
            self._warn("no-inputs", message + "; left out", section.motions[0][0])
        elif not section.closed and self._sections == 1:
            self._warn("no-motion", no_motion_message(len(section.inputs)), first)
        else:
            fault = "found //" if section.closed else "the file ends"
            message = f"{fault}, expected a motion line: {unit} has no motion; left out"
            self._warn("no-motion", message, section.end if section.closed else meaningful[-1])

    def _source(self, index: int, column: int = 1) -> Source:
        """Return the source of the line at an index of the chunk."""
        return Source(self.file, self._number + index, column)

    def _report_remarks(self, line: Line, index: int) -> None:
        """Record the remarks on a line as warnings, with the line in canonical form as their fix.

        If the line is in canonical form already, the warnings have no fix.
        """
        if line.remarks:
            mended = write_line(line)
            fix = mended if mended != self._lines[index] else None
            for column, code, message in line.remarks:
                self._warn(code, message, index, column, fix)

    def _warn(self, code: str, message: str, index: int, column: int = 1, fix: str | None = None) -> None:
        """Record a warning about the line at an index of the chunk."""
        line = self._lines[index] if index < len(self._lines) else "//"
        self.reading.warn(code, message, self._source(index, column), line, fix)

    def _reject(self, code: str, message: str, index: int, column: int = 1) -> None:
        """Record a fault of the line at an index of the chunk.

        If ``lenient``, it is a warning, and the line counts as left out.
        """
        self.reading.left_out += self.reading.lenient
        self.reading.reject(code, message, self._source(index, column), self._lines[index])


class _Section:
    """The lines between two separators ``//``, while they are read one by one.

    ``end``: the index behind the last line.
    ``first_index``: the index of the first line with content; -1 without one.
    ``closed``: true if ``//`` follows.
    ``motions``: the motion lines, each with its index.
    ``copies``: the sources that comment lines name.
    ``block``: the block of the current object line; ``None`` before the first object line.
    ``object_unreadable``: true if the current object line cannot be read. The states under it are left out.
    ``has_error``: true if an error in a line may be the reason for a missing motion or object.
    ``left_out``: the number of lines of the file that were left out before this section.
    """

    def __init__(self, end: int, closed: bool, left_out: int) -> None:
        self.end, self.closed, self.left_out = end, closed, left_out
        self.first_index = -1
        self.motions: list[tuple[int, MotionLine]] = []
        self.inputs: list[_OpenBlock] = []
        self.outputs: list[_OpenBlock] = []
        self.copies: list[Source] = []
        self.block: _OpenBlock | None = None
        self.object_unreadable = self.has_error = False


def no_motion_message(object_count: int) -> str:
    """Return the warning that a file has only objects where a network was expected."""
    objects = "one object" if object_count == 1 else f"{object_count} objects"
    return f"{objects} and no motion: a list such as a kitchen or goals, without units"


def _closed_blocks(open_blocks: list[_OpenBlock]) -> tuple[ObjectBlock, ...]:
    """Return object blocks to which no more lines will be added."""
    return tuple(
        ObjectBlock(block.line, tuple(block.states), block.source, block.amount) for block in open_blocks
    )


def _without_lines(unit: ListedUnit) -> ReadUnit:
    """Return a unit without its lines; the amount of a node that is listed twice is its greatest amount."""
    if all(block.amount is None for block in (*unit.inputs, *unit.outputs)):
        return unit.identity
    return unit.identity._replace(amounts=unit.without_repeats.amounts)
