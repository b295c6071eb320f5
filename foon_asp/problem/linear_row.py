"""A linear constraint on how often units are executed."""

from collections.abc import Iterable, Mapping
from typing import NamedTuple


class LinearRow(NamedTuple):
    """A linear constraint on a tree or plan: the sum of the weights of its executions is at most ``bound``.

    With ``at_least``, the sum has to be at least ``bound``. ``weights`` maps unit ids to weights; other units
    have weight 0. Each execution of a unit counts. With ``used``, only the first execution of each unit
    counts.
    """

    weights: Mapping[int, int]
    bound: int
    at_least: bool = False
    used: bool = False

    def weight(self, unit: int) -> int:
        """Return the weight of a unit, 0 if ``weights`` does not have it."""
        return self.weights.get(unit, 0)

    def total(self, units: Iterable[int]) -> int:
        """Return the sum of the weights of executed units, given by id with repeats."""
        return sum(map(self.weight, frozenset(units) if self.used else units))

    def holds(self, units: Iterable[int]) -> bool:
        """Whether executed units, given by id with repeats, satisfy the constraint."""
        total = self.total(units)
        return total >= self.bound if self.at_least else total <= self.bound
