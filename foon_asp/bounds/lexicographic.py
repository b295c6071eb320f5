"""Costs of several levels that are compared exactly: counts, and products of rates.

A cost is a vector of rational numbers. A level that counts has one coordinate. A level that multiplies rates
has one for each rate ``r``: the exponent ``e`` in the product of all ``r ** e``, which costs ``-log`` of it.
Costs add up coordinate by coordinate, can be multiplied by rational numbers, and are ordered: the first level
at which they differ decides. So linear programming works on them as on numbers, and nothing is rounded.
"""

import math
from collections.abc import Iterable, Sequence
from fractions import Fraction

Vector = tuple[Fraction, ...]

_MARGIN = 1e-9  # of a sum of logarithms, beyond which its float cannot have the wrong sign


class Lexicographic:
    """An order on vectors; ``levels`` names for each level its rates, or ``None`` where it counts.

    Rates lie strictly between 0 and 1. ``width`` is the number of coordinates of a vector.
    """

    def __init__(self, levels: Sequence[Sequence[Fraction] | None]) -> None:
        self.levels = tuple(None if rates is None else tuple(rates) for rates in levels)
        self.width = sum(1 if rates is None else len(rates) for rates in self.levels)
        self._logarithms = [
            [] if rates is None else [math.log(r.denominator) - math.log(r.numerator) for r in rates]
            for rates in self.levels
        ]

    @property
    def zero(self) -> Vector:
        """The cost of nothing."""
        return (Fraction(0),) * self.width

    def total(self, vectors: Iterable[Vector]) -> Vector:
        """Add up costs."""
        return tuple(sum(parts, Fraction(0)) for parts in zip(self.zero, *vectors, strict=True))

    def sign(self, vector: Sequence[Fraction]) -> int:
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
                if abs(total) > _MARGIN * size:
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


def _product_sign(rates: Sequence[Fraction], exponents: Sequence[Fraction]) -> int:
    """Compare 1 with a product of rational powers, in whole numbers: -1 where the product is above 1."""
    common = math.lcm(*(e.denominator for e in exponents))
    above, below = 1, 1
    for rate, exponent in zip(rates, exponents, strict=True):
        power = int(exponent * common)
        one, other = rate.numerator ** abs(power), rate.denominator ** abs(power)
        above *= one if power > 0 else other
        below *= other if power > 0 else one
    return (above < below) - (above > below)
