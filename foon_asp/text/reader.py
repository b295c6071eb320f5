"""Reading of FOON files of any format into a network."""

from collections.abc import Iterable, Iterator
from pathlib import Path

from foon_asp.network import FunctionalUnit, Network, NetworkBuilder, Source
from foon_asp.text.diagnostics import InputError
from foon_asp.text.formats import format_of
from foon_asp.text.line import Line, LineError
from foon_asp.text.line_parser import read_line
from foon_asp.text.listed_unit import ListedUnit, ObjectBlock, ReadUnit
from foon_asp.text.plain_file import plain_text, read_beginning_text, read_plain_text, split_lines
from foon_asp.text.reading import Reading
from foon_asp.text.repeated_node import RepeatedNode, repeated_node
from foon_asp.text.text_units import TextUnits


class FoonReader(Reading):
    r"""A reader of any number of FOON files, which parses each distinct line and object block once.

    With ``lenient``, parts that are not understood are left out with a warning; otherwise they are errors.
    ``diagnostics`` has the findings in all files read so far. ``left_out`` counts the lines that were not
    understood or do not form a unit. ``prices`` and ``amounts`` are those that copies of units state.
    ``marked`` are the nodes with the goal mark ``!``, each with its first place. ``repeated`` are the nodes
    that a copy of a unit lists twice. ``last_units`` maps the id of a unit to its place. It has
    the last unit with outputs of each file that :meth:`read_network` read.

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

    def read_network(self, files: Iterable[Path]) -> Network:
        """Return the network that files are merged into.

        The last unit of each file is recorded in ``last_units``.

        Parameters:
            files: The paths of the files.

        Raises:
            InputError: with all errors of all files.
        """
        builder = NetworkBuilder()
        earlier_count = len(self.diagnostics)
        for file in files:
            last: tuple[int, Source] | None = None
            for motion, inputs, outputs, sources, _ in self.file_units(file):
                unit = builder.add(motion, inputs, outputs, *sources)
                last = (unit, sources[0]) if outputs else last
            if last:
                self.last_units.setdefault(*last)
        self.raise_errors(earlier_count)
        return builder.build()

    def tree_units(self, text: str, file: str) -> list[tuple[FunctionalUnit, Source]]:
        """Return the units of a text in listed order, copies included, each with its first source.

        Their amounts are recorded in ``amounts``.

        Parameters:
            text: The FOON text.
            file: The name of the file, for messages and sources.

        Raises:
            InputError: with all errors of the text.
        """
        earlier_count = len(self.diagnostics)
        units = []
        for motion, inputs, outputs, sources, amounts in self.units(text, file):
            unit = FunctionalUnit.of(motion, inputs, outputs)
            units.append((unit, sources[0]))
            if amounts:
                self.amounts.add(unit, amounts, sources[0])
        self.raise_errors(earlier_count)
        return units

    def file_units(self, file: Path) -> Iterator[ReadUnit]:
        """Yield the units of a file in order; FOON text and neutral files are read piece by piece.

        Amounts and prices are recorded in this reader, and so are repeated nodes of FOON text. A file that is
        not text adds an error to ``diagnostics``.

        Parameters:
            file: The path of the file.
        """
        is_pipe = not file.is_file()  # which can be read only once
        beginning_text = self.text(file) if is_pipe else read_beginning_text(file)
        format_ = format_of(beginning_text, file.name)
        try:
            for unit in (
                format_.units(beginning_text, str(file), self) if is_pipe else format_.file_units(file, self)
            ):
                node = None if format_.machine_written else repeated_node(unit.inputs, unit.outputs)
                if node:
                    self.repeated.append(RepeatedNode(str(node), unit.source))
                if unit.amounts:
                    copy = FunctionalUnit.of(unit.motion, unit.inputs, unit.outputs)
                    for source in unit.sources:
                        self.amounts.add(copy, unit.amounts, source)
                yield unit
        except InputError as error:
            self.diagnostics += error.diagnostics

    def text(self, file: Path, content: bytes | None = None) -> str:
        """Return the text of a file; if the file is not text, record an error and return an empty text.

        Parameters:
            file: The path of the file.
            content: Its bytes, if they are known; ``None`` to read the file.

        Raises:
            UserError: if the file cannot be read, or is a store.
        """
        try:
            return read_plain_text(file) if content is None else plain_text(content, file)
        except InputError as error:
            self.diagnostics += error.diagnostics
            return ""

    def units(self, text: str, file: str) -> Iterator[ReadUnit]:
        """Yield the units of a text in order; findings are added to ``diagnostics``.

        Their amounts are not recorded in ``amounts``.

        Parameters:
            text: The FOON text.
            file: The name of the file, for messages and sources.
        """
        return format_of(text, file).units(text, file, self)

    def listed_units(self, text: str, file: str) -> Iterator[ListedUnit]:
        """Yield the units of a text in order, with their lines as written.

        Parameters:
            text: The FOON text.
            file: The name of the file, for messages and sources.
        """
        return format_of(text, file).listed_units(text, file, self)

    def object_blocks(self, text: str, file: str) -> list[ObjectBlock]:
        """Return the object blocks of FOON text without motions: a kitchen, or goals.

        A motion is added to ``diagnostics`` as an error.

        Parameters:
            text: The text.
            file: The name of the file, for messages and sources.
        """
        return TextUnits(["\n".join(split_lines(text))], file, self).objects()

    def parse(self, line: str) -> Line | LineError:
        """Return the parsed line, or its error; each distinct line is parsed once.

        Parameters:
            line: The line.
        """
        return read_line(line)
