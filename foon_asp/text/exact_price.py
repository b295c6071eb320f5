"""Prices as they are written, exact decimals from 0; and exact numbers written as decimals."""

import re
from fractions import Fraction

_DECIMAL = re.compile(r"\d+(\.\d*)?|\.\d+", re.ASCII)
_LONGEST = 1000  # letters of a price: nobody means more


class PriceError(ValueError):
    """What was found in the place of a price, and what was expected."""

    def __init__(self, found: str, expected: str) -> None:
        super().__init__(f"found {found}, expected {expected}")
        self.found, self.expected = found, expected


def read_price(written: str) -> Fraction:
    """Read a price; raises :class:`PriceError` for anything else."""
    if len(written) > _LONGEST:
        raise PriceError(f"a number of {len(written)} letters", f"at most {_LONGEST}")
    if not _DECIMAL.fullmatch(written):
        raise PriceError(repr(written), "a price from 0, as a decimal such as 1.99")
    return Fraction(written)


def decimal_text(number: Fraction) -> str:
    """Write a number from 0 as the decimal it was read from."""
    places = 0
    while (number * 10**places).denominator != 1 and places < _LONGEST:
        places += 1
    digits = f"{int(number * 10**places):0{places + 1}d}"
    return f"{digits[:-places]}.{digits[-places:]}" if places else digits
