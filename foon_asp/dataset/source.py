"""What data are read from: a network in memory, or a store."""

from collections.abc import Collection, Container, Iterable, Mapping, Sequence
from fractions import Fraction
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from foon_asp.dataset.names import NamesAndUnits
from foon_asp.dataset.prices import DataPrices
from foon_asp.network import FunctionalUnit, Network, StartingKitchen, UnitPrices, starting_kitchen
from foon_asp.network import Source as Place
from foon_asp.problem import ContainerRule, Objective, Unpriced, count_unpriced, first_places
from foon_asp.text.object_list import ListedObject
from foon_asp.text.repeated_node import RepeatedNode

if TYPE_CHECKING:  # text does without SQLite
    from foon_asp.store.cone import Cone
    from foon_asp.store.elsewhere import Elsewhere


class Source:
    """A network in memory; a :class:`~foon_asp.dataset.store_source.StoreSource` reads it part by part.

    Ids are those of the whole network. ``names`` has its nodes and units, ``unit_count`` counts these.
    ``seconds`` are those that reading took so far, ``left_out`` counts lines that were not understood, and
    ``repeated`` are nodes that a unit lists twice. A store has the ``kitchen`` and the ``prices`` that were
    imported, and states ``digests`` of them and of the network.
    """

    kitchen: Collection[int] | None = None
    prices: DataPrices | None = None
    names: NamesAndUnits

    def __init__(
        self, network: Network, seconds: float, left_out: int = 0, repeated: tuple[RepeatedNode, ...] = ()
    ) -> None:
        self.names = self._network = network
        self.unit_count, self.seconds = len(network), seconds
        self.left_out, self.repeated = left_out, repeated

    @property
    def digests(self) -> Mapping[str, str]:
        """The digests of network, kitchen and prices that are stated and not computed."""
        return MappingProxyType({})

    @property
    def starting(self) -> StartingKitchen[Any]:
        """The starting kitchen."""
        return starting_kitchen(self._network)

    @property
    def motions(self) -> Collection[str]:
        """The motions of the network, each once."""
        return self._network.different_motions

    def motion_places(self) -> Iterable[tuple[str, Place]]:
        """Return the motions with the places of units that have them, the first of each among them."""
        return first_places(self._network)

    def whole(self) -> Network:
        """Return the whole network."""
        return self._network

    def touched(self) -> Network:
        """Return the whole network, of which a store reads what is looked at."""
        return self._network

    def part(self, units: Iterable[int], objects: Iterable[int]) -> Network:
        """Return a network with at least some units and object nodes."""
        return self._network

    def cone(
        self,
        goals: Sequence[int],
        containers: ContainerRule,
        utensils: frozenset[str],
        at_hand: Container[int],
        most: int | None,
    ) -> "Cone | None":
        """Return what goals can need, or about ``most`` units of it; ``None`` where all was read."""
        return None

    def elsewhere(
        self,
        kitchen: Collection[int],
        utensils: Collection[str],
        rates: Mapping[str, Fraction] | None,
        objective: Objective,
    ) -> "Elsewhere | None":
        """Look at all units, which skip the ``utensils``; ``None`` where all was read."""
        return None

    def true_digests(self) -> dict[str, str]:
        """Compute the digests that are stated; raises :class:`UserError` where one is not true."""
        return {}

    def unit_prices(self, network: Network, from_file: bool) -> Mapping[FunctionalUnit, Fraction] | None:
        """Return the prices that a store has of single units of a network; ``None`` where it has none."""
        return None

    def unpriced(self, prices: DataPrices) -> Sequence[Unpriced]:
        """Return the units that have no price, by motion."""
        network = self._network
        known = UnitPrices(prices.motions or {}, prices.units).of_units(network)
        lacking = (unit for unit, price in enumerate(known) if price is None)
        return count_unpriced((network.motions[unit], network.sources[unit]) for unit in lacking)

    def kitchen_items(self) -> tuple[ListedObject, ...]:
        """Return the entries of the kitchen that was imported."""
        return ()

    def close(self) -> None:
        """Close the files that are read only as far as questions go."""
