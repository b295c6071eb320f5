"""Numbers taken apart far enough to see which products of their powers are equal.

Numbers without common divisors, each above 1, are *independent*: a product of rational powers of them is 1
only if all exponents are 0. So when every rate is written in powers of such numbers, equal products have
equal exponents. Finding them takes greatest common divisors alone, and no prime factors.
"""

import math
from collections.abc import Iterable, Sequence
from fractions import Fraction


def coprime_base(numbers: Iterable[int]) -> list[int]:
    """Give numbers above 1, no two with a common divisor, whose powers multiply to each of these numbers."""
    base: list[int] = []
    waiting = sorted(set(numbers))
    while waiting:
        number = waiting.pop()
        if number == 1:
            continue
        for place, other in enumerate(base):
            common = math.gcd(number, other)
            if common > 1:
                del base[place]
                waiting += [common, *Fraction(number, other).as_integer_ratio()]
                break
        else:
            base.append(number)
    return base


def powers(number: int, base: Sequence[int]) -> dict[int, int]:
    """Write a number in powers of a base that was made for it; powers of 0 are left out."""
    found: dict[int, int] = {}
    for factor in base:
        while number % factor == 0:
            number //= factor
            found[factor] = found.get(factor, 0) + 1
    return found
