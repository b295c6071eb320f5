"""A store, which is read as far as each question goes."""

import copy
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from foon_asp.dataset.dataset import Dataset, ask, left_out
from foon_asp.dataset.names import changed_prices, changed_rates
from foon_asp.dataset.nearby import FIRST, Nearby, NearbyProblem
from foon_asp.errors import UserError
from foon_asp.network import (
    FunctionalUnit,
    Network,
    UnitPrices,
    network_at_level,
    pattern_at_level,
    starting_kitchen,
)
from foon_asp.problem import (
    ContainerRule,
    Number,
    Objective,
    Problem,
    UnitPricesNamed,
    Unpriced,
    UsedUp,
    container_rule,
    unrated_remarks,
    unrated_text,
)
from foon_asp.store.cone import Cone
from foon_asp.store.store import Store
from foon_asp.store.touched_network import TouchedNetwork
from foon_asp.text.data_folder import (
    STARTING,
    Data,
    DataFiles,
    kitchen_item_warning,
    kitchen_nodes,
    unit_price_warning,
)
from foon_asp.text.diagnostics import Diagnostic, in_brief, summarize
from foon_asp.text.label_list import read_labels
from foon_asp.text.object_list import ListedObject, read_object_list
from foon_asp.text.rate_table import read_rates
from foon_asp.text.repeated_node import repeated_note
from foon_asp.text.unit_price_list import read_unit_prices

if TYPE_CHECKING:  # plain answers do not need it
    from foon_asp.proof.verify import Subject
    from foon_asp.store.elsewhere import Elsewhere


def read_stored(files: DataFiles, level: int) -> Dataset:
    """Open the store that is named instead of networks; what is named beside it replaces what is in it.

    Below level 3 it is read whole, since its nodes become others there.
    """
    if len(files.network) > 1:
        raise UserError(
            f"{files.network[0]} and {files.network[1]}: a store is read alone; import "
            "the files together into one"
        )
    began = time.perf_counter()
    store = Store(files.network[0])
    warnings: list[Diagnostic] = []
    kitchen = None
    starting = files.kitchen == STARTING or (files.kitchen is None and not store.has_kitchen)
    if files.kitchen and not starting:
        kitchen = read_object_list(files.kitchen, warnings)
        warnings += [kitchen_item_warning(item) for item in kitchen if not store.find(item.pattern)]
    goals = read_object_list(files.goals, warnings) if files.goals else store.goals
    rates = store.rates
    if files.rates:
        rates = read_rates(files.rates)
    utensils = read_labels(files.utensils) if files.utensils else store.utensils
    prices = _own_prices(store)
    if files.unit_prices:
        read = read_unit_prices(files.unit_prices)
        units = {unit: price for unit, price in read.units.items() if store.unit_id(unit) is not None}
        warnings += [
            unit_price_warning(unit, read.sources[unit]) for unit in read.units.keys() - units.keys()
        ]
        prices = _StoredPrices(read.motions, units, listed=False)
    remarks = [] if rates is None else [*unrated_remarks(store.motion_sources(), rates)]
    if store.left_out:
        remarks.append(f"{left_out(store.left_out)} when the store was made")
    remarks += repeated_note(store.repeated)
    told, brief = (*summarize(warnings), *remarks), (*in_brief(warnings), *remarks)
    dataset = StoredDataset(store, kitchen, goals, rates, utensils, prices, began, told)
    dataset.brief = brief
    dataset.goals_from = "" if files.goals else store.goals_from
    if starting:
        dataset = dataset.with_starting_kitchen()
        dataset.has_kitchen = files.kitchen is not None
    if level == 3:
        return dataset
    data = _at_level(dataset.data, level)
    dataset.close()
    whole = Dataset(data, time.perf_counter() - began, told, dataset.has_kitchen)
    whole.brief = brief
    return whole


class _StoredPrices(NamedTuple):
    """The prices of units beside those in a store: by motion, and of single units that have others here.

    ``listed`` says that those count which were imported with a file of prices.
    """

    motions: Mapping[str, Fraction] | None
    units: Mapping[FunctionalUnit, Fraction]
    listed: bool


class StoredDataset(Dataset):
    """The store, and what is asked of it beside; ids are those of the whole network.

    ``kitchen`` and the others take the place of the store's own, as far as they are not ``None``.
    ``began`` is when reading did.
    """

    def __init__(
        self,
        store: Store,
        kitchen: Sequence[ListedObject] | None,
        goals: Sequence[ListedObject],
        rates: Mapping[str, Fraction] | None,
        utensils: frozenset[str],
        prices: _StoredPrices,
        began: float,
        remarks: tuple[str, ...] = (),
    ) -> None:
        self._store = store
        self.names = store
        self._kitchen = kitchen
        self.listed = goals
        self.rates = rates
        self.utensils = utensils
        self._prices = prices
        self._at_hand: Callable[[int], bool] = store.in_kitchen
        if kitchen is not None:
            self._at_hand = {o for item in kitchen for o in store.find(item.pattern)}.__contains__
        self._all_at_hand: Callable[[], frozenset[int]] | None = None  # unless it is what the entries say
        self._read_whole: list[tuple[Network, frozenset[int]]] = []  # shared by all that vary it
        self.remarks = remarks
        self.has_kitchen = kitchen is not None or store.has_kitchen
        self.goals_from = ""
        self._starting = False
        self._origin: StoredDataset | None = None  # that this has the kitchen for some goals of
        self.read_seconds = time.perf_counter() - began

    def close(self) -> None:
        """Close the store, for all data that vary this too."""
        self._store.close()

    def with_kitchen(self, items: Sequence[ListedObject]) -> Dataset:
        """Give the same store with the kitchen of another file."""
        began = time.perf_counter()
        beside = self.listed, self.rates, self.utensils, self._prices
        other = StoredDataset(self._store, items, *beside, began)
        other.goals_from = self.goals_from
        return other.measured(self.measures)

    def with_starting_kitchen(self) -> "StoredDataset":
        """Return the same store with what makes the units of each file run at hand; nothing is read."""
        other = self._copied()
        other._kitchen = ()
        other._at_hand = self._store.is_starting
        other._all_at_hand = self._store.starting_kitchen
        other._starting = True
        return other

    def _copied(self) -> "StoredDataset":
        other = copy.copy(self)
        for known in ("data", "kitchen", "unrated"):
            other.__dict__.pop(known, None)
        return other

    def varied(
        self,
        more: Collection[int],
        less: Collection[int],
        only: Collection[int] | None,
    ) -> "StoredDataset":
        """Give the same store with another kitchen; nothing is read."""
        before = self._at_hand if only is None else frozenset(only).__contains__
        other = self._copied()
        other._starting = self._starting and only is None
        other._at_hand = lambda o: o not in less and (o in more or before(o))
        other._all_at_hand = lambda: (
            (self.kitchen if only is None else frozenset(only)).union(more).difference(less)
        )
        other._kitchen = self._kitchen if only is None else ()
        return other

    def valued(self, rates: Mapping[str, Number] | None, unit_prices: UnitPricesNamed | None) -> Dataset:
        """Give the same store with some success rates and some prices changed; of units, ids are read."""
        if rates is None and unit_prices is None:
            return self
        other = self._copied()
        other.rates = changed_rates(self.rates, rates, self.motions)
        known = UnitPrices(self._prices.motions or {}, self._prices.units)
        prices = changed_prices(known, unit_prices, self.motions, self._store)
        if unit_prices is not None and prices is not None:
            other._prices = self._prices._replace(motions=prices.motions, units=prices.units)
        return other

    @cached_property
    def data(self) -> Data:
        """Everything there is: the whole store is read."""
        began = time.perf_counter()
        network, kitchen = self._whole()
        items = self._store.kitchen_items() if self._kitchen is None else tuple(self._kitchen)
        if self._at_hand != self._store.in_kitchen:
            kitchen = self.kitchen
        data = self._with(network, kitchen)._replace(kitchen_items=items)
        self.read_seconds += time.perf_counter() - began
        return data

    def made_too(self, objects: Iterable[int]) -> list[int]:
        """Return those of some nodes of a starting kitchen that a unit makes out of others."""
        return self._store.made_too(objects)

    def goal_changes(self, goals: Iterable[int]) -> tuple[frozenset[int], frozenset[int]]:
        """Return what a starting kitchen has more, and what it lacks, because these are the goals."""
        if not self._starting:
            return frozenset(), frozenset()
        store = self._store
        added, lacking = store.starting_changes(goals)
        return frozenset(o for o in added if self._at_hand(o) or not store.is_starting(o)), lacking

    def _for(self, goals: Iterable[int]) -> "StoredDataset":
        """Return the same store with the kitchen for goals."""
        added, lacking = self.goal_changes(goals)
        if not added and not lacking:
            return self
        other = self.varied(added, lacking, None)
        other._origin = self
        return other

    def subject(self, everything: bool = True, goals: Iterable[int] = ()) -> "Subject":
        """Give what a certificate speaks about: all of it, or what is read when it is looked at.

        Then the digests of the network and of what was imported beside it are those that the store states.
        All is read, too, where a starting kitchen or other prices count. Raises :class:`UserError` where that
        shows that a digest that is stated is not true.
        """
        own_prices = self._prices == _own_prices(self._store)
        rates = None if self.unrated else self.rates
        everything = everything or self._starting or not own_prices
        from foon_asp.proof.verify import Subject  # noqa: PLC0415

        stated = self._true_digests() if everything else dict(self._store.digests)
        if self._at_hand != self._store.in_kitchen:
            del stated["kitchen"]
        if not own_prices:
            del stated["prices"]
        if everything:
            data = self.data
            kitchen = self.kitchen_for(goals)
            return Subject(data.network, kitchen, rates, self.utensils, data.unit_prices, stated)
        network, touched = TouchedNetwork(self._store), _AtHand(self)
        return Subject(network, touched, rates, self.utensils, None, stated, tuple(sorted(stated)))

    def _true_digests(self) -> dict[str, str]:
        """Work out the digests that the store states, of all that is in it."""
        from foon_asp.proof.verify import Subject  # noqa: PLC0415 (few answers need it)

        store, (network, kitchen) = self._store, self._whole()
        prices = self._prices_of(network, _own_prices(store))
        found = Subject(network, kitchen, None, frozenset(), prices).digests()
        for name, stated in store.digests.items():
            if stated != found[name]:
                raise UserError(
                    f"{store.name}: the digest of the {name} that the store states is not that of what is in "
                    "it, so it was changed after the import; import its source files again"
                )
        return {name: found[name] for name in store.digests}

    def _whole(self) -> tuple[Network, frozenset[int]]:
        if not self._read_whole:
            self._read_whole.append(self._store.whole())
        return self._read_whole[0]

    @property
    def whole_network(self) -> Network:
        """The whole network, read when it is looked at unless it was before."""
        return self._read_whole[0][0] if self._read_whole else TouchedNetwork(self._store)

    @property
    def unit_prices(self) -> UnitPrices | None:
        """The prices of units, ``None`` where none are known; all of them are read."""
        return self.data.unit_prices

    def unpriced(self) -> Sequence[Unpriced]:
        """Give the units that have no price, by motion."""
        return self._store.unpriced(self._prices.motions or {}, self._prices.units, self._prices.listed)

    @cached_property
    def unrated(self) -> str:
        """The motions of the whole network that the success rates lack."""
        return "" if self.rates is None else unrated_text(self._store.motion_sources(), self.rates)

    @property
    def motions(self) -> list[str]:
        """The motions of the network, in alphabetical order."""
        return sorted(motion for motion, _ in self._store.motion_sources())

    @cached_property
    def kitchen(self) -> frozenset[int]:
        """The object nodes at hand, by id: the kitchen's entries are looked up, and no more is read."""
        return self._from_entries() if self._all_at_hand is None else self._all_at_hand()

    def _from_entries(self) -> frozenset[int]:
        items = self._store.kitchen_items() if self._kitchen is None else self._kitchen
        return frozenset(o for item in items for o in self._store.find(item.pattern))

    def at_hand(self, o: int) -> bool:
        """Whether the kitchen has an object node, by id."""
        return self._at_hand(o)

    def kitchen_changes(
        self, problem: Problem, goals: Iterable[int]
    ) -> tuple[frozenset[int], frozenset[int]]:
        """Give what a problem posed of this data has in its kitchen beyond it, and what it lacks.

        Ids are those of the whole network, those of its ``goals`` too.
        """
        network, stocked = problem.network, self._for(goals)
        numbers = {network.object_number(o) for o in range(len(network.objects))}
        theirs = {network.object_number(o) for o in problem.kitchen}
        ours = {o for o in numbers if stocked._at_hand(o)}
        return frozenset(theirs - ours), frozenset(ours - theirs)

    def problem(
        self,
        goals: Sequence[int],
        containers: str,
        everything: bool = False,
        items: UsedUp | None = None,
    ) -> Problem:
        """Ask for goals; what no tree for them needs is not read, unless everything is asked for."""
        if everything:
            return ask(self._stocked(goals), goals, containers, self, items)
        stocked = self._for(goals)
        cone = stocked._cone(goals, containers, items)
        return stocked._posed(cone, containers, items)

    def nearby(
        self, goals: Sequence[int], containers: str, items: UsedUp | None = None, first: int = FIRST
    ) -> Problem:
        """Ask for goals that can need many units, of which at ``first`` so many are read.

        Where they need more than these, the rest is read when it is looked at. Where no kitchen was given,
        all that they need is read, since what is taken to be at hand is listed.
        """
        if items is not None or not self.has_kitchen:
            return self.problem(goals, containers, items=items)
        stocked = self._for(goals)
        cone, pose = stocked._cone(goals, containers, None, first), stocked._posed
        return NearbyProblem.of(
            Nearby(
                cone,
                lambda cone: pose(cone, containers, None),
                lambda: self.problem(goals, containers) if cone.open else pose(cone, containers, None),
                lambda units: stocked._asked(self._store.part(units, goals), goals, containers, None),
                lambda objective: self._elsewhere(containers, objective, cone.units),
                lambda: self.subject(False, goals),
            ),
            lambda goals: self.nearby(goals, containers, None, first),
        )

    def _elsewhere(self, containers: str, objective: Objective, near: Iterable[int]) -> "Elsewhere | None":
        """Look at all units, unless all would have to be read to know what is at hand.

        Those ``near`` the goals were read.
        """
        from foon_asp.store.elsewhere import Elsewhere  # noqa: PLC0415 (few answers need numpy)

        store = self._store
        if self._starting:
            return None
        outline = store.outline_with(near)
        own = self._at_hand == store.in_kitchen
        kitchen = outline.kitchen() if own else outline.nodes(self.kitchen)
        implied = container_rule(containers) is ContainerRule.IMPLIED
        skipped = outline.labelled(self.utensils if implied else ())
        motions = [motion for motion, _ in store.motion_sources()]
        return Elsewhere(outline, kitchen, skipped, motions, self.rates, objective)

    def _cone(
        self, goals: Sequence[int], containers: str, items: UsedUp | None, most: int | None = None
    ) -> Cone:
        """Find the units that goals can need, or about ``most`` of them."""
        began = time.perf_counter()
        # of what may run out, more may have to be made
        counted = {self._store.object_id(node) for node in (items.stock if items else ())}
        cone = self._store.cone(
            goals,
            container_rule(containers),
            self.utensils,
            (lambda o: o not in counted and self._at_hand(o)) if counted else self._at_hand,
            most,
        )
        self.read_seconds += time.perf_counter() - began
        return cone

    def _posed(self, cone: Cone, containers: str, items: UsedUp | None) -> Problem:
        """Pose a question over what was found of a cone."""
        began = time.perf_counter()
        problem = self._asked(self._store.part_of(cone), cone.goals, containers, items)
        self.read_seconds += time.perf_counter() - began
        return problem

    def _asked(self, part: Network, goals: Sequence[int], containers: str, items: UsedUp | None) -> Problem:
        return ask(self._part(part), _places(part, goals), containers, self._origin or self, items)

    def part(
        self, goals: Sequence[int], units: Iterable[int] = (), tree: Iterable[FunctionalUnit] = ()
    ) -> tuple[Data, tuple[int, ...]]:
        """Read these goals, units by id, and what of a tree is in the network."""
        units, tree = list(units), list(tree)
        self._check_units(units, self._store.units)
        known = (self._store.unit_id(unit) for unit in tree)
        nodes = {node for unit in tree for side in (unit.inputs, unit.outputs) for node in side}
        objects = (self._store.object_id(node) for node in nodes)
        network = self._store.part(
            [*units, *(unit for unit in known if unit is not None)],
            [*goals, *(o for o in objects if o is not None)],
        )
        return self._for(goals)._part(network), _places(network, goals)

    def _part(self, network: Network) -> Data:
        at_hand = (place for place, o in enumerate(network.object_numbers) if self._at_hand(o))
        return self._with(network, frozenset(at_hand))

    def _with(self, network: Network, kitchen: frozenset[int]) -> Data:
        goals = tuple(self.listed)
        left_out = self._store.left_out
        rates = None if self.rates is None else dict(self.rates)
        return Data(
            network,
            kitchen,
            (),
            goals,
            rates,
            self.utensils,
            (),
            left_out,
            self._prices_of(network, self._prices),
            self._starting,
            self.goals_from,
            self._store.repeated,
        )

    def _prices_of(self, network: Network, prices: _StoredPrices) -> UnitPrices | None:
        """Give the prices of a part of the network, or of all of it."""
        motions, units, listed = prices
        if motions is None and not units and not self._store.has_unit_prices:
            return None
        return UnitPrices(motions or {}, self._store.unit_prices(network, listed) | dict(units))


class _AtHand(Collection[int]):
    """The ids of the object nodes at hand: whether one is needs no list of all."""

    def __init__(self, dataset: Dataset) -> None:
        self._dataset = dataset

    def __contains__(self, o: object) -> bool:
        return isinstance(o, int) and self._dataset.at_hand(o)

    def __iter__(self) -> Iterator[int]:
        return iter(self._dataset.kitchen)

    def __len__(self) -> int:
        return len(self._dataset.kitchen)


def _own_prices(store: Store) -> _StoredPrices:
    """Give the prices that were imported."""
    return _StoredPrices(store.motion_prices, {}, listed=True)


def _places(part: Network, goals: Sequence[int]) -> tuple[int, ...]:
    """Give the ids that goals have in a part of the network."""
    places = {o: place for place, o in enumerate(part.object_numbers)}
    return tuple(places[goal] for goal in goals)


def _at_level(data: Data, level: int) -> Data:
    network = network_at_level(data.network, level)
    goals = tuple(entry._replace(pattern=pattern_at_level(entry.pattern, level)) for entry in data.goals)
    kitchen = starting_kitchen(network).nodes if data.starting else kitchen_nodes(network, data.kitchen_items)
    return data._replace(network=network, kitchen=kitchen, goals=goals)
