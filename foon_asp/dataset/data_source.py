"""Sources of data: a network in memory, or a store."""

from collections.abc import Collection, Container, Iterable, Mapping, Sequence
from fractions import Fraction
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from foon_asp.dataset.prices import DataPrices
from foon_asp.dataset.python_names import NodeAndUnitNames
from foon_asp.network import (
    NO_AMOUNTS,
    DataAmounts,
    FunctionalUnit,
    Network,
    Source,
    StartingKitchen,
    UnitPrices,
    starting_kitchen,
)
from foon_asp.problem import ContainerRule, Objective, Unpriced, count_unpriced, first_sources
from foon_asp.text.object_list import ListedObject
from foon_asp.text.repeated_node import RepeatedNode

if TYPE_CHECKING:  # text does without SQLite
    from foon_asp.store.cone import Cone
    from foon_asp.store.unit_distances import UnitDistances


class DataSource:
    """The source of a dataset: a network in memory; for a store, the subclass :class:`StoreSource`.

    All ids are ids in the whole network.
    ``names``: looks up nodes and units.
    ``unit_count``: the number of units.
    ``seconds``: the time that reading took so far.
    ``left_out``: the number of lines that were not understood.
    ``repeated``: the nodes that a unit lists twice.
    ``kitchen``: the ids of the nodes of the kitchen that was imported into a store; ``None`` for a network in
    memory.
    ``prices``: the prices that were imported into a store; ``None`` for a network in memory.
    """

    kitchen: Collection[int] | None = None
    prices: DataPrices | None = None
    names: NodeAndUnitNames

    def __init__(
        self,
        network: Network,
        seconds: float,
        left_out: int = 0,
        repeated: tuple[RepeatedNode, ...] = (),
        amounts: DataAmounts = NO_AMOUNTS,
    ) -> None:
        self.names = self._network = network
        self.unit_count, self.seconds = len(network), seconds
        self.left_out, self.repeated, self._amounts = left_out, repeated, amounts

    @property
    def amounts(self) -> DataAmounts:
        """The numbers of copies that units take and make of object nodes, where these are not 1."""
        return self._amounts

    @property
    def digests(self) -> Mapping[str, str]:
        """The digests of network, kitchen and prices that a store states, by name; empty without a store."""
        return MappingProxyType({})

    @property
    def starting_kitchen(self) -> StartingKitchen[Any]:
        """The starting kitchen of the whole network, also if another kitchen was given."""
        return starting_kitchen(self._network)

    @property
    def motions(self) -> Collection[str]:
        """The motions of the network, each once."""
        return self._network.different_motions

    def motion_sources(self) -> Iterable[tuple[str, Source]]:
        """Return pairs of a motion and the source of a unit with this motion.

        A motion may be repeated. The first unit of each motion is among the units.
        """
        return first_sources(self._network)

    def whole_network(self) -> Network:
        """Return the whole network."""
        return self._network

    def network_read_on_access(self) -> Network:
        """Return the whole network; that of a store reads each unit and node when it is accessed."""
        return self._network

    def network_part(self, units: Iterable[int], objects: Iterable[int]) -> Network:
        """Return a network that has at least these units and object nodes, by id.

        A source in memory returns the whole network.
        """
        return self._network

    def cone(
        self,
        goals: Sequence[int],
        containers: ContainerRule,
        utensils: frozenset[str],
        available: Container[int],
        max_units: int | None,
    ) -> "Cone | None":
        """Return the cone of goals: all units that the goals can need; ``None`` for a network in memory.

        ``goals``, ``available``: ids of object nodes. Units that make available nodes are not needed.
        ``containers``, ``utensils``: the container rule, and the labels of utensils for it.
        ``max_units``: about how many units the cone has at most, those nearest to the goals;
        ``None`` for no limit.
        """
        return None

    def unit_distances(
        self,
        kitchen: Collection[int],
        utensils: Collection[str],
        rates: Mapping[str, Fraction] | None,
        objective: Objective,
    ) -> "UnitDistances | None":
        """Return the distance of each unit: a lower bound on the cost of any tree with the unit.

        Return ``None`` for a network in memory. The nodes of ``kitchen``, by id, are available. Inputs whose
        labels are ``utensils`` cost nothing. A unit costs 1. If ``objective`` is ``success``, it costs minus
        the scaled logarithm of its rate instead; see :class:`UnitDistances`.
        """
        return None

    def checked_digests(self) -> dict[str, str]:
        """Compute the digests that a store states, and return them by name; empty without a store.

        Raises :class:`UserError` if a stated digest is not the one that is computed.
        """
        return {}

    def unit_prices(self, network: Network, from_file: bool) -> Mapping[FunctionalUnit, Fraction] | None:
        """Return the prices that a store has for single units of ``network``; ``None`` if there are none.

        The prices are those that the imported networks state. With ``from_file``, the prices of the imported
        file are added, and take precedence.
        """
        return None

    def unpriced(self, prices: DataPrices) -> Sequence[Unpriced]:
        """Return each motion of unpriced units, with their number and the source of the first one."""
        network = self._network
        unit_prices = UnitPrices(prices.motions or {}, prices.units).of_units(network)
        unpriced = (unit for unit, price in enumerate(unit_prices) if price is None)
        return count_unpriced((network.motions[unit], network.sources[unit]) for unit in unpriced)

    def kitchen_items(self) -> tuple[ListedObject, ...]:
        """Return the entries of the kitchen file that was imported into a store; empty without a store."""
        return ()

    def close(self) -> None:
        """Close the store; do nothing for a network in memory."""
