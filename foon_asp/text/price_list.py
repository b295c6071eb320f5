"""Prices of things to buy: an object node or a label and its price on each line."""

import re
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from foon_asp.network import ObjectNode, Source
from foon_asp.text.line import LineError
from foon_asp.text.line_parser import parse_name
from foon_asp.text.table_rows import read_rows

_DECIMAL = re.compile(r"\d{1,9}(\.\d{1,6})?", re.ASCII)


class Price(NamedTuple):
    """One line of a price list; ``label_alone`` says that it has nothing but the label of a node."""

    node: ObjectNode
    label_alone: bool
    price: Fraction
    source: Source


def priced_name(name: str) -> tuple[ObjectNode, bool]:
    """Return the node that has a price, and whether the name is a label alone; raises :class:`LineError`."""
    named = parse_name(name)
    return (ObjectNode(named), True) if isinstance(named, str) else (named, False)


def read_prices(file: Path) -> list[Price]:
    """Read ``node⇥price`` lines; blank lines and ``#`` comments are passed over.

    A node is in one-line notation (``sugar; in [sugar jar]``) or a label alone (``sugar``); ``sugar;`` is the
    node that is nothing but the label. A price is a decimal from 0, with up to nine digits before the point
    and six behind it. Raises :class:`InputError` for a line of another form and for a node that is listed
    twice.
    """
    prices: dict[tuple[ObjectNode, bool], Price] = {}

    def read(name: str, price: str, source: Source) -> None:
        if not _DECIMAL.fullmatch(price):
            raise LineError(len(name) + 2, repr(price[:40]), ("a price as a decimal such as 1.99",))
        key = priced_name(name.strip())
        if key in prices:
            raise LineError(1, f"a second price for {name.strip()!r}", ("one",))
        prices[key] = Price(*key, Fraction(price), source)

    read_rows(file, "price", "a price", read)
    return list(prices.values())
