"""Writing of units and objects as FOON text of a dialect."""

from collections.abc import Sequence

from foon_asp.network import Relation
from foon_asp.text.amount_mark import write_amount
from foon_asp.text.conversion_ids import Numbering
from foon_asp.text.conversion_loss import CannotHoldError, lost_in_line
from foon_asp.text.format import Dialect, WrittenPart
from foon_asp.text.line import Line, LineError, MotionLine, ObjectLine, StateLine
from foon_asp.text.line_parser import read_line
from foon_asp.text.listed_unit import ObjectBlock
from foon_asp.text.motion_times import MotionFields, in_one_field, in_two_fields
from foon_asp.text.provenance import read_video
from foon_asp.text.writer import write_line


class TextWriter:
    """A writer of FOON text, which reads each line back: names from JSON may mean something else in text.

    See :class:`~foon_asp.text.format.Writer` for its methods.
    """

    holds_prices = holds_no_inputs = False

    def __init__(self, target: Dialect, numbering: Numbering) -> None:
        self._target = target
        self._numbering = numbering

    def block(self, block: ObjectBlock, in_list: bool) -> WrittenPart:
        """Return the lines of an object block, and its losses; an amount of 1 is written only in a list."""
        parts = list(map(self._line_text, block.lines))
        mark = ""
        if block.amount is not None and (in_list or block.amount > 1):
            mark = write_amount(block.amount)
        return "".join(text for text, _ in parts) + mark, [loss for _, lost in parts for loss in lost]

    def motion(self, line: MotionLine) -> WrittenPart:
        """Return the line of a motion, and its losses."""
        return self._line_text(line)

    def unit(self, inputs: Sequence[str], motion: str, outputs: Sequence[str], price: str) -> str:
        """Return the lines of a unit from its parts, with a closing ``//``; ``price`` is not written."""
        return "".join((*inputs, motion, *outputs, "//\n"))

    def network(self, units: Sequence[str], videos: Sequence[str]) -> str:
        """Return the text of a file from its units; lines ``# Source:`` at its top name the videos."""
        header = "".join(f"# Source:\t{video}\n" for video in videos) + "//\n" if videos else ""
        return header + "".join(units)

    def objects(self, parts: Sequence[str]) -> str:
        """Return the text of a list of objects."""
        return "".join(parts)

    def held_videos(self, videos: tuple[str, ...], comments: Sequence[str]) -> tuple[str, ...]:
        """Return the ``videos`` that a comment line can name."""
        return tuple(video for video in videos if read_video(f"# Source:\t{video}") == video)

    def in_dialect(self, line: Line) -> Line:
        """Return a line with only the parts that the dialect can hold; in ``IDS``, the line gets an id.

        Remarks are removed. Times are put into one field or two, as the dialect has them. A relation without
        a word gets the word ``in``.
        """
        line = line._replace(remarks=())
        line = with_container_word(line) if isinstance(line, StateLine) else line
        line = self._numbering.number(line) if self._target is Dialect.IDS else line._replace(id="")
        if self._target is Dialect.PLAIN:
            if isinstance(line, ObjectLine):
                return line._replace(fields=())
            return line._replace(fields=(), composite=False) if isinstance(line, MotionLine) else line
        if isinstance(line, MotionLine):
            motion_fields = MotionFields.of(line.fields)
            convert = in_two_fields if self._target is Dialect.IDS else in_one_field
            return line._replace(fields=motion_fields._replace(times=convert(motion_fields.times)).fields)
        return line

    def _line_text(self, line: Line) -> WrittenPart:
        """Return the text of a line in the dialect, with its line end, and its losses.

        Raises :class:`CannotHoldError` where the text would not be read back with the same meaning.
        """
        written = write_line(self.in_dialect(line))
        if any("\ud800" <= c <= "\udfff" for c in written):
            raise CannotHoldError(f"{written!r} contains half a character")
        read_back = read_line(written) if "\n" not in written and "\r" not in written else None
        if read_back is None or isinstance(read_back, LineError):
            raise CannotHoldError(f"{written!r} is no line of FOON text")
        return written + "\n", lost_in_line(line, read_back)


def with_container_word(line: StateLine) -> StateLine:
    """Return a state line; if it is a relation without a word, return it with the word ``in``."""
    if isinstance(line.attribute, Relation) and not line.attribute.word:
        return line._replace(attribute=line.attribute._replace(word="in"))
    return line
