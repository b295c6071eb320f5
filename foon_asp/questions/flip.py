"""Where another tree becomes the best as one success rate changes: exact, and as decimals for people."""

from decimal import Context, Decimal
from fractions import Fraction
from typing import NamedTuple

from foon_asp.problem.root import Root

_SHORT = Fraction(1, 10**9)  # smallest number that is written without an exponent


class Flip(NamedTuple):
    """The value ``at`` of a rate beyond which another tree is the best.

    The other tree is the best at rates above this value if ``above``, else at rates below. Flips are in order
    of the relative change of the rate.
    """

    rate: Fraction
    at: Root
    above: bool

    @property
    def inwards(self) -> Fraction:
        """The rate of the flip, rounded towards the given rate to a decimal of four digits or more."""
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
        """The relative change of the rate in percent, in three digits, rounded towards 0."""
        digits = 4
        while True:
            low, high = self.change(digits)
            if low == high == 0:
                return "0 %"
            if low > 0:
                shown = {Root(1, 100 * end).round_down(3) for end in (low, high)}
                if len(shown) == 1:
                    return f"{'+' if self.above else '-'}{decimal_text(shown.pop())} %"
            digits *= 2

    def change(self, digits: int) -> tuple[Fraction, Fraction]:
        """Return two numbers that enclose the relative change of the rate.

        They are computed from the factor of the rate, enclosed in ``digits`` significant digits.
        The numbers are equal if the change is rational.
        """
        factor = self.at.divide_by(self.rate)
        exact = factor.rational
        low, high = (factor.round_down(digits), factor.round_up(digits)) if exact is None else (exact, exact)
        return (low - 1, high - 1) if self.above else (1 - high, 1 - low)

    def __lt__(self, other: object) -> bool:
        """Compare relative changes exactly, by as many digits as it takes.

        Equal factors of the rate are compared first. After that, two changes that are not rational cannot be
        equal. On one side, their factors would be equal; on two sides, the factors would add up to 2. But
        positive roots none of which is a rational multiple of another are linearly independent over the
        rational numbers (Besicovitch, 1940).
        """
        assert isinstance(other, Flip)
        if self.at.divide_by(self.rate) == other.at.divide_by(other.rate):
            return False  # on one side, or both at the rate itself
        digits = 4
        while True:
            (low, high), (others_low, others_high) = self.change(digits), other.change(digits)
            if high < others_low or others_high <= low:
                return high < others_low
            digits *= 2


def decimal_text(value: Fraction) -> str:
    """Return a number as a decimal if it is finite, and else as a fraction."""
    context = Context(prec=value.numerator.bit_length() + value.denominator.bit_length())
    decimal = context.divide(Decimal(value.numerator), Decimal(value.denominator)).normalize(context)
    if Fraction(decimal) != value:
        return str(value)
    return f"{decimal:f}" if value >= _SHORT else f"{decimal}"
