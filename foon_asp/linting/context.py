"""The context of rules: the files that are linted together, and a vocabulary of known names."""

from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from foon_asp.linting.chain import Chain
from foon_asp.linting.habits import Habits
from foon_asp.linting.linted_files import Copy, LintedFiles
from foon_asp.linting.names import Kind, Names
from foon_asp.linting.near_names import near_names
from foon_asp.linting.remarks import remarks_by_code
from foon_asp.linting.vocabulary import Vocabulary, read_vocabulary
from foon_asp.network import ObjectNode
from foon_asp.resources import bundled_vocabulary
from foon_asp.text.diagnostics import Diagnostic


class Side(NamedTuple):
    """One side of a unit: its inputs (``number`` 0) or its outputs (1), and the nodes of its other side."""

    unit: int
    number: int
    nodes: list[ObjectNode]
    others: list[ObjectNode]


class Context:
    """The files with their network and names, and the names of a vocabulary.

    ``findings`` are those of all rules but ``noqa``, once these have run.
    """

    def __init__(self, files: LintedFiles, vocabulary: Path | None = None) -> None:
        self.files, self.sheets, self.network = files, files.sheets, files.network
        self.names = Names(files)
        self.vocabulary = read_vocabulary(vocabulary or bundled_vocabulary())
        self.findings: list[Diagnostic] = []

    @cached_property
    def habits(self) -> Habits:
        """The changes and habits of the units."""
        return Habits(self.network)

    @cached_property
    def all_names(self) -> Vocabulary:
        """The vocabulary, with the names and habits of the files added."""
        return self.vocabulary.plus(Vocabulary.of(self.names, self.habits))

    @cached_property
    def remarks(self) -> dict[str, list[Diagnostic]]:
        """The remarks of the reader, by code."""
        return remarks_by_code(self.files, self.all_names)

    @cached_property
    def near_names(self) -> dict[Kind, list[tuple[str, str]]]:
        """Pairs of similar names by kind: the rarer name, and the one that may be meant."""
        names, words = self.names, self.vocabulary.words
        return {
            kind: list(near_names(names.counts[kind], kind is not Kind.OBJECT, words, names.loose[kind]))
            for kind in Kind
        }

    @cached_property
    def paired_names(self) -> set[tuple[Kind, str]]:
        """The names in :attr:`near_names`, with their kinds."""
        return {(kind, name) for kind, pairs in self.near_names.items() for pair in pairs for name in pair}

    @cached_property
    def made(self) -> set[int]:
        """The nodes that a unit makes: those among its outputs and not among its inputs."""
        return {node for chain in self.chains for node in chain.producers}

    @cached_property
    def sides(self) -> list[Side]:
        """Both sides of each unit."""
        objects, both = self.network.objects, []
        for unit, sides in enumerate(zip(self.network.inputs, self.network.outputs, strict=True)):
            inputs, outputs = ([objects[node] for node in side] for side in sides)
            both += [Side(unit, 0, inputs, outputs), Side(unit, 1, outputs, inputs)]
        return both

    @cached_property
    def chains(self) -> list[Chain]:
        """The units of each sheet in order."""
        return [Chain(self.network, copies) for copies in self.files.copies_by_sheet]

    def at_unit(self, copy: Copy, message: str) -> Diagnostic:
        """Return a finding about a copy of a unit."""
        return self.sheets[copy.sheet].finding(message, copy.at)

    def at_node(self, copy: Copy, side: int, node: ObjectNode, message: str) -> Diagnostic:
        """Return a finding about a node among the inputs (0) or outputs (1) of a copy of a unit."""
        sheet = self.sheets[copy.sheet]
        return sheet.finding(message, self.node_line(copy, side, node), node.label)

    def line(self, copy: Copy, side: int, node: ObjectNode) -> str:
        """Return the line of a node in a copy of a unit, as messages about the same file name it."""
        sheet = self.sheets[copy.sheet]
        return sheet.where(self.node_line(copy, side, node), sheet)

    def node_line(self, copy: Copy, side: int, node: ObjectNode) -> int:
        """Return the index of a node's object line in a copy of a unit, else of the copy's first line."""
        blocks = self.node_lines(copy)[side]
        return next((index for index, listed_node in blocks if listed_node == node), copy.at)

    def node_lines(self, copy: Copy) -> tuple[list[tuple[int, ObjectNode]], list[tuple[int, ObjectNode]]]:
        """Return the input and output nodes that a copy of a unit lists, each with its object line."""
        blocks = list(self.sheets[copy.sheet].blocks(copy.at))
        return blocks[: copy.inputs], blocks[copy.inputs :]
