"""The table ``unit_prices.txt``: on each line a motion or a single unit, and its price."""

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
    """The prices in a file: of ``motions``, and of single ``units`` with the ``sources`` of their prices."""

    motions: dict[str, Fraction]
    units: dict[FunctionalUnit, Fraction]
    sources: dict[FunctionalUnit, Source]


def read_unit_prices(file: Path) -> UnitPriceList:
    """Return the prices in a file.

    A line ``motion⇥price`` has the price of all units of a motion. A line
    ``motion⇥input⇥...⇥→⇥output⇥...⇥price`` has the price of a single unit. Nodes are in one-line notation;
    ``->`` may stand for ``→``. Raises :class:`InputError` for a line of another form, and for a motion or a
    unit with two different prices.
    """
    price_list = UnitPriceList({}, {}, {})
    for name, price, source in UNIT_PRICES.rows(file):
        if isinstance(name, str):
            price_list.motions[name] = price
        else:
            price_list.units[name], price_list.sources[name] = price, source
    return price_list


def _price_row(name: str, value: str, column: int) -> tuple[str | FunctionalUnit, Fraction]:
    """Return the motion or the single unit of a row, and its price; raises :class:`LineError` at a fault."""
    motion = motion_in_first_column(name, "a price")
    *fields, written = value.split("\t")
    price = read_price(written.strip(), column + len(value) - len(written))
    return _parse_unit(motion, fields, column) if fields else motion, price


UNIT_PRICES = Table("unit-price", NameKind.MOTION, "a price", _price_row, "a second price for {name!r}")
"""``motion⇥1.99`` and ``motion⇥input⇥→⇥output⇥1.99``: prices of motions and of single units, from 0."""


def write_unit_prices(prices: UnitPrices) -> str:
    """Return the text of a file that :func:`read_unit_prices` reads as these prices."""
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
    """Return a node as a field of a row; a label that is an arrow is in quotes."""
    return in_quotes(node.label) if str(node) in _ARROWS else str(node)


def _parse_unit(motion: str, fields: list[str], column: int) -> FunctionalUnit:
    """Return the unit of a motion and of fields: one or more inputs, an arrow, and any number of outputs.

    ``column`` is where the fields begin. Raises :class:`LineError` at a fault.
    """
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
