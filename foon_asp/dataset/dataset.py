"""Data that was read, and the problems that are posed of it."""

import copy
import shlex
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from foon_asp.dataset.names import changed_prices, changed_rates, item_id, listed, node_id, node_ids
from foon_asp.errors import UserError
from foon_asp.network import (
    FunctionalUnit,
    Network,
    ObjectNode,
    UnitPrices,
    counted,
    pattern_at_level,
    starting_kitchen,
)
from foon_asp.problem import (
    Changes,
    Measure,
    Names,
    Number,
    Problem,
    UnitPricesNamed,
    Unpriced,
    UsedUp,
    container_rule,
    count_unpriced,
    first_places,
    unrated_text,
)
from foon_asp.text.data_folder import STARTING, Data, kitchen_item_warning, kitchen_nodes
from foon_asp.text.goal_name import NodeNames, entry_names, find_goal, listed_goal, listed_nodes
from foon_asp.text.object_list import ListedObject, read_object_list
from foon_asp.text.repeated_node import refuse_repeated
from foon_asp.warning import warn

if TYPE_CHECKING:  # plain answers do not need it
    from foon_asp.proof.verify import Subject


def ask(
    data: Data, goals: Sequence[int], containers: str, origin: "Dataset", items: UsedUp | None = None
) -> Problem:
    """Ask for goals of the network under a container rule, of data that belong to others."""
    if items is not None:
        refuse_repeated(data.repeated)
    unrated = origin.unrated
    return Problem(
        data.network,
        data.kitchen,
        tuple(goals),
        None if unrated else data.rates,
        data.utensils,
        container_rule(containers),
        origin=origin,
        unit_prices=data.unit_prices,
        measures=origin.measures,
        items=items,
        starting=data.starting,
        unrated=unrated,
    )


class Dataset:
    """Data that was read, and how many seconds that took.

    Whoever asks it for goals and problems leaves the rest to it; ``data`` is everything, for those that need
    it. ``listed`` are the entries of the goals file, ``names`` what goals are looked up in, ``rates`` the
    success rates of motions, ``None`` where none are known, and ``utensils`` the labels that the container
    rule ``implied`` looks at. ``remarks`` are what was assumed while reading, in words, and ``brief``
    the same in few lines; ``has_kitchen`` says that a kitchen was given, even an empty one; without one, the
    starting kitchen is at hand.
    ``goals_from`` says what the entries were assumed from if no file lists goals. ``measures`` are the
    user's own, by name.
    """

    measures: Mapping[str, Measure] = MappingProxyType({})

    def __init__(
        self, data: Data, read_seconds: float, remarks: tuple[str, ...] = (), has_kitchen: bool = True
    ) -> None:
        self._data = data
        self.listed: Sequence[ListedObject] = data.goals
        self.names: NodeNames = data.network
        self.rates: Mapping[str, Fraction] | None = data.rates
        self.utensils = data.utensils
        self.read_seconds = read_seconds
        self.remarks = self.brief = remarks
        self.has_kitchen = has_kitchen
        self.goals_from = data.goals_from

    @property
    def unrated(self) -> str:
        """The motions without a success rate, in words; empty where all have one, or no rates are known."""
        rates, network = self.rates, self.data.network
        if rates is None or rates.keys() >= set(network.motions):
            return ""
        return unrated_text(first_places(network), rates)

    def close(self) -> None:
        """Close the files that are read only as far as questions go; there are none here."""

    @property
    def data(self) -> Data:
        """Everything there is."""
        return self._data

    @property
    def whole_network(self) -> Network:
        """The whole network."""
        return self.data.network

    @property
    def unit_prices(self) -> UnitPrices | None:
        """The prices of units, ``None`` where none are known."""
        return self.data.unit_prices

    @property
    def motions(self) -> list[str]:
        """The motions of the network, in alphabetical order."""
        return sorted(set(self.data.network.motions))

    @property
    def kitchen(self) -> frozenset[int]:
        """The object nodes at hand, by id."""
        return self.data.kitchen

    def at_hand(self, o: int) -> bool:
        """Whether the kitchen has an object node, by id."""
        return o in self.data.kitchen

    def kitchen_for(self, goals: Iterable[int]) -> frozenset[int]:
        """Return the object nodes available to a question about goals; a starting kitchen withholds these."""
        added, lacking = self.goal_changes(goals)
        return self.kitchen.union(added).difference(lacking) if added or lacking else self.kitchen

    def made_too(self, objects: Iterable[int]) -> list[int]:
        """Return those of some nodes of a starting kitchen that a unit makes out of others."""
        return list(filter(starting_kitchen(self.data.network).is_made, objects))

    def goal_changes(self, goals: Iterable[int]) -> tuple[frozenset[int], frozenset[int]]:
        """Return what a starting kitchen has more, and what it lacks, because these are the goals."""
        if not self.data.starting:
            return frozenset(), frozenset()
        assumed = starting_kitchen(self.data.network)
        added, lacking = assumed.changes(tuple(goals))
        # what was taken out stays out
        return (
            (added - (assumed.nodes - self.data.kitchen), lacking) if added or lacking else (added, lacking)
        )

    def goals(self, names: Sequence[str | ObjectNode]) -> tuple[int, ...]:
        """Find the goals by name; without a name, the goals file has to hold exactly one.

        Without a file, they are all that were assumed.
        """
        if not names and self.goals_from and not self.listed:
            raise UserError(
                "no functional unit makes anything, so there is no goal: expected a recipe or a network"
            )
        if not names and self.goals_from:
            return tuple(dict.fromkeys(self.each_goal(())))
        if not names and len(self.listed) == 1:
            return (listed_goal(self.listed[0], self.names),)
        if not names:
            listed = "\n".join(
                f"  --goal {shlex.quote(name)}" for name in entry_names(self.listed, self.names)
            )
            raise UserError("name a goal with --goal" + (f"; the goals file has\n{listed}" if listed else ""))
        return tuple(dict.fromkeys(self.each_goal(names)))

    def assumed_goals(self) -> list[ObjectNode]:
        """Give the goals that were assumed because no file lists any; empty where one does."""
        return self.listed_goals() if self.goals_from else []

    def listed_goals(self) -> list[ObjectNode]:
        """Return the goals of the goals file, or those that were assumed."""
        return [self.names.node(o) for o in dict.fromkeys(self.each_goal(()))]

    def each_goal(self, names: Sequence[str | ObjectNode]) -> list[int]:
        """Find one goal for each name; without names, all nodes of the goals file."""
        if names:
            return [
                node_id(self, name, "goal")
                if isinstance(name, ObjectNode)
                else find_goal(name, self.names, self.listed)
                for name in names
            ]
        return [node for entry in self.listed for node in listed_nodes(entry, self.names)]

    def with_kitchen(self, items: Sequence[ListedObject]) -> "Dataset":
        """Give the same data with the kitchen of another file."""
        kitchen = kitchen_nodes(self.data.network, items)
        data = self.data._replace(kitchen=kitchen, kitchen_items=tuple(items), starting=False)
        return self._varied(data)

    def with_goals(self, goals: Sequence[ListedObject]) -> "Dataset":
        """Give the same data with other entries of a goals file."""
        other = self._varied(self.data._replace(goals=tuple(goals), goals_from=""))
        other.has_kitchen = self.has_kitchen
        return other

    def with_starting_kitchen(self) -> "Dataset":
        """Return the same data with what makes the units of each file run at hand."""
        kitchen = starting_kitchen(self.data.network).nodes
        return self._varied(self.data._replace(kitchen=kitchen, kitchen_items=(), starting=True))

    def _varied(self, data: Data) -> "Dataset":
        return Dataset(data, self.read_seconds).measured(self.measures)

    def measured(self, measures: Mapping[str, Measure]) -> "Dataset":
        """Give the same data with other measures of the user's."""
        other = copy.copy(self)
        other.measures = measures
        return other

    def varied(
        self,
        more: Collection[int],
        less: Collection[int],
        only: Collection[int] | None,
    ) -> "Dataset":
        """Give the same data with these object nodes, by id, put into the kitchen and taken out of it.

        ``only`` are all that is in the kitchen before that, where it is not ``None``.
        """
        kitchen = self._data.kitchen if only is None else only
        items = self._data.kitchen_items if only is None else ()
        at_hand = frozenset(kitchen).union(more).difference(less)
        starting = self._data.starting and only is None
        data = self._data._replace(kitchen=at_hand, kitchen_items=items, starting=starting)
        return self._varied(data)

    def valued(self, rates: Mapping[str, Number] | None, unit_prices: UnitPricesNamed | None) -> "Dataset":
        """Give the same data with some success rates and some prices changed."""
        if rates is None and unit_prices is None:
            return self
        network = self._data.network
        changed = changed_rates(self._data.rates, rates, self.motions)
        prices = changed_prices(self._data.unit_prices, unit_prices, self.motions, network)
        data = self._data._replace(rates=None if changed is None else dict(changed), unit_prices=prices)
        return self._varied(data)

    def vary(self, changes: Changes) -> "Dataset":
        """Give the same data with another kitchen, other rates or prices."""
        kitchen, adding, without, rates, unit_prices, measures = changes
        dataset = self.valued(rates, unit_prices)
        if measures is not None:
            # takes the facts for rules along, which most questions do without
            from foon_asp.rules.measure import read_measures  # noqa: PLC0415

            dataset = dataset.measured(read_measures(measures))
        if kitchen is None and not adding and not without:
            return dataset
        only = None
        if isinstance(kitchen, Path | str) and kitchen in {STARTING, str(STARTING)}:
            dataset = dataset.with_starting_kitchen()
        elif isinstance(kitchen, Path):
            items = read_object_list(kitchen)
            dataset = dataset.with_kitchen(items)
            names = dataset.names
            for item in items:
                if not names.find(pattern_at_level(item.pattern, names.level)):
                    warn(str(kitchen_item_warning(item)))
        elif kitchen is not None:
            only = frozenset(node_ids(self, kitchen, "kitchen item"))
        more = frozenset(node_ids(self, adding, "kitchen item"))
        with_more = dataset.varied(more, frozenset(), only)
        less = frozenset(item_id(with_more, name) for name in listed(without))
        return with_more.varied((), less, None) if less else with_more

    def posed_anew(
        self, problem: Problem, goals: Names | None, containers: str | None, changes: Changes
    ) -> Problem:
        """Pose a problem of these data with changes; see :meth:`Problem.vary`."""
        dataset = self.with_kitchen_of(problem).vary(changes)
        ids = _whole_goals(problem) if goals is None else dataset.named_goals(goals)
        posed = dataset.nearby(ids, containers or problem.containers, problem.items)
        return _with_own_rates(posed, problem)

    def posed_whole(self, problem: Problem) -> Problem:
        """Pose a problem of these data over the whole network."""
        dataset = self.with_kitchen_of(problem)
        posed = dataset.problem(_whole_goals(problem), problem.containers, True, problem.items)
        return _with_own_rates(posed, problem)

    def posed_about(self, problem: Problem, units: Iterable[FunctionalUnit]) -> Problem:
        """Pose a problem of these data over what its goals and these units are made of."""
        dataset = self.with_kitchen_of(problem)
        data, goals = dataset.part(_whole_goals(problem), tree=units)
        return _with_own_rates(ask(data, goals, problem.containers, dataset, problem.items), problem)

    def subject(self, everything: bool = True, goals: Iterable[int] = ()) -> "Subject":
        """Give what a certificate speaks about; of a store, it may not be read, and its digests be trusted.

        A starting kitchen is that for these ``goals``. Raises :class:`UserError` where ``everything`` is read
        of a store whose digests are not true.
        """
        data = self.data
        rates = None if self.unrated else data.rates
        from foon_asp.proof.verify import Subject  # noqa: PLC0415 (few answers need it)

        return Subject(data.network, self.kitchen_for(goals), rates, data.utensils, data.unit_prices)

    def named_goals(self, names: Names) -> tuple[int, ...]:
        """Find goals that Python names, by id in the whole network, each once.

        Without a name, the goals file has to hold exactly one.
        """
        found = tuple(dict.fromkeys(node_ids(self, names, "goal")))
        if found:
            return found
        if self.goals_from:
            each = self.each_goal(())
            if len(each) == 1:
                return tuple(each)
            known = ", ".join(repr(str(self.names.node(o))) for o in each)
            raise UserError(f"name a goal; no file lists goals, and taken for them are {known}")
        if len(self.listed) == 1:
            return (listed_goal(self.listed[0], self.names),)
        known = ", ".join(map(repr, entry_names(self.listed, self.names)))
        raise UserError("name a goal" + (f"; the goals file has {known}" if known else ""))

    def with_kitchen_of(self, problem: Problem) -> "Dataset":
        """Give the same data with the kitchen that a problem posed of it has."""
        from foon_asp.dataset.nearby import shown  # noqa: PLC0415 (few answers need it)

        more, less = self.kitchen_changes(shown(problem), _whole_goals(problem))
        return self.varied(more, less, None) if more or less else self

    def kitchen_changes(
        self, problem: Problem, goals: Iterable[int]
    ) -> tuple[frozenset[int], frozenset[int]]:
        """Give what a problem posed of this data has in its kitchen beyond it, and what it lacks.

        Ids are those of the whole network, those of its ``goals`` too.
        """
        ours, theirs = self.kitchen_for(goals), problem.kitchen
        return (frozenset(), frozenset()) if ours is theirs else (theirs - ours, ours - theirs)

    def unpriced(self) -> Sequence[Unpriced]:
        """Give the units that have no price, by motion."""
        network, prices = self.data.network, self.data.unit_prices
        known = (None,) * len(network) if prices is None else prices.each(network)
        return count_unpriced(
            (network.motions[unit], network.sources[unit])
            for unit, price in enumerate(known)
            if price is None
        )

    def problem(
        self,
        goals: Sequence[int],
        containers: str,
        everything: bool = False,
        items: UsedUp | None = None,
    ) -> Problem:
        """Ask for goals, which are those of the problem in the same order, under a container rule.

        ``everything`` asks for units that no goal needs to be there too. ``items`` says that items are used
        up, if they are.
        """
        return ask(self._stocked(goals), goals, containers, self, items)

    def _stocked(self, goals: Iterable[int]) -> Data:
        """Return the data with the kitchen for goals."""
        kitchen = self.kitchen_for(goals)
        return self.data if kitchen is self.data.kitchen else self.data._replace(kitchen=kitchen)

    def nearby(self, goals: Sequence[int], containers: str, items: UsedUp | None = None) -> Problem:
        """Ask for goals that can need many units, which of a store are read when they are looked at."""
        return self.problem(goals, containers, items=items)

    def part(
        self, goals: Sequence[int], units: Iterable[int] = (), tree: Iterable[FunctionalUnit] = ()
    ) -> tuple[Data, tuple[int, ...]]:
        """Give data with at least these goals, these units by id, and what a tree is made of.

        With it come the ids that the goals have there. Raises :class:`UserError` for ids of no unit.
        """
        self._check_units(units, len(self.data.network))
        return self._stocked(goals), tuple(goals)

    def _check_units(self, units: Iterable[int], count: int) -> None:
        for unit in units:
            if not 0 <= unit < count:
                raise UserError(f"there is no unit {unit}: the network has units 0 to {count - 1}")


def left_out(count: int) -> str:
    """Say that lines were left out."""
    return f"warning: {counted(count, 'line')} left out"


def _whole_goals(problem: Problem) -> tuple[int, ...]:
    """Give the goals of a problem by id in the whole network."""
    from foon_asp.dataset.nearby import shown  # noqa: PLC0415 (few answers need it)

    problem = shown(problem)
    return tuple(problem.network.object_number(goal) for goal in problem.goals)


def _with_own_rates(posed: Problem, problem: Problem) -> Problem:
    """Give a problem the rates that units of another one over the same network have of their own."""
    if not problem.own_rates:
        return posed
    numbered = {problem.network.unit_number(unit): rate for unit, rate in problem.own_rates.items()}
    own = {posed.network.unit_of_number(number): rate for number, rate in numbered.items()}
    return replace(posed, own_rates={unit: rate for unit, rate in own.items() if unit is not None})
