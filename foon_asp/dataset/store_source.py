"""A store as a source of data: each question reads only the part that it needs."""

import time
from collections.abc import Collection, Container, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING

from foon_asp.dataset.data_source import DataSource
from foon_asp.dataset.prices import DataPrices
from foon_asp.errors import UserError
from foon_asp.network import DataAmounts, FunctionalUnit, Network, Source, UnitPrices
from foon_asp.problem import ContainerRule, Objective, Unpriced
from foon_asp.store.cone import Cone
from foon_asp.store.on_demand_network import TouchedNetwork
from foon_asp.store.store import Store
from foon_asp.store.stored_ids import StoredIds
from foon_asp.store.stored_kitchen import StoredStartingKitchen
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.object_list import ListedObject
from foon_asp.text.stated_amounts import UnitAmount, apply_amount_table
from foon_asp.text.value_table import Row

if TYPE_CHECKING:  # few answers need numpy
    from foon_asp.store.unit_distances import UnitDistances


class StoreSource(DataSource):
    """A store as the source of a dataset; variants of the dataset share what was read from it.

    ``names`` is the open store.
    """

    names: Store
    kitchen: StoredIds
    prices: DataPrices

    def __init__(self, store: Store, unit_amounts: Sequence[Row[UnitAmount, int]] = ()) -> None:
        """Take an open store, and rows of a table of amounts, which replace imported amounts."""
        self._amount_table = unit_amounts
        self.names, self.seconds = store, 0.0
        self.unit_count, self.left_out, self.repeated = store.unit_count, store.left_out, store.repeated
        self.kitchen = StoredIds(store, "kitchen")
        self.prices = DataPrices(store.motion_prices, {}, from_file=True)
        self._starting_kitchen = StoredStartingKitchen(store)

    @cached_property
    def _amounts_and_warnings(self) -> tuple[DataAmounts, list[Diagnostic]]:
        """The amounts, changed by the table, and warnings about rows of the table that match no unit."""
        units = (
            self.names.units_with_motions({row.name[0] for row in self._amount_table})
            if self._amount_table
            else ()
        )
        return apply_amount_table(self.names.amounts, self._amount_table, units)

    @property
    def amounts(self) -> DataAmounts:
        """The numbers of copies that units take and make of object nodes, where these are not 1."""
        return self._amounts_and_warnings[0] if self._amount_table else self.names.amounts

    @property
    def unmatched_amounts(self) -> list[Diagnostic]:
        """Warnings about rows of the table of amounts that match no unit."""
        return self._amounts_and_warnings[1] if self._amount_table else []

    @property
    def starting_kitchen(self) -> StoredStartingKitchen:
        """The starting kitchen of the whole network, also if another kitchen was given."""
        return self._starting_kitchen

    @property
    def motions(self) -> Collection[str]:
        """The motions of the network, each once."""
        return [motion for motion, _ in self.names.motion_sources()]

    @property
    def digests(self) -> Mapping[str, str]:
        """The digests of network, kitchen and prices that the store states."""
        return self.names.digests

    @contextmanager
    def _add_reading_time(self) -> Iterator[None]:
        """Add the time of a ``with`` block to :attr:`seconds`, unless the block raises an exception."""
        began = time.perf_counter()
        yield
        self.seconds += time.perf_counter() - began

    @cached_property
    def _network_and_kitchen(self) -> tuple[Network, frozenset[int]]:
        """The whole network and the kitchen, read at the first access."""
        with self._add_reading_time():
            return self.names.read_whole()

    def whole_network(self) -> Network:
        """Return the whole network, which is read at the first call."""
        return self._network_and_kitchen[0]

    def network_read_on_access(self) -> Network:
        """Return the whole network: in memory if it was read, otherwise one that reads on access."""
        return (
            self._network_and_kitchen[0]
            if "_network_and_kitchen" in vars(self)
            else TouchedNetwork.of(self.names)
        )

    def cone(
        self,
        goals: Sequence[int],
        containers: ContainerRule,
        utensils: frozenset[str],
        available: Container[int],
        max_units: int | None,
    ) -> Cone:
        """Read and return the cone of goals; with ``max_units``, only about that many units near the goals.

        See :meth:`DataSource.cone` for the parameters.
        """
        with self._add_reading_time():
            return self.names.cone(goals, containers, utensils, available, max_units)

    def network_part(self, units: Iterable[int], objects: Iterable[int]) -> Network:
        """Read and return a network of the given units with their nodes, and of further nodes; all by id."""
        with self._add_reading_time():
            return self.names.read_part(units, objects)

    def unit_distances(
        self,
        kitchen: Collection[int],
        utensils: Collection[str],
        rates: Mapping[str, Fraction] | None,
        objective: Objective,
    ) -> "UnitDistances":
        """Return the distance of each unit: a lower bound on the cost of any tree with the unit.

        See :meth:`DataSource.unit_distances` for the parameters.
        """
        from foon_asp.store.unit_distances import UnitDistances  # noqa: PLC0415 (few answers need numpy)

        outline = self.names.outline
        available, skipped = outline.node_mask(kitchen), outline.labelled_nodes(utensils)
        return UnitDistances(outline, available, skipped, rates, objective)

    def checked_digests(self) -> dict[str, str]:
        """Read everything, compute the digests that the store states, and return them by name.

        Raises :class:`UserError` if a stated digest is not the one that is computed.
        """
        from foon_asp.proof.certificate_subject import Subject  # noqa: PLC0415 (few answers need it)

        store, (network, kitchen) = self.names, self._network_and_kitchen
        single_prices = self.unit_prices(network, self.prices.from_file)
        has_prices = self.prices.motions is not None or single_prices is not None
        prices = UnitPrices(self.prices.motions or {}, single_prices or {}) if has_prices else None
        computed = Subject(network, kitchen, None, frozenset(), prices).digests()
        for name, stated_digest in store.digests.items():
            if stated_digest != computed[name]:
                raise UserError(
                    f"{store.name}: the digest of the {name} that the store states is not that of what is in "
                    "it, so it was changed after the import; import its source files again"
                )
        return {name: computed[name] for name in store.digests}

    def motion_sources(self) -> Iterable[tuple[str, Source]]:
        """Return pairs of a motion, each once, and the first source of the first unit that has it."""
        return self.names.motion_sources()

    def unit_prices(self, network: Network, from_file: bool) -> Mapping[FunctionalUnit, Fraction] | None:
        """Read the prices of single units of ``network``; return ``None`` if the store has none.

        See :meth:`DataSource.unit_prices` for ``from_file``.
        """
        return self.names.unit_prices(network, from_file) if self.names.has_unit_prices else None

    def unpriced(self, prices: DataPrices) -> Sequence[Unpriced]:
        """Return each motion of unpriced units, with their number and the source of the first one."""
        return self.names.unpriced(prices.motions or {}, prices.units, prices.from_file)

    def kitchen_items(self) -> tuple[ListedObject, ...]:
        """Read and return the entries of the kitchen file that was imported."""
        return self.names.kitchen_items()

    def close(self) -> None:
        """Close the store; to read more of it raises :class:`UserError`."""
        self.names.close()
