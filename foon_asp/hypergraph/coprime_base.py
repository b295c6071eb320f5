"""Coprime bases: factors of numbers, by which products of powers of the numbers can be compared.

Pairwise coprime numbers above 1 are *independent*: a product of rational powers of them is 1 only if all
exponents are 0. So when every rate is written as a product of powers of such numbers, equal products have
equal exponents. A coprime base is computed by greatest common divisors alone, without prime factors.
"""

import math
from collections.abc import Iterable, Sequence
from fractions import Fraction


def coprime_base(numbers: Iterable[int]) -> list[int]:
    """Return pairwise coprime numbers above 1 such that each given number is a product of their powers."""
    base: list[int] = []
    waiting = sorted(set(numbers))
    while waiting:
        number = waiting.pop()
        if number == 1:
            continue
        for i, other in enumerate(base):
            common = math.gcd(number, other)
            if common > 1:
                del base[i]
                waiting += [common, *Fraction(number, other).as_integer_ratio()]
                break
        else:
            base.append(number)
    return base


def factor_exponents(number: int, base: Sequence[int]) -> dict[int, int]:
    """Return the exponents of a number by factor of its coprime base, without exponents of 0."""
    exponents: dict[int, int] = {}
    for factor in base:
        while number % factor == 0:
            number //= factor
            exponents[factor] = exponents.get(factor, 0) + 1
    return exponents
