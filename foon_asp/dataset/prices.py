"""The prices of units in data, by motion and of single units; others may be in a store."""

from collections.abc import Mapping
from fractions import Fraction
from typing import NamedTuple

from foon_asp.network import FunctionalUnit, UnitPrices


class DataPrices(NamedTuple):
    """The prices of units by motion, ``None`` where no file lists any, and of single units.

    For a single unit without a price in ``units``, its price in the store counts: if ``from_file``, the price
    in the imported file, and otherwise or without such a price the price that networks state.
    """

    motions: Mapping[str, Fraction] | None = None
    units: Mapping[FunctionalUnit, Fraction] = {}
    from_file: bool = False

    @classmethod
    def of(cls, prices: UnitPrices | None) -> "DataPrices":
        """Return prices that are all in memory."""
        return cls() if prices is None else cls(prices.motions, prices.units)


NO_PRICES = DataPrices()
