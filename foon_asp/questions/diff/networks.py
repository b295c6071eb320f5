"""Comparison of two networks: two annotations of one video, or two versions of a FOON."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Final, Literal, Self

from foon_asp.json_layout import schema_name
from foon_asp.network import ALL_ONE, LEVELS, Amounts, Network, counted, network_at_level
from foon_asp.questions.diff.difference import Difference, difference_fields
from foon_asp.results.table import Block, Table
from foon_asp.results.values import Node, Unit, Value
from foon_asp.results.values_of import named_node, unit_of

Side = Literal["inputs", "outputs"]
_SIDES: Final[tuple[Side, Side]] = ("inputs", "outputs")


class Agreement(Value, frozen=True):
    """The overlap of two sets.

    Attributes:
        a: The size of the first set.
        b: The size of the other set.
        both: The size of their intersection.
        jaccard: The size of the intersection divided by that of the union; 1 where the sets are equal.
        f1: Twice the size of the intersection, divided by the sum of the two sizes.
    """

    a: int
    b: int
    both: int
    jaccard: Fraction
    f1: Fraction

    @classmethod
    def of(cls, sides: Sequence[Sequence[object]]) -> Self:
        """Return the agreement of two sets, which ``sides`` has as sequences without repeats.

        For two empty sets, both coefficients are 1.
        """
        a, b = map(len, sides)
        both = len(set(sides[0]).intersection(sides[1]))
        jaccard, f1 = (Fraction(both, a + b - both), Fraction(2 * both, a + b)) if a + b else (1, 1)
        return cls(a, b, both, Fraction(jaccard), Fraction(f1))


class LevelAgreement(Value, frozen=True):
    """How much two networks agree at a level: their units, and their object nodes."""

    level: int
    units: Agreement
    nodes: Agreement


class AmountDifference(Value, frozen=True):
    """An object node of which a unit takes or makes different numbers in the two networks.

    Attributes:
        side: Whether the unit takes it (inputs) or makes it (outputs).
    """

    unit: Unit
    node: Node
    side: Side
    a: int
    b: int

    def __str__(self) -> str:
        verb = "takes" if self.side == "inputs" else "makes"
        return f"{verb} {self.a} x {self.node} in A, {self.b} x in B"


class NetworkDifference(Difference, frozen=True, kw_only=True, tag=schema_name("diff-network")):
    """Two networks, compared at a level.

    Attributes:
        a: The name of the first network.
        b: The name of the other one.
        agreement: How much they agree at each level.
        other_amounts: The amounts in which units of both differ; at level 3 only.

    Example:
        >>> foon = foon_asp.load()
        >>> found = foon_asp.diff(foon, foon)
        >>> found
        <NetworkDifference: compared as networks, at level 3>
        >>> len(found.in_both), str(found.agreement[0].units.jaccard), found.html()[:15]
        (220, '1', '<!DOCTYPE html>')
    """

    a: str
    b: str
    level: int
    agreement: tuple[LevelAgreement, ...]
    other_amounts: tuple[AmountDifference, ...]

    def figures(self) -> Sequence[Sequence[str]]:
        """Return a table of how much the units and the nodes agree at each level, the headings first."""
        return [
            ("agreement", "A", "B", "both", "Jaccard", "F1"),
            *(
                (
                    f"{noun}, level {level_agreement.level}",
                    *(f"{count:,}" for count in (scores.a, scores.b, scores.both)),
                    *(f"{float(score):.3f}" for score in (scores.jaccard, scores.f1)),
                )
                for noun, field in (("units", "units"), ("object nodes", "nodes"))
                for level_agreement in self.agreement
                for scores in (getattr(level_agreement, field),)
            ),
        ]

    def show(self) -> Iterator[Block]:
        """Yield the agreement at all levels, the units in which the networks differ, and other amounts."""
        yield from (f"compared as networks, at level {self.level}", f"A: {self.a}", f"B: {self.b}", "")
        headings, *rows = self.figures()
        yield from (Table(headings, rows), "")
        yield from self.unit_lines()
        if self.other_amounts:
            yield from ("", f"other amounts: {counted(len(self.other_amounts), 'object node', ',')}")
        for difference in self.other_amounts:
            yield f"  {difference.unit.motion}    [{difference.unit.source[0]}]  {difference}"


def compare_networks(
    names: Sequence[str], networks: Sequence[Network], amounts: tuple[Amounts, Amounts], level: int
) -> NetworkDifference:
    """Compare two networks, given at level 3: their agreement at each level, and their units at ``level``.

    Amounts are compared at level 3 only.
    """
    at_level = {detail: [network_at_level(network, detail) for network in networks] for detail in LEVELS}
    a, b = ({n.unit(u): unit_of(n, u) for u in range(len(n))} for n in at_level[level])
    agreement = tuple(
        LevelAgreement(detail, Agreement.of([[*n] for n in both]), Agreement.of([n.objects for n in both]))
        for detail, both in at_level.items()
    )
    return NetworkDifference(
        a=names[0],
        b=names[1],
        level=level,
        agreement=agreement,
        other_amounts=tuple(_amount_differences(networks, amounts)) if level == max(LEVELS) else (),
        **difference_fields(a, b),
    )


def _amount_differences(
    networks: Sequence[Network], amounts: tuple[Amounts, Amounts]
) -> Iterator[AmountDifference]:
    """Yield differences of amounts in units that both networks have, in the order of the first network.

    An amount that is not stated is 1.
    """
    (a, b), (amounts_a, amounts_b) = networks, amounts
    for unit_id in range(len(a)) if amounts_a or amounts_b else ():
        unit = a.unit(unit_id)
        if b.unit_id(unit) is None:
            continue
        of_a, of_b = (of_data.get(unit, ALL_ONE) for of_data in amounts)
        for side, nodes, in_a, in_b in zip(_SIDES, (unit.inputs, unit.outputs), of_a, of_b, strict=True):
            for node in nodes:
                pair = in_a.get(node, 1), in_b.get(node, 1)
                if pair[0] != pair[1]:
                    yield AmountDifference(unit_of(a, unit_id), named_node(a, node), side, *pair)
