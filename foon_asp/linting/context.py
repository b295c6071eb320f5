"""The context in which lint rules run: the linted files, and a vocabulary of known names."""

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
    """One side of a unit: its inputs (``number`` 0) or its outputs (1).

    ``nodes`` are the nodes of this side, ``others`` those of the other side. ``unit`` is the id of the unit.
    """

    unit: int
    number: int
    nodes: list[ObjectNode]
    others: list[ObjectNode]


class Context:
    """What rules look at: the linted files with their network and names, and a vocabulary of known names.

    ``vocabulary`` is the vocabulary file; for ``None``, the bundled one is read. ``findings`` is empty at
    first. The linter adds the findings of all rules but ``noqa``, because ``noqa`` looks at them.
    """

    def __init__(self, files: LintedFiles, vocabulary: Path | None = None) -> None:
        self.files, self.sheets, self.network = files, files.sheets, files.network
        self.names = Names(files)
        self.vocabulary = read_vocabulary(vocabulary or bundled_vocabulary())
        self.findings: list[Diagnostic] = []

    @cached_property
    def habits(self) -> Habits:
        """The changes of each unit of the files, and the habits of motions."""
        return Habits(self.network)

    @cached_property
    def all_names(self) -> Vocabulary:
        """The names and habits of the vocabulary and of the files together."""
        return self.vocabulary.union(Vocabulary.of(self.names, self.habits))

    @cached_property
    def remarks(self) -> dict[str, list[Diagnostic]]:
        """The remarks of the reader on the files, by code; only fixes that are certain are kept."""
        return remarks_by_code(self.files, self.all_names)

    @cached_property
    def near_names(self) -> dict[Kind, list[tuple[str, str]]]:
        """By kind of name, pairs of similar names: the rarer one, and the one that is probably meant."""
        names, words = self.names, self.vocabulary.words
        return {
            kind: list(near_names(names.counts[kind], kind is not Kind.OBJECT, words, names.one_sided[kind]))
            for kind in Kind
        }

    @cached_property
    def paired_names(self) -> set[tuple[Kind, str]]:
        """All names in the pairs of :attr:`near_names`, each after its kind."""
        return {(kind, name) for kind, pairs in self.near_names.items() for pair in pairs for name in pair}

    @cached_property
    def made_nodes(self) -> set[int]:
        """The ids of the nodes that some unit makes: they are among its outputs and not among its inputs."""
        return {node for chain in self.chains for node in chain.producers}

    @cached_property
    def sides(self) -> list[Side]:
        """Both sides of each unit, inputs first, in the order of unit ids."""
        objects, both_sides = self.network.objects, []
        for unit, sides in enumerate(zip(self.network.inputs, self.network.outputs, strict=True)):
            inputs, outputs = ([objects[node] for node in side] for side in sides)
            both_sides += [Side(unit, 0, inputs, outputs), Side(unit, 1, outputs, inputs)]
        return both_sides

    @cached_property
    def chains(self) -> list[Chain]:
        """The chain of each sheet, in the order of the sheets."""
        return [Chain(self.network, copies) for copies in self.files.copies_by_sheet]

    def finding_at_unit(self, copy: Copy, message: str) -> Diagnostic:
        """Return a finding at the first line of a copy of a unit."""
        return self.sheets[copy.sheet].finding(message, copy.first_index)

    def finding_at_node(self, copy: Copy, side: int, node: ObjectNode, message: str) -> Diagnostic:
        """Return a finding at the object line of an input (``side`` 0) or output (1) of a copy of a unit.

        Its line is the one that :meth:`node_line` returns. Its column is that of the label.
        """
        sheet = self.sheets[copy.sheet]
        return sheet.finding(message, self.node_line(copy, side, node), node.label)

    def line_name(self, copy: Copy, side: int, node: ObjectNode) -> str:
        """Return the line of a node in a copy of a unit as text for messages, such as ``line 7``.

        ``side`` is 0 for inputs and 1 for outputs.
        """
        sheet = self.sheets[copy.sheet]
        return sheet.line_name(self.node_line(copy, side, node), sheet)

    def node_line(self, copy: Copy, side: int, node: ObjectNode) -> int:
        """Return the index of the object line of a node in a copy of a unit.

        ``side`` is 0 for inputs and 1 for outputs. If this side does not list the node, return the index of
        the first line of the copy.
        """
        blocks = self.node_lines(copy)[side]
        return next((index for index, listed_node in blocks if listed_node == node), copy.first_index)

    def node_lines(self, copy: Copy) -> tuple[list[tuple[int, ObjectNode]], list[tuple[int, ObjectNode]]]:
        """Return the inputs and outputs of a copy of a unit, each node with the index of its object line."""
        blocks = list(self.sheets[copy.sheet].object_nodes(copy.first_index))
        return blocks[: copy.inputs], blocks[copy.inputs :]
