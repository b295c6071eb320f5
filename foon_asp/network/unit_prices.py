"""Prices of units: by motion, and of single units."""

from collections.abc import Mapping
from fractions import Fraction
from typing import NamedTuple

from foon_asp.network.functional_unit import FunctionalUnit
from foon_asp.network.network import Network


class UnitPrices(NamedTuple):
    """Exact prices, none below 0: of ``units`` of level 3, and of all others by their motion."""

    motions: Mapping[str, Fraction]
    units: Mapping[FunctionalUnit, Fraction]

    def each(self, network: Network) -> tuple[Fraction | None, ...]:
        """Return the price of every unit of a network, ``None`` where it has none.

        Below level 3 it is the least of those that a unit stands for, and all of them need one.
        """
        if network.detailed is None:
            return self._each(network)
        known = self._each(network.detailed)
        found = ([known[detail] for detail in details] for details in network.stands_for)
        return tuple(map(_least, found))

    def price(self, unit: FunctionalUnit, network: Network | None = None) -> Fraction | None:
        """Return the price of a unit at the level of a network; of one that is not in it, its motion's."""
        if network is None or network.detailed is None:
            return self.units.get(unit, self.motions.get(unit.motion))
        number = network.unit_id(unit)
        if number is None:
            return self.motions.get(unit.motion)
        return _least([self.price(network.detailed.unit(each)) for each in network.stands_for[number]])

    def _each(self, network: Network) -> tuple[Fraction | None, ...]:
        own = {unit.motion for unit in self.units}  # to look for no unit whose motion none of them has
        return tuple(
            self.price(network.unit(unit)) if motion in own else self.motions.get(motion)
            for unit, motion in enumerate(network.motions)
        )


def _least(prices: list[Fraction | None]) -> Fraction | None:
    known = [price for price in prices if price is not None]
    return min(known) if len(known) == len(prices) else None
