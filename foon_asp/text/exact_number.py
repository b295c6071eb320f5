"""Exact decimals from 0, as prices and rates are written."""

import re
from fractions import Fraction

from foon_asp.text.line import LineError

_DECIMAL = re.compile(r"\d+(\.\d*)?|\.\d+", re.ASCII)
MAX_LETTERS = 1000
"""The greatest number of letters of a number in a file."""


def read_price(written: str, column: int = 1) -> Fraction:
    """Return the exact price that a text states: a decimal from 0, such as ``1.99``.

    Raises :class:`LineError` for any other text, and for more than ``MAX_LETTERS`` letters. ``column`` is
    where the price begins in its line.
    """
    return read_decimal(written, column, "a price from 0, as a decimal such as 1.99")


def read_decimal(written: str, column: int, expected: str) -> Fraction:
    """Return the exact number that a text states: a decimal from 0, without sign and exponent.

    Raises :class:`LineError` for any other text, and for more than ``MAX_LETTERS`` letters. ``column`` is
    where the decimal begins in its line; ``expected`` describes the decimal in messages.
    """
    if len(written) > MAX_LETTERS:
        raise LineError(column, f"a number of {len(written)} letters", (f"at most {MAX_LETTERS}",))
    if not _DECIMAL.fullmatch(written):
        raise LineError(column, repr(written), (expected,))
    return Fraction(written)


def decimal_text(number: Fraction) -> str:
    """Return the shortest exact decimal of a number from 0: ``3.2`` for 16/5.

    The number has to be a decimal of at most ``MAX_LETTERS`` places.
    """
    places = 0
    while (number * 10**places).denominator != 1 and places < MAX_LETTERS:
        places += 1
    digits = f"{int(number * 10**places):0{places + 1}d}"
    return f"{digits[:-places]}.{digits[-places:]}" if places else digits
