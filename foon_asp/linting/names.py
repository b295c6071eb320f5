"""The names in the files that are linted together, and where each stands."""

from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

from foon_asp.linting.habits import Habits
from foon_asp.linting.linted_files import LintedFiles
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
    """Every name of every kind with its mentions, in order."""

    def __init__(self, files: LintedFiles) -> None:
        self.files = files
        self.network = files.network
        self.sheets = files.sheets
        self.has_network = any(sheet.entries is None for sheet in files.sheets)
        self.mentions: dict[Kind, dict[str, list[Mention]]] = {kind: {} for kind in Kind}
        for number, sheet in enumerate(files.sheets):
            for line, index, count in sheet.distinct_lines:
                mention = Mention(number, line, index, count)
                for kind, name, _ in dict.fromkeys(line_names(line)):
                    self.mentions[kind].setdefault(name, []).append(mention)
        self.counts: dict[Kind, dict[str, int]] = {
            kind: {name: sum(m.often for m in mentions) for name, mentions in names.items()}
            for kind, names in self.mentions.items()
        }
        self.objects = {
            name: count
            for name, mentions in self.mentions[Kind.OBJECT].items()
            if (count := sum(m.often for m in mentions if isinstance(m.line, ObjectLine)))
        }
        """How often each label stands on an object line."""

    @cached_property
    def habits(self) -> Habits:
        """What the units change."""
        return Habits(self.network)

    @cached_property
    def loose(self) -> dict[Kind, set[str]]:
        """Names that stand on one side of units alone: what has them is never made, or never taken."""
        network = self.network
        taken = {node for nodes in network.inputs for node in nodes}
        made = {node for nodes in network.outputs for node in nodes}
        sides: dict[Kind, tuple[set[str], set[str]]] = {kind: (set(), set()) for kind in Kind}
        for side, nodes in enumerate((taken, made)):
            for node in nodes:
                label, states, relations, contents = network.objects[node]
                sides[Kind.OBJECT][side].update({label}, *(held for _, held in contents))
                sides[Kind.OBJECT][side].update(place for _, place in relations)
                sides[Kind.STATE][side].update(states)
                sides[Kind.WORD][side].update(word for word, _ in (*relations, *contents))
        return {kind: names.keys() - (sides[kind][0] & sides[kind][1]) for kind, names in self.counts.items()}

    def objects_alike(self, name: str) -> list[str]:
        """Give labels on object lines that may be meant, the most frequent first.

        That is the name in singular or plural, or else a few labels that end with its words.
        """
        same, longer = self._alike
        wanted = _singular(name)
        return same.get(wanted) or longer.get(wanted, [])

    @cached_property
    def _alike(self) -> tuple[dict[str, list[str]], dict[str, list[str]]]:
        """Labels in the singular, and by their last words, a few of each."""
        same: dict[str, list[str]] = {}
        longer: dict[str, list[str]] = {}
        for label in sorted(self.objects, key=lambda label: (-self.objects[label], label)):
            singular = _singular(label)
            same.setdefault(singular, []).append(label)
            words = singular.split(" ")
            for start in range(max(1, len(words) - _WORDS), len(words)):
                ending = longer.setdefault(" ".join(words[start:]), [])
                if len(ending) < _ALIKE:
                    ending.append(label)
        return same, longer

    def by_sheet(self, kind: Kind, name: str) -> Iterator[tuple[int, int, int]]:
        """Give the number of each sheet with a name, the index of its first line, and its mentions there."""
        found: dict[int, tuple[int, int]] = {}
        for sheet, _, index, count in self.mentions[kind][name]:
            first, total = found.get(sheet, (index, 0))
            found[sheet] = min(first, index), total + count
        for sheet, (index, count) in found.items():
            yield sheet, index, count


def times(count: int) -> str:
    """Say how often."""
    return "once" if count == 1 else "twice" if count == 2 else f"{count} times"


def _singular(name: str) -> str:
    return name[:-1] if name[-1:] == "s" and name[-2:] != "ss" else name
