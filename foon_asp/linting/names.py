"""The names in the files that are linted together, and where each stands."""

from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

from foon_asp.linting.linted_files import LintedFiles
from foon_asp.linting.sheet import Sheet
from foon_asp.network import ObjectNode
from foon_asp.text.line import Line, NameKind, ObjectLine, line_names

_ALIKE = 3  # labels that are named where another may be meant
_WORDS = 4  # of their ends are compared


Kind = NameKind


class Mention(NamedTuple):
    """A distinct line of a sheet that has a name in it: the index where it stands first, and how often."""

    sheet: int
    line: Line
    first: int
    often: int


class Names:
    """Every name of every kind with its mentions, in order, and how often it stands."""

    def __init__(self, files: LintedFiles) -> None:
        self.files = files
        self.network = files.network
        self.mentions: dict[Kind, dict[str, list[Mention]]] = {kind: {} for kind in Kind}
        self.counts: dict[Kind, dict[str, int]] = {kind: {} for kind in Kind}
        self.objects: dict[str, int] = {}
        """How often each label stands on an object line."""
        for number, sheet in enumerate(files.sheets):
            for line, index, often in sheet.distinct_lines:
                mention = Mention(number, line, index, often)
                for kind, name, _ in dict.fromkeys(line_names(line)):
                    self.mentions[kind].setdefault(name, []).append(mention)
                    self.counts[kind][name] = self.counts[kind].get(name, 0) + often
                if isinstance(line, ObjectLine):
                    self.objects[line.label] = self.objects.get(line.label, 0) + often

    @cached_property
    def loose(self) -> dict[Kind, set[str]]:
        """Names that stand on one side of units alone: what has them is never made, or never taken."""
        network = self.network
        taken, made = (
            {
                name
                for node in {node for nodes in side for node in nodes}
                for name in _names_in(network.objects[node])
            }
            for side in (network.inputs, network.outputs)
        )
        both = taken & made
        return {
            kind: {name for name in names if (kind, name) not in both} for kind, names in self.counts.items()
        }

    def objects_alike(self, name: str) -> list[str]:
        """Return labels on object lines that may be meant, the most frequent first.

        That is the name in singular or plural, or else a few labels that end with its words.
        """
        wanted = _singular(name)
        alike = self._by_ending.get(wanted, [])
        return [label for label in alike if _singular(label) == wanted] or alike[:_ALIKE]

    @cached_property
    def _by_ending(self) -> dict[str, list[str]]:
        """Labels by their last words in the singular, and by all of them."""
        endings: dict[str, list[str]] = {}
        for label in sorted(self.objects, key=lambda label: (-self.objects[label], label)):
            words = _singular(label).split(" ")
            for start in {0, *range(max(1, len(words) - _WORDS), len(words))}:
                endings.setdefault(" ".join(words[start:]), []).append(label)
        return endings

    def by_sheet(self, kind: Kind, name: str) -> Iterator[tuple[Sheet, int, int]]:
        """Yield each sheet with a name, the index of its first line, and its mentions there."""
        places: dict[int, tuple[int, int]] = {}
        for sheet, _, index, often in self.mentions[kind][name]:
            first, total = places.get(sheet, (index, 0))
            places[sheet] = min(first, index), total + often
        for sheet, place in places.items():
            yield self.files.sheets[sheet], *place


def _names_in(node: ObjectNode) -> Iterator[tuple[Kind, str]]:
    yield Kind.OBJECT, node.label
    yield from ((Kind.STATE, state) for state in node.states)
    for word, place in node.relations:
        yield from ((Kind.WORD, word), (Kind.OBJECT, place))
    for word, items in node.contents:
        yield from ((Kind.WORD, word), *((Kind.OBJECT, item) for item in items))


def times(count: int) -> str:
    """Return how often, in words."""
    return "once" if count == 1 else "twice" if count == 2 else f"{count} times"


def _singular(name: str) -> str:
    return name[:-1] if name[-1:] == "s" and name[-2:] != "ss" else name
