"""The prices of units as data have them, beside those that a store has of single units."""

from collections.abc import Mapping
from fractions import Fraction
from typing import NamedTuple

from foon_asp.network import FunctionalUnit, UnitPrices


class DataPrices(NamedTuple):
    """The prices of units by motion, ``None`` where no file lists any, and of single units.

    The prices of single units in a store count where ``units`` have none: those of the file that was imported
    with it too, if ``from_file``.
    """

    motions: Mapping[str, Fraction] | None = None
    units: Mapping[FunctionalUnit, Fraction] = {}
    from_file: bool = False

    @classmethod
    def of(cls, prices: UnitPrices | None) -> "DataPrices":
        """Return prices that are all in memory."""
        return cls() if prices is None else cls(prices.motions, prices.units)


NO_PRICES = DataPrices()
