"""Prices of units: ``unit_prices.txt``, a motion or a single unit and its price on each line."""

from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from foon_asp.network import FunctionalUnit, ObjectNode, Source, UnitPrices, in_quotes
from foon_asp.text.exact_number import decimal_text, read_price
from foon_asp.text.line import LineError, NameKind
from foon_asp.text.line_parser import parse_node
from foon_asp.text.tables import motion_in_first_column
from foon_asp.text.value_table import Table

_ARROWS = ("→", "->")


class UnitPriceList(NamedTuple):
    """The prices of a file by motion and by unit, with the sources of the units."""

    motions: dict[str, Fraction]
    units: dict[FunctionalUnit, Fraction]
    sources: dict[FunctionalUnit, Source]


def read_unit_prices(file: Path) -> UnitPriceList:
    """Read ``motion⇥price`` lines, and ``motion⇥input⇥...⇥→⇥output⇥...⇥price`` for single units.

    Nodes are in one-line notation; ``->`` may stand for ``→``. Raises :class:`InputError` for a line of
    another form, and for a motion or a unit with two different prices.
    """
    price_list = UnitPriceList({}, {}, {})
    for name, price, source in UNIT_PRICES.rows(file):
        if isinstance(name, str):
            price_list.motions[name] = price
        else:
            price_list.units[name], price_list.sources[name] = price, source
    return price_list


def _row(name: str, value: str, column: int) -> tuple[str | FunctionalUnit, Fraction]:
    motion = motion_in_first_column(name, "a price")
    *fields, written = value.split("\t")
    price = read_price(written.strip(), column + len(value) - len(written))
    return _parse_unit(motion, fields, column) if fields else motion, price


UNIT_PRICES = Table("unit-price", NameKind.MOTION, "a price", _row, "a second price for {name!r}")


def write_unit_prices(prices: UnitPrices) -> str:
    """Return the text of a file of prices."""
    lines = [f"{motion}\t{decimal_text(price)}\n" for motion, price in prices.motions.items()]
    for unit, price in prices.units.items():
        fields = [
            unit.motion,
            *map(_node_field, unit.inputs),
            _ARROWS[0],
            *map(_node_field, unit.outputs),
            decimal_text(price),
        ]
        lines.append("\t".join(fields) + "\n")
    return "".join(lines)


def _node_field(node: ObjectNode) -> str:
    """Write a node as a field; a label that is an arrow is quoted."""
    return in_quotes(node.label) if str(node) in _ARROWS else str(node)


def _parse_unit(motion: str, fields: list[str], column: int) -> FunctionalUnit:
    """Read a unit from its input, arrow and output fields, which begin at a column."""
    sides: list[list[ObjectNode]] = [[]]
    for field in fields:
        if field.strip() in _ARROWS:
            if len(sides) > 1:
                raise LineError(column, "a second arrow", ("an object node", "the price"))
            if not sides[0]:
                raise LineError(column, "an arrow", ("an input before it",))
            sides.append([])
        else:
            try:
                sides[-1].append(parse_node(field.strip()))
            except LineError as error:
                blanks = len(field) - len(field.lstrip())
                raise LineError(column + blanks + error.column - 1, error.found, error.expected) from None
        column += len(field) + 1
    if len(sides) == 1:
        raise LineError(column, "the price of a unit", ("an arrow (-> between two tabs) before it",))
    return FunctionalUnit.of(motion, *sides)
