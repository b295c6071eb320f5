"""The interfaces of file formats and of their writers."""

from collections.abc import Iterator, Sequence
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from foon_asp.network import NodePattern, UnitAmounts
from foon_asp.text.line import Line, Mention, MotionLine
from foon_asp.text.listed_unit import ListedUnit, ObjectBlock, ReadUnit
from foon_asp.text.plain_file import read_plain_text
from foon_asp.text.reading import Reading

if TYPE_CHECKING:
    from foon_asp.text.conversion_ids import Numbering
    from foon_asp.text.conversion_loss import Loss
    from foon_asp.text.renaming import Renaming


class Dialect(StrEnum):
    """A dialect of FOON files; ``docs/formats.md`` has an example of each."""

    PLAIN = "plain"
    """``O⇥onion``, ``M⇥chop``: names only, as in a universal FOON."""
    NO_IDS = "no-ids"
    """``O⇥onion⇥1``, ``M⇥chop⇥<0:14,0:20>``: motion flags and times in one field."""
    IDS = "ids"
    """``O294⇥onion⇥1``, ``M12⇥chop⇥0:14⇥0:20``: ids, motion flags, and times in two fields."""
    JSON = "json"
    """``{"functional_units": [...]}`` with ``object_label``, ids, motion flags and times."""
    JSON_LIST = "json-list"
    """A list of units whose objects have ``label``, ``states``, ``ingredients`` and ``container``."""

    NEUTRAL = "neutral"
    """``{"id": "chop", "inputs": ["onion"], "outputs": ["chopped onion"]}``: a unit a line, plain names."""


class Format(Protocol):
    """A format of files, as the reader, ``fmt``, ``convert``, ``rename`` and ``lint`` use it.

    ``dialects``: the dialects of the format.
    ``suffix``, ``list_suffix``: the end of file names of networks, and of lists of objects.
    ``has_comments``: whether files may have comments.
    ``machine_written``: whether a node that a unit lists twice means two copies of the node.

    The parameter ``file`` of most methods is the name of the file for messages.
    """

    dialects: tuple[Dialect, ...] = ()
    suffix: str
    list_suffix: str
    has_comments: bool = False
    machine_written: bool = False

    def recognises(self, text: str, file: str) -> bool:
        """Whether a text is in this format; the beginning of a long text is enough."""

    def dialect(self, text: str) -> Dialect:
        """Return the dialect of a text, even if parts of it cannot be understood."""

    def lists_objects(self, text: str) -> bool:
        """Whether a text lists object nodes, as a kitchen or goals do, and has no functional units."""

    def file_units(self, file: Path, reading: Reading) -> Iterator[ReadUnit]:
        """Yield the units of a file in order; raises :class:`InputError` for a file that is no text."""
        yield from self.units(read_plain_text(file), str(file), reading)

    def units(self, text: str, file: str, reading: Reading) -> Iterator[ReadUnit]:
        """Yield the units of a text in order, without their lines.

        The units have amounts if the format is ``machine_written``; other formats may replace this method.
        The diagnostics of the text are added to ``reading``.
        """
        for unit in self.listed_units(text, file, reading):
            amounts = unit.amounts if self.machine_written else UnitAmounts()
            yield unit.identity._replace(amounts=amounts) if amounts else unit.identity

    def listed_units(self, text: str, file: str, reading: Reading) -> Iterator[ListedUnit]:
        """Yield the units of a text in order, with their lines as written."""

    def objects(self, text: str, file: str, reading: Reading) -> Iterator[tuple[ObjectBlock, NodePattern]]:
        """Yield the objects of a kitchen or of goals, each with its pattern."""

    def lines(self, text: str) -> Iterator[Line]:
        """Yield the parts of a text that can be understood, as lines of FOON text."""

    def canonical_text(self, text: str, file: str, lenient: bool = False) -> str:
        """Return a text in canonical form, with the same meaning.

        Raises :class:`InputError` with all faults; with ``lenient``, parts that cannot be understood stay.
        """

    def mentions(self, text: str, file: str) -> Iterator[Mention]:
        """Yield every mention of a name in a text.

        Raises :class:`InputError` for a text in JSON that has a fault of syntax.
        """

    def renamed_text(self, text: str, file: str, renaming: "Renaming") -> str:
        """Return a text in which ``renaming`` has replaced the name; all else stays as it is written."""

    def writer(self, target: Dialect, numbering: "Numbering") -> "Writer":
        """Return a writer of files in ``target``, a dialect of this format.

        Lines without an id get it from ``numbering``, where the dialect has ids.
        """


WrittenPart = tuple[str, "list[Loss]"]
"""The text of a part of a unit, and its losses."""


class Writer(Protocol):
    """A writer of files in a dialect, part by part.

    ``block`` and ``motion`` return the text of a part. ``unit``, ``network`` and ``objects`` put such texts
    together. ``holds_prices`` is true if the files can hold prices of units. ``holds_no_inputs`` is true if
    they can hold units without inputs.
    """

    holds_prices: bool
    holds_no_inputs: bool

    def block(self, block: ObjectBlock, in_list: bool) -> WrittenPart:
        """Return the text of an object and its losses.

        ``in_list`` is true in a list of objects, and false in a unit. Raises :class:`CannotHoldError` if the
        text would be read as another object.
        """

    def motion(self, line: MotionLine) -> WrittenPart:
        """Return the text of a motion and its losses.

        Raises :class:`CannotHoldError` if the text would be read as another motion.
        """

    def unit(self, inputs: Sequence[str], motion: str, outputs: Sequence[str], price: str) -> str:
        """Return the text of a unit from the texts of its parts; without a price, ``price`` is empty."""

    def network(self, units: Sequence[str], videos: Sequence[str]) -> str:
        """Return the text of a file from the texts of its units and from its source videos."""

    def objects(self, parts: Sequence[str]) -> str:
        """Return the text of a list of objects; ``parts`` are the texts of its objects."""

    def held_videos(self, videos: tuple[str, ...], comments: Sequence[str]) -> tuple[str, ...]:
        """Return the ``videos`` that the written file can name.

        ``videos`` are the source videos that all units share. ``comments`` are the comment lines of the file
        that is converted.
        """
