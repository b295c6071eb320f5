"""What two networks have in common: two annotations of one video, or two versions of a FOON."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from foon_asp.dataset.paths import File
from foon_asp.deadline import Cancel
from foon_asp.document.json_document import document, fraction_json, listed_unit_json
from foon_asp.errors import UserError
from foon_asp.foon import Foon
from foon_asp.network import LEVELS, FunctionalUnit, Network, Source, counted, network_at_level
from foon_asp.network.near_units import NearUnits, nearest_units
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.caller import caller
from foon_asp.questions.contract import TABLES, Kind, Option, Part, question
from foon_asp.questions.posing import no_data
from foon_asp.questions.result import Result
from foon_asp.report.stacked import is_narrow, stacked_lines
from foon_asp.report.two_columns import Column, Pair, two_columns
from foon_asp.report.unit_block import difference_text, unit_block
from foon_asp.report.whole_file import utf_8, write_whole
from foon_asp.text.data_folder import network_files
from foon_asp.text.diagnostics import in_brief
from foon_asp.text.reader import FoonReader

_SUFFIXES = {
    ".html": "html",
    ".htm": "html",
    ".json": "json",
    ".txt": "text",
    ".csv": "csv",
    ".md": "markdown",
}


class Agreement(NamedTuple):
    """How much two sets have in common: how many ``left`` has, ``right`` has, and ``both`` have.

    Example:
        >>> agreement = foon_asp.Agreement(left=12, right=10, both=8)
        >>> str(agreement.jaccard), str(agreement.f1)
        ('4/7', '8/11')
    """

    left: int
    right: int
    both: int

    @property
    def jaccard(self) -> Fraction:
        """What both have, of all that there is: 1 where the sets are the same."""
        union = self.left + self.right - self.both
        return Fraction(self.both, union) if union else Fraction(1)

    @property
    def f1(self) -> Fraction:
        """The harmonic mean of the shares of both sets that the other one has, too."""
        total = self.left + self.right
        return Fraction(2 * self.both, total) if total else Fraction(1)


@dataclass(frozen=True, repr=False)
class NetworkDifference(Result):
    """Two networks, ``left`` and ``right`` with their ``names``, compared at a ``level``.

    ``only_left`` and ``only_right`` are the units that one has and the other has not, nor one that nearly
    agrees; ``near`` are the pairs of units that nearly agree, and ``both`` the units that both have.
    ``units`` and ``nodes`` say for each level how much the networks agree.

    Example:
        >>> foon = foon_asp.load()
        >>> foon_asp.diff_networks(foon, foon)
        <NetworkDifference: 0 only left, 0 only right, 0 nearly the same, 220 in both>
        >>> foon_asp.diff_networks(foon, foon).html()[:15]
        '<!DOCTYPE html>'
    """

    names: tuple[str, str]
    level: int
    left: Network
    right: Network
    only_left: tuple[FunctionalUnit, ...]
    only_right: tuple[FunctionalUnit, ...]
    near: tuple[NearUnits, ...]
    both: tuple[FunctionalUnit, ...]
    units: dict[int, Agreement]
    nodes: dict[int, Agreement]

    def text(self) -> str:
        """Give the figures of all levels, and the units in which the networks differ."""
        lines = [f"{letter}: {name}" for letter, name in zip("AB", self.names, strict=True)]
        lines += ["", *self._figures(), ""]
        lines.append(f"in both, at level {self.level}: {counted(len(self.both), 'unit', ',')}")
        if self.near:
            lines += ["", f"nearly the same: {counted(len(self.near), 'unit', ',')} in each"]
        for pair in self.near:
            places = self._place(self.left, pair.left), self._place(self.right, pair.right)
            lines += ["", f"  {pair.left.motion}    [A {places[0]}, B {places[1]}]"]
            lines += [f"    {difference_text(difference)}" for difference in pair.differences]
        for letter, network, only in self._sides():
            if only:
                lines += ["", f"only in {letter}: {counted(len(only), 'unit', ',')}"]
            for unit in only:
                lines += unit_block(unit, self._place(network, unit))
        return "\n".join(lines) + "\n"

    def json_dict(self) -> object:
        """Give the same, with the units of both."""
        left, right = self.left, self.right
        return document(
            "diff-network",
            a=self.names[0],
            b=self.names[1],
            level=self.level,
            agreement=[
                {"level": level, "units": _agreement_json(self.units[level]), "nodes": _agreement_json(nodes)}
                for level, nodes in self.nodes.items()
            ],
            only_in_a=[self._json(left, unit) for unit in self.only_left],
            only_in_b=[self._json(right, unit) for unit in self.only_right],
            nearly_the_same=[
                {
                    "a": self._json(left, pair.left),
                    "b": self._json(right, pair.right),
                    "differences": [
                        {"kind": kind, "a": one or None, "b": other or None, "of": of or None}
                        for kind, one, other, of in pair.differences
                    ],
                }
                for pair in self.near
            ],
            in_both=[self._json(left, unit) for unit in self.both],
        )

    def html(self) -> str:
        """Give a page with a column for each network."""
        return two_columns(
            f"{self.names[0]} and {self.names[1]}",
            self.names,
            [[*row] for row in (_HEADINGS, *self._rows())],
            [
                Pair(
                    "nearly the same",
                    [
                        (self._column(self.left, p.left), self._column(self.right, p.right), p.differences)
                        for p in self.near
                    ],
                ),
                Pair("only in A", [(self._column(self.left, unit), None, ()) for unit in self.only_left]),
                Pair("only in B", [(None, self._column(self.right, unit), ()) for unit in self.only_right]),
                Pair(
                    "in both",
                    [(self._column(self.left, u), self._column(self.right, u), ()) for u in self.both],
                    folded=True,
                ),
            ],
        )

    def write(self, file: File, format_: str | None = None) -> None:
        """Write the result into a file.

        Parameters:
            file: The path of the file.
            format_: ``html``, ``json``, ``text``, ``csv`` or ``markdown``; without it, the end of the file
                name chooses one.

        Raises:
            UserError: for another name, or a file that cannot be written.
        """
        form = format_ or _SUFFIXES.get(Path(file).suffix.lower())
        if form is None or form not in _SUFFIXES.values():
            raise UserError(f"{file}: the name says no format: end it in {' '.join(_SUFFIXES)}")
        written = self.json_text() if form == "json" else getattr(self, form)()
        write_whole(Path(file), utf_8(written))

    def __repr__(self) -> str:
        return (
            f"<NetworkDifference: {len(self.only_left)} only left, {len(self.only_right)} only right, "
            f"{len(self.near)} nearly the same, {len(self.both)} in both>"
        )

    def _figures(self) -> list[str]:
        rows = self._rows()
        if is_narrow():
            return list(stacked_lines(_HEADINGS, rows))
        widths = [max(map(len, column)) for column in zip(_HEADINGS, *rows, strict=True)]
        return [
            "  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True))
            for row in (_HEADINGS, *rows)
        ]

    def _rows(self) -> list[tuple[str, ...]]:
        return [
            (
                f"{noun}, level {level}",
                *(f"{n:,}" for n in found[level]),
                *(f"{float(x):.3f}" for x in (found[level].jaccard, found[level].f1)),
            )
            for noun, found in (("units", self.units), ("object nodes", self.nodes))
            for level in LEVELS
        ]

    def _sides(self) -> list[tuple[str, Network, tuple[FunctionalUnit, ...]]]:
        return [("A", self.left, self.only_left), ("B", self.right, self.only_right)]

    def _source(self, network: Network, unit: FunctionalUnit) -> Source:
        number = network.unit_id(unit)
        assert number is not None
        return network.sources[number][0]

    def _place(self, network: Network, unit: FunctionalUnit) -> str:
        """Name the line of a unit, and the file where the network is of several."""
        source = self._source(network, unit)
        return f"line {source.line}" if source.file in self.names else str(source)

    def _column(self, network: Network, unit: FunctionalUnit) -> Column:
        return Column(unit, self._place(network, unit))

    def _json(self, network: Network, unit: FunctionalUnit) -> object:
        return listed_unit_json(network, unit, self._source(network, unit))


_HEADINGS = ("agreement", "A", "B", "both", "Jaccard", "F1")


@question(
    Option(
        "left",
        "A network, or a folder of networks.",
        Kind.FILE,
        part=Part.PROBLEM,
        metavar="A",
        positional=True,
    ),
    Option(
        "right",
        "The other one.",
        Kind.FILE,
        part=Part.PROBLEM,
        metavar="B",
        positional=True,
    ),
    Option(
        "level",
        "The level of detail at which units are compared and listed, 1 to 3.",
        Kind.WHOLE,
        default=3,
        least=1,
    ),
    formats=("text", "json", "html", *TABLES[2:]),
    suffixes=_SUFFIXES,
    pose=no_data,
    help_="""
    \b
    foon-asp diff-network mine.txt yours.txt
    foon-asp diff-network v1/FOON.txt v2/FOON.txt --level 2
    foon-asp diff-network mine.txt yours.txt -o page.html      side by side

    Units are the same when motion, inputs and outputs are, ids, times and order aside; level 2 ignores
    contents, level 1 all but labels. Units nearly agree when they differ in three things at most (a motion, a
    label, a state, a relation, an ingredient, a whole object) and agree in more than half of what they say;
    each is paired with one other at most. Jaccard is what both have, of all that there is; F1 is twice what
    both have, by the sum of both.

    Exits with 0 when both were compared, whether they differ or not.
    """,
)
def diff_networks(
    left: File | Foon,
    right: File | Foon,
    *,
    level: int = 3,
    time_limit: float | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> NetworkDifference:
    """Compare two networks: units of only one, units that nearly agree, and agreement at each level.

    Parameters:
        left: A path, or data that were loaded.
        right: The same.

    Returns:
        The units, and for each level the agreement of units and of object nodes.

    Raises:
        UserError: for a path without a network, and another level.

    Example:
        >>> foon = foon_asp.load()
        >>> found = foon_asp.diff_networks("data/kitchen/FOON.txt", foon)
        >>> len(found.both), str(found.units[1].jaccard), found.near
        (220, '1', ())
    """
    if level not in LEVELS:
        raise UserError(f"found level={level}, expected 1, 2 or 3")
    wholes = [_network(given) for given in (left, right)]
    at_level = {each: [network_at_level(whole, each) for whole in wholes] for each in LEVELS}
    here, there = at_level[level]
    ours, theirs = (dict.fromkeys(network.unit(u) for u in range(len(network))) for network in (here, there))
    only_left = [unit for unit in ours if unit not in theirs]
    only_right = [unit for unit in theirs if unit not in ours]
    near = nearest_units(only_left, only_right)
    paired = {pair.left for pair in near}, {pair.right for pair in near}
    order = {unit: place for place, unit in enumerate(only_left)}
    return NetworkDifference(
        (_name(left, "left"), _name(right, "right")),
        level,
        here,
        there,
        tuple(unit for unit in only_left if unit not in paired[0]),
        tuple(unit for unit in only_right if unit not in paired[1]),
        tuple(sorted(near, key=lambda pair: order[pair.left])),
        tuple(unit for unit in ours if unit in theirs),
        {
            each: _agreement([[n.unit(u) for u in range(len(n))] for n in both])
            for each, both in at_level.items()
        },
        {each: _agreement([n.objects for n in both]) for each, both in at_level.items()},
    )


def _network(given: File | Foon) -> Network:
    if isinstance(given, Foon):
        network = given.dataset.data.network
        if network.level != 3:
            raise UserError(
                f"found data of level {network.level}, expected level 3, of which the others are made"
            )
        return network
    path = Path(given)
    if not path.exists():
        raise UserError(f"{path}: no such file or folder")
    reader = FoonReader()
    network = reader.read_network(network_files(path))
    for text in in_brief(reader.diagnostics):
        caller().reporter.warning(text)
    return network


def _name(given: File | Foon, otherwise: str) -> str:
    return otherwise if isinstance(given, Foon) else str(given)


def _agreement(sides: Sequence[Sequence[object]]) -> Agreement:
    left, right = map(set, sides)
    return Agreement(len(left), len(right), len(left & right))


def _agreement_json(found: Agreement) -> object:
    return {
        "a": found.left,
        "b": found.right,
        "both": found.both,
        "jaccard": fraction_json(found.jaccard),
        "f1": fraction_json(found.f1),
    }
