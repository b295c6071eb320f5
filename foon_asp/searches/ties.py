"""Tie-breaking of the published searches: of equally good achievers, the first or the last in file order."""

from collections.abc import Callable, Sequence
from enum import StrEnum
from fractions import Fraction

Choose = Callable[[Sequence[int]], int]
"""Chooses one of the achievers of an object, which are in file order; at least one exists."""


class Ties(StrEnum):
    """The tie-breaking rule: of equally good units, the first or the last in file order is chosen."""

    FIRST = "first"
    LAST = "last"


def least(ties: Ties, size: Callable[[int], int | Fraction] = lambda _: 0) -> Choose:
    """Return a function that chooses the unit of the least ``size``; ties are broken by file order."""
    return lambda candidates: min(candidates if ties is Ties.FIRST else reversed(candidates), key=size)
