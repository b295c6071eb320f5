"""Rates at which another tree becomes the best, as one success rate changes: exact, and as decimals."""

from decimal import Context, Decimal
from fractions import Fraction
from typing import NamedTuple

from foon_asp.problem.root import Root

_SHORT = Fraction(1, 10**9)  # smallest number that is written without an exponent


class Flip(NamedTuple):
    """The value ``at`` of a rate beyond which another tree is the best.

    ``rate`` is the present value of this rate. The other tree is the best at rates above ``at`` if ``above``,
    else at rates below ``at``. Flips are ordered by the relative change from ``rate`` to ``at``.
    """

    rate: Fraction
    at: Root
    above: bool

    @property
    def inwards(self) -> Fraction:
        """The value ``at``, rounded towards ``rate`` to four significant digits.

        If four digits would pass ``rate``, it has more.
        """
        digits = 4
        if self.at.rational == self.rate:
            return self.rate
        while True:
            rounded = self.at.round_down(digits) if self.above else self.at.round_up(digits)
            if rounded >= self.rate if self.above else rounded <= self.rate:
                return rounded
            digits += 1

    @property
    def percent(self) -> str:
        """The relative change of the rate in three digits, rounded towards 0: ``+1.23 %``."""
        digits = 4
        while True:
            low, high = self.change(digits)
            if low == high == 0:
                return "0 %"
            if low > 0:
                rounded_percents = {Root(1, 100 * end).round_down(3) for end in (low, high)}
                if len(rounded_percents) == 1:
                    return f"{'+' if self.above else '-'}{decimal_text(rounded_percents.pop())} %"
            digits *= 2

    def change(self, digits: int) -> tuple[Fraction, Fraction]:
        """Return a lower and an upper bound on the size of the relative change of the rate, without its sign.

        The quotient of ``at`` and ``rate`` is enclosed in ``digits`` significant digits. If it is rational,
        both bounds are equal to the change.
        """
        factor = self.at.divide_by(self.rate)
        exact = factor.rational
        low, high = (factor.round_down(digits), factor.round_up(digits)) if exact is None else (exact, exact)
        return (low - 1, high - 1) if self.above else (1 - high, 1 - low)

    def __lt__(self, other: object) -> bool:
        """Compare relative changes exactly, by as many digits as it takes.

        A factor is the quotient of ``at`` and ``rate``. Equal factors are found first. Other changes can only
        be equal if both are rational. Proof: equal changes in one direction have equal factors. In opposite
        directions, the factors add up to 2. But positive roots are linearly independent over the rational
        numbers if none is a rational multiple of another (Besicovitch, 1940).
        """
        assert isinstance(other, Flip)
        if self.at.divide_by(self.rate) == other.at.divide_by(other.rate):
            return False  # on one side, or both at the rate itself
        digits = 4
        while True:
            (low, high), (other_low, other_high) = self.change(digits), other.change(digits)
            if high < other_low or other_high <= low:
                return high < other_low
            digits *= 2


def decimal_text(value: Fraction) -> str:
    """Return a number as a decimal if it has finitely many digits, else as a fraction: ``0.25``, ``1/3``.

    A decimal below 10^-9 has an exponent.
    """
    context = Context(prec=value.numerator.bit_length() + value.denominator.bit_length())
    decimal = context.divide(Decimal(value.numerator), Decimal(value.denominator)).normalize(context)
    if Fraction(decimal) != value:
        return str(value)
    return f"{decimal:f}" if value >= _SHORT else f"{decimal}"
