"""The names in the files that are linted together, with the lines that mention them."""

from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

from foon_asp.linting.linted_files import LintedFiles
from foon_asp.linting.sheet import Sheet
from foon_asp.network import ObjectNode
from foon_asp.text.line import Line, NameKind, ObjectLine, line_names

Kind = NameKind


def is_of_another_network(unknown: int, total: int) -> bool:
    """Whether a list or table is probably for another network, as most of its names are unknown.

    ``total`` is the number of its names, and ``unknown`` how many of them the network lacks. False for up to
    ten unknown names: these are probably slips, which are reported one by one.
    """
    return unknown > 10 and 2 * unknown > total


class Mention(NamedTuple):
    """A line with a name; equal lines of a sheet are one mention.

    ``sheet``: the index of the sheet.
    ``first_index``: the index of the first of the equal lines.
    ``occurrences``: how many equal lines there are.
    """

    sheet: int
    line: Line
    first_index: int
    occurrences: int


class Names:
    """Every name in the files, by its kind.

    ``mentions``: by kind and name, the lines with the name, in order.
    ``counts``: by kind and name, the number of lines with the name; equal lines all count.
    """

    def __init__(self, files: LintedFiles) -> None:
        """Collect and count the mentions of every name in the files."""
        self.files = files
        self.network = files.network
        self.mentions: dict[Kind, dict[str, list[Mention]]] = {kind: {} for kind in Kind}
        self.counts: dict[Kind, dict[str, int]] = {kind: {} for kind in Kind}
        self.object_counts: dict[str, int] = {}
        """The number of object lines with each label."""
        for number, sheet in enumerate(files.sheets):
            for line, index, occurrences in sheet.distinct_lines:
                mention = Mention(number, line, index, occurrences)
                for kind, name, _ in dict.fromkeys(line_names(line)):
                    self.mentions[kind].setdefault(name, []).append(mention)
                    self.counts[kind][name] = self.counts[kind].get(name, 0) + occurrences
                if isinstance(line, ObjectLine):
                    self.object_counts[line.label] = self.object_counts.get(line.label, 0) + occurrences

    @cached_property
    def one_sided(self) -> dict[Kind, set[str]]:
        """By kind, the names that never stand among the inputs of units, or never among the outputs."""
        network = self.network
        input_names, output_names = (
            {
                name
                for node in {node for nodes in nodes_by_unit for node in nodes}
                for name in _names_in(network.objects[node])
            }
            for nodes_by_unit in (network.inputs, network.outputs)
        )
        two_sided = input_names & output_names
        return {
            kind: {name for name in names if (kind, name) not in two_sided}
            for kind, names in self.counts.items()
        }

    def similar_labels(self, name: str) -> list[str]:
        """Return labels of object lines that a name may stand for, the most frequent first.

        These are the labels that equal the name in the singular or plural. If there are none, return up to
        three labels that end with the words of the name.
        """
        singular = _singular(name)
        alike = self._labels_by_ending.get(singular, [])
        return [label for label in alike if _singular(label) == singular] or alike[:3]

    @cached_property
    def _labels_by_ending(self) -> dict[str, list[str]]:
        """Labels by their endings of one to four words, and by all of their words; keys are in the singular.

        The labels with an ending are in order, the most frequent first.
        """
        endings: dict[str, list[str]] = {}
        for label in sorted(self.object_counts, key=lambda label: (-self.object_counts[label], label)):
            words = _singular(label).split(" ")
            for start in {0, *range(max(1, len(words) - 4), len(words))}:
                endings.setdefault(" ".join(words[start:]), []).append(label)
        return endings

    def mentions_by_sheet(self, kind: Kind, name: str) -> Iterator[tuple[Sheet, int, int]]:
        """Yield each sheet with a name, the index of its first line with it, and the number of such lines."""
        by_sheet: dict[int, tuple[int, int]] = {}
        for sheet, _, index, occurrences in self.mentions[kind][name]:
            first, total = by_sheet.get(sheet, (index, 0))
            by_sheet[sheet] = min(first, index), total + occurrences
        for sheet, first_and_total in by_sheet.items():
            yield self.files.sheets[sheet], *first_and_total


def _names_in(node: ObjectNode) -> Iterator[tuple[Kind, str]]:
    """Yield all names in a node, each after its kind."""
    yield Kind.OBJECT, node.label
    yield from ((Kind.STATE, state) for state in node.states)
    for word, related_object in node.relations:
        yield from ((Kind.WORD, word), (Kind.OBJECT, related_object))
    for word, items in node.contents:
        yield from ((Kind.WORD, word), *((Kind.OBJECT, item) for item in items))


def times_text(count: int) -> str:
    """Return a count in words: ``once``, ``twice``, ``3 times``."""
    return "once" if count == 1 else "twice" if count == 2 else f"{count} times"


def _singular(name: str) -> str:
    """Return a name without a final s; a name that ends in ss stays."""
    return name[:-1] if name[-1:] == "s" and name[-2:] != "ss" else name
