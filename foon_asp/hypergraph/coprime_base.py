"""Coprime bases: factors of numbers, by which products of powers of the numbers can be compared.

Pairwise coprime numbers above 1 are *independent*: a product of rational powers of them is 1 only if all
exponents are 0. Write every rate as a product of powers of such numbers. Then equal products have equal
exponents. A coprime base is computed by greatest common divisors alone, without prime factors.
"""

import math
from collections.abc import Iterable, Sequence
from fractions import Fraction


def coprime_base(numbers: Iterable[int]) -> list[int]:
    """Return pairwise coprime numbers above 1 such that each given number is a product of their powers.

    The numbers 4 and 6 have the coprime base 2 and 3. ``numbers`` are positive.
    """
    base: list[int] = []
    remaining = sorted(set(numbers))
    while remaining:
        number = remaining.pop()
        if number == 1:
            continue
        for i, factor in enumerate(base):
            divisor = math.gcd(number, factor)
            if divisor > 1:
                del base[i]
                remaining += [divisor, *Fraction(number, factor).as_integer_ratio()]
                break
        else:
            base.append(number)
    return base


def factor_exponents(number: int, base: Sequence[int]) -> dict[int, int]:
    """Write a number as a product of powers of a coprime base; return the exponents that are not 0.

    The exponents of 72 over the base ``[2, 3, 5]`` are ``{2: 3, 3: 2}``. The number has to be such a product.
    """
    exponents: dict[int, int] = {}
    for factor in base:
        while number % factor == 0:
            number //= factor
            exponents[factor] = exponents.get(factor, 0) + 1
    return exponents
