"""Exact rational numbers from the numbers and texts that callers write."""

import re
from decimal import Decimal
from fractions import Fraction

from foon_asp.errors import UserError

Number = int | str | float | Decimal | Fraction
"""An exact number; a float is the decimal that it is printed as, so that 0.9 is nine tenths."""

INT32_MAX = 2**31 - 1
"""The greatest integer of clingo, which wraps silently above it, and of planners."""

_MAX_DIGITS = 1000  # of a number: those of 1e999999999 take hours to compute
_EXPONENT = re.compile(r"e([+-]?[\d_]+)\s*", re.IGNORECASE)


def exact_number(number: Number, quantity: str) -> Fraction:
    """Return a number as an exact fraction: ``Fraction(9, 10)`` for ``0.9`` and for ``"0.9"``.

    Raises :class:`UserError` for a value that is no finite number, and for an exponent beyond 1,000. The
    message of the error names the ``quantity``, such as ``the duration of 'stir'``.
    """
    try:
        power = _EXPONENT.search(str(number)) if isinstance(number, str | Decimal) else None
        if power and abs(int(power[1])) > _MAX_DIGITS:
            raise UserError(
                f"found {str(number)[:40]} for {quantity}, expected an exponent of at most {_MAX_DIGITS:,}"
            )
        return Fraction(repr(number) if isinstance(number, float) else number)
    except (ValueError, ZeroDivisionError, OverflowError):
        raise UserError(f"found {number!r} for {quantity}, expected a number such as '0.85'") from None


def unit_price(number: Number, quantity: str) -> Fraction:
    """Return a price as an exact fraction.

    Raises :class:`UserError` for a value that is no finite number, and for a price below 0. The numerator and
    the denominator may have at most 1,000 digits. The message of the error names the ``quantity``.
    """
    price = exact_number(number, quantity)
    if price < 0 or max(price.numerator, price.denominator) >= 10**_MAX_DIGITS:
        raise UserError(
            f"found {str(number)[:40]} for {quantity}, expected a price from 0, of at most "
            f"{_MAX_DIGITS:,} digits"
        )
    return price


def success_rate(number: Number, quantity: str) -> Fraction:
    """Return a success rate as an exact fraction, above 0 and at most 1.

    Raises :class:`UserError` for a value that is no finite number, and for a rate outside this range. The
    message of the error names the ``quantity``.
    """
    rate = exact_number(number, quantity)
    if not 0 < rate <= 1:
        raise UserError(f"found {number} for {quantity}, expected a number above 0 and at most 1")
    return rate
