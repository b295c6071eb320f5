"""What data are read from: a network in memory, or a store."""

from collections.abc import Collection, Container, Iterable, Mapping, Sequence
from fractions import Fraction
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Protocol

from foon_asp.dataset.prices import DataPrices
from foon_asp.network import FunctionalUnit, Network, StartingKitchen, UnitPrices, starting_kitchen
from foon_asp.network import Source as Place
from foon_asp.problem import ContainerRule, Objective, Unpriced, count_unpriced, first_places
from foon_asp.text.goal_name import NodeNames
from foon_asp.text.object_list import ListedObject
from foon_asp.text.repeated_node import RepeatedNode

if TYPE_CHECKING:  # text does without SQLite
    from foon_asp.store.cone import Cone
    from foon_asp.store.elsewhere import Elsewhere


class NamesAndUnits(NodeNames, Protocol):
    """What nodes and units are looked up in."""

    def unit_id(self, unit: FunctionalUnit) -> int | None:
        """Return the id of a unit, or ``None`` where the network does not have it."""


class Source(Protocol):
    """A network and what was read with it; ids are those of the whole network.

    ``seconds`` are those that reading took so far, and ``digests`` those that are stated and not computed.
    """

    seconds: float

    @property
    def names(self) -> NamesAndUnits:
        """What nodes and units are looked up in."""

    @property
    def unit_count(self) -> int:
        """How many units the network has."""

    @property
    def left_out(self) -> int:
        """How many lines were not understood."""

    @property
    def repeated(self) -> tuple[RepeatedNode, ...]:
        """The nodes that a unit lists twice."""

    @property
    def digests(self) -> Mapping[str, str]:
        """The digests of network, kitchen and prices that a store states; none of text."""

    @property
    def kitchen(self) -> Collection[int] | None:
        """The kitchen that was imported into a store."""

    @property
    def prices(self) -> DataPrices | None:
        """The prices that were imported into a store."""

    @property
    def starting(self) -> StartingKitchen[Any]:
        """The starting kitchen."""

    def whole(self) -> Network:
        """Return the whole network."""

    def touched(self) -> Network:
        """Return the whole network, of which a store reads what is looked at."""

    def part(self, units: Iterable[int], objects: Iterable[int]) -> Network:
        """Return a network with at least some units and object nodes."""

    def cone(
        self,
        goals: Sequence[int],
        containers: ContainerRule,
        utensils: frozenset[str],
        at_hand: Container[int],
        most: int | None,
    ) -> "Cone | None":
        """Return what goals can need, or about ``most`` units of it; ``None`` where all was read."""

    def elsewhere(
        self,
        kitchen: Collection[int],
        utensils: Collection[str],
        rates: Mapping[str, Fraction] | None,
        objective: Objective,
    ) -> "Elsewhere":
        """Look at all units of a store; units skip the ``utensils``."""

    def true_digests(self) -> dict[str, str]:
        """Compute the digests that are stated; raises :class:`UserError` where one is not true."""

    def motion_places(self) -> Iterable[tuple[str, Place]]:
        """Return the motions of the network, with the place of the first unit that has each."""

    def unit_prices(self, network: Network, from_file: bool) -> Mapping[FunctionalUnit, Fraction] | None:
        """Return the prices that a store has of single units of a network; ``None`` where it has none."""

    def unpriced(self, prices: DataPrices) -> Sequence[Unpriced]:
        """Return the units that have no price, by motion."""

    def kitchen_items(self) -> tuple[ListedObject, ...]:
        """Return the entries of the kitchen that was imported."""

    def close(self) -> None:
        """Close the files that are read only as far as questions go."""


class NetworkSource:
    """A network in memory."""

    digests: Mapping[str, str] = MappingProxyType({})
    kitchen = prices = None

    def __init__(
        self, network: Network, seconds: float, left_out: int = 0, repeated: tuple[RepeatedNode, ...] = ()
    ) -> None:
        self.names, self.unit_count = network, len(network)
        self.seconds, self.left_out, self.repeated = seconds, left_out, repeated

    @property
    def starting(self) -> StartingKitchen[str]:
        """The starting kitchen."""
        return starting_kitchen(self.names)

    def whole(self) -> Network:
        """Return the network."""
        return self.names

    touched = whole

    def part(self, units: Iterable[int], objects: Iterable[int]) -> Network:
        """Return the network, which has these units and object nodes."""
        return self.names

    def cone(self, *_: object) -> None:
        """Return nothing, as all was read."""

    def elsewhere(self, *_: object) -> "Elsewhere":
        """Raise :class:`LookupError`, as all was read."""
        raise LookupError("there are no other units than those in memory")

    def true_digests(self) -> dict[str, str]:
        """Return nothing, as nothing is stated."""
        return {}

    def motion_places(self) -> Iterable[tuple[str, Place]]:
        """Return the motion of each unit, with its place."""
        return first_places(self.names)

    def unit_prices(self, network: Network, from_file: bool) -> None:
        """Return nothing, as the data have the prices."""

    def unpriced(self, prices: DataPrices) -> Sequence[Unpriced]:
        """Return the units that have no price, by motion."""
        network = self.names
        known = UnitPrices(prices.motions or {}, prices.units).each(network)
        return count_unpriced(
            (network.motions[unit], network.sources[unit])
            for unit, price in enumerate(known)
            if price is None
        )

    def kitchen_items(self) -> tuple[ListedObject, ...]:
        """Return nothing, as the data have the entries."""
        return ()

    def close(self) -> None:
        """Do nothing."""
