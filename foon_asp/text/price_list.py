"""Prices of things to buy: an object node or a label and its price on each line."""

import re
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from foon_asp.network import ObjectNode, Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.line import LineError, parse_node
from foon_asp.text.plain_file import read_plain_text

_DECIMAL = re.compile(r"\d{1,9}(\.\d{1,6})?", re.ASCII)


class Price(NamedTuple):
    """One line of a price list; ``label_alone`` says that it has nothing but the label of a node."""

    node: ObjectNode
    label_alone: bool
    price: Fraction
    source: Source


def read_prices(file: Path) -> list[Price]:
    """Read ``node⇥price`` lines; blank lines and ``#`` comments are passed over.

    A node is in one-line notation (``sugar; in [sugar jar]``) or a label alone (``sugar``); ``sugar;`` is the
    node that is nothing but the label. A price is a decimal from 0, with up to nine digits before the point
    and six behind it. Raises :class:`InputError` for a line of another form and for a node that is listed
    twice.
    """
    prices: list[Price] = []
    errors: list[Diagnostic] = []
    seen: set[tuple[ObjectNode, bool]] = set()
    for number, raw in enumerate(read_plain_text(file).split("\n"), 1):
        line = raw.removesuffix("\r")
        if not line.strip() or line.startswith("#"):
            continue

        def reject(column: int, message: str, number: int = number, line: str = line) -> None:
            source = Source(str(file), number, column)
            errors.append(Diagnostic(Severity.ERROR, "price", message, source, line))

        name, tab, field = line.partition("\t")
        price = field.strip()
        if not tab:
            reject(len(line) + 1, "found the end of the line, expected a tab and a price")
            continue
        if not _DECIMAL.fullmatch(price):
            reject(len(name) + 2, f"found {price[:40]!r}, expected a price as a decimal such as 1.99")
            continue
        try:
            node = parse_node(name.strip())
        except LineError as error:
            reject(error.column, str(error))
            continue
        key = node, ";" not in name
        if key in seen:
            reject(1, f"found a second price for {name.strip()!r}, expected one")
            continue
        seen.add(key)
        prices.append(Price(*key, Fraction(price), Source(str(file), number)))
    if errors:
        raise InputError(errors)
    return prices
