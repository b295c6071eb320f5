"""Taking FOON files from one dialect to another, and keeping count of what is lost on the way."""

from typing import NamedTuple

from foon_asp.network import Source
from foon_asp.text.conversion_ids import Numbering
from foon_asp.text.conversion_loss import CannotHoldError, Loss, lost_in_line
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.foon_text import FoonText, rewritten
from foon_asp.text.format import Dialect, Format, Part
from foon_asp.text.formats import format_of, format_with
from foon_asp.text.json_writer import with_container
from foon_asp.text.line import Line, MotionLine
from foon_asp.text.listed_unit import ListedUnit, ObjectBlock
from foon_asp.text.plain_file import split_lines, with_own_mark
from foon_asp.text.provenance import is_video, read_copy, read_video
from foon_asp.text.reading import Reading
from foon_asp.text.text_writer import TextWriter
from foon_asp.text.writer import write_line


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
        self._reading = Reading(lenient)
        self._numbering = Numbering()
        self._writer = format_with(target).writer(target, self._numbering)
        self._parts: dict[object, Part] = {}

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """What was remarked on in all files so far."""
        return self._reading.diagnostics

    @property
    def left_out(self) -> int:
        """How many lines were left out."""
        return self._reading.left_out

    def learn(self, text: str) -> None:
        """Record the ids of a text that will be converted, so that others keep clear of them."""
        if self.target is Dialect.IDS:
            for line in format_of(text).lines(text):
                self._numbering.learn(line)

    def convert(self, text: str, file: str) -> Converted:
        """Convert a text; what it says on functional units or listed objects is the same before and after.

        Raises :class:`InputError` with the place of everything that cannot be understood, or whose meaning
        the target cannot hold.
        """
        earlier = len(self.diagnostics)
        lost = _Tally(file)
        format_ = format_of(text, file)
        dialect = format_.dialect(text)
        if isinstance(format_, FoonText) and isinstance(self._writer, TextWriter):
            converted = self._lines(text, file, self._writer, lost)
        elif dialect is self.target:
            converted = format_.normalised(text, file, self.lenient)
        elif format_.lists_objects(text):
            converted = self._objects(text, file, format_, lost)
        else:
            converted = self._units(text, file, format_, lost)
        self._reading.raise_errors(earlier)
        return Converted(converted, dialect, lost.found)

    def _lines(self, text: str, file: str, writer: TextWriter, lost: "_Tally") -> str:
        """Rewrite line by line, so that all between the lines stays."""
        seen: dict[str, list[Loss]] = {}

        def rewrite(line: Line, written: str) -> str:
            held = writer.held(line)
            seen[written] = lost_in_line(line, held)
            return write_line(held)

        new = rewritten(text, file, self.lenient, rewrite)
        for number, line in enumerate(split_lines(text), 1):
            lost.add(seen.get(line, ()), Source(file, number))
        return with_own_mark(new)

    def _objects(self, text: str, file: str, format_: Format, lost: "_Tally") -> str:
        blocks = [with_container(*entry) for entry in format_.objects(text, file, self._reading)]
        if format_.has_comments:
            lost.comments(text, ())
        parts: list[str] = []
        for block in blocks:
            try:
                parts.append(self._part(block, block.source, lost, in_list=True))
            except CannotHoldError as problem:
                self._cannot_hold(problem, block.source)
        return self._writer.objects(parts)

    def _units(self, text: str, file: str, format_: Format, lost: "_Tally") -> str:
        listed = list(format_.listed_units(text, file, self._reading))
        videos = self._videos(text, format_, listed, lost)
        written = [self._unit(unit, lost) for unit in listed]
        return self._writer.network([unit for unit in written if unit], videos)

    def _unit(self, unit: ListedUnit, lost: "_Tally") -> str:
        """Write a unit; it is empty where the target cannot hold it, which is noted."""
        try:
            if not unit.inputs and not self._writer.holds_no_inputs:
                raise CannotHoldError(f"the unit {unit.motion.motion!r} has no input objects")
            motion = self._part(unit.motion, unit.motion_source, lost)
            inputs, outputs = (
                [self._part(block, block.source, lost) for block in side]
                for side in (unit.inputs, unit.outputs)
            )
        except CannotHoldError as problem:
            self._cannot_hold(problem, unit.motion_source)
            return ""
        lost.add([Loss.PRICES] if unit.price and not self._writer.holds_prices else [], unit.motion_source)
        return self._writer.unit(inputs, motion, outputs, unit.price)

    def _part(
        self, said: ObjectBlock | MotionLine, source: Source, lost: "_Tally", in_list: bool = False
    ) -> str:
        """Write an object or a motion, and count what is lost of it; each distinct one is written once."""
        key = said if isinstance(said, MotionLine) else (said.object, said.states, in_list)
        part = self._parts.get(key)
        if part is None:
            part = self._parts[key] = (
                self._writer.motion(said)
                if isinstance(said, MotionLine)
                else self._writer.block(said, in_list)
            )
        lost.add(part[1], source)
        return part[0]

    def _videos(self, text: str, format_: Format, units: list[ListedUnit], lost: "_Tally") -> tuple[str, ...]:
        """Return the videos that the result can name, those of the whole file, and count the others."""
        found = {unit.sources[0].videos for unit in units}
        common = found.pop() if len(found) == 1 else ()
        comments = [line for line in split_lines(text) if line[:1] == "#"]
        kept = self._writer.held_videos(common, comments)
        if format_.has_comments:
            lost.comments(text, kept)
        else:
            lost.add([Loss.VIDEOS] * (len(common) - len(kept)), Source(lost.file, 1))
        return kept

    def _cannot_hold(self, problem: CannotHoldError, source: Source) -> None:
        self._reading.reject("cannot-hold", f"{self.target} cannot hold this: {problem}", source)


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
