"""Comparison of two lists of units, of task trees or networks."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from foon_asp.json_layout import Json
from foon_asp.network import FunctionalUnit, counted
from foon_asp.network.near_units import nearest_units
from foon_asp.pictures.two_columns import PairSection, two_column_page
from foon_asp.questions.result import Result
from foon_asp.results.plain_values import plain
from foon_asp.results.table_columns import flat_row
from foon_asp.results.values import Unit, UnitDifference, Value
from foon_asp.results.values_of import differences_of


class NearUnits(Value, frozen=True):
    """Two units that are nearly the same, one of each tree or network, and their differences."""

    a: Unit
    b: Unit
    differences: tuple[UnitDifference, ...]


class Difference(Result, frozen=True, kw_only=True):
    """The comparison of two trees or networks: the units of only one, of both, and nearly equal pairs.

    Attributes:
        only_in_a: The units that only the first has; those that are nearly the same are not among them.
        only_in_b: The units that only the other has.
        nearly_the_same: Pairs of units that differ in three things at most.
        in_both: The units that both have, as the first has them.
    """

    a: object
    b: object
    only_in_a: tuple[Unit, ...]
    only_in_b: tuple[Unit, ...]
    nearly_the_same: tuple[NearUnits, ...]
    in_both: tuple[Unit, ...]

    def figures(self) -> Sequence[Sequence[str]]:
        """Return the rows of a table that compares the two by numbers, the headings first."""
        raise NotImplementedError

    def unit_lines(self) -> Iterator[str]:
        """Yield the number of common units, then lines on pairs that nearly agree, and on all other units."""
        yield f"in both: {counted(len(self.in_both), 'unit', ',')}"
        if self.nearly_the_same:
            yield from ("", f"nearly the same: {counted(len(self.nearly_the_same), 'unit', ',')} in each")
        for pair in self.nearly_the_same:
            yield f"  {pair.a.motion}    [A {pair.a.source[0]}, B {pair.b.source[0]}]"
            yield from (f"    {difference}" for difference in pair.differences)
        for letter, units in (("A", self.only_in_a), ("B", self.only_in_b)):
            if units:
                yield from ("", f"only in {letter}: {counted(len(units), 'unit', ',')}")
            yield from (line for unit in units for line in unit.lines())

    def table_rows(self) -> Iterator[Json]:
        """Return a row for each unit; its column ``in`` says in which of the two the unit is.

        The values are ``a``, ``b`` and ``both``; for nearly equal pairs, ``a, nearly b`` and ``b, nearly a``.
        """
        lists = [("a", self.only_in_a), ("b", self.only_in_b), ("both", self.in_both)]
        for pair in self.nearly_the_same:
            lists += [("a, nearly b", (pair.a,)), ("b, nearly a", (pair.b,))]
        return (flat_row({"in": membership, **plain(unit)}) for membership, units in lists for unit in units)

    def html(self) -> str:
        """Return a page in HTML with a column for each of the two; the common units are folded."""
        return two_column_page(
            f"{self.a} and {self.b}",
            [str(self.a), str(self.b)],
            self.figures(),
            [
                PairSection(
                    "nearly the same", [(pair.a, pair.b, pair.differences) for pair in self.nearly_the_same]
                ),
                PairSection("only in A", [(unit, None, ()) for unit in self.only_in_a]),
                PairSection("only in B", [(None, unit, ()) for unit in self.only_in_b]),
                PairSection("in both", [(unit, None, ()) for unit in self.in_both], folded=True),
            ],
        )


def difference_fields(a: Mapping[FunctionalUnit, Unit], b: Mapping[FunctionalUnit, Unit]) -> dict[str, Any]:
    """Return the fields of a :class:`Difference` by name, for the units of two trees or networks.

    ``a`` and ``b`` map each unit to its value in the result. The common units have the values of ``a``.
    """
    pairs = nearest_units([unit for unit in a if unit not in b], [unit for unit in b if unit not in a])
    paired = {unit for unit_a, unit_b, _ in pairs for unit in (unit_a, unit_b)}
    only_in_a, only_in_b = (
        tuple(value for unit, value in own.items() if unit not in other and unit not in paired)
        for own, other in ((a, b), (b, a))
    )
    return {
        "only_in_a": only_in_a,
        "only_in_b": only_in_b,
        "nearly_the_same": tuple(NearUnits(a[p.left], b[p.right], differences_of(p)) for p in pairs),
        "in_both": tuple(value for unit, value in a.items() if unit in b),
    }
