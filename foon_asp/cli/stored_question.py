"""Questions to a store, which is read as far as a question goes."""

import time
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from functools import cached_property

import click

from foon_asp.cli.options import Question, ask
from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, Network, network_at_level, pattern_at_level
from foon_asp.problem import ContainerRule, Problem, require_rates
from foon_asp.store import Store
from foon_asp.text import (
    Data,
    DataFiles,
    Diagnostic,
    ListedObject,
    NodeNames,
    kitchen_item_warning,
    kitchen_nodes,
    read_labels,
    read_object_list,
    read_rates,
    summarize,
)


def read_stored(files: DataFiles, level: int, kitchen_expected: bool) -> Question:
    """Open the store that is named instead of networks; what is named beside it replaces what is in it.

    Warnings go to stderr. Below level 3 it is read whole, since its nodes become others there.
    """
    if len(files.network) > 1:
        raise UserError(
            f"{files.network[0]} and {files.network[1]}: a store is read by itself; "
            "import the files together into one"
        )
    began = time.perf_counter()
    store = Store(files.network[0])
    warnings: list[Diagnostic] = []
    kitchen = None
    if files.kitchen:
        kitchen = read_object_list(files.kitchen, warnings)
        warnings += [kitchen_item_warning(item) for item in kitchen if not store.find(item.pattern)]
    goals = read_object_list(files.goals, warnings) if files.goals else store.goals
    rates = store.rates
    if files.rates:
        rates = read_rates(files.rates)
        require_rates(store.motion_sources(), rates)
    utensils = read_labels(files.utensils) if files.utensils else store.utensils
    for text in summarize(warnings):
        click.echo(text, err=True)
    if store.left_out:
        lines = "1 line" if store.left_out == 1 else f"{store.left_out} lines"
        click.echo(f"warning: {lines} left out when the store was made", err=True)
    if kitchen is None and not store.has_kitchen and kitchen_expected:
        click.echo("warning: no kitchen is given, so nothing is at hand; name one with --kitchen", err=True)
    question = StoredQuestion(store, kitchen, goals, rates, utensils, began)
    return question if level == 3 else Question(_at_level(question.data, level), time.perf_counter() - began)


class StoredQuestion(Question):
    """The store, and what is asked of it beside; ids are those of the whole network.

    ``kitchen`` and the others take the place of the store's own, as far as they are not ``None``.
    ``began`` is when reading did.
    """

    def __init__(
        self,
        store: Store,
        kitchen: Sequence[ListedObject] | None,
        goals: Sequence[ListedObject],
        rates: dict[str, Fraction] | None,
        utensils: frozenset[str],
        began: float,
    ) -> None:
        self._store = store
        self._kitchen = kitchen
        self._listed = goals
        self._rates = rates
        self._utensils = utensils
        self._at_hand: Callable[[int], bool] = store.in_kitchen
        if kitchen is not None:
            self._at_hand = {o for item in kitchen for o in store.find(item.pattern)}.__contains__
        self.read_seconds = time.perf_counter() - began

    def with_kitchen(self, items: Sequence[ListedObject]) -> Question:
        """Give the same store with another kitchen."""
        began = time.perf_counter()
        return StoredQuestion(self._store, items, self._listed, self._rates, self._utensils, began)

    def with_changes(self, added: frozenset[int], removed: frozenset[int]) -> Question:
        """Give the same store with object nodes added to the kitchen and taken from it."""
        return _ChangedQuestion(self, added, removed)

    @property
    def motions(self) -> list[str]:
        """The motions of the network, in alphabetical order."""
        return sorted(motion for motion, _ in self._store.motion_sources())

    @cached_property
    def at_hand(self) -> frozenset[int]:
        """The object nodes of the kitchen, by id: its entries are looked up, and no more is read."""
        items = self._store.kitchen_items() if self._kitchen is None else self._kitchen
        return frozenset(o for item in items for o in self._store.find(item.pattern))

    @cached_property
    def data(self) -> Data:
        """Everything there is: the whole store is read."""
        began = time.perf_counter()
        network, kitchen = self._store.whole()
        items = self._store.kitchen_items()
        if self._kitchen is not None:
            items, kitchen = tuple(self._kitchen), kitchen_nodes(network, self._kitchen)
        data = self._with(network, kitchen)._replace(kitchen_items=items)
        self.read_seconds += time.perf_counter() - began
        return data

    @property
    def listed(self) -> Sequence[ListedObject]:
        """The entries of the goals file."""
        return self._listed

    @property
    def names(self) -> Network | NodeNames:
        """What goals are looked up in: the indexes of the store."""
        return self._store

    def problem(self, goals: Sequence[int], containers: str, everything: bool = False) -> Problem:
        """Ask for goals; what no tree for them needs is not read, unless everything is asked for."""
        if everything:
            return ask(self.data, goals, containers)
        began = time.perf_counter()
        cone = self._store.cone(goals, ContainerRule(containers), self._utensils, self._at_hand)
        problem = ask(self._part(cone), _places(cone, goals), containers)
        self.read_seconds += time.perf_counter() - began
        return problem

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
        return self._part(network), _places(network, goals)

    def _part(self, network: Network) -> Data:
        at_hand = (place for place, o in enumerate(network.object_numbers) if self._at_hand(o))
        return self._with(network, frozenset(at_hand))

    def _with(self, network: Network, kitchen: frozenset[int]) -> Data:
        goals = tuple(self._listed)
        left_out = self._store.left_out
        return Data(network, kitchen, (), goals, self._rates, self._utensils, (), left_out)


class _ChangedQuestion(StoredQuestion):
    """A store with another kitchen than the ``base`` has; what that reads is read once."""

    def __init__(self, base: StoredQuestion, added: frozenset[int], removed: frozenset[int]) -> None:
        vars(self).update({k: v for k, v in vars(base).items() if k not in {"at_hand", "data"}})
        self._base, self._added, self._removed = base, added, removed
        self._at_hand = lambda o: o in added or (o not in removed and base._at_hand(o))

    @cached_property
    def at_hand(self) -> frozenset[int]:
        """The object nodes of the kitchen, by id."""
        return self._base.at_hand - self._removed | self._added

    @cached_property
    def data(self) -> Data:
        """Everything there is."""
        data = self._base.data
        return data._replace(kitchen=data.kitchen - self._removed | self._added)


def _places(part: Network, goals: Sequence[int]) -> tuple[int, ...]:
    """Give the ids that goals have in a part of the network."""
    places = {o: place for place, o in enumerate(part.object_numbers)}
    return tuple(places[goal] for goal in goals)


def _at_level(data: Data, level: int) -> Data:
    network = network_at_level(data.network, level)
    goals = tuple(entry._replace(pattern=pattern_at_level(entry.pattern, level)) for entry in data.goals)
    return data._replace(network=network, kitchen=kitchen_nodes(network, data.kitchen_items), goals=goals)
