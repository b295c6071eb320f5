"""Conversion of FOON files from one dialect to another, with counts of losses."""

from typing import NamedTuple

from foon_asp.network import Source
from foon_asp.text.amount_mark import is_amount
from foon_asp.text.conversion_ids import Numbering
from foon_asp.text.conversion_loss import CannotHoldError, Loss, lost_in_line
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.foon_json_writer import with_container
from foon_asp.text.foon_text import FoonText, rewrite_lines
from foon_asp.text.format import Dialect, Format, WrittenPart
from foon_asp.text.formats import format_of, format_with
from foon_asp.text.line import Line, MotionLine
from foon_asp.text.listed_unit import ListedUnit, ObjectBlock
from foon_asp.text.plain_file import protect_byte_order_mark, split_lines
from foon_asp.text.provenance import is_video, read_copy, read_video
from foon_asp.text.reading import Reading
from foon_asp.text.text_writer import TextWriter
from foon_asp.text.writer import write_line


class Lost(NamedTuple):
    """The losses of one kind: their number, and the source of the first one in the file."""

    occurrences: int
    first: Source


class Converted(NamedTuple):
    """A converted text, the ``dialect`` of the original text, and the losses by kind."""

    text: str
    dialect: Dialect
    lost: dict[Loss, Lost]


class Converter:
    """A converter of any number of files to the dialect ``target``; equal names get equal ids in all of them.

    A part that cannot be understood, or that the dialect cannot hold, is an error. If ``lenient``, such a
    part is left out, with a warning in ``diagnostics``. Only in a conversion from FOON text to FOON text, it
    then stays unchanged, without a warning.
    """

    def __init__(self, target: Dialect, lenient: bool = False) -> None:
        self.target = target
        self.lenient = lenient
        self._reading = Reading(lenient)
        self._numbering = Numbering()
        self._writer = format_with(target).writer(target, self._numbering)
        self._written: dict[object, WrittenPart] = {}

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """The diagnostics of all files so far."""
        return self._reading.diagnostics

    @property
    def left_out(self) -> int:
        """The number of lines left out of all files so far."""
        return self._reading.left_out

    def learn(self, text: str) -> None:
        """Record the ids in a text that will be converted, so that new ids differ from them.

        A name with an id keeps it in all files. Call this with all texts before the first one is converted.
        Nothing is done unless the target is the dialect ``ids``.
        """
        if self.target is Dialect.IDS:
            for line in format_of(text).lines(text):
                self._numbering.learn(line)

    def convert(self, text: str, file: str) -> Converted:
        """Return a converted text with the same functional units or listed objects, and the losses.

        ``file`` is the name of the file in messages. JSON or neutral lines that are in the target dialect
        already are laid out anew. Raises :class:`InputError` with the places of all parts that cannot be
        understood, or whose meaning the target cannot hold.
        """
        earlier_count = len(self.diagnostics)
        lost = _Tally(file)
        format_ = format_of(text, file)
        dialect = format_.dialect(text)
        if isinstance(format_, FoonText) and isinstance(self._writer, TextWriter):
            converted = self._converted_lines(text, file, self._writer, lost)
        elif dialect is self.target:
            converted = format_.canonical_text(text, file, self.lenient)
        elif format_.lists_objects(text):
            converted = self._converted_objects(text, file, format_, lost)
        else:
            converted = self._converted_network(text, file, format_, lost)
        self._reading.raise_errors(earlier_count)
        return Converted(converted, dialect, lost.by_kind)

    def _converted_lines(self, text: str, file: str, writer: TextWriter, lost: "_Tally") -> str:
        """Return FOON text in another dialect of FOON text; losses are added to ``lost``.

        Comments and blank lines stay. If ``lenient``, lines that cannot be understood stay unchanged;
        otherwise :class:`InputError` is raised for them.
        """
        losses_by_line: dict[str, list[Loss]] = {}

        def rewrite(line: Line, written: str) -> str:
            """Return a line as the target writes it, and record its losses under its old text ``written``."""
            target_line = writer.in_dialect(line)
            losses_by_line[written] = lost_in_line(line, target_line)
            return write_line(target_line)

        converted = rewrite_lines(text, file, self.lenient, rewrite)
        for number, line in enumerate(split_lines(text), 1):
            lost.add(losses_by_line.get(line, ()), Source(file, number))
        return protect_byte_order_mark(converted)

    def _converted_objects(self, text: str, file: str, format_: Format, lost: "_Tally") -> str:
        """Return a list of objects in the other dialect; losses are added to ``lost``, comments among them.

        Objects that the dialect cannot hold are left out, and recorded as faults.
        """
        blocks = [with_container(*entry) for entry in format_.objects(text, file, self._reading)]
        if format_.has_comments:
            lost.add_comments(text, ())
        texts: list[str] = []
        for block in blocks:
            try:
                texts.append(self._element_text(block, block.source, lost, in_list=True))
            except CannotHoldError as error:
                self._reject(error, block.source)
        return self._writer.objects(texts)

    def _converted_network(self, text: str, file: str, format_: Format, lost: "_Tally") -> str:
        """Return a network in the other dialect; losses are added to ``lost``.

        A node that a unit lists twice is written once. Its amount is the sum of both amounts if ``format_``
        is a machine-written format, and otherwise the greater amount. Units that the dialect cannot hold are
        left out, and recorded as faults.
        """
        units = list(format_.listed_units(text, file, self._reading))
        videos = self._kept_videos(text, format_, units, lost)
        merged_units = [
            unit.with_totals if format_.machine_written else unit.without_repeats for unit in units
        ]
        unit_texts = [self._converted_unit(unit, lost) for unit in merged_units]
        return self._writer.network([unit for unit in unit_texts if unit], videos)

    def _converted_unit(self, unit: ListedUnit, lost: "_Tally") -> str:
        """Return the text of a unit; losses are added to ``lost``.

        If the target cannot hold the unit, the text is empty, and a fault is recorded.
        """
        try:
            if not unit.inputs and not self._writer.holds_no_inputs:
                raise CannotHoldError(f"the unit {unit.motion.motion!r} has no input objects")
            motion = self._element_text(unit.motion, unit.motion_source, lost)
            inputs, outputs = (
                [self._element_text(block, block.source, lost) for block in blocks]
                for blocks in (unit.inputs, unit.outputs)
            )
        except CannotHoldError as error:
            self._reject(error, unit.motion_source)
            return ""
        lost.add([Loss.PRICES] if unit.price and not self._writer.holds_prices else [], unit.motion_source)
        return self._writer.unit(inputs, motion, outputs, unit.price)

    def _element_text(
        self, element: ObjectBlock | MotionLine, source: Source, lost: "_Tally", in_list: bool = False
    ) -> str:
        """Return the text of an object or a motion, cached for equal ones; losses are added to ``lost``.

        ``in_list`` is true in a list of objects, and false in a unit. Raises :class:`CannotHoldError` if the
        target cannot hold the element.
        """
        key = (
            element
            if isinstance(element, MotionLine)
            else (element.object, element.states, element.amount, in_list)
        )
        written = self._written.get(key)
        if written is None:
            written = self._written[key] = (
                self._writer.motion(element)
                if isinstance(element, MotionLine)
                else self._writer.block(element, in_list)
            )
        lost.add(written[1], source)
        return written[0]

    def _kept_videos(
        self, text: str, format_: Format, units: list[ListedUnit], lost: "_Tally"
    ) -> tuple[str, ...]:
        """Return the source videos that all units share, if the target can name them.

        If the videos of two units differ, the result is empty. Lost comments and videos are added to
        ``lost``.
        """
        video_lists = {unit.sources[0].videos for unit in units}
        shared_videos = video_lists.pop() if len(video_lists) == 1 else ()
        comments = [line for line in split_lines(text) if line[:1] == "#"]
        kept = self._writer.held_videos(shared_videos, comments)
        if format_.has_comments:
            lost.add_comments(text, kept)
        else:
            lost.add([Loss.VIDEOS] * (len(shared_videos) - len(kept)), Source(lost.file, 1))
        return kept

    def _reject(self, error: CannotHoldError, source: Source) -> None:
        """Record a part that the target cannot hold: as an error, or as a warning if ``lenient``."""
        self._reading.reject("cannot-hold", f"{self.target} cannot hold this: {error}", source)


class _Tally:
    """The losses of one file so far; ``by_kind`` has their numbers and first places."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.by_kind: dict[Loss, Lost] = {}

    def add(self, losses: list[Loss] | tuple[()], source: Source) -> None:
        """Count losses at a place; for each kind of loss, keep its first place in the file."""
        for loss in losses:
            count, first = self.by_kind.get(loss, (0, source))
            self.by_kind[loss] = Lost(count + 1, min(first, source))

    def add_comments(self, text: str, kept: tuple[str, ...]) -> None:
        """Count the comments of a text as lost, except amounts and names of ``kept`` videos.

        The kind of loss is a video, a copy that a unit was merged from, or another comment.
        """
        for number, line in enumerate(split_lines(text), 1):
            if line[:1] == "#" and not is_amount(line) and read_video(line) not in kept:
                kind = Loss.VIDEOS if is_video(line) else Loss.COPIES if read_copy(line) else Loss.COMMENTS
                self.add([kind], Source(self.file, number))
