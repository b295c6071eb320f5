"""Success rates as integers for clingo, and as exact exponents where rounding could decide.

A product of rates is the sum of their logarithms; clingo adds integers, so each rate p is given the weight
``floor(S * -ln p)``. Rounding down loses less than 1 per unit, which bounds what it can hide: see
``docs/exact-success.md`` for the argument and ``foon_asp/asp/solver.py`` for its use.
"""

import math
from collections.abc import Collection, Iterable, Mapping
from decimal import ROUND_CEILING, Context, Decimal
from fractions import Fraction
from typing import NamedTuple

from foon_asp.errors import BugError
from foon_asp.problem import Problem

_LARGEST = 2**31 - 1
_SCALES = tuple(10**k for k in range(8, -1, -1))
_CONTEXT = Context(prec=60)


class RateScale(NamedTuple):
    """Integer weights and exponents for a set of rates.

    ``weights[p]`` is ``floor(scale * -ln p)``; ``exponents[p][f]`` is the power to which the rate holds
    factor number ``f``. The factors are pairwise coprime, so two products of rates are equal exactly when
    the sums of their exponents are.
    """

    scale: int
    weights: Mapping[Fraction, int]
    exponents: Mapping[Fraction, Mapping[int, int]]

    def product_exponents(self, rates: Iterable[Fraction]) -> dict[int, int]:
        """Give the exponents of a product of rates; every factor is listed."""
        total = {factor: 0 for rate in self.exponents.values() for factor in rate}
        for rate in rates:
            for factor, exponent in self.exponents[rate].items():
                total[factor] += exponent
        return total

    def success_bound(self, weight: int) -> Fraction:
        """Bound from above the success of every tree whose weights sum to at least ``weight``.

        Since rounding went down, such a tree has ``-ln(success) >= weight / scale``.
        """
        value = _CONTEXT.exp(_CONTEXT.divide(Decimal(-weight), Decimal(self.scale)))
        places = Decimal(1).scaleb(value.adjusted() - 17)
        return min(Fraction(1), Fraction(value.quantize(places, rounding=ROUND_CEILING)) + Fraction(places))


def rate_scale(rates: Collection[Fraction]) -> RateScale:
    """Scale rates in (0, 1] as finely as clingo's 32-bit integers allow, at most by 10^8."""
    logarithms = {rate: _minus_log(rate) for rate in sorted(rates)}
    largest = max(logarithms.values(), default=Decimal(0))
    scale = next(s for s in _SCALES if largest * s < _LARGEST)
    weights = {rate: _floor(logarithm * scale) for rate, logarithm in logarithms.items()}
    return RateScale(scale, weights, _exponents(weights))


def problem_scale(problem: Problem, units: Iterable[int]) -> RateScale:
    """Scale the rates of some units of a problem."""
    return rate_scale(problem.different_rates(units))


def _minus_log(rate: Fraction) -> Decimal:
    numerator, denominator = Decimal(rate.numerator), Decimal(rate.denominator)
    return _CONTEXT.subtract(_CONTEXT.ln(denominator), _CONTEXT.ln(numerator))


def _floor(value: Decimal) -> int:
    # The logarithm of a rational other than 1 is never a whole number, so 60 digits settle the floor;
    # if they ever did not, say so instead of rounding the wrong way.
    nearest = value.to_integral_value()
    if value and abs(value - nearest) < Decimal("1e-30"):
        raise BugError(f"a scaled logarithm is too close to {nearest} to be rounded safely")
    return math.floor(value)


def _exponents(rates: Iterable[Fraction]) -> dict[Fraction, dict[int, int]]:
    rates = list(rates)
    base = _coprime_base(n for rate in rates for n in (rate.numerator, rate.denominator))
    found: dict[Fraction, dict[int, int]] = {}
    for rate in rates:
        exponents: dict[int, int] = {}
        for number, factor in enumerate(base):
            up, down = _multiplicity(rate.numerator, factor), _multiplicity(rate.denominator, factor)
            if up != down:
                exponents[number] = up - down
        found[rate] = exponents
    return found


def _coprime_base(numbers: Iterable[int]) -> list[int]:
    """Give pairwise coprime factors > 1 of which every number is a product of powers (no factoring)."""
    base: list[int] = []
    for number in sorted(set(numbers)):
        pending = [number]
        while pending:
            a = pending.pop()
            if a == 1:
                continue
            for index, b in enumerate(base):
                common = math.gcd(a, b)
                if common > 1:
                    del base[index]
                    pending += [a // common, b // common, common]
                    break
            else:
                base.append(a)
    return sorted(base)


def _multiplicity(number: int, factor: int) -> int:
    count = 0
    while number % factor == 0:
        number //= factor
        count += 1
    return count
