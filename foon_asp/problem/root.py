"""Roots of rational numbers, exact: where products of rates in which one rate varies are equal."""

import functools
import math
from dataclasses import dataclass
from fractions import Fraction


@functools.total_ordering
@dataclass(frozen=True)
class Root:
    """The positive root of a positive rational number: that of ``of``, of a degree as small as it can be.

    :meth:`taken` makes one. Roots are compared by powers, which are rational numbers.
    """

    degree: int
    of: Fraction

    @classmethod
    def taken(cls, degree: int, of: Fraction) -> "Root":
        """Take a root; raises ``ValueError`` for numbers that are not positive.

        If a root is the root of two degrees it is that of their greatest common divisor, too. So dividing the
        degree by one number after another, as long as what is left is a rational number, ends with the least.
        """
        if degree < 1 or of <= 0:
            raise ValueError("expected a positive degree, and a positive number under the root")
        for divisor in range(2, degree + 1):
            while degree % divisor == 0:
                above, below = whole_root(divisor, of.numerator), whole_root(divisor, of.denominator)
                if above**divisor != of.numerator or below**divisor != of.denominator:
                    break
                degree, of = degree // divisor, Fraction(above, below)
        return cls(degree, of)

    @property
    def rational(self) -> Fraction | None:
        """The number itself where it is rational, else ``None``."""
        return self.of if self.degree == 1 else None

    def over(self, number: Fraction) -> "Root":
        """Divide by a positive rational number."""
        return Root(self.degree, self.of / number**self.degree)

    def __lt__(self, other: "Root") -> bool:
        return self.of**other.degree < other.of**self.degree

    def below(self, digits: int) -> Fraction:
        """Give the greatest decimal with ``digits`` significant digits that is not greater."""
        places = self._places(digits)
        return self._scaled(places) / Fraction(10) ** places

    def above(self, digits: int) -> Fraction:
        """Give the least decimal with ``digits`` significant digits that is not less."""
        places = self._places(digits)
        scaled = self._scaled(places)
        exact = scaled**self.degree == self.of * Fraction(10) ** (places * self.degree)
        return (scaled + (not exact)) / Fraction(10) ** places

    def _places(self, digits: int) -> int:
        """Give the number of places after the point that leaves ``digits`` significant digits."""
        bits = self.of.numerator.bit_length() - self.of.denominator.bit_length()
        places = digits - bits * 3 // (10 * self.degree)  # about: three tenths of a digit a bit
        while self._scaled(places) >= 10**digits:
            places -= 1
        while self._scaled(places) < 10 ** (digits - 1):
            places += 1
        return places

    def _scaled(self, places: int) -> int:
        """Give the whole part of the number times ten to the ``places``."""
        return whole_root(self.degree, math.floor(self.of * Fraction(10) ** (places * self.degree)))


def whole_root(degree: int, number: int) -> int:
    """Give the whole part of a root of a whole number that is not negative.

    Newton's method from above on whole numbers falls until it is there.
    """
    if number < 2:
        return number
    root = 1 << -(-number.bit_length() // degree)  # no less than the root
    while True:
        lower = ((degree - 1) * root + number // root ** (degree - 1)) // degree
        if lower >= root:
            return root
        root = lower
