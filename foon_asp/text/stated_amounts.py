"""Amounts that networks state for their units, and those of a table beside them."""

from collections import Counter
from collections.abc import Iterable, Sequence

from foon_asp.network import DataAmounts, FunctionalUnit, Network, ObjectNode, Source, UnitAmounts
from foon_asp.text.diagnostics import Diagnostic, Severity
from foon_asp.text.value_table import Row

UnitAmount = tuple[str, bool, ObjectNode]
"""The first columns of a table of amounts: a motion, whether the node is an output, and the node."""


class StatedAmounts:
    """The amounts that copies of units state."""

    def __init__(self) -> None:
        self._copies: dict[FunctionalUnit, dict[Source, UnitAmounts]] = {}

    def __len__(self) -> int:
        """The number of units of which a copy states amounts."""
        return len(self._copies)

    def add(self, unit: FunctionalUnit, amounts: UnitAmounts, source: Source) -> None:
        """Record the amounts of one copy of a unit, and where they are stated."""
        self._copies.setdefault(unit, {})[source] = amounts

    def amounts_by_unit(self, network: Network | None = None) -> DataAmounts:
        """Return the amounts of units of which a copy states amounts, and a message if copies disagree.

        The amounts of a unit are those of its first copy. The message is about the first disagreement.

        With a ``network``, all copies of a unit count. A copy without stated amounts then has the amount 1 of
        each node. Without a network, only copies that state amounts count.
        """
        amounts: dict[FunctionalUnit, UnitAmounts] = {}
        conflict = ""
        for unit, copies in self._copies.items():
            unit_id = None if network is None else network.unit_id(unit)
            sources = tuple(copies) if network is None or unit_id is None else network.sources[unit_id]
            first_source = sources[0]
            amounts_of_copies = [(copies.get(source, UnitAmounts()), source) for source in sources]
            amounts[unit] = amounts_of_copies[0][0]
            differing_source = next(
                (source for unit_amounts, source in amounts_of_copies if unit_amounts != amounts[unit]), None
            )
            if differing_source is not None and not conflict:
                conflict = (
                    f"{differing_source}: found a copy of the unit {unit.motion!r} of {first_source} with "
                    "other amounts, expected the same, since items used up are counted: "
                    "give one of the two another name"
                )
        return DataAmounts(amounts, conflict)


def apply_amount_table(
    stated: DataAmounts, rows: Sequence[Row[UnitAmount, int]], units: Iterable[FunctionalUnit]
) -> tuple[DataAmounts, list[Diagnostic]]:
    """Return stated amounts overridden by a table, and warnings about rows that match no unit.

    ``rows`` are those of the table. ``units`` are all units whose motion is in the table. The result leaves
    out units whose amounts are all 1.
    """
    amounts = dict(stated.units)
    matched_names: set[UnitAmount] = set()
    by_name = {row.name: row.value for row in rows}
    for unit in units:
        sides: list[dict[ObjectNode, int]] = []
        for is_output, nodes in enumerate((unit.inputs, unit.outputs)):
            amounts_of_side = dict(amounts.get(unit, UnitAmounts())[is_output])
            for node in nodes:
                name = unit.motion, bool(is_output), node
                if name in by_name:
                    matched_names.add(name)
                    amounts_of_side[node] = by_name[name]
            sides.append({node: amount for node, amount in amounts_of_side.items() if amount != 1})
        amounts[unit] = UnitAmounts(*sides)
    warnings = [
        Diagnostic(
            Severity.WARNING,
            "unit-amount",
            f"no unit {row.name[0]!r} {'makes' if row.name[1] else 'takes'} {str(row.name[2])!r}",
            row.source,
        )
        for row in rows
        if row.name not in matched_names
    ]
    amounts_above_one = {unit: sides for unit, sides in amounts.items() if sides}
    return stated._replace(units=amounts_above_one), warnings


def counted_amounts(
    inputs: Iterable[tuple[ObjectNode, int]], outputs: Iterable[tuple[ObjectNode, int]]
) -> UnitAmounts:
    """Return the amounts above 1 of a unit; inputs and outputs are pairs of node and amount.

    If a node comes several times on a side, its amounts are added up.
    """
    return UnitAmounts(_totals_above_one(inputs), _totals_above_one(outputs))


def _totals_above_one(side: Iterable[tuple[ObjectNode, int]]) -> dict[ObjectNode, int]:
    """Return the sum of the amounts of each node; sums of 1 are left out."""
    totals: Counter[ObjectNode] = Counter()
    for node, amount in side:
        totals[node] += amount
    return {node: total for node, total in totals.items() if total > 1}
