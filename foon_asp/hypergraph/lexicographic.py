"""Lexicographic costs that are compared exactly: counts, and products of rates.

A cost is a vector of rational numbers. Its coordinates belong to levels, the most important first. A level
that counts has one coordinate. A level that multiplies rates has a coordinate for each rate ``r``: the
exponent ``e`` in the product of all ``r ** e``. Its cost is ``-log`` of the product.

Costs add up coordinate by coordinate, can be multiplied by rational numbers, and are ordered: the first level
at which they differ decides. So linear programming works on them as on numbers, and nothing is rounded.
"""

from collections.abc import Iterable, Iterator, Sequence
from decimal import Context, Decimal
from fractions import Fraction
from functools import cached_property, lru_cache

from foon_asp.hypergraph.coprime_base import coprime_base, factor_exponents

Vector = tuple[Fraction, ...]

_DIGITS = 60  # of a logarithm, at first


class Lexicographic:
    """An order on cost vectors.

    ``levels``: for each level, the tuple of the rates that it multiplies; ``None`` for a level that adds up
    counts. Rates lie strictly between 0 and 1.
    ``width``: the number of coordinates of a vector.
    """

    def __init__(self, levels: Sequence[Sequence[Fraction] | None]) -> None:
        self.levels = tuple(None if rates is None else tuple(rates) for rates in levels)
        # the factor of each coordinate in its level, in floats
        self._float_factors = [
            [1.0] if rates is None else [float(minus_log(rate, _DIGITS)[0]) for rate in rates]
            for rates in self.levels
        ]
        self.width = sum(map(len, self._float_factors))

    @property
    def zero(self) -> Vector:
        """The cost of nothing: a vector of zeros."""
        return (Fraction(0),) * self.width

    def total(self, vectors: Iterable[Vector]) -> Vector:
        """Return the sum of costs; :attr:`zero` for no costs."""
        return tuple(sum(coordinates, Fraction(0)) for coordinates in zip(self.zero, *vectors, strict=True))

    def sign(self, vector: Sequence[Fraction | int]) -> int:
        """Return -1, 0 or 1 for a cost below, equal to or above the cost of nothing.

        The result is exact. A vector with coordinates other than 0 can cost nothing: the product of
        ``(7/10) ** 2`` and ``(49/100) ** -1`` is 1.
        """
        for level, coordinates in self._split_by_level(vector):
            rates = self.levels[level]
            sign = (
                _sign(coordinates[0]) if rates is None else self._sign_of_product(level, rates, coordinates)
            )
            if sign != 0:
                return sign
        return 0

    def compare(self, one: Vector, other: Vector) -> int:
        """Return -1, 0 or 1 if ``one`` is below, equal to or above ``other``. The result is exact."""
        return self.sign(subtract(one, other))

    def approximate(self, vector: Sequence[Fraction | int]) -> list[float]:
        """Return the cost at each level as a float, for heuristics.

        Coordinates are limited to the range from -10^12 to 10^12, since HiGHS fails far beyond it.
        """
        greatest = 10**12
        return [
            sum(self._log_terms(level, [max(-greatest, min(e, greatest)) for e in coordinates]))
            for level, coordinates in self._split_by_level(vector)
        ]

    def _split_by_level(
        self, vector: Sequence[Fraction | int]
    ) -> Iterator[tuple[int, Sequence[Fraction | int]]]:
        """Yield for each level a pair: its index, and its coordinates in the vector."""
        start = 0
        for level, measures in enumerate(self._float_factors):
            end = start + len(measures)
            yield level, vector[start:end]
            start = end

    def _log_terms(self, level: int, exponents: Sequence[Fraction | int]) -> list[float]:
        """Return each exponent of a level times ``-log`` of its rate, as floats; a count stays as it is."""
        return [float(e) * measure for e, measure in zip(exponents, self._float_factors[level], strict=True)]

    def _sign_of_product(
        self, level: int, rates: Sequence[Fraction], exponents: Sequence[Fraction | int]
    ) -> int:
        """Return the sign of ``-log`` of the product of all ``rates[i] ** exponents[i]``.

        The sign is exact. It is -1 for a product above 1. If floats are not precise enough to decide it,
        logarithms with more and more digits are computed.
        """
        if not any(exponents):
            return 0
        large = 10**15  # with larger exponents, lost digits could matter
        if all(-large < exponent < large for exponent in exponents):
            terms = self._log_terms(level, exponents)
            approximation = sum(terms)
            # the sum is this exact, at least; below 1e-290 floats lose their last digits
            if abs(approximation) > 1e-9 * sum(map(abs, terms)) + 1e-290:
                return _sign(approximation)
        if self._is_product_one(level, exponents):
            return 0
        digits = _DIGITS
        while True:
            total = error = Fraction(0)
            for i, exponent in enumerate(exponents):
                logarithm, log_error = minus_log(rates[i], digits)
                total += logarithm * exponent
                error += abs(log_error * exponent)
            if abs(total) > error:
                return _sign(total)
            digits += digits

    @cached_property
    def _coprime_factors(self) -> list[dict[int, dict[int, int]]]:
        """For each level, the factors of a coprime base of its rates.

        Each factor is mapped to the exponent that it has in each rate, by the index of the rate. A factor of
        a denominator has a negative exponent.
        """
        factors_by_level: list[dict[int, dict[int, int]]] = []
        for rates in self.levels:
            base = coprime_base(n for rate in rates or () for n in rate.as_integer_ratio())
            factors: dict[int, dict[int, int]] = {b: {} for b in base}
            for i, rate in enumerate(rates or ()):
                for b, power in factor_exponents(rate.numerator, base).items():
                    factors[b][i] = power
                for b, power in factor_exponents(rate.denominator, base).items():
                    factors[b][i] = -power
            factors_by_level.append(factors)
        return factors_by_level

    def _is_product_one(self, level: int, exponents: Sequence[Fraction | int]) -> bool:
        """Return whether a product of powers of a level's rates is exactly 1."""
        return not any(
            sum(power * exponents[i] for i, power in rates.items())
            for rates in self._coprime_factors[level].values()
        )


def subtract(one: Vector, other: Vector) -> Vector:
    """Return the difference of two costs, ``one - other``."""
    return tuple(a - b for a, b in zip(one, other, strict=True))


def multiply(vector: Vector, factor: Fraction) -> Vector:
    """Return a cost multiplied by a rational number."""
    return vector if factor == 1 else tuple(coordinate * factor for coordinate in vector)


@lru_cache(maxsize=4096)
def minus_log(rate: Fraction, digits: int) -> tuple[Fraction, Fraction]:
    """Return ``-log(rate)`` of a rate below 1 to ``digits`` digits, and a bound on its error.

    Results are cached.
    """
    # close to 1, the logarithms of denominator and numerator share their first digits
    shared_digits = (rate.denominator.bit_length() - (rate.denominator - rate.numerator).bit_length()) // 3
    precise = Context(prec=digits + shared_digits + 10)
    logarithms = [Fraction(precise.ln(Decimal(n))) for n in (rate.denominator, rate.numerator)]
    # each is off by half of its last digit, at most
    error = sum(logarithms) / Fraction(10 ** (precise.prec - 1))
    return logarithms[0] - logarithms[1], error


def _sign(number: Fraction | float) -> int:
    """Return -1, 0 or 1 for a number below, equal to or above 0."""
    return (number > 0) - (number < 0)
