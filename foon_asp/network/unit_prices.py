"""Prices of units: by motion, and of single units."""

from collections.abc import Mapping
from fractions import Fraction
from typing import NamedTuple

from foon_asp.network.functional_unit import FunctionalUnit
from foon_asp.network.network import Network


class UnitPrices(NamedTuple):
    """Exact prices of units, none below 0.

    ``units`` has the prices of single units of level 3. All other units have the price of their motion, which
    is in ``motions``; a motion may have none.
    """

    motions: Mapping[str, Fraction]
    units: Mapping[FunctionalUnit, Fraction]

    def of_units(self, network: Network) -> tuple[Fraction | None, ...]:
        """Return the price of every unit of a network, in order of id; ``None`` for a unit without a price.

        The price of a unit below level 3 is the least price of the level-3 units that it stands for. It is
        ``None`` if one of them has no price.
        """
        if network.detailed is None:
            return self._own_level_prices(network)
        detail_prices = self._own_level_prices(network.detailed)
        prices_by_unit = ([detail_prices[detail] for detail in details] for details in network.stands_for)
        return tuple(map(_least_price, prices_by_unit))

    def price(self, unit: FunctionalUnit, network: Network | None = None) -> Fraction | None:
        """Return the price of a unit, or ``None`` if it has none.

        In a network below level 3, it is the least price of the level-3 units that the unit stands for, and
        ``None`` if one of them has no price. A unit that is not in the network has the price of its motion.
        Without a network, the unit is taken to be of level 3.
        """
        if network is None or network.detailed is None:
            return self.units.get(unit, self.motions.get(unit.motion))
        number = network.unit_id(unit)
        if number is None:
            return self.motions.get(unit.motion)
        return _least_price(
            [self.price(network.detailed.unit(detail)) for detail in network.stands_for[number]]
        )

    def _own_level_prices(self, network: Network) -> tuple[Fraction | None, ...]:
        """Return the price of every unit of a network of any level; ``None`` for a unit without a price."""
        priced_motions = {unit.motion for unit in self.units}  # spares looking up units of other motions
        return tuple(
            self.price(network.unit(unit)) if motion in priced_motions else self.motions.get(motion)
            for unit, motion in enumerate(network.motions)
        )


def _least_price(prices: list[Fraction | None]) -> Fraction | None:
    """Return the least price, or ``None`` if one of the prices is ``None``."""
    known_prices = [price for price in prices if price is not None]
    return min(known_prices) if len(known_prices) == len(prices) else None
