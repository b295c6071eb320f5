"""Success rates as integer weights for clingo, and as exact exponents where rounding could decide.

The logarithm of a product of rates is the sum of their logarithms. clingo adds integers, so each rate p has
the weight ``floor(S * -ln p)``, where S is a scale. Rounding down changes the weight of a unit by less than
1, so the error of a sum is below the number of units. ``docs/dev/exact-success.md`` has the argument, and
``foon_asp/asp/solver.py`` uses it.
"""

import math
from collections.abc import Collection, Iterable, Mapping
from decimal import MAX_EMAX, MIN_EMIN, ROUND_CEILING, Context, Decimal
from fractions import Fraction
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.hypergraph.coprime_base import coprime_base, factor_exponents
from foon_asp.problem import Problem
from foon_asp.problem.number import INT32_MAX

USUAL_SCALE = 10**8
"""The finest scale of costs that are rounded, except for rates next to 1."""

_CONTEXT = Context(prec=60, Emax=MAX_EMAX, Emin=MIN_EMIN)


class RateScale(NamedTuple):
    """Integer weights and exponents for a set of rates.

    ``weights[p]`` is ``floor(scale * -ln p)``; a rate slightly below 1 may have the weight 0.
    ``exponents[p][f]`` is the exponent of factor number ``f`` in the rate ``p``. The factors are pairwise
    coprime. So two products of rates are equal exactly when the sums of their exponents are equal.
    """

    scale: int
    weights: Mapping[Fraction, int]
    exponents: Mapping[Fraction, Mapping[int, int]]

    def product_exponents(self, rates: Iterable[Fraction]) -> dict[int, int]:
        """Return the exponents of a product of rates, by factor number, including exponents of 0."""
        total = {factor: 0 for rate in self.exponents.values() for factor in rate}
        for rate in rates:
            for factor, exponent in self.exponents[rate].items():
                total[factor] += exponent
        return total

    def weigh(self, product: Fraction) -> int:
        """Return ``floor(scale * -ln product)``: no plan with this success rate weighs more."""
        return _weight(product, self.scale)

    def success_bound(self, weight: int) -> Fraction:
        """Return an upper bound on the success of trees whose weights sum up to at least ``weight``.

        Weights are rounded down, so such a tree has ``-ln(success) >= weight / scale``. The bound is rounded
        up to 18 digits, and is at most 1.
        """
        value = _CONTEXT.exp(_CONTEXT.divide(Decimal(-weight), Decimal(self.scale)))
        places = _CONTEXT.scaleb(Decimal(1), value.adjusted() - 17)
        above = _CONTEXT.add(value.quantize(places, ROUND_CEILING, _CONTEXT), places)
        return Fraction(min(Decimal(1), above))


def rate_scale(rates: Collection[Fraction]) -> RateScale:
    """Return the weights of rates in (0, 1] for clingo, and their exponents for exact comparison.

    The scale of the weights is a power of ten by which all weights fit into 32 bits. It is at most 10^8,
    except where a rate next to 1 would weigh almost 0. The exponents are those of coprime factors of the
    rates. Two products of rates are equal if and only if their exponents add up to the same sums. Raises
    ``ValueError`` for a rate outside of (0, 1].
    """
    if not all(0 < rate <= 1 for rate in rates):
        raise ValueError("expected success rates above 0 and at most 1")
    logarithms = {rate: _minus_log(rate, 40) for rate in sorted(rates)}
    scale = _scale([logarithm for logarithm in logarithms.values() if logarithm])
    weights = {rate: _weight(rate, scale) for rate in logarithms}
    return RateScale(scale, weights, _exponents(weights))


def _scale(logarithms: Collection[Decimal]) -> int:
    """Return the power of ten by which logarithms above 0 are multiplied to become weights.

    The usual result is 10^8, also without logarithms. It is smaller if the greatest weight would otherwise
    exceed 32 bits. It is greater if the least weight would otherwise be below 1000, as far as 32 bits allow.
    """
    if not logarithms:
        return USUAL_SCALE
    fitting_scale: int = 10 ** (INT32_MAX / max(logarithms)).adjusted()
    # A rate next to 1 weighs 1000 or more, where that fits.
    useful_scale: int = 10 ** ((1000 / min(logarithms)).adjusted() + 1)
    return min(fitting_scale, max(USUAL_SCALE, useful_scale))


def problem_scale(problem: Problem, units: Iterable[int]) -> RateScale:
    """Return the :func:`rate_scale` of the success rates that units of a problem have.

    Raises :class:`UserError` if a sum of exponents of the units could exceed 32 bits.
    """
    units = list(units)
    scale = rate_scale(problem.different_rates(units))
    if any(len(units) * abs(e) > INT32_MAX for rate in scale.exponents.values() for e in rate.values()):
        raise UserError(
            "the success rates of the motions are too far apart: written as powers of common factors, "
            f"the exponents of {len(units)} units add up to more than clingo's numbers hold"
        )
    return scale


def _minus_log(rate: Fraction, digits: int) -> Decimal:
    """Return ``-ln`` of a rate in (0, 1] with ``digits`` digits: the relative error is below 10^-digits."""
    failure_rate = 1 - rate
    zeros = -_CONTEXT.divide(Decimal(failure_rate.numerator), Decimal(failure_rate.denominator)).adjusted()
    # The logarithm of 1 + x has as many digits fewer than 1 + x as x begins with zeros.
    context = Context(prec=digits + zeros + 2, Emax=MAX_EMAX, Emin=MIN_EMIN)
    return context.ln(context.divide(Decimal(rate.denominator), Decimal(rate.numerator)))


def _weight(rate: Fraction, scale: int) -> int:
    """Return ``floor(scale * -ln rate)``, exactly.

    The logarithm of a rational number other than 1 is irrational, so with enough digits the floor is certain.
    """
    # bounds of scale * -ln rate, precise enough next to 1
    low = scale * (1 - rate)
    high = low / rate
    digits = 40  # doubled until the floor is settled
    while math.floor(low) < math.floor(high):
        value = scale * Fraction(_minus_log(rate, digits))
        error = value / 10**digits
        low, high = value - error, value + error
        digits *= 2
    return math.floor(low)


def _exponents(rates: Collection[Fraction]) -> dict[Fraction, dict[int, int]]:
    """Return for each rate its exponents in a coprime base of all rates, by factor number, without zeros.

    The exponents of factors of a denominator are negative.
    """
    base = coprime_base(number for rate in rates for number in rate.as_integer_ratio())
    numbers = {factor: number for number, factor in enumerate(base)}
    exponents: dict[Fraction, dict[int, int]] = {}
    for rate in rates:
        # no factor is in both
        of_numerator, of_denominator = (factor_exponents(number, base) for number in rate.as_integer_ratio())
        exponents[rate] = {numbers[factor]: e for factor, e in of_numerator.items()}
        exponents[rate] |= {numbers[factor]: -e for factor, e in of_denominator.items()}
    return exponents
