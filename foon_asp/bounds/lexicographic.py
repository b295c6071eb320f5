"""Costs of several levels that are compared exactly: counts, and products of rates.

A cost is a vector of rational numbers. A level that counts has one coordinate. A level that multiplies rates
has one for each rate ``r``: the exponent ``e`` in the product of all ``r ** e``, which costs ``-log`` of it.
Costs add up coordinate by coordinate, can be multiplied by rational numbers, and are ordered: the first level
at which they differ decides. So linear programming works on them as on numbers, and nothing is rounded.
"""

import math
from collections.abc import Iterable, Sequence
from decimal import Context, Decimal
from fractions import Fraction
from functools import lru_cache

Vector = tuple[Fraction, ...]

_MARGIN = 1e-9  # of a sum of logarithms, beyond which its float cannot have the wrong sign
_TINY = 1e-45  # and where logarithms themselves are so small that sixty digits do not tell them
_DIGITS = Context(prec=60)
_FINE = Fraction(1, 10**58)  # how much of a logarithm of so many digits is not known
_LARGEST = 2_000_000  # bits of powers; what is closer than fifty digits and larger than this counts as equal


class Lexicographic:
    """An order on vectors; ``levels`` names for each level its rates, or ``None`` where it counts.

    Rates lie strictly between 0 and 1. ``width`` is the number of coordinates of a vector.
    """

    def __init__(self, levels: Sequence[Sequence[Fraction] | None]) -> None:
        self.levels = tuple(None if rates is None else tuple(rates) for rates in levels)
        self.width = sum(1 if rates is None else len(rates) for rates in self.levels)
        self._logarithms = [
            [float(below - above) for below, above in map(_logarithms, rates or ())] for rates in self.levels
        ]

    @property
    def zero(self) -> Vector:
        """The cost of nothing."""
        return (Fraction(0),) * self.width

    def total(self, vectors: Iterable[Vector]) -> Vector:
        """Add up costs."""
        return tuple(sum(parts, Fraction(0)) for parts in zip(self.zero, *vectors, strict=True))

    def sign(self, vector: Sequence[Fraction | int]) -> int:
        """Give -1, 0 or 1 for a cost below, equal to or above that of nothing, exactly."""
        place = 0
        for rates, logarithms in zip(self.levels, self._logarithms, strict=True):
            if rates is None:
                value = vector[place]
                place += 1
                if value:
                    return 1 if value > 0 else -1
                continue
            exponents = vector[place : place + len(rates)]
            place += len(rates)
            if any(exponents):
                terms = [float(e) * log for e, log in zip(exponents, logarithms, strict=True)]
                total, size = sum(terms), sum(map(abs, terms))
                if abs(total) > _MARGIN * size + _TINY:
                    return 1 if total > 0 else -1
                found = _product_sign(rates, exponents)
                if found:
                    return found
        return 0

    def approximate(self, vector: Sequence[Fraction]) -> list[float]:
        """Give each level as a float, for methods that guess what is then checked."""
        values: list[float] = []
        place = 0
        for rates, logarithms in zip(self.levels, self._logarithms, strict=True):
            if rates is None:
                values.append(float(vector[place]))
                place += 1
            else:
                exponents = vector[place : place + len(rates)]
                values.append(sum(float(e) * log for e, log in zip(exponents, logarithms, strict=True)))
                place += len(rates)
        return values


@lru_cache(maxsize=4096)
def _logarithms(rate: Fraction) -> tuple[Fraction, Fraction]:
    """Give the logarithms of denominator and numerator, each to sixty digits."""
    denominator, numerator = (_DIGITS.ln(Decimal(n)) for n in (rate.denominator, rate.numerator))
    return Fraction(denominator), Fraction(numerator)


def _product_sign(rates: Sequence[Fraction], exponents: Sequence[Fraction | int]) -> int:
    """Compare 1 with a product of rational powers: -1 where the product is above 1."""
    total = error = Fraction(0)
    for rate, exponent in zip(rates, exponents, strict=True):
        if exponent:
            below, above = _logarithms(rate)
            total += (below - above) * exponent
            error += (below + above) * _FINE * (exponent if exponent > 0 else -exponent)
    if abs(total) > error:
        return 1 if total > 0 else -1
    common = math.lcm(*(e.denominator for e in exponents))
    powers = [int(e * common) for e in exponents]
    if sum(abs(p) * r.denominator.bit_length() for r, p in zip(rates, powers, strict=True)) > _LARGEST:
        return 0
    over, under = 1, 1
    for rate, power in zip(rates, powers, strict=True):
        one, other = rate.numerator ** abs(power), rate.denominator ** abs(power)
        over *= one if power > 0 else other
        under *= other if power > 0 else one
    return (over < under) - (over > under)
