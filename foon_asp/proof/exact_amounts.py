"""Exact arithmetic with amounts: the costs, weights and bounds of a certificate.

The part of an amount for ``success`` is a sum of ``e * -log(rate)`` with rational ``e``. Bounds of the
logarithms decide its sign. If they are too close, the product of ``rate ** e`` is compared with 1 in whole
numbers.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from decimal import Context, Decimal
from fractions import Fraction
from functools import cache
from itertools import accumulate
from typing import TypeAlias

from foon_asp.proof.certificate_limits import ALLOWED
from foon_asp.proof.refusal import CheckLimitError
from foon_asp.proof.step_budget import StepBudget

# A cost or weight: exact numbers by objective (its index) and rate (``None`` except by success).
Amount: TypeAlias = dict[tuple[int, Fraction | None], Fraction]

UNMEASURED = "nothing"  # in place of objectives, if the claim is that there is no tree


def negate(amount: Amount) -> Amount:
    """Return an amount with the opposite sign."""
    return {key: -value for key, value in amount.items()}


def bit_length(value: Fraction) -> int:
    """Return the number of bits of a fraction, numerator and denominator together."""
    return value.numerator.bit_length() + value.denominator.bit_length()


class AmountArithmetic:
    """Exact arithmetic with amounts, whose work counts as steps of a check.

    ``objectives``: the objectives, most important first; empty if the claim is that there is no tree.
    ``budget``: the steps of the check; :class:`CheckLimitError` is raised if they run out.
    ``minus_log``: a cached function from a rate to bounds of ``-log(rate)`` from below and above.
    """

    def __init__(self, objectives: Sequence[str], budget: StepBudget) -> None:
        self.objectives, self.budget = objectives, budget
        self.minus_log = cache(self._minus_log)

    def sum(self, amounts: Iterable[Amount]) -> Amount:
        """Return the sum of amounts; the work counts as steps of the check."""
        total: Amount = {}
        for amount in amounts:
            self.add_to(total, amount)
        return total

    def times(self, amount: Amount, factor: Fraction) -> Amount:
        """Return an amount times a factor; the work counts as steps of the check."""
        return self.sum([{key: value * factor for key, value in amount.items()}])

    def add_to(self, total: Amount, amount: Amount) -> None:
        """Add ``amount`` to ``total`` in place, and count the additions as steps of the check."""
        for key, value in amount.items():
            total[key] = total[key] + value if key in total else value
            self.budget.spend_on_fractions(bit_length(total[key]))

    def common_denominators(self, amounts: Sequence[Amount]) -> dict[tuple[int, Fraction | None], int]:
        """Return, for each part of amounts (objective and rate), the least common denominator.

        The work counts as steps of the check.
        """
        scales: dict[tuple[int, Fraction | None], int] = {}
        for amount in amounts:
            for key, value in amount.items():
                scale = scales.get(key, 1)
                if scale % value.denominator:
                    scale = math.lcm(scale, value.denominator)
                    self.budget.spend_on_fractions(scale.bit_length())
                scales[key] = scale
        return scales

    def sign(self, amount: Amount) -> Fraction | int:
        """Return a number with the exact sign of an amount.

        The part for the most important objective that is not 0 decides. If all parts are 0, return 0. For the
        objective ``success``, the work counts as steps, and :class:`CheckLimitError` may be raised.
        """
        for level, objective in enumerate(self.objectives or (UNMEASURED,)):
            if objective == "success":
                sign = self._minus_log_sign({r: e for (_, r), e in amount.items() if r is not None})
            else:
                sign = amount.get((level, None), 0)
            if sign:
                return sign
        return 0

    def _minus_log_sign(self, exponents: Mapping[Fraction, Fraction]) -> Fraction | int:
        """Return a number with the sign of the sum of ``e * -log(rate)`` over ``exponents``, exactly.

        Bounds of the logarithms decide if they can. Otherwise, all exponents are made whole by a common
        factor, and the product of all ``rate ** e`` is compared with 1. The sign is positive if the product
        is below 1. If the rate 0 has an exponent, the sign of this exponent decides, since ``-log(0)`` is
        infinite. Raises :class:`CheckLimitError` if the product is too long.
        """
        if zero_exponent := exponents.get(Fraction(0)):
            return zero_exponent
        exponents = {rate: e for rate, e in exponents.items() if e and rate != 1}
        # bounds of logarithms have hundreds of bits themselves
        for size in accumulate(map(bit_length, exponents.values())):
            self.budget.spend_on_fractions(4000 + size)
        bounds = [[e * bound for bound in self.minus_log(rate)] for rate, e in exponents.items()]
        low, high = sum(map(min, bounds)), sum(map(max, bounds))
        if low > 0 or high < 0:
            return low
        common = math.lcm(*(e.denominator for e in exponents.values()))
        powers = {rate: int(e * common) for rate, e in exponents.items()}
        bits = sum(abs(e) * rate.denominator.bit_length() for rate, e in powers.items())
        if bits > ALLOWED.product_bits:
            raise CheckLimitError("products of rates are too close to be told apart in reasonable time")
        self.budget.spend(bits * math.isqrt(bits) // 64)
        above, below = 1, 1
        for rate, power in powers.items():
            up, down = max(power, 0), max(-power, 0)
            above *= rate.numerator**up * rate.denominator**down
            below *= rate.denominator**up * rate.numerator**down
        return below - above

    def _minus_log(self, rate: Fraction) -> tuple[Fraction, Fraction]:
        """Return bounds of ``-log(rate)`` from below and above.

        Python's decimal logarithm is off by less than one unit of its last digit. For a rate near 1, the
        logarithms of denominator and numerator are nearly equal, so up to 400 more digits are computed. The
        work counts as steps of the check, so :class:`CheckLimitError` may be raised.
        """
        shared = (rate.denominator.bit_length() - (rate.denominator - rate.numerator).bit_length()) // 3
        decimal_context = Context(prec=50 + min(shared, 400))
        self.budget.spend((decimal_context.prec // 10) ** 3)
        low = high = Fraction(0)
        for sign, number in ((1, rate.denominator), (-1, rate.numerator)):
            logarithm = decimal_context.ln(Decimal(number))
            last_digit = (
                Fraction(10) ** (logarithm.adjusted() + 1 - decimal_context.prec)
                if logarithm
                else Fraction(0)
            )
            low += sign * Fraction(logarithm) - last_digit
            high += sign * Fraction(logarithm) + last_digit
        return low, high
