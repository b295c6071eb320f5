"""Taking FOON files from one dialect to another, and keeping count of what is lost on the way."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from foon_asp.network import ObjectNode, Relation, Source
from foon_asp.text.conversion_ids import Numbering
from foon_asp.text.conversion_loss import CannotHoldError, Loss, lost_in_line, lost_in_states
from foon_asp.text.conversion_times import in_one_field, in_two_fields
from foon_asp.text.diagnostics import Diagnostic, Severity
from foon_asp.text.dialect import Dialect, dialect_of, is_object_list
from foon_asp.text.formatter import format_text, with_own_mark
from foon_asp.text.json_layout import lay_out
from foon_asp.text.json_list import JsonList
from foon_asp.text.json_object import read_objects
from foon_asp.text.json_units import read_json_units
from foon_asp.text.json_value import json_line
from foon_asp.text.json_writer import (
    json_motion,
    json_object,
    list_motion,
    list_object,
    written_list,
    written_network,
    written_unit,
)
from foon_asp.text.line import Line, LineError, MotionLine, ObjectLine, StateLine
from foon_asp.text.listed_unit import ListedUnit, ObjectBlock
from foon_asp.text.motion_times import MotionFields
from foon_asp.text.neutral_units import write_neutral_unit
from foon_asp.text.plain_file import is_json, split_lines
from foon_asp.text.provenance import is_video, read_copy, read_video
from foon_asp.text.reader import FoonReader
from foon_asp.text.writer import write_line

_Part = tuple[str, list[Loss]]  # how an object block or motion is written, and what of it is lost


class Lost(NamedTuple):
    """How often something of one kind could not be kept, and where first."""

    occurrences: int
    first: Source


class Converted(NamedTuple):
    """A text in another dialect, the dialect it was in, and what of it was lost."""

    text: str
    dialect: Dialect
    lost: dict[Loss, Lost]


class Converter:
    """Converts any number of files to one dialect, with the same ids for the same names in all of them.

    With ``lenient``, what cannot be understood or held is left out with a warning, or stays as it is where
    lines are turned into lines. Warnings are in ``diagnostics``.
    """

    def __init__(self, target: Dialect, lenient: bool = False) -> None:
        self.target = target
        self.lenient = lenient
        self._reader = FoonReader(lenient)
        self._numbering = Numbering()
        self._parts: dict[object, _Part] = {}
        self._names: dict[str, ObjectNode] = {}  # of the neutral form
        self._is_list = False

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """What was remarked on in all files so far."""
        return self._reader.diagnostics

    @property
    def left_out(self) -> int:
        """How many lines were left out."""
        return self._reader.left_out

    def learn(self, text: str) -> None:
        """Note the ids of a text that will be converted, so that others keep clear of them."""
        if self.target is not Dialect.IDS:
            return
        reader = FoonReader(lenient=True)
        if is_json(text):
            blocks: list[ObjectBlock] = []
            if is_object_list(text):
                blocks += _listed_json(text, "", [])
            for unit in () if blocks else reader.listed_units(text, ""):
                blocks += unit.inputs + unit.outputs
                self._numbering.learn(unit.motion)
            for line in (line for block in blocks for line in block.lines):
                self._numbering.learn(line)
            return
        lines = dict.fromkeys(split_lines(text))
        for written in lines:
            if written[:1] in {"O", "S", "M"}:
                parsed = self._reader.parse(written)
                if not isinstance(parsed, LineError):
                    self._numbering.learn(parsed)

    def convert(self, text: str, file: str) -> Converted:
        """Convert a text; what it says on functional units or listed objects is the same before and after.

        Raises :class:`InputError` with the place of everything that cannot be understood, or whose meaning
        the target cannot hold.
        """
        earlier = len(self.diagnostics)
        lost = _Tally(file)
        dialect = dialect_of(text, self._reader, file)
        self._is_list = is_object_list(text)
        if dialect is self.target and dialect.is_json:
            converted = format_text(text, file, self.lenient)
        elif not dialect.is_json and not self.target.is_json:
            converted = self._lines(text, file, lost)
        elif self._is_list:
            converted = self._object_list(text, file, lost)
        else:
            converted = self._units(text, file, lost)
        self._reader.raise_errors(earlier)
        return Converted(converted, dialect, lost.found)

    def _lines(self, text: str, file: str, lost: "_Tally") -> str:
        """Rewrite line by line, so that all between the lines stays."""
        seen: dict[str, list[Loss]] = {}

        def rewrite(line: Line, written: str) -> str:
            held = self._held(line)
            seen[written] = lost_in_line(line, held)
            return write_line(held)

        formatted = format_text(text, file, self.lenient, rewrite, self._reader)
        for number, line in enumerate(split_lines(text), 1):
            lost.add(seen.get(line, ()), Source(file, number))
        return with_own_mark(formatted)

    def _object_list(self, text: str, file: str, lost: "_Tally") -> str:
        if is_json(text):
            blocks = _listed_json(text, file, self.diagnostics)
        else:
            blocks = self._reader.object_blocks(text, file)
            if self.target.is_json:
                lost.comments(text, ())
        parts: list[str] = []
        for block in blocks:
            try:
                if self.target is Dialect.NEUTRAL:
                    parts.append(f'{{"label": {json_line(self._name(block, lost))}}}')
                else:
                    parts += _counted([(self._block(block, 1), block.source)], lost)
            except CannotHoldError as problem:
                self._cannot_hold(problem, block.source)
        return written_list(parts, 0) + "\n" if self.target.is_json else "".join(parts)

    def _units(self, text: str, file: str, lost: "_Tally") -> str:
        level = 2 if self.target is Dialect.JSON else 1
        units: list[str] = []
        if self.target is Dialect.NEUTRAL:
            return "".join(self._neutral_unit(unit, lost) for unit in self._neutral_listed(text, file, lost))
        listed = list(self._reader.listed_units(text, file))
        videos = self._videos(text, listed, lost)
        for unit in listed:
            try:
                if not unit.inputs:
                    raise CannotHoldError(f"the unit {unit.motion.motion!r} has no input objects")
                motion = _counted([(self._motion(unit.motion, level + 1), unit.motion_source)], lost)
                inputs, outputs = (
                    _counted([(self._block(block, level + 2), block.source) for block in side], lost)
                    for side in (unit.inputs, unit.outputs)
                )
            except CannotHoldError as problem:
                self._cannot_hold(problem, unit.motion_source)
                continue
            if self.target.is_json:
                units.append(written_unit(inputs, motion[0], outputs, unit.price, level))
            else:
                units.append("".join((*inputs, *motion, *outputs, "//\n")))
                lost.add([Loss.PRICES] if unit.price else [], unit.motion_source)
        if self.target is Dialect.JSON:
            return written_network(videos, units)
        if self.target is Dialect.JSON_LIST:
            return written_list(units, 0) + "\n"
        header = "".join(f"# Source:\t{video}\n" for video in videos) + "//\n" if videos else ""
        return header + "".join(units)

    def _neutral_listed(self, text: str, file: str, lost: "_Tally") -> Iterator[ListedUnit]:
        if not is_json(text):
            lost.comments(text, ())
        for number, unit in enumerate(self._reader.listed_units(text, file)):
            if is_json(text) and not number:
                lost.add([Loss.VIDEOS] * len(unit.sources[0].videos), Source(file, 1))
            yield unit

    def _neutral_unit(self, unit: ListedUnit, lost: "_Tally") -> str:
        """Write a unit with the motion as its id, and each object node as one name, in one-line notation."""
        try:
            inputs, outputs = (
                [self._name(block, lost) for block in side] for side in (unit.inputs, unit.outputs)
            )
            lost.add(lost_in_line(unit.motion, MotionLine(unit.motion.motion)), unit.motion_source)
        except CannotHoldError as problem:
            self._cannot_hold(problem, unit.motion_source)
            return ""
        return write_neutral_unit(unit.motion.motion, inputs, outputs, unit.price)

    def _name(self, block: ObjectBlock, lost: "_Tally") -> str:
        """Give the plain name of an object node, which no other node has."""
        states = tuple(map(_with_word, block.states))
        node = block._replace(states=states).node
        name = str(node) if states else node.label
        if not name or name != name.strip(" "):
            raise CannotHoldError(f"{name!r} is no name, or has blanks around it")
        if self._names.setdefault(name, node) != node:
            raise CannotHoldError(f"{name!r} would be the name of two object nodes")
        losses = lost_in_line(block.object, ObjectLine(block.object.label))
        losses += [Loss.IDS] * sum(bool(state.id) for state in states) + [Loss.PARTS] * bool(states)
        losses += [Loss.CONTAINERS] * (states != block.states)
        lost.add(losses, block.source)
        return name

    def _videos(self, text: str, units: list[ListedUnit], lost: "_Tally") -> tuple[str, ...]:
        """Give the videos that the result can name: those of the whole file, in lines or under one key."""
        found = {unit.sources[0].videos for unit in units}
        common = found.pop() if len(found) == 1 else ()
        if self.target is Dialect.JSON_LIST:
            kept: tuple[str, ...] = ()
        elif self.target is Dialect.JSON:
            lines = [line for line in split_lines(text) if line[:1] == "#"]
            named = tuple(video for video in map(read_video, lines) if video)
            kept = common if named == common and not any(map(read_copy, lines)) else ()
        else:
            kept = tuple(video for video in common if read_video(f"# Source:\t{video}") == video)
        if is_json(text):
            lost.add([Loss.VIDEOS] * (len(common) - len(kept)), Source(lost.file, 1))
        else:
            lost.comments(text, kept)
        return kept

    def _block(self, block: ObjectBlock, level: int) -> _Part:
        key = block.object, block.states, self._is_list
        part = self._parts.get(key)
        if part is None:
            line, states = block.object, block.states
            if self.target.is_json:
                form = json_object if self.target is Dialect.JSON else list_object
                text = form(line, states)
                back = self._object_back(text)
                losses = lost_in_line(line, back.object) + lost_in_states(states, back.states)
                part = lay_out(text, level), losses
            else:
                lines = list(map(self._line_part, block.lines))
                part = "".join(text for text, _ in lines), [loss for _, found in lines for loss in found]
            self._parts[key] = part
        return part

    def _motion(self, line: MotionLine, level: int) -> _Part:
        part = self._parts.get(line)
        if part is None:
            if self.target.is_json:
                text = (json_motion if self.target is Dialect.JSON else list_motion)(line)
                unit = self._unit_back('{"label":"x"}', text)
                part = lay_out(text, level), lost_in_line(line, unit.motion)
            else:
                part = self._line_part(line)
            self._parts[line] = part
        return part

    def _line_part(self, line: Line) -> _Part:
        """Write a line of text, and read it back: what stood in JSON may mean something else in text."""
        written = write_line(self._held(line))
        if any("\ud800" <= c <= "\udfff" for c in written):
            raise CannotHoldError(f"{written!r} contains half a character")
        back = self._reader.parse(written) if "\n" not in written and "\r" not in written else None
        if back is None or isinstance(back, LineError):
            raise CannotHoldError(f"{written!r} is no line of FOON text")
        return written + "\n", lost_in_line(line, back)

    def _held(self, line: Line) -> Line:
        """Give the line as a dialect of text has it."""
        line = line._replace(remarks=())
        line = _with_word(line) if isinstance(line, StateLine) else line
        line = self._numbering.number(line) if self.target is Dialect.IDS else line._replace(id="")
        if self.target is Dialect.PLAIN:
            if isinstance(line, ObjectLine):
                return line._replace(fields=())
            return line._replace(fields=(), composite=False) if isinstance(line, MotionLine) else line
        if isinstance(line, MotionLine):
            said = MotionFields.of(line.fields)
            change = in_two_fields if self.target is Dialect.IDS else in_one_field
            return line._replace(fields=said._replace(times=change(said.times)).fields)
        return line

    def _object_back(self, text: str) -> ObjectBlock:
        if self._is_list:
            diagnostics: list[Diagnostic] = []
            found = _listed_json(f"[{text}]", "", diagnostics)
            _raise_first_error(diagnostics)
            return found[0]
        return self._unit_back(text, '"x"').inputs[0]

    def _unit_back(self, node: str, motion: str) -> ListedUnit:
        text = f'[{{"input_nodes":[{node}],"motion_node":{motion},"output_nodes":[{node}]}}]'
        diagnostics: list[Diagnostic] = []
        found = list(read_json_units(text, "", diagnostics, lenient=False))
        _raise_first_error(diagnostics)
        return found[0]

    def _cannot_hold(self, problem: CannotHoldError, source: Source) -> None:
        severity = Severity.WARNING if self.lenient else Severity.ERROR
        message = f"{self.target} cannot hold this: {problem}" + ("; left out" if self.lenient else "")
        self.diagnostics.append(Diagnostic(severity, "cannot-hold", message, source))


def _with_word(line: StateLine) -> StateLine:
    """Give a container without a word as one that the object is in."""
    if isinstance(line.attribute, Relation) and not line.attribute.word:
        return line._replace(attribute=line.attribute._replace(word="in"))
    return line


def _counted(parts: list[tuple[_Part, Source]], lost: "_Tally") -> list[str]:
    """Give the texts of parts, and count what is lost of each."""
    for (_, losses), place in parts:
        lost.add(losses, place)
    return [text for (text, _), _ in parts]


def _raise_first_error(diagnostics: list[Diagnostic]) -> None:
    """Refuse what cannot be read back; what is only in doubt there was so before, or counts as lost."""
    for diagnostic in diagnostics:
        if diagnostic.severity is Severity.ERROR:
            raise CannotHoldError(diagnostic.message)


class _Tally:
    """Counts what is lost of one file."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.found: dict[Loss, Lost] = {}

    def add(self, losses: list[Loss] | tuple[()], place: Source) -> None:
        for loss in losses:
            count, first = self.found.get(loss, (0, place))
            self.found[loss] = Lost(count + 1, min(first, place))

    def comments(self, text: str, kept: tuple[str, ...]) -> None:
        """Count the comments of a text that goes to JSON, but for videos that are kept."""
        for number, line in enumerate(split_lines(text), 1):
            if line[:1] == "#" and read_video(line) not in kept:
                kind = Loss.VIDEOS if is_video(line) else Loss.COPIES if read_copy(line) else Loss.COMMENTS
                self.add([kind], Source(self.file, number))


def _listed_json(text: str, file: str, errors: list[Diagnostic]) -> list[ObjectBlock]:
    """Read a list of objects; a container is a relation without a word, and comes last."""
    elements = JsonList(text, Path(file))
    blocks = []
    for block, pattern, _ in read_objects(elements):
        anywhere = (StateLine(Relation("", pattern.container)),) if pattern.container is not None else ()
        blocks.append(block._replace(states=block.states + anywhere))
    errors += elements.errors
    return blocks
