"""The rates of one motion at which a tree stays optimal: exact ends, and how far they are."""

from fractions import Fraction
from typing import NamedTuple

from foon_asp.problem.root import Root

_DIGITS = 4  # of an end in words, at least


class End(NamedTuple):
    """How far a rate may go to one side, and what is the best tree beyond.

    ``at`` is where another tree is as good, and beyond it better: ``beyond``, its units by id in an order
    that executes. Both are ``None`` where no rate on that side makes another tree better. ``proved`` says
    that this is the end; where it is false a limit came first, and the end may be nearer to the rate.
    """

    at: Root | None
    beyond: tuple[int, ...] | None
    proved: bool = True


class Interval(NamedTuple):
    """The rates of one motion at which the tree stays optimal, while all other rates are what they are.

    ``rate`` is the one that is given, and ``units`` says how many units of the tree have it. The interval
    goes from ``below.at``, or from 0, which is not in it, to ``above.at``, or to 1.
    """

    motion: str
    rate: Fraction
    units: int
    below: End
    above: End

    @property
    def proved(self) -> bool:
        """Whether both ends are proved."""
        return self.below.proved and self.above.proved

    @property
    def flips(self) -> tuple["Flip", ...]:
        """The ends beyond which another tree is the best, the nearer one first."""
        sides = ((self.below, False), (self.above, True))
        return tuple(sorted(Flip(self, end, above) for end, above in sides if end.at is not None))


class Flip(NamedTuple):
    """An end beyond which another tree is the best: flips are in order of relative change of the rate."""

    interval: Interval
    end: End
    above: bool

    @property
    def at(self) -> Root:
        """The rate at which it is."""
        assert self.end.at is not None
        return self.end.at

    @property
    def inwards(self) -> Fraction:
        """The rate at which it is, rounded to a decimal within the interval."""
        rate, digits = self.interval.rate, _DIGITS
        if self.at.rational == rate:
            return rate
        while True:
            rounded = self.at.below(digits) if self.above else self.at.above(digits)
            if rounded >= rate if self.above else rounded <= rate:
                return rounded
            digits += 1

    def change(self, digits: int) -> tuple[Fraction, Fraction]:
        """Give two numbers between which the relative change of the rate is, by the digits that count.

        They are one number where that is rational.
        """
        factor = self.at.over(self.interval.rate)
        exact = factor.rational
        low, high = (factor.below(digits), factor.above(digits)) if exact is None else (exact, exact)
        return (low - 1, high - 1) if self.above else (1 - high, 1 - low)

    def __lt__(self, other: object) -> bool:
        """Compare relative changes exactly, by as many digits as it takes.

        Changes that are equal and not rational are on one side, and factors of the rate that are equal: were
        the factors on two sides, they would add up to 2. But positive roots none of which is a rational
        multiple of another are linearly independent over the rational numbers (Besicovitch, 1940).
        """
        assert isinstance(other, Flip)
        if self.at.over(self.interval.rate) == other.at.over(other.interval.rate):
            return False  # on one side, or both at the rate itself
        digits = _DIGITS
        while True:
            (low, high), (others_low, others_high) = self.change(digits), other.change(digits)
            if high < others_low or others_high <= low:
                return high < others_low
            digits *= 2
