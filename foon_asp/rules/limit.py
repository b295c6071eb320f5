"""Limits on how often units are executed."""

from collections.abc import Mapping
from typing import NamedTuple


class Limit(NamedTuple):
    """A linear constraint on executions: their weights sum up to ``bound`` at most, or ``at_least``.

    ``weights`` are by unit. Each execution of a unit counts; with ``used``, a unit counts once.
    """

    weights: Mapping[int, int]
    bound: int
    at_least: bool = False
    used: bool = False
