"""Datasets: data that was read, and the problems posed of it."""

import shlex
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from foon_asp.dataset.data_source import DataSource
from foon_asp.dataset.kitchen import Kitchen
from foon_asp.dataset.prices import NO_PRICES, DataPrices
from foon_asp.dataset.python_names import (
    NodeAndUnitNames,
    changed_prices,
    changed_rates,
    item_id,
    names_as_list,
    node_id,
    node_ids,
    stated_copies,
)
from foon_asp.errors import UserError
from foon_asp.network import (
    FunctionalUnit,
    Network,
    ObjectNode,
    StandInTable,
    UnitPrices,
    counted,
    is_starting,
    pattern_at_level,
)
from foon_asp.problem import (
    Changes,
    ContainerRule,
    Measure,
    Names,
    Number,
    Objective,
    Problem,
    UnitPricesNamed,
    Unpriced,
    UsedUp,
    container_rule,
    unrated_text,
)
from foon_asp.text.data_folder import Data, amounts_of_items, kitchen_item_warning
from foon_asp.text.node_lookup import entry_names, find_goal, node_of_entry, nodes_of_entry
from foon_asp.text.object_list import ListedObject, read_object_list
from foon_asp.warning import warn

if TYPE_CHECKING:  # plain answers do not need it
    from foon_asp.proof.certificate_subject import Subject
    from foon_asp.store.unit_distances import UnitDistances


def pose_problem(
    data: Data, goals: Sequence[int], containers: str, origin: "Dataset", items: UsedUp | None = None
) -> Problem:
    """Return the problem of goals over ``data``, which is all or a part of the data of ``origin``.

    ``goals``: ids in the network of ``data``.
    ``containers``: the name of the container rule.
    ``items``: how items are used up; ``None`` if they last.

    The user measures are those of ``origin``. If a motion of ``origin`` has no success rate, the problem has
    no rates.

    Raises :class:`UserError` for an unknown container rule, and for contradictory amounts if items are used
    up.
    """
    if items is not None and data.amounts.conflict:
        raise UserError(data.amounts.conflict)
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
        amounts=data.amounts.units,
    )


@dataclass(frozen=True, eq=False)
class Dataset:
    """Data that was read from text, or an open store, of which each problem reads only its part.

    ``source``: the network in memory, or the store. All ids are ids in the whole network.
    ``kitchen``: the available nodes.
    ``goal_entries``: the entries of the goals file, or the assumed goals.
    ``rates``: the success rates of motions; ``None`` without a file of rates.
    ``utensils``: the labels of utensils for the container rule ``implied``.
    ``prices``: the prices of units, except those in a store.
    ``kitchen_items``: the entries of the kitchen file; ``None`` if these are in the store.
    ``starting``: true if the kitchen is the starting kitchen, with or without changes.
    ``goals_from``: the origin of the assumed goals, as in :class:`Data`; empty if a file lists goals.
    ``remarks``: the assumptions made while reading, in words.
    ``brief``: a summary of the remarks.
    ``has_kitchen``: true if a kitchen was given, even an empty one.
    ``measures``: the user measures, by name.
    ``stand_ins``: the table of stand-ins; ``None`` where nothing may stand in.
    ``stock``: the amounts that the kitchen states; other items never run out.

    A dataset never changes: the methods ``with_...`` and ``vary`` return another one. If kitchen, goals,
    rates or prices change, the other one has no remarks. If kitchen, rates or prices change, its
    ``has_kitchen`` is true. Only :meth:`with_kitchen_for` keeps both.
    """

    source: DataSource
    kitchen: Kitchen
    goal_entries: Sequence[ListedObject] = ()
    rates: Mapping[str, Fraction] | None = None
    utensils: frozenset[str] = frozenset()
    prices: DataPrices = NO_PRICES
    kitchen_items: tuple[ListedObject, ...] | None = ()
    starting: bool = False
    goals_from: str = ""
    remarks: tuple[str, ...] = ()
    brief: tuple[str, ...] = ()
    has_kitchen: bool = True
    measures: Mapping[str, Measure] = field(default_factory=dict)
    stand_ins: StandInTable | None = None
    stock: Mapping[ObjectNode, int] = field(default_factory=dict)

    @classmethod
    def of(cls, data: Data, seconds: float = 0.0) -> Self:
        """Return the dataset of data in memory; ``seconds`` is how long reading took.

        The amounts of kitchen items become the stock. The warnings of ``data`` do not become remarks.
        """
        return cls(
            DataSource(data.network, seconds, data.left_out, data.repeated, data.amounts),
            Kitchen(data.kitchen),
            data.goals,
            data.rates,
            data.utensils,
            DataPrices.of(data.unit_prices),
            data.kitchen_items,
            data.starting,
            data.goals_from,
            stock=amounts_of_items(data.network, data.kitchen_items),
        )

    def close(self) -> None:
        """Close the store, if the source is one, for all datasets that share it."""
        self.source.close()

    @property
    def names(self) -> NodeAndUnitNames:
        """The lookup of object nodes and units by name."""
        return self.source.names

    @property
    def read_seconds(self) -> float:
        """The seconds spent on reading so far."""
        return self.source.seconds

    @cached_property
    def unrated(self) -> str:
        """A text about the motions without a success rate.

        It is empty if all motions have a rate, or if there are no rates at all.
        """
        if self.rates is None or self.rates.keys() >= set(self.source.motions):
            return ""
        return unrated_text(self.source.motion_sources(), self.rates)

    @cached_property
    def data(self) -> Data:
        """The whole data, without warnings. A store is read completely at the first access."""
        network = self.source.whole_network()
        items = self.source.kitchen_items() if self.kitchen_items is None else self.kitchen_items
        return self._data_with(network, self.kitchen.ids)._replace(kitchen_items=items)

    def _data_of_network(self, network: Network) -> Data:
        """Return the data of this dataset over ``network``, which is a part of the network or all of it.

        The kitchen is matched to the ids of ``network``.
        """
        if network is self.names:
            return self.data
        kitchen = (local_id for local_id, o in enumerate(network.object_numbers) if o in self.kitchen)
        return self._data_with(network, frozenset(kitchen))

    def _data_with(self, network: Network, kitchen: frozenset[int]) -> Data:
        """Return the data of this dataset with another network, and with a kitchen of ids in this network.

        The prices are those of units of this network. The entries of the kitchen file and the warnings are
        empty.
        """
        return Data(
            network,
            kitchen,
            (),
            tuple(self.goal_entries),
            None if self.rates is None else dict(self.rates),
            self.utensils,
            (),
            self.source.left_out,
            self._unit_prices(network),
            self.starting,
            self.goals_from,
            self.source.repeated,
            self.source.amounts,
        )

    def _unit_prices(self, network: Network) -> UnitPrices | None:
        """Return the prices of the units of a network, also those in a store; ``None`` if there are none.

        Prices of single units in memory take precedence over those in the store.
        """
        motions, units, from_file = self.prices
        stored = self.source.unit_prices(network, from_file)
        if motions is None and not units and stored is None:
            return None
        return UnitPrices(motions or {}, {**stored, **units} if stored else units)

    @property
    def whole_network(self) -> Network:
        """The whole network. In a store, each unit and node is read when it is accessed."""
        return self.source.network_read_on_access()

    @property
    def unit_prices(self) -> UnitPrices | None:
        """The prices of units, all read; ``None`` where no prices are known."""
        return self.data.unit_prices

    @property
    def motions(self) -> list[str]:
        """The motions of the network, in alphabetical order."""
        return sorted(self.source.motions)

    def at_hand(self, o: int) -> bool:
        """Whether an object node, by id, is in the kitchen."""
        return o in self.kitchen

    def made_by_units(self, objects: Iterable[int]) -> list[int]:
        """Return those of the ``objects``, by id, that some unit makes without needing them."""
        return [o for o in objects if self.source.starting_kitchen.makers(o)]

    def with_kitchen_for(self, goals: Iterable[int]) -> "Dataset":
        """Return the dataset with the kitchen that it has in a question about these goals, by id.

        A starting kitchen loses goals that units make, and may gain other nodes; see
        :meth:`StartingKitchen.changes_for_goals`. Nodes that were removed from a starting kitchen stay
        removed. Any other kitchen stays as it is.
        """
        if not self.starting:
            return self
        starting = self.source.starting_kitchen
        added, lacking = starting.changes_for_goals(goals)
        # nodes that the user removed stay removed
        added = frozenset(o for o in added if o in self.kitchen or o not in starting.nodes)
        if not added and not lacking:
            return self
        return replace(self, kitchen=self.kitchen.with_changes(added, lacking))

    def command_goal_ids(self, names: Sequence[str | ObjectNode]) -> tuple[int, ...]:
        """Return the ids of the goals that a command names, each once.

        Without names, return all assumed goals, or the node of the only entry of the goals file.

        Raises :class:`UserError`
        - for a name that means no object node or several, and
        - without names, if the file has several entries, or if there is no goal to assume.
        """
        if not names and self.goals_from and not self.goal_entries:
            raise UserError(
                "no functional unit makes anything, so there is no goal: expected a recipe or a network"
            )
        if not names and self.goals_from:
            return tuple(dict.fromkeys(self.goal_ids(())))
        if not names and len(self.goal_entries) == 1:
            return (node_of_entry(self.goal_entries[0], self.names),)
        if not names:
            options = "\n".join(
                f"  --goal {shlex.quote(name)}" for name in entry_names(self.goal_entries, self.names)
            )
            raise UserError(
                "name a goal with --goal" + (f"; the goals file has\n{options}" if options else "")
            )
        return tuple(dict.fromkeys(self.goal_ids(names)))

    def assumed_goals(self) -> list[ObjectNode]:
        """Return the goals that were assumed because no file lists goals; an empty list if a file does."""
        return self.listed_goals() if self.goals_from else []

    def listed_goals(self) -> list[ObjectNode]:
        """Return the goals of the goals file, each once. If there is no file, return the assumed goals."""
        return [self.names.node(o) for o in dict.fromkeys(self.goal_ids(()))]

    def goal_ids(self, names: Sequence[str | ObjectNode]) -> list[int]:
        """Return the id of the goal for each name, in order; an id may be repeated.

        Without names, return the ids of all nodes that match entries of the goals file. Without names and
        file, return the ids of the assumed goals. Raises :class:`GoalError` for a name that means no object
        node or several, and for an entry that matches none.
        """
        if names:
            return [
                node_id(self, name, "goal")
                if isinstance(name, ObjectNode)
                else find_goal(name, self.names, self.goal_entries)
                for name in names
            ]
        return [node for entry in self.goal_entries for node in nodes_of_entry(entry, self.names)]

    def with_kitchen(self, items: Sequence[ListedObject]) -> "Dataset":
        """Return the same data with another kitchen: the nodes that match entries of a kitchen file.

        ``items`` are the entries, whose amounts become the stock. Entries that match no node are ignored. The
        remarks are dropped, and the kitchen counts as given.
        """
        names = self.names
        patterns = [pattern_at_level(item.pattern, names.level) for item in items]
        kitchen = Kitchen(frozenset(o for pattern in patterns for o in names.find(pattern)))
        stock = amounts_of_items(names, items)
        return self._with_fields(kitchen=kitchen, kitchen_items=tuple(items), starting=False, stock=stock)

    @property
    def goal_amounts(self) -> dict[int, int]:
        """The numbers of copies of goals that the goals file states, by the id of the goal."""
        return {
            o: entry.amount
            for entry in self.goal_entries
            if entry.amount is not None
            for o in self.names.find(entry.pattern)
        }

    def with_goals(self, goals: Sequence[ListedObject]) -> "Dataset":
        """Return the same data with these entries as its goals file, and without remarks.

        No goals are assumed then.
        """
        return self._with_fields(goal_entries=tuple(goals), goals_from="", has_kitchen=self.has_kitchen)

    def with_starting_kitchen(self) -> "Dataset":
        """Return the same data with the starting kitchen, without a stock and without remarks.

        The kitchen then counts as given.
        """
        kitchen = Kitchen(self.source.starting_kitchen.nodes)
        return self._with_fields(kitchen=kitchen, kitchen_items=(), starting=True, stock={})

    def _with_fields(self, **changes: Any) -> "Dataset":
        """Return a copy with some fields changed.

        Unless ``changes`` say otherwise, the copy has no remarks, and its kitchen counts as given
        (``has_kitchen``).
        """
        return replace(self, **{"remarks": (), "brief": (), "has_kitchen": True, **changes})

    def with_remarks(
        self, warnings: Iterable[str], brief: Iterable[str], remarks: Sequence[str], has_kitchen: bool
    ) -> "Dataset":
        """Return the same data with other remarks: ``warnings``, then ``remarks``.

        The parameter ``brief`` is a summary of the warnings. The field :attr:`brief` of the result has this
        summary, then ``remarks``. ``has_kitchen`` says whether a kitchen was given.
        """
        all_remarks, brief_remarks = (*warnings, *remarks), (*brief, *remarks)
        return replace(self, remarks=all_remarks, brief=brief_remarks, has_kitchen=has_kitchen)

    def with_measures(self, measures: Mapping[str, Measure]) -> "Dataset":
        """Return the same data with these user measures, by name, instead of its own."""
        return replace(self, measures=measures)

    def with_stand_in_table(self, table: StandInTable | None) -> "Dataset":
        """Return the same data with stand-ins by a table; without stand-ins if ``table`` is ``None``.

        With a table, only the assumed goals of the first file are kept, if it has any. The other files are
        there to help make the goals of the first one.
        """
        goals = self.goal_entries
        if table is not None and self.goals_from and len(goals) > 1:
            first_unit_sources = next(iter(self.whole_network.sources), ())
            first_file = first_unit_sources[0].file if first_unit_sources else None
            goals = [goal for goal in goals if goal.source.file == first_file] or goals
        return replace(self, stand_ins=table, goal_entries=goals)

    def with_kitchen_changes(
        self,
        added: Collection[int],
        removed: Collection[int],
        replacement: Collection[int] | None,
    ) -> "Dataset":
        """Return the same data with object nodes, by id, added to the kitchen and removed from it.

        If there is a ``replacement``, its nodes first replace the whole kitchen, and no item has a stock. If
        it is ``None``, the kitchen and its stock are kept. Added nodes never run out. The remarks are
        dropped, and the kitchen counts as given.
        """
        if replacement is not None:
            kitchen = Kitchen(replacement, added, removed)
            return self._with_fields(kitchen=kitchen, kitchen_items=(), starting=False, stock={})
        endless = set(map(self.names.node, added)) if self.stock else set()
        stock = {node: amount for node, amount in self.stock.items() if node not in endless}
        return self._with_fields(kitchen=self.kitchen.with_changes(added, removed), stock=stock)

    def with_rates_and_prices(
        self, rates: Mapping[str, Number] | None, unit_prices: UnitPricesNamed | None
    ) -> "Dataset":
        """Return the same data with some success rates and some prices replaced or added.

        ``rates`` are by motion, ``unit_prices`` by motion or unit. ``None`` keeps all rates, or all prices.
        Unless both are ``None``, the remarks are dropped. A kitchen that was assumed still counts as assumed.
        Raises :class:`UserError` as :func:`changed_rates` and :func:`changed_prices` do.
        """
        if rates is None and unit_prices is None:
            return self
        motions, units, _ = prices = self.prices
        if unit_prices is not None:
            listed_prices = UnitPrices(motions or {}, units)
            motions, units = changed_prices(listed_prices, unit_prices, self.motions, self.names)
            prices = prices._replace(motions=motions, units=units)
        changed = changed_rates(self.rates, rates, self.motions)
        return self._with_fields(rates=changed, prices=prices, has_kitchen=self.has_kitchen)

    def vary(self, changes: Changes) -> "Dataset":
        """Return the same data with changes, as :meth:`foon_asp.Foon.vary` does.

        The rates, prices and measures are changed first. Then the kitchen is replaced, items are added, and
        items are removed. A new kitchen may have numbers of copies by name, which become the stock. Entries
        of a kitchen file that match no object node cause a warning. Without any change, return this dataset
        itself. Raises :class:`UserError` for an unknown name.
        """
        kitchen, adding, without, rates, unit_prices, measures = changes
        dataset = self.with_rates_and_prices(rates, unit_prices)
        if measures is not None:
            # imports the facts for rules, which most questions do without
            from foon_asp.rules.measure import read_measures  # noqa: PLC0415

            dataset = dataset.with_measures(read_measures(measures))
        if kitchen is None and not adding and not without:
            return dataset
        replacement = None
        if kitchen is not None and is_starting(kitchen):
            dataset = dataset.with_starting_kitchen()
        elif isinstance(kitchen, Path):
            items = read_object_list(kitchen)
            dataset = dataset.with_kitchen(items)
            names = dataset.names
            for item in items:
                if not names.find(pattern_at_level(item.pattern, names.level)):
                    warn(str(kitchen_item_warning(item)))
        elif kitchen is not None:
            replacement = frozenset(node_ids(self, kitchen, "kitchen item"))
        added = frozenset(node_ids(self, adding, "kitchen item"))
        with_added = dataset.with_kitchen_changes(added, frozenset(), replacement)
        if isinstance(kitchen, Mapping):
            with_added = replace(with_added, stock=stated_copies(dataset, kitchen, "kitchen item"))
        removed = frozenset(item_id(with_added, name) for name in names_as_list(without))
        return with_added.with_kitchen_changes((), removed, None) if removed else with_added

    def vary_problem(
        self, problem: Problem, goals: Names | None, containers: str | None, changes: Changes
    ) -> Problem:
        """Return a variation of a problem over changed data, as :meth:`Problem.vary` describes.

        The changes begin from the kitchen of the problem. For ``None``, its goals or its container rule are
        kept. Items are used up as in the problem. With another kitchen, their stock is that of the other
        kitchen. The rates that the problem has for single units are kept. Of a store, only units near the
        goals are read; see :meth:`nearby`.
        """
        dataset = self.with_kitchen_of(problem).vary(changes)
        ids = _whole_goal_ids(problem) if goals is None else dataset.python_goal_ids(goals)
        items = problem.items
        if items is not None and changes.kitchen is not None:
            items = replace(items, stock=dict(dataset.stock))
        varied = dataset.nearby(ids, containers or problem.containers, items)
        return _with_own_rates(varied, problem)

    def extend_to_whole(self, problem: Problem) -> Problem:
        """Return the same problem over the whole network, with the units that no goal needs.

        Of a store, everything is read. The rates that the problem has for single units are kept.
        """
        dataset = self.with_kitchen_of(problem)
        extended = dataset.problem(_whole_goal_ids(problem), problem.containers, True, problem.items)
        return _with_own_rates(extended, problem)

    def extend_to_units(self, problem: Problem, units: Iterable[FunctionalUnit]) -> Problem:
        """Return the same problem over a part of the network that has its goals and at least the given units.

        Units that the network lacks are left out. Of a network in memory, the part is the whole network. The
        rates that the problem has for single units are kept, if the part has these units.
        """
        dataset = self.with_kitchen_of(problem)
        data, goals = dataset.data_part(_whole_goal_ids(problem), tree=units)
        return _with_own_rates(pose_problem(data, goals, problem.containers, dataset, problem.items), problem)

    def subject(self, everything: bool = True, goals: Iterable[int] = ()) -> "Subject":
        """Return what a certificate is about: network, kitchen and prices, with the digests of the store.

        All data are read, and the digests are checked,
        - if ``everything`` is true,
        - for a starting kitchen,
        - for prices that are not those of the store, and
        - for a store without digests.
        Otherwise, the store is read on access and its digests are trusted. The subject then has no prices,
        only the digests that the store states.

        Digests of a kitchen or of prices that are not those of the store are left out. A starting kitchen is
        the one for ``goals``, by id. If some motion has no success rate, the subject has no rates.

        Raises :class:`UserError` if all data are read and do not have a digest that the store states.
        """
        from foon_asp.proof.certificate_subject import Subject  # noqa: PLC0415 (few answers need it)

        source, with_goal_kitchen = self.source, self.with_kitchen_for(goals)
        rates = None if self.unrated else self.rates
        has_stored_prices = self.prices == source.prices
        everything = everything or self.starting or not has_stored_prices or not source.digests
        digests = dict(source.checked_digests() if everything else source.digests)
        if not self.kitchen.is_exactly(source.kitchen):
            digests.pop("kitchen", None)
        if not has_stored_prices:
            digests.pop("prices", None)
        if everything:
            data = self.data
            kitchen, prices, trusted = with_goal_kitchen.kitchen.ids, data.unit_prices, ()
            return Subject(
                data.network, kitchen, rates, self.utensils, prices, digests, trusted, data.amounts.units
            )
        network = source.network_read_on_access()
        return Subject(
            network,
            with_goal_kitchen.kitchen,
            rates,
            self.utensils,
            None,
            digests,
            tuple(sorted(digests)),
            source.amounts.units,
        )

    def subject_with_stand_ins(
        self, goals: Sequence[int], containers: str, everything: bool, steps: Sequence[int] = ()
    ) -> "Subject":
        """Return the network with stand-ins and the kitchen that a certificate is about.

        ``steps`` are the ids of the units of a tree.

        The network has these stand-ins:
        - with ``steps``, those for the repair of this tree;
        - without ``steps``, those for the goals;
        - with ``everything`` and without ``steps``, also those that no goal needs.

        Without a table of stand-ins, the network has none. The subject has no digests of a store.
        """
        from foon_asp.proof.certificate_subject import Subject  # noqa: PLC0415 (few answers need it)

        if steps and self.stand_ins is not None:
            from foon_asp.standins.repair import Repair  # noqa: PLC0415 (few questions have stand-ins)

            original = pose_problem(self.with_kitchen_for(goals).data, goals, containers, self)
            problem = Repair.over(original, tuple(steps), self.stand_ins).shown
        else:
            problem = self.problem(goals, containers, everything)
        values = problem.kitchen, problem.rates, problem.utensils, problem.unit_prices
        return Subject(problem.network, *values, stand_ins=self.stand_ins)

    def python_goal_ids(self, names: Names) -> tuple[int, ...]:
        """Return the ids of the goals that a Python caller names, each once.

        Without a name, return the node of the only entry of the goals file. Without a name and a file, return
        the only assumed goal.

        Raises :class:`UserError`
        - for a name that means no object node or several, and
        - without a name, if there are several goals or none.
        """
        named = tuple(dict.fromkeys(node_ids(self, names, "goal")))
        if named:
            return named
        if self.goals_from:
            assumed = self.goal_ids(())
            if len(assumed) == 1:
                return tuple(assumed)
            choices = ", ".join(repr(str(self.names.node(o))) for o in assumed)
            raise UserError(f"name a goal; no file lists goals, and taken for them are {choices}")
        if len(self.goal_entries) == 1:
            return (node_of_entry(self.goal_entries[0], self.names),)
        choices = ", ".join(map(repr, entry_names(self.goal_entries, self.names)))
        raise UserError("name a goal" + (f"; the goals file has {choices}" if choices else ""))

    def with_kitchen_of(self, problem: Problem) -> "Dataset":
        """Return the same data with the kitchen of ``problem``, a problem that was made from this dataset.

        No more of a store is read. If the problem is about a part of the network, only nodes of this part are
        added to the kitchen or removed from it.
        """
        from foon_asp.dataset.nearby import without_reading_more  # noqa: PLC0415 (few answers need it)

        added, removed = self.kitchen_changes(without_reading_more(problem), _whole_goal_ids(problem))
        return self.with_kitchen_changes(added, removed, None) if added or removed else self

    def kitchen_changes(
        self, problem: Problem, goals: Iterable[int]
    ) -> tuple[frozenset[int], frozenset[int]]:
        """Return the ids of nodes that only the problem has available, and those that only the dataset has.

        The kitchen of the dataset is the one for ``goals``. All ids, also those of ``goals``, are ids in the
        whole network. If the problem is about a part of the network, only nodes of this part are compared.
        """
        kitchen, network = self.with_kitchen_for(goals).kitchen, problem.network
        if not network.object_numbers:
            own_items, problem_items = kitchen.ids, problem.kitchen
            return (
                (frozenset(), frozenset())
                if own_items is problem_items
                else (problem_items - own_items, own_items - problem_items)
            )
        problem_items = frozenset(map(network.object_number, problem.kitchen))
        own_items = frozenset(o for o in network.object_numbers if o in kitchen)
        return problem_items - own_items, own_items - problem_items

    def unpriced(self) -> Sequence[Unpriced]:
        """Return each motion of unpriced units, with their number and the source of the first one."""
        return self.source.unpriced(self.prices)

    def problem(
        self,
        goals: Sequence[int],
        containers: str,
        everything: bool = False,
        items: UsedUp | None = None,
    ) -> Problem:
        """Return the problem of goals, by id and in this order, under the container rule ``containers``.

        The network of the problem is whole if the data are in memory, or with ``everything``. Otherwise, it
        has only the units that the goals can need. Stand-ins, if any, are also units of the network; with
        ``everything``, even stand-ins that no goal needs.

        ``items`` says how items are used up; ``None`` if items last. If items are used up, the goals can also
        need units that make items of the stock, since these items may run out.
        """
        dataset = self.with_kitchen_for(goals)
        if self.stand_ins is not None:
            from foon_asp.standins import with_stand_ins  # noqa: PLC0415 (few questions have stand-ins)

            without_stand_ins = pose_problem(dataset.data, goals, containers, self, items)
            return with_stand_ins(without_stand_ins, self.stand_ins, everything)
        if everything:
            return pose_problem(dataset.data, goals, containers, self, items)
        # items of the stock may run out, and then have to be made
        stocked_ids = {self.names.object_id(node) for node in (items.stock if items else ())}
        kitchen = dataset.kitchen.with_changes((), [o for o in stocked_ids if o is not None])
        cone = self.source.cone(goals, container_rule(containers), self.utensils, kitchen, None)
        network = self.source.whole_network() if cone is None else self.source.network_part(cone.units, goals)
        return pose_problem(
            dataset._data_of_network(network), _local_ids(network, goals), containers, self, items
        )

    def nearby(
        self, goals: Sequence[int], containers: str, items: UsedUp | None = None, units_at_first: int = 1000
    ) -> Problem:
        """Return the problem of goals; of a store, only about ``units_at_first`` units are read now.

        The units read now are near the goals. All other units that the goals can need are read when a field
        of the problem is accessed; see :class:`NearbyProblem`. All are read now if no kitchen was given, if
        items are used up, or if there are stand-ins. Of data in memory, the problem is that of
        :meth:`problem`.
        """
        cone = None
        if items is None and self.has_kitchen and self.stand_ins is None:
            kitchen = self.with_kitchen_for(goals).kitchen
            cone = self.source.cone(goals, container_rule(containers), self.utensils, kitchen, units_at_first)
        if cone is None:
            return self.problem(goals, containers, items=items)
        from foon_asp.dataset.nearby import Nearby, NearbyProblem  # noqa: PLC0415 (text does without)

        return NearbyProblem.of(Nearby(self, cone, containers), units_at_first)

    def problem_of_units(self, units: Iterable[int], goals: Sequence[int], containers: str) -> Problem:
        """Return the problem of goals over a part of the network that has at least these units.

        Goals and units are by id. Items last in the problem. Of a network in memory, the part is the whole
        network.
        """
        network = self.source.network_part(units, goals)
        return pose_problem(
            self.with_kitchen_for(goals)._data_of_network(network),
            _local_ids(network, goals),
            containers,
            self,
        )

    def unit_distances(self, containers: str, objective: Objective) -> "UnitDistances | None":
        """Return the distance of each unit of a store: a lower bound on the cost of any tree with the unit.

        Return ``None`` if the data are in memory, and for a starting kitchen. ``containers`` is the name of
        the container rule; under ``implied``, utensils cost nothing. See :meth:`DataSource.unit_distances`
        for ``objective``.
        """
        if self.starting:
            return None
        implied = container_rule(containers) is ContainerRule.IMPLIED
        return self.source.unit_distances(
            self.kitchen.ids, self.utensils if implied else (), self.rates, objective
        )

    def data_part(
        self, goals: Sequence[int], units: Iterable[int] = (), tree: Iterable[FunctionalUnit] = ()
    ) -> tuple[Data, tuple[int, ...]]:
        """Return a part of the data, and the ids that the goals have in the network of the part.

        The part has at least the ``goals`` and ``units``, both by id. It also has the units and nodes of
        ``tree`` that the network has. Its kitchen is the one for the goals. Raises :class:`UserError` for an
        id in ``units`` that no unit has.
        """
        units, names = list(units), self.names
        for unit in units:
            if not 0 <= unit < self.source.unit_count:
                count = self.source.unit_count
                raise UserError(f"there is no unit {unit}: the network has units 0 to {count - 1}")
        tree = list(tree)
        tree_ids = [unit_id for unit in tree if (unit_id := names.unit_id(unit)) is not None]
        nodes = {node for unit in tree for node in (*unit.inputs, *unit.outputs)}
        objects = [o for node in nodes if (o := names.object_id(node)) is not None]
        network = self.source.network_part([*units, *tree_ids], [*goals, *objects])
        return self.with_kitchen_for(goals)._data_of_network(network), _local_ids(network, goals)


def _local_ids(network: Network, goals: Sequence[int]) -> tuple[int, ...]:
    """Return the ids that goals of the whole network have in ``network``, a part of it or all of it."""
    if not network.object_numbers:
        return tuple(goals)
    local_ids = {o: local_id for local_id, o in enumerate(network.object_numbers)}
    return tuple(local_ids[goal] for goal in goals)


def left_out_warning(count: int) -> str:
    """Return a warning that ``count`` lines were not understood and left out."""
    return f"warning: {counted(count, 'line')} left out"


def _whole_goal_ids(problem: Problem) -> tuple[int, ...]:
    """Return the ids that the goals of a problem have in the whole network; no more of a store is read."""
    from foon_asp.dataset.nearby import without_reading_more  # noqa: PLC0415 (few answers need it)

    problem = without_reading_more(problem)
    return tuple(problem.network.object_number(goal) for goal in problem.goals)


def _with_own_rates(new_problem: Problem, problem: Problem) -> Problem:
    """Return ``new_problem`` with the success rates that ``problem`` has for single units.

    Rates of units that ``new_problem`` does not have are left out.
    """
    if not problem.own_rates:
        return new_problem
    rates_by_number = {problem.network.unit_number(unit): rate for unit, rate in problem.own_rates.items()}
    own_rates = {new_problem.network.unit_of_number(number): rate for number, rate in rates_by_number.items()}
    return replace(
        new_problem, own_rates={unit: rate for unit, rate in own_rates.items() if unit is not None}
    )
