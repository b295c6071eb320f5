"""Limits on how often units are executed."""

from collections.abc import Mapping
from typing import NamedTuple


class Limit(NamedTuple):
    """That units, times their weights, add up to ``bound`` at most, or ``at_least``.

    Each execution of a unit counts; if it says what is ``used``, a unit counts once.
    """

    weights: Mapping[int, int]
    bound: int
    at_least: bool = False
    used: bool = False
