"""Tie-breaking of the published searches: of equally good achievers, the first or the last in file order."""

from collections.abc import Callable, Sequence
from enum import StrEnum
from fractions import Fraction

Choose = Callable[[Sequence[int]], int]
"""A function that returns one of the achievers of an object; they are in file order, and not empty."""


class Ties(StrEnum):
    """The tie-breaking rule: of equally good units, the first or the last in file order is chosen."""

    FIRST = "first"
    LAST = "last"


def least_chooser(ties: Ties, size: Callable[[int], int | Fraction] = lambda _: 0) -> Choose:
    """Return a function that chooses the achiever of the least ``size``.

    Of several achievers of the least size, it chooses the first or the last in file order, as ``ties`` says.
    Without ``size``, all achievers have the same size.
    """
    return lambda candidates: min(candidates if ties is Ties.FIRST else reversed(candidates), key=size)
