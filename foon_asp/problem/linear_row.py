"""A linear row over executions: the form of every limit."""

from collections.abc import Iterable, Mapping
from typing import NamedTuple


class LinearRow(NamedTuple):
    """A linear constraint on executions: the sum of their weights is at most ``bound``.

    With ``at_least``, the sum is at least ``bound``. ``weights`` has the weight of a unit by id. A unit
    counts for each of its executions; with ``used``, only once.
    """

    weights: Mapping[int, int]
    bound: int
    at_least: bool = False
    used: bool = False

    def weight(self, unit: int) -> int:
        """Return the weight of one execution of a unit, 0 for a unit that the row does not name."""
        return self.weights.get(unit, 0)

    def total(self, units: Iterable[int]) -> int:
        """Return the sum of the weights of executed units; each occurrence of a unit is one execution."""
        return sum(map(self.weight, frozenset(units) if self.used else units))

    def holds(self, units: Iterable[int]) -> bool:
        """Whether executed units keep to the row."""
        total = self.total(units)
        return total >= self.bound if self.at_least else total <= self.bound
