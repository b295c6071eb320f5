"""The prices of units in data, by motion and of single units; others may be in a store."""

from collections.abc import Mapping
from fractions import Fraction
from typing import NamedTuple

from foon_asp.network import FunctionalUnit, UnitPrices


class DataPrices(NamedTuple):
    """The prices of units by motion and of single units; others may be in a store.

    ``motions``: the prices by motion; ``None`` where no file lists any.
    ``units``: the prices of single units that are in memory.
    ``from_file``: whether the imported file of prices of a store still counts.

    A price in ``units`` comes first. Then comes one of the imported file, if it counts. Last is a price that
    the imported networks state.
    """

    motions: Mapping[str, Fraction] | None = None
    units: Mapping[FunctionalUnit, Fraction] = {}
    from_file: bool = False

    @classmethod
    def of(cls, prices: UnitPrices | None) -> "DataPrices":
        """Return the prices of data in memory; without any prices if ``prices`` is ``None``."""
        return cls() if prices is None else cls(prices.motions, prices.units)


NO_PRICES = DataPrices()
