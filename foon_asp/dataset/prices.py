"""The prices of units in data, by motion and of single units; others may be in a store."""

from collections.abc import Mapping
from fractions import Fraction
from typing import NamedTuple

from foon_asp.network import FunctionalUnit, UnitPrices


class DataPrices(NamedTuple):
    """The prices of units by motion and of single units; others may be in a store.

    ``motions``: the prices by motion; ``None`` where no file lists any.
    ``units``: the prices of single units that are in memory.
    ``from_file``: whether the imported file of prices counts for other units of a store. A unit without a
    price there has the price that the networks in the store state.
    """

    motions: Mapping[str, Fraction] | None = None
    units: Mapping[FunctionalUnit, Fraction] = {}
    from_file: bool = False

    @classmethod
    def of(cls, prices: UnitPrices | None) -> "DataPrices":
        """Return the prices of data in memory; ``None`` is no prices."""
        return cls() if prices is None else cls(prices.motions, prices.units)


NO_PRICES = DataPrices()
