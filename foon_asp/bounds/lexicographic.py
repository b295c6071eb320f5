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
from functools import cached_property, lru_cache

from foon_asp.bounds.coprime_base import coprime_base, powers

Vector = tuple[Fraction, ...]

_MARGIN = 1e-9  # of a sum of logarithms, beyond which its float cannot have the wrong sign
_TINY = 1e-290  # below this, floats lose their last digits
_DIGITS = 60  # of a logarithm, at first
_SMALL = 200_000  # bits of powers that are sooner multiplied out than compared by more digits


class Lexicographic:
    """An order on vectors; ``levels`` names for each level its rates, or ``None`` where it counts.

    Rates lie strictly between 0 and 1. ``width`` is the number of coordinates of a vector.
    """

    def __init__(self, levels: Sequence[Sequence[Fraction] | None]) -> None:
        self.levels = tuple(None if rates is None else tuple(rates) for rates in levels)
        self.width = sum(1 if rates is None else len(rates) for rates in self.levels)
        self._logarithms = [
            [float(_minus_log(rate, _DIGITS)[0]) for rate in rates or ()] for rates in self.levels
        ]

    @property
    def zero(self) -> Vector:
        """The cost of nothing."""
        return (Fraction(0),) * self.width

    def total(self, vectors: Iterable[Vector]) -> Vector:
        """Add up costs."""
        return tuple(sum(parts, Fraction(0)) for parts in zip(self.zero, *vectors, strict=True))

    def sign(self, vector: Sequence[Fraction | int]) -> int:
        """Give -1, 0 or 1 for a cost below, equal to or above that of nothing, exactly.

        It can be 0 for a vector that is not: 7/10 * 7/10 is 49/100.
        """
        place = 0
        for level, (rates, logarithms) in enumerate(zip(self.levels, self._logarithms, strict=True)):
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
                if self._is_one(level, exponents):
                    continue
                return _product_sign(rates, exponents)
        return 0

    def compare(self, one: Vector, other: Vector) -> int:
        """Give -1, 0 or 1 for a cost below, equal to or above another, exactly."""
        return self.sign([a - b for a, b in zip(one, other, strict=True)])

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

    @cached_property
    def _factors(self) -> list[list[dict[int, int]]]:
        """For each rate of each level its power of every number of a base without common divisors."""
        found: list[list[dict[int, int]]] = []
        for rates in self.levels:
            base = coprime_base([n for rate in rates or () for n in rate.as_integer_ratio()])
            parts = []
            for rate in rates or ():
                under = powers(rate.denominator, base)
                over = powers(rate.numerator, base)
                parts.append({b: over.get(b, 0) - under.get(b, 0) for b in over.keys() | under.keys()})
            found.append(parts)
        return found

    def _is_one(self, level: int, exponents: Sequence[Fraction | int]) -> bool:
        """Whether a product of powers of a level's rates is 1, however large the powers are."""
        total: dict[int, Fraction] = {}
        for factors, exponent in zip(self._factors[level], exponents, strict=True):
            for b, power in factors.items():
                total[b] = total.get(b, Fraction(0)) + power * exponent
        return not any(total.values())


@lru_cache(maxsize=4096)
def _minus_log(rate: Fraction, digits: int) -> tuple[Fraction, Fraction]:
    """Give ``-log(rate)`` to so many digits, and by how much it may be off; the rate is below 1."""
    # close to 1, the logarithms of denominator and numerator share their first digits
    shared = (rate.denominator.bit_length() - (rate.denominator - rate.numerator).bit_length()) // 3
    precise = Context(prec=digits + shared + 10)
    below, above = (Fraction(precise.ln(Decimal(n))) for n in (rate.denominator, rate.numerator))
    return below - above, (below + above + 1) / Fraction(10 ** (precise.prec - 1))


def _product_sign(rates: Sequence[Fraction], exponents: Sequence[Fraction | int]) -> int:
    """Compare 1 with a product of rational powers that is not 1: -1 where the product is above 1."""
    digits = _DIGITS
    while True:
        total = error = Fraction(0)
        for rate, exponent in zip(rates, exponents, strict=True):
            if exponent:
                logarithm, off = _minus_log(rate, digits)
                total += logarithm * exponent
                error += off * (exponent if exponent > 0 else -exponent)
        if abs(total) > error:
            return 1 if total > 0 else -1
        common = math.lcm(*(e.denominator for e in exponents))
        whole = [int(e * common) for e in exponents]
        if sum(abs(p) * r.denominator.bit_length() for r, p in zip(rates, whole, strict=True)) <= _SMALL:
            return _compared(rates, whole)
        digits *= 2


def _compared(rates: Sequence[Fraction], whole: Sequence[int]) -> int:
    """Compare a product of powers with 1 by multiplying it out."""
    over, under = 1, 1
    for rate, power in zip(rates, whole, strict=True):
        one, other = rate.numerator ** abs(power), rate.denominator ** abs(power)
        over *= one if power > 0 else other
        under *= other if power > 0 else one
    return (over < under) - (over > under)
