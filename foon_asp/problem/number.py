"""Exact numbers that callers write."""

import re
from decimal import Decimal
from fractions import Fraction

from foon_asp.errors import UserError

Number = int | str | float | Decimal | Fraction
"""An exact number; a float is taken as it is printed, so 0.9 is nine tenths."""


_LONGEST = 3322  # bits of a price: a thousand digits
_EXPONENT = re.compile(r"e([+-]?[\d_]+)\s*", re.IGNORECASE)
_LARGEST_EXPONENT = 1000  # 1e999999999 takes hours to write out


def exact(given: Number, what: str) -> Fraction:
    """Read an exact number; raises :class:`UserError` that says ``what`` it was to be."""
    try:
        power = _EXPONENT.search(str(given)) if isinstance(given, str | Decimal) else None
        if power and abs(int(power[1])) > _LARGEST_EXPONENT:
            raise UserError(
                f"found {str(given)[:40]} for {what}, expected an exponent of at most {_LARGEST_EXPONENT:,}"
            )
        return Fraction(repr(given) if isinstance(given, float) else given)
    except (ValueError, ZeroDivisionError, OverflowError):
        raise UserError(f"found {given!r} for {what}, expected a number such as '0.85'") from None


def unit_price(given: Number, what: str) -> Fraction:
    """Read the exact price of a unit; raises :class:`UserError` that says ``what`` it was to be."""
    price = exact(given, what)
    if price < 0 or max(price.numerator, price.denominator).bit_length() > _LONGEST:
        raise UserError(
            f"found {str(given)[:40]} for {what}, expected a price from 0, of at most 1,000 digits"
        )
    return price


def success_rate(given: Number, what: str) -> Fraction:
    """Read an exact success rate; raises :class:`UserError` that says ``what`` it was to be."""
    rate = exact(given, what)
    if not 0 < rate <= 1:
        raise UserError(f"found {given} for {what}, expected a number above 0 and at most 1")
    return rate
