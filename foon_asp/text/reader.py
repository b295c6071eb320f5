"""Reading FOON files into a network: FOON text of every dialect, and JSON."""

from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import chain
from pathlib import Path

from foon_asp.network import FunctionalUnit, Network, NetworkBuilder, ObjectNode, Source
from foon_asp.text.diagnostics import InputError
from foon_asp.text.line import Line, LineError, MotionLine, ObjectLine
from foon_asp.text.line_parser import read_line
from foon_asp.text.listed_unit import ListedUnit, ObjectBlock, ReadUnit
from foon_asp.text.plain_file import (
    is_json,
    is_neutral,
    is_neutral_file,
    plain_text,
    read_plain_text,
    split_lines,
    text_pieces,
)
from foon_asp.text.reading import Reading
from foon_asp.text.repeated_node import RepeatedNode, repeated_node
from foon_asp.text.text_units import TextUnits

_PIECE = 1_000_000  # letters of a file read at a time


class FoonReader(Reading):
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
        super().__init__(lenient)
        self.last_units: dict[int, Source] = {}
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
            yield from TextUnits(chain([first], pieces), str(file), self).units()

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

    def units(self, text: str, file: str) -> Iterator[ReadUnit]:
        """Give the units of a text in order.

        Parameters:
            text: The FOON text.
            file: The name of the file, for messages and sources.
        """
        if is_neutral(text, file):
            return self._neutral_units(split_lines(text), file)
        if is_json(text):
            return (unit.identity for unit in self._json_units(text, file))
        return self._text(text, file).units()

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
        return self._text(text, file).listed_units()

    def object_blocks(self, text: str, file: str) -> list[ObjectBlock]:
        """Give the object nodes of a text that lists them without motions: a kitchen, or goals.

        Parameters:
            text: The text.
            file: The name of the file, for messages and sources.
        """
        return self._text(text, file).objects()

    def _text(self, text: str, file: str) -> TextUnits:
        return TextUnits([text.replace("\r\n", "\n").replace("\r", "\n")], file, self)

    def _json_units(self, text: str, file: str) -> Iterator[ListedUnit]:
        # most networks are none
        from foon_asp.text.exact_number import read_price  # noqa: PLC0415
        from foon_asp.text.json_units import read_json_units  # noqa: PLC0415

        self._plain.add(file)
        for unit in read_json_units(text, file, self.diagnostics, self.lenient):
            if unit.price:
                copy = FunctionalUnit.of(unit.motion.motion, *unit.sides)
                self.prices.add(copy, read_price(unit.price), unit.motion_source)
            yield unit

    def _neutral_units(self, lines: Iterable[str], file: str) -> Iterator[ReadUnit]:
        from foon_asp.text.exact_number import read_price  # noqa: PLC0415 (most networks are none)
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

    def parse(self, line: str) -> Line | LineError:
        """Give what a line says, or its error; each distinct line is parsed once.

        Parameters:
            line: The line.
        """
        return read_line(line)
