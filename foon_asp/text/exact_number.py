"""Exact decimals from 0, as prices and rates are written."""

import re
from fractions import Fraction

from foon_asp.text.line import LineError

_DECIMAL = re.compile(r"\d+(\.\d*)?|\.\d+", re.ASCII)
MAX_LETTERS = 1000
"""Letters of a number in a file."""


def read_price(written: str, column: int = 1) -> Fraction:
    """Read a price; raises :class:`LineError` at its column for any other text."""
    return read_decimal(written, column, "a price from 0, as a decimal such as 1.99")


def read_decimal(written: str, column: int, expected: str) -> Fraction:
    """Read a number from 0; raises :class:`LineError` for any other text, saying what is ``expected``."""
    if len(written) > MAX_LETTERS:
        raise LineError(column, f"a number of {len(written)} letters", (f"at most {MAX_LETTERS}",))
    if not _DECIMAL.fullmatch(written):
        raise LineError(column, repr(written), (expected,))
    return Fraction(written)


def decimal_text(number: Fraction) -> str:
    """Write a number from 0 as the decimal it was read from."""
    places = 0
    while (number * 10**places).denominator != 1 and places < MAX_LETTERS:
        places += 1
    digits = f"{int(number * 10**places):0{places + 1}d}"
    return f"{digits[:-places]}.{digits[-places:]}" if places else digits
