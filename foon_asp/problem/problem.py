"""Problem: a network, a kitchen, goals, rates, prices and the container rule."""

from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from itertools import groupby
from os import PathLike
from pathlib import Path
from typing import NamedTuple, Protocol

from foon_asp.argument_checks import typed
from foon_asp.deadline import Deadline
from foon_asp.errors import UserError
from foon_asp.network import (
    STAND_IN,
    Amounts,
    FunctionalUnit,
    Network,
    ObjectNode,
    Source,
    StandInTable,
    TaskTree,
    UnitPrices,
)
from foon_asp.problem.container_rule import (
    DEFAULT_RULE,
    ContainerRule,
    conditions,
    network_makers,
    network_sides,
)
from foon_asp.problem.costs import Costs, tree_costs
from foon_asp.problem.items import Flow, UnitFlows, UsedUp, plain_flows
from foon_asp.problem.number import Number
from foon_asp.problem.objective import Measured, Objective, OptionalData
from foon_asp.problem.restriction import Restriction

Names = str | ObjectNode | Iterable[str | ObjectNode]
"""One object node or several: labels, one-line notation (``ice; crushed; in [drinking glass]``), or nodes."""

UnitPricesNamed = Mapping[str | FunctionalUnit, Number]
"""Prices of units, by motion and of single units."""


class Unpriced(NamedTuple):
    """The units of one motion that have no price: their number, and the source of the first unit."""

    motion: str
    units: int
    source: Source


class StandIns(NamedTuple):
    """The table that the stand-ins of a network come from.

    ``nearest``: whether the network has only those stand-ins that a best tree by dissimilarity can contain.
    Otherwise it has one for every pair of nodes in the table.
    """

    table: StandInTable
    nearest: bool


class Measure(Protocol):
    """A user measure: rules that assign a cost to each unit."""

    @property
    def name(self) -> str:
        """The name of the objective."""

    @property
    def text(self) -> str:
        """The text of the rules; empty for costs that are not defined by rules."""

    @property
    def place(self) -> str:
        """The file of the rules; for rules without a file, their name in messages."""

    def costs(self, problem: "Problem", deadline: Deadline | None = None) -> Sequence[int | Fraction]:
        """Return the exact cost of each unit of a problem, from 0.

        Raises :class:`UserError` for rules that assign two costs to a unit, or one that is no number.
        """


class Changes(NamedTuple):
    """Changes of the data of a problem; the fields are the parameters of :meth:`Problem.vary`."""

    kitchen: Names | Path | None = None
    adding: Names = ()
    without: Names = ()
    rates: Mapping[str, Number] | None = None
    unit_prices: UnitPricesNamed | None = None
    measures: "str | PathLike[str] | Iterable[str | PathLike[str]] | None" = None


class Origin(Protocol):
    """The data from which a problem was made, and from which similar problems can be made."""

    def vary_problem(
        self, problem: "Problem", goals: Names | None, containers: str | None, changes: Changes
    ) -> "Problem":
        """Return a variation of a problem with changed data; see :meth:`Problem.vary`."""

    @property
    def whole_network(self) -> Network:
        """The whole network; of a store, units and nodes are read at their first access."""

    def unpriced(self) -> Sequence[Unpriced]:
        """Return one entry for each motion of the whole network with units that have no price."""

    def extend_to_whole(self, problem: "Problem") -> "Problem":
        """Return the same problem over the whole network."""

    def extend_to_units(self, problem: "Problem", units: Iterable[FunctionalUnit]) -> "Problem":
        """Return the same problem over a network that is relevant to its goals and also has these units."""


@dataclass(frozen=True, eq=False, repr=False)
class Problem:
    """A planning problem over a network, with goals, a kitchen and a container rule.

    :meth:`foon_asp.Foon.problem` makes one from names.

    ``network``: the network; for a store, the part that is relevant to the goals.
    ``kitchen``, ``goals``: object node ids, positions in ``network.objects``. One tree has to make all goals.
    ``rates``: the success rate of every motion; ``None`` if rates are not known for all motions of the
    network.
    ``own_rates``: the rates of units, by id, that differ from the rate of their motion; see :meth:`rate`.
    ``unrated``: the error that lists the motions without a rate, if ``rates`` were ignored for this reason;
    else empty.
    ``utensils``: the labels of utensils, for the rule ``implied`` of ``containers``.
    ``unit_prices``: the prices of units, or ``None``; see :meth:`price`.
    ``measures``: the user measures by name; see :meth:`measure`.
    ``origin``: the data from which the problem was made; ``None`` for a problem made by hand.
    ``as_seen``: the problem whose rates and kitchen the user's rules see, if this problem has other rates or
    a larger kitchen; ``None`` if the rules see this problem.
    ``restriction``: the effect of rules on the network, for this question only; each variation needs its own.
    ``items``: the model in which items are used up; ``None`` if items last.
    ``starting``: whether no kitchen is named. Then the nodes that no unit makes out of others are available.
    ``stand_ins``: the source of the stand-ins of the network; ``None`` if it has none.
    ``amounts``: how many copies of a node units take and make; these count if items are used up.

    Example:
        >>> problem = foon_asp.load().problem("ice")
        >>> problem.vary(without="knife", containers="implied")
        <Problem: ice; crushed; in [drinking glass] (implied containers)>
        >>> tree = problem.tree([26, 27])
        >>> [unit.motion for unit in tree], problem.costs([26, 27]).units
        (['twist', 'crush'], 2)
        >>> str(problem.rate(27)), problem.vary(unit_prices={"twist": 1, "crush": "0.5"}).price(27)
        ('7/10', Fraction(1, 2))
        >>> inputs = foon_asp.Objective.INPUTS
        >>> problem.figure(inputs, 27), list(problem.figures(inputs, [26, 27]))
        (3, [3, 3])
        >>> str(problem.measured(27).rate)
        '7/10'
        >>> problem.at_hand(problem.goal_nodes[0]), problem.place(tree.units[0]).line, problem.stock_of(0)
        (False, 302, None)
        >>> sorted(map(str, problem.different_rates([26, 27]))), len(problem.about(tree).network)
        (['23/25', '7/10'], 220)
    """

    network: Network
    kitchen: frozenset[int]
    goals: tuple[int, ...]
    rates: Mapping[str, Fraction] | None
    utensils: frozenset[str]
    containers: ContainerRule = DEFAULT_RULE
    own_rates: Mapping[int, Fraction] = field(default_factory=dict)
    origin: Origin | None = field(default=None, kw_only=True)
    as_seen: "Problem | None" = field(default=None, kw_only=True)
    unit_prices: UnitPrices | None = field(default=None, kw_only=True)
    restriction: Restriction | None = field(default=None, kw_only=True)
    measures: Mapping[str, Measure] = field(default_factory=dict, kw_only=True)
    items: UsedUp | None = field(default=None, kw_only=True)
    starting: bool = field(default=False, kw_only=True)
    unrated: str = field(default="", kw_only=True)
    amounts: Amounts = field(default_factory=dict, kw_only=True)
    stand_ins: StandIns | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        """Drop repeated goals. If a motion of the network has no rate, drop all rates and set ``unrated``.

        Raises :class:`UserError` without goals.
        """
        if not self.goals:
            raise UserError("no goal is given")
        object.__setattr__(self, "goals", tuple(dict.fromkeys(self.goals)))
        if self.rates is not None and not self.rates.keys() >= set(self.network.motions):
            object.__setattr__(self, "unrated", unrated_text(first_sources(self.network), self.rates))
            object.__setattr__(self, "rates", None)

    @property
    def goal_nodes(self) -> tuple[ObjectNode, ...]:
        """The goals as object nodes."""
        return tuple(self.network.objects[goal] for goal in self.goals)

    def at_hand(self, node: ObjectNode) -> bool:
        """Return whether an object node is in the kitchen.

        It is ``False`` if the network lacks the node.

        Parameters:
            node: The object node.
        """
        return self.network.object_id(node) in self.kitchen

    @cached_property
    def whole(self) -> "Problem":
        """The same problem over the whole network, with all stand-ins; of a store, all of it is read.

        It is the problem itself if its network is whole already, or if the problem was made by hand.
        """
        nearest = self.stand_ins is not None and self.stand_ins.nearest
        is_part = self.network.object_numbers or nearest
        return self.origin.extend_to_whole(self) if self.origin is not None and is_part else self

    @property
    def plain(self) -> "Problem":
        """The same problem without ``origin``, so that it can be pickled for another process."""
        rates = None if self.rates is None else dict(self.rates)
        own_rates, measures = dict(self.own_rates), dict(self.measures)
        return replace(self, origin=None, rates=rates, own_rates=own_rates, measures=measures)

    def about(self, units: Iterable[FunctionalUnit]) -> "Problem":
        """Return this problem over a network that also has the given units.

        If the network is part of a store, the units are read from the store. Units that the store lacks are
        left out. If the network is no part of a store, this problem itself is returned.

        Parameters:
            units: The units.
        """
        is_part = self.origin is not None and self.network.object_numbers
        return self.origin.extend_to_units(self, units) if self.origin is not None and is_part else self

    @typed
    def vary(
        self,
        goals: Names | None = None,
        containers: str | None = None,
        *,
        kitchen: Names | Path | None = None,
        adding: Names = (),
        without: Names = (),
        rates: Mapping[str, Number] | None = None,
        unit_prices: UnitPricesNamed | None = None,
        measures: str | PathLike[str] | Iterable[str | PathLike[str]] | None = None,
    ) -> "Problem":
        """Return a variation of this problem: with other goals, container rule, kitchen, rates or prices.

        Nothing is read or indexed again, except the part of a store that the new problem needs in addition.
        ``None`` keeps what this problem has. Whether items are used up does not change. If they are, a new
        kitchen comes with its own stock.

        Parameters:
            goals: The new goals: one object node or several, by name or as :class:`ObjectNode`.
            containers: The new container rule, ``strict`` or ``implied``.
            kitchen: All available items: names, or a kitchen file as a :class:`~pathlib.Path`.
            adding: Names of object nodes to add to the kitchen.
            without: Names of object nodes to remove from the kitchen.
            rates: New success rates of some motions, above 0 and at most 1.
            unit_prices: New prices, from 0, of motions by name and of single units.
            measures: All user measures: files with rules for the costs of units, or the rules themselves.

        Raises:
            UserError: for a name that means no object node or several, a value out of range, or a problem
                made by hand. Use :func:`dataclasses.replace` to vary such a problem.
        """
        if self.origin is None:
            raise UserError("this problem was put together by hand: dataclasses.replace makes another of it")
        changes = Changes(kitchen, adding, without, rates, unit_prices, measures)
        return self.origin.vary_problem(self, goals, containers, changes)

    def place(self, unit: FunctionalUnit) -> Source:
        """Return the source of the first copy of a unit: its file and line.

        If the network lacks the unit, the file is ``-``.

        Parameters:
            unit: The unit.
        """
        number = self.network.unit_id(unit)
        return Source("-", 0) if number is None else self.network.sources[number][0]

    @property
    def conditions(self) -> str:
        """The conditions of every claim about this problem, in words: ``strict containers, stand-ins``."""
        text = conditions(self.containers, self.network.level, self.starting)
        text += "" if self.stand_ins is None else ", stand-ins"
        return text if self.items is None else f"{text}, items used up"

    @cached_property
    def needs(self) -> tuple[tuple[int, ...], ...]:
        """The preconditions of each unit: the ids of the inputs that it needs under the container rule."""
        return network_sides(self.network, self.containers, self.utensils)[0]

    @cached_property
    def gives(self) -> tuple[tuple[int, ...], ...]:
        """The add effects of each unit: the ids of its outputs, except inputs that the rule skips."""
        return network_sides(self.network, self.containers, self.utensils)[1]

    @cached_property
    def makers(self) -> Sequence[tuple[int, ...]]:
        """The achievers of each object node: the units that make it under the container rule, ascending.

        A restriction removes units, and appends each of its required sets as the achievers of an additional
        node.
        """
        makers = network_makers(self.network, self.containers, self.utensils)
        return makers if self.restriction is None else self.restriction.makers(makers)

    @cached_property
    def flows(self) -> Sequence[Flow]:
        """The preconditions and effects of each unit on copies, by unit id.

        If items are used up, the flow of a unit is computed at the first access to it. If items last, no unit
        uses up any copies, and all numbers of copies are 1.
        """
        items, network = self.items, self.network
        if items is None:
            return tuple(
                Flow(dict.fromkeys(needs, 1), {}, dict.fromkeys(gives, 1))
                for needs, gives in zip(self.needs, self.gives, strict=True)
            )
        plain = plain_flows(network, self.containers, self.utensils, frozenset(items.told.items()))
        if not self.amounts:
            return plain
        motions_with_amounts = {unit.motion for unit in self.amounts}

        def flow(unit: int) -> Flow:
            """Return the flow of a unit: by its stated amounts, or else from ``plain``."""
            has_amounts = network.motions[unit] in motions_with_amounts
            amounts = self.amounts.get(network.unit(unit)) if has_amounts else None
            if amounts is None:
                return plain[unit]
            return items.flow(network, unit, self.needs[unit], self.gives[unit], self.utensils, amounts)

        return UnitFlows(len(network), flow)

    def wanted(self, goal: int) -> int:
        """Return how many copies of a goal have to be available in the end; 1 if items last.

        Parameters:
            goal: The id of the goal.
        """
        return 1 if self.items is None else self.items.wanted.get(self.network.objects[goal], 1)

    @cached_property
    def counts_amounts(self) -> bool:
        """Whether some unit takes or makes several copies of a node, or several copies of a goal are wanted.

        False if items last.
        """
        if self.items is None:
            return False
        stated = (side for sides in self.amounts.values() for side in sides)
        return any(self.wanted(goal) > 1 for goal in self.goals) or any(
            n > 1 for side in stated for n in side.values()
        )

    def stock_of(self, o: int) -> int | None:
        """Return the number of copies of a kitchen item; ``None`` if it never runs out.

        Parameters:
            o: The id of the object node.
        """
        return None if self.items is None else self.items.stock.get(self.network.objects[o])

    @cached_property
    def kitchen_seen(self) -> frozenset[int]:
        """The ids of the kitchen items that the user's rules see.

        If ``as_seen`` is set, items outside its kitchen are left out.
        """
        return self.kitchen if self.as_seen is None else self.kitchen & self.as_seen.kitchen

    @cached_property
    def endless(self) -> frozenset[int]:
        """The ids of the kitchen items that never run out; if items last, these are all kitchen items."""
        if self.items is None:
            return self.kitchen
        return frozenset(o for o in self.kitchen if self.stock_of(o) is None)

    def copies_taken(self, plan: Iterable[int]) -> dict[int, int]:
        """Return the fewest copies of each consumable kitchen item with which a plan can be executed.

        The numbers are by object node id; the mapping is empty if items last. The number is 0 for an item
        that the plan does not need. If an item is a goal, the copies that are wanted in the end count as
        well.

        Parameters:
            plan: The ids of the units, in the order of execution.
        """
        required = dict.fromkeys(self.kitchen - self.endless, 0)
        if not required:
            return {}
        net_effects = dict.fromkeys(required, 0)
        for unit, run in groupby(plan):
            times = sum(1 for _ in run)
            asks, uses, adds = self.flows[unit]
            for o in required.keys() & {*asks, *adds}:
                change = adds.get(o, 0) - uses.get(o, 0)
                least = net_effects[o] + min(0, (times - 1) * change)  # before one of the executions
                required[o] = max(required[o], asks.get(o, 0) - least)
                net_effects[o] += times * change
        for o in required.keys() & self.goals:
            required[o] = max(required[o], self.wanted(o) - net_effects[o])
        return required

    @property
    def targets(self) -> tuple[int, ...]:
        """The ids of what a tree has to make: the goals, and an additional node for each required set.

        The ids of the additional nodes follow those of the network's object nodes.
        """
        size, restriction = len(self.network.objects), self.restriction
        return (*self.goals, *range(size, size + (len(restriction.required) if restriction else 0)))

    def __eq__(self, other: object) -> bool:
        """Return whether two problems are equal; networks are compared without the order of their files."""
        if not isinstance(other, Problem):
            return NotImplemented
        return self is other or (
            self._question == other._question
            and self.network.is_like(other.network)
            and self.restriction is other.restriction
        )

    def __hash__(self) -> int:
        return hash((self.kitchen, self.goals, self.containers, len(self.network)))

    @property
    def _question(self) -> tuple[object, ...]:
        """All properties that are compared for equality, except the network and the restriction."""
        measures = {name: measure.text for name, measure in self.measures.items()}
        rules = self.containers, self.utensils, self.items, self.starting, self.amounts
        values = self.rates, self.own_rates, self.unit_prices, measures, self.as_seen, self.stand_ins
        return self.kitchen, self.goals, *rules, *values

    def __repr__(self) -> str:
        return f"<Problem: {' + '.join(map(str, self.goal_nodes))} ({self.conditions})>"

    def require_known_for(self, objectives: Collection[Objective]) -> None:
        """Raise :class:`UserError` where data that objectives need are missing.

        Parameters:
            objectives: The objectives.

        Raises:
            UserError: if the rates, the prices of some units, or the rules of a measure are missing. Also if
                a rate is 0 and an objective divides by it.
        """
        for objective in objectives:
            if objective.row.needs is OptionalData.MEASURES and objective not in self.measures:
                raise UserError(
                    f"the objective {objective} needs the rules of its measure: "
                    "give them with --measure FILE or in Python load(..., measures=FILE)"
                )
        by_rates = [objective for objective in objectives if objective.row.needs is OptionalData.RATES]
        sums = [str(objective) for objective in by_rates if not objective.row.multiplies]
        if sums and 0 in {*(self.rates or {}).values(), *self.own_rates.values()}:
            raise UserError(
                f"a success rate is 0, for which the objective {sums[0]} has no value: leave it out"
            )
        if self.rates is None and by_rates:
            raise UserError(
                self.unrated
                or "the objective success needs the success rates of the motions: "
                "give a rates file, with --rates FILE or in Python load(..., rates=FILE)"
            )
        by_prices = [str(objective) for objective in objectives if objective.row.needs is OptionalData.PRICES]
        if by_prices and self.unit_prices is None:
            raise UserError(
                f"the objective {by_prices[0]} needs the prices of the units: "
                "give a file of prices, with --unit-prices FILE or in Python load(..., unit_prices=FILE)"
            )
        if by_prices and self.unpriced:
            raise UserError(_unpriced_text(self.unpriced))

    def has_stand_ins_for(self, objectives: Sequence[Objective]) -> bool:
        """Return whether the network has all stand-ins that a best tree by these objectives can contain.

        A network with only the nearest stand-ins has them if ``dissimilarity`` is the first objective. Any
        other network has them for all objectives.

        Parameters:
            objectives: The objectives, the most important first.
        """
        nearest = self.stand_ins is not None and self.stand_ins.nearest
        return not nearest or tuple(objectives[:1]) == (Objective.DISSIMILARITY,)

    def rate(self, unit: int) -> Fraction:
        """Return the success rate of a unit: its own, or else that of its motion.

        Parameters:
            unit: The id of the unit.

        Raises:
            ValueError: if no rates are known.
        """
        if self.rates is None:
            raise ValueError("no success rates are known")
        if unit in self.own_rates:
            return self.own_rates[unit]
        return self.rates[self.network.motions[unit]]

    @cached_property
    def prices(self) -> tuple[Fraction | None, ...]:
        """The price of each unit, by unit id; ``None`` for a unit without a price."""
        return (
            (None,) * len(self.network)
            if self.unit_prices is None
            else self.unit_prices.of_units(self.network)
        )

    def price(self, unit: int) -> Fraction:
        """Return the price of a unit.

        Parameters:
            unit: The id of the unit.

        Raises:
            ValueError: if its price is not known.
        """
        price = self.prices[unit]
        if price is None:
            raise ValueError(f"no price of unit {unit} is known")
        return price

    def dissimilarity(self, unit: int) -> Fraction:
        """Return the dissimilarity of a unit: by the table if it is a stand-in, 0 for other units.

        Parameters:
            unit: The id of the unit.

        Raises:
            ValueError: if the table has no price of the stand-in.
        """
        network = self.network
        if self.stand_ins is None or network.motions[unit] != STAND_IN:
            return Fraction(0)
        (serving,), (served,) = network.inputs[unit], network.outputs[unit]
        price = self.stand_ins.table.dissimilarity(network.objects[serving], network.objects[served])
        if price is None:
            raise ValueError(f"the table has no price of unit {unit}")
        return price

    def measure(self, name: str, unit: int) -> int | Fraction:
        """Return the cost of a unit by a user measure.

        Parameters:
            name: The name of the measure.
            unit: The id of the unit.

        Raises:
            ValueError: if the measure is unknown.
            UserError: if its rules are wrong.
        """
        return self._costs_by(name)[unit]

    @cached_property
    def _known_costs(self) -> dict[str, Sequence[int | Fraction]]:
        """The costs of the units by each measure that was computed, by name of measure.

        :meth:`apply_measures` fills the mapping.
        """
        return {}  # by measure

    def _costs_by(self, name: str) -> Sequence[int | Fraction]:
        """Return the cost of each unit by a measure; at the first access, all measures are computed.

        Raises ``ValueError`` for an unknown measure.
        """
        if name not in self.measures:
            raise ValueError(f"no measure {name} is known")
        self.apply_measures()
        return self._known_costs[name]

    def apply_measures(self, deadline: Deadline | None = None) -> None:
        """Compute the costs of all units by each measure that has not been computed yet, and keep them.

        Parameters:
            deadline: The limits; ``None`` for no limits.

        Raises:
            UserError: if rules are wrong.
            KeyboardInterrupt: at a limit.
        """
        for name in self.measures.keys() - self._known_costs.keys():
            self._known_costs[name] = self.measures[name].costs(self, deadline)

    @cached_property
    def unpriced(self) -> Sequence[Unpriced]:
        """One entry for each motion with units that have no price; of a store, the whole network counts."""
        network = self.network
        lacking = (unit for unit, price in enumerate(self.prices) if price is None)
        in_network = count_unpriced((network.motions[unit], network.sources[unit]) for unit in lacking)
        is_part = self.origin is not None and network.object_numbers
        return (self.origin.unpriced() if self.origin is not None and is_part else ()) or in_network

    def different_rates(self, units: Iterable[int]) -> set[Fraction]:
        """Return the distinct success rates of some units.

        Parameters:
            units: The ids of the units.

        Raises:
            ValueError: if no rates are known.
        """
        own, motions = self.own_rates, self.network.motions
        units = list(units)
        unit_of_motion = {motions[unit]: unit for unit in units if unit not in own}
        return {
            self.rate(unit) for unit in (*unit_of_motion.values(), *(unit for unit in units if unit in own))
        }

    def tree(self, units: Iterable[int]) -> TaskTree:
        """Return the task tree that consists of the given units.

        Parameters:
            units: The ids of the units, in the order of the tree.
        """
        return TaskTree(tuple(self.network.unit(unit) for unit in units))

    def costs(self, units: Iterable[int]) -> Costs:
        """Return the costs of a tree or, where items are used up, of a plan.

        For a tree, each unit counts once. For a plan, each execution counts, as does each copy of a
        consumable kitchen item that the plan requires. Objectives for which data are missing have no value.

        Parameters:
            units: The ids of the units; for a plan in the order of execution, with repeats.
        """
        plan = list(units)
        counts = dict.fromkeys(sorted(plan), 1) if self.items is None else Counter(plan)
        items = len({o for unit in counts for o in self.needs[unit] if o in self.endless})
        if self.items is not None:
            items += sum(self.copies_taken(plan).values())
        available = {OptionalData.MEASURES} | ({OptionalData.RATES} if self.rates is not None else set())
        if self.unit_prices is not None and all(self.prices[unit] is not None for unit in counts):
            available.add(OptionalData.PRICES)
        if self.stand_ins is not None:
            available.add(OptionalData.STAND_INS)
        user_objectives = map(Objective.of_measure, self.measures)
        return tree_costs({self.measured(u): n for u, n in counts.items()}, items, available, user_objectives)

    def measured(self, unit: int) -> Measured:
        """Return a unit with the properties that objectives read.

        Parameters:
            unit: The id of the unit.
        """
        return _MeasuredUnit(self, unit)

    def figure(self, objective: Objective, unit: int) -> int | Fraction:
        """Return the cost of one unit by an objective; for an objective that multiplies, its factor.

        Parameters:
            objective: The objective.
            unit: The id of the unit.

        Raises:
            ValueError: if a rate or price is missing that the objective needs.
        """
        return objective.row.unit(_MeasuredUnit(self, unit))

    def figures(self, objective: Objective, units: Iterable[int]) -> Iterable[int | Fraction]:
        """Return the cost of each of some units, in their order; see :meth:`figure`.

        Figures of built-in objectives are computed, and errors raised, only when the result is iterated over.

        Parameters:
            objective: The objective.
            units: The ids of the units.

        Raises:
            ValueError: if a rate, price or measure is missing that the objective needs.
        """
        if objective.row.needs is OptionalData.MEASURES:
            return map(self._costs_by(objective).__getitem__, units)
        return (self.figure(objective, unit) for unit in units)


class _MeasuredUnit(NamedTuple):
    """A unit of a problem, given by id, with the properties that objectives read."""

    problem: Problem
    unit: int

    @property
    def inputs(self) -> Iterable[ObjectNode]:
        """The input object nodes."""
        network = self.problem.network
        return map(network.objects.__getitem__, network.inputs[self.unit])

    @property
    def rate(self) -> Fraction:
        """The success rate."""
        return self.problem.rate(self.unit)

    @property
    def price(self) -> Fraction:
        """The price."""
        return self.problem.price(self.unit)

    @property
    def dissimilarity(self) -> Fraction:
        """The dissimilarity of the unit if it is a stand-in; 0 for other units."""
        return self.problem.dissimilarity(self.unit)

    def measure(self, name: str) -> int | Fraction:
        """Return the cost by the user measure of this name."""
        return self.problem.measure(name, self.unit)


def for_each_goal(problem: Problem) -> list[Problem]:
    """Return one problem for each goal, in the order of the goals.

    Each problem has only this goal. Prices that were already computed are shared with the new problems.
    """
    shared = {name: value for name, value in vars(problem).items() if name in {"prices", "unpriced"}}
    problems = [replace(problem, goals=(goal,)) for goal in problem.goals]
    for single in problems:
        vars(single).update(shared)
    return problems


def count_unpriced(units: Iterable[tuple[str, Sequence[Source]]]) -> list[Unpriced]:
    """Return the number of units without a price for each motion, with the source of the first such unit.

    ``units`` has the motion and the sources of each unit without a price. For a unit without sources, the
    file of the source is ``-``.
    """
    by_motion: dict[str, Unpriced] = {}
    for motion, sources in units:
        counted = by_motion.get(motion) or Unpriced(motion, 0, sources[0] if sources else Source("-", 0))
        by_motion[motion] = counted._replace(units=counted.units + 1)
    return list(by_motion.values())


def _unpriced_text(lacking: Sequence[Unpriced], max_lines: int = 10) -> str:
    """Return the error message that units have no price; it lists at most ``max_lines`` motions."""
    lines = []
    for motion, units, source in lacking[:max_lines]:
        others = "" if units == 1 else f", nor have {units - 1} more with this motion"
        lines.append(f"{source}:1: error: the unit {motion!r} has no price{others}")
    if len(lacking) > max_lines:
        lines.append(f"... and units of {len(lacking) - max_lines} more motions")
    lines.append(
        "add a line with the motion, a tab and its price to the file of prices (unit_prices.txt), or one for "
        "the single unit (docs/formats.md)"
    )
    return "\n".join(lines)


def first_sources(network: Network) -> Iterable[tuple[str, Source]]:
    """Yield the motion of each unit, and the source of its first copy.

    For a unit without sources, the file of the source is ``-``.
    """
    for motion, copies in zip(network.motions, network.sources, strict=True):
        yield motion, copies[0] if copies else Source("-", 0)


def unrated_text(
    motions: Iterable[tuple[str, Source]], rates: Mapping[str, Fraction], max_lines: int = 10
) -> str:
    """Return the error message that lists motions without a success rate; empty if every motion has one.

    ``motions`` are pairs of a motion and the source of a unit. The message shows the first source of each
    motion, and lists at most ``max_lines`` motions.
    """
    missing: dict[str, Source] = {}
    for motion, source in motions:
        if motion not in rates:
            missing.setdefault(motion, source)
    if not missing:
        return ""
    lines = [
        f"{source}:1: error: the motion {motion!r} has no success rate"
        for motion, source in list(missing.items())[:max_lines]
    ]
    if len(missing) > max_lines:
        lines.append(f"... and {len(missing) - max_lines} more motions")
    lines.append("add a line with the motion, a tab and its rate to the rates file (motion.txt)")
    return "\n".join(lines)


def unrated_remarks(motions: Iterable[tuple[str, Source]], rates: Mapping[str, Fraction]) -> list[str]:
    """Return a list with one warning, which names up to four motions without a success rate.

    The list is empty if all motions have a rate. ``motions`` are pairs of a motion and the source of a unit.
    """
    lacking = [
        repr(motion) for motion in dict.fromkeys(motion for motion, _ in motions) if motion not in rates
    ]
    if not lacking:
        return []
    named = ", ".join(lacking[:4])
    if len(lacking) > 4:
        named += f" and {len(lacking) - 4} more"
    return [f"warning: no success is known, since the rates file has no rate for {named}"]
