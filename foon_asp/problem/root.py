"""Exact roots of rational numbers.

They are the values of a success rate at which two products of rates are equal.
"""

import functools
import math
from dataclasses import dataclass
from fractions import Fraction


@functools.total_ordering
@dataclass(frozen=True)
class Root:
    """The positive root of a rational number: the number ``of`` to the power of 1 / ``degree``.

    :meth:`simplify` makes one of the least possible degree. Roots are compared exactly, by their powers,
    which are rational numbers.
    """

    degree: int
    of: Fraction

    @classmethod
    def simplify(cls, degree: int, of: Fraction) -> "Root":
        """Return a root with the least possible degree: ``Root(2, 3)`` for degree 4 and number 9.

        Raises ``ValueError`` for a degree or number that is not positive.
        """
        if degree < 1 or of <= 0:
            raise ValueError("expected a positive degree, and a positive number under the root")
        # if two powers of the root are rational, so is that by the greatest common divisor of the exponents
        for divisor in range(2, degree + 1):
            while degree % divisor == 0:
                numerator, denominator = (
                    integer_root(divisor, of.numerator),
                    integer_root(divisor, of.denominator),
                )
                if numerator**divisor != of.numerator or denominator**divisor != of.denominator:
                    break
                degree, of = degree // divisor, Fraction(numerator, denominator)
        return cls(degree, of)

    @property
    def rational(self) -> Fraction | None:
        """The value of the root if it is rational; ``None`` if it is irrational."""
        return self.of if self.degree == 1 else None

    def divide_by(self, number: Fraction) -> "Root":
        """Return the root divided by a positive rational number."""
        return Root(self.degree, self.of / number**self.degree)

    def __lt__(self, other: "Root") -> bool:
        return self.of**other.degree < other.of**self.degree

    def round_down(self, digits: int) -> Fraction:
        """Return the greatest decimal with ``digits`` significant digits that is at most the root."""
        places = self._decimal_places(digits)
        return self._scaled(places) / Fraction(10) ** places

    def round_up(self, digits: int) -> Fraction:
        """Return the least decimal with ``digits`` significant digits that is at least the root."""
        places = self._decimal_places(digits)
        scaled = self._scaled(places)
        exact = scaled**self.degree == self.of * Fraction(10) ** (places * self.degree)
        return (scaled + (not exact)) / Fraction(10) ** places

    def _decimal_places(self, digits: int) -> int:
        """Return the number of decimal places that gives the root ``digits`` significant digits.

        It is negative if the root has more digits before the decimal point: ``-1`` for 2 digits of 123.
        """
        bits = self.of.numerator.bit_length() - self.of.denominator.bit_length()
        places = digits - bits * 3 // (10 * self.degree)  # an estimate: a bit is about 0.3 digits
        while self._scaled(places) >= 10**digits:
            places -= 1
        while self._scaled(places) < 10 ** (digits - 1):
            places += 1
        return places

    def _scaled(self, places: int) -> int:
        """Return the integer part of the root times ten to the power of ``places``."""
        return integer_root(self.degree, math.floor(self.of * Fraction(10) ** (places * self.degree)))


def integer_root(degree: int, number: int) -> int:
    """Return the integer part of the ``degree``-th root of an integer from 0: 3 for degree 2 and number 10.

    Newton's method on integers, started above the root, decreases until it reaches the result.
    """
    if number < 2:
        return number
    root = 1 << -(-number.bit_length() // degree)  # at least the root
    while True:
        lower = ((degree - 1) * root + number // root ** (degree - 1)) // degree
        if lower >= root:
            return root
        root = lower
