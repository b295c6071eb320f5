"""Success rates as integers for clingo, and as exact exponents where rounding could decide.

A product of rates is the sum of their logarithms; clingo adds integers, so each rate p is given the weight
``floor(S * -ln p)``. Rounding down loses less than 1 per unit, which bounds what it can hide: see
``docs/exact-success.md`` for the argument and ``foon_asp/asp/solver.py`` for its use.
"""

import math
from collections.abc import Collection, Iterable, Mapping
from decimal import MAX_EMAX, MIN_EMIN, ROUND_CEILING, Context, Decimal
from fractions import Fraction
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.problem import Problem

_LARGEST = 2**31 - 1
_SCALES = tuple(10**k for k in range(8, -1, -1))
_ENOUGH = 1000  # what a rate should weigh at least: next to 1 a finer scale is taken where it fits
_DIGITS = 40  # of a logarithm, at first
_CONTEXT = Context(prec=60, Emax=MAX_EMAX, Emin=MIN_EMIN)


class RateScale(NamedTuple):
    """Integer weights and exponents for a set of rates.

    ``weights[p]`` is ``floor(scale * -ln p)``; ``exponents[p][f]`` is the power to which the rate holds
    factor number ``f``. The factors are pairwise coprime, so two products of rates are equal exactly when
    the sums of their exponents are. A weight of 0 says nothing of the rate: it may be next to 1.
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
    """Scale rates in (0, 1] as finely as clingo's 32-bit integers allow, but no finer than is of use.

    That is 10^8 at most, and more only where a rate next to 1 would weigh next to nothing. Raises
    ``ValueError`` for other rates.
    """
    if not all(0 < rate <= 1 for rate in rates):
        raise ValueError("expected success rates above 0 and at most 1")
    logarithms = {rate: _minus_log(rate, _DIGITS) for rate in sorted(rates)}
    largest = max(logarithms.values(), default=Decimal(0))
    smallest = min(filter(None, logarithms.values()), default=largest)
    scale = next(s for s in _SCALES if largest * s < _LARGEST)
    if 0 < smallest * scale < _ENOUGH:
        useful = (_ENOUGH / smallest).adjusted() + 1
        fitting = (_LARGEST / largest).adjusted()
        scale = max(scale, 10 ** min(useful, fitting))
    weights = {rate: _weight(rate, scale) for rate in logarithms}
    return RateScale(scale, weights, _exponents(weights))


def problem_scale(problem: Problem, units: Iterable[int]) -> RateScale:
    """Scale the rates of some units of a problem.

    Raises :class:`UserError` where clingo could not add up their exponents.
    """
    units = list(units)
    scale = rate_scale(problem.different_rates(units))
    most = max((abs(e) for rate in scale.exponents.values() for e in rate.values()), default=0)
    if most * len(units) > _LARGEST:
        raise UserError(
            "the success rates of the motions are too far apart: written as powers of common factors, "
            f"the exponents of {len(units)} units add up to more than clingo's numbers hold"
        )
    return scale


def _minus_log(rate: Fraction, digits: int) -> Decimal:
    """Give ``-ln`` of a rate to so many digits: it is off by less than 10^-digits of itself."""
    lost = 1 - rate
    context = Context(prec=2 * digits + 5, Emax=MAX_EMAX, Emin=MIN_EMIN)
    if lost < Fraction(1, 10 ** (digits + 1)):  # lost < -ln(1 - lost) < lost / (1 - lost)
        return context.divide(Decimal(lost.numerator), Decimal(lost.denominator))
    # The logarithm of 1 + x has as many digits fewer than 1 + x as x is small: fewer than half of them.
    return context.ln(context.divide(Decimal(rate.denominator), Decimal(rate.numerator)))


def _weight(rate: Fraction, scale: int) -> int:
    """Give ``floor(scale * -ln rate)``, exactly.

    The logarithm of a rational number other than 1 is irrational, so enough digits always settle the floor.
    """
    lost = 1 - rate
    low, high = math.floor(scale * lost), math.floor(scale * lost / rate)
    digits = _DIGITS
    while low < high:
        value, off = Fraction(_minus_log(rate, digits)) * scale, Fraction(1, 10**digits)
        low, high = math.floor(value * (1 - off)), math.floor(value * (1 + off))
        digits *= 2
    return low


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
