"""One question: a network, a kitchen, goals, rates, prices and the container rule."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import NamedTuple, Protocol

from foon_asp.deadline import Deadline
from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, Network, ObjectNode, Source, TaskTree, UnitPrices
from foon_asp.problem.containers import (
    ContainerRule,
    conditions,
    network_makers,
    network_sides,
)
from foon_asp.problem.costs import Costs, tree_costs
from foon_asp.problem.items import Flow, UsedUp
from foon_asp.problem.number import Number
from foon_asp.problem.objective import Known, Measured, Objective
from foon_asp.problem.restriction import Restriction
from foon_asp.typed import typed

_NAMED = 4  # motions that a remark names

Names = str | ObjectNode | Iterable[str | ObjectNode]
"""One object node or several: labels, one-line notation (``ice; crushed; in [drinking glass]``), or nodes."""

UnitPricesNamed = Mapping[str | FunctionalUnit, Number]
"""Prices of units, by motion and of single units."""


class Unpriced(NamedTuple):
    """Units of one motion that have no price: how many, and where the first was read."""

    motion: str
    units: int
    source: Source


class Measure(Protocol):
    """A measure of the user's own: rules that say what each unit costs."""

    @property
    def name(self) -> str:
        """The name of the objective."""

    @property
    def text(self) -> str:
        """The rules."""

    @property
    def place(self) -> str:
        """The file of the rules, or what messages call them."""

    def costs(self, problem: "Problem", deadline: Deadline | None = None) -> Sequence[int | Fraction]:
        """Give what each unit of a problem costs, exactly and never below 0.

        Raises :class:`UserError` for rules that give a unit two costs, or none that is a number.
        """


class Changes(NamedTuple):
    """What varies of the data that a problem was posed of; see :meth:`foon_asp.Foon.vary`."""

    kitchen: Names | Path | None = None
    adding: Names = ()
    without: Names = ()
    rates: Mapping[str, Number] | None = None
    unit_prices: UnitPricesNamed | None = None
    measures: "str | PathLike[str] | Iterable[str | PathLike[str]] | None" = None


class Origin(Protocol):
    """The data that a problem was posed of."""

    def posed_anew(
        self, problem: "Problem", goals: Names | None, containers: str | None, changes: Changes
    ) -> "Problem":
        """Pose a problem of these data with changes; see :meth:`Problem.vary`."""

    @property
    def whole_network(self) -> Network:
        """The whole network; of a store, units and nodes are read when they are looked at."""

    def unpriced(self) -> Sequence[Unpriced]:
        """Give the units of the whole network that have no price."""

    def posed_whole(self, problem: "Problem") -> "Problem":
        """Pose a problem of these data over the whole network."""

    def posed_about(self, problem: "Problem", units: Iterable[FunctionalUnit]) -> "Problem":
        """Pose a problem of these data over what its goals and these units are made of."""


@dataclass(frozen=True, eq=False, repr=False)
class Problem:
    """A question to ask: goals, a kitchen and a container rule, over a network.

    :meth:`foon_asp.Foon.problem` makes one from names. ``kitchen`` and ``goals`` are object node ids,
    positions in ``network.objects``; one tree has to make all goals. ``rates`` has the success rate of every
    motion, or is ``None`` if none are known. ``utensils`` are the labels that the rule ``implied`` of
    ``containers`` is about. ``own_rates`` has, by id, the rates of units that differ from that of their
    motion; :meth:`rate` gives the rate of any unit. ``unit_prices`` are the prices of units, or ``None``;
    :meth:`price` gives that of a unit. For a store, ``network`` is the part that can matter for the goals.
    ``measures`` are those of the user's own, by the name of the objective; :meth:`measure` gives what a unit
    costs by one. ``origin`` is the data that it was made from, or ``None`` for a problem made by hand.
    ``as_seen`` is the problem whose rates the user's rules look at, if others are used, and whose kitchen, if
    there is more in this one. ``restriction`` is
    what rules leave of the network, for this question only: a variation of it has to find its own.
    ``items`` says that items are used up, and which; ``None`` if they last. ``starting`` says that no kitchen
    was given, so that what no unit makes out of others is at hand. Rates that lack a motion of the network
    are set aside, and ``unrated`` says which they lack.

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
    containers: ContainerRule = ContainerRule.STRICT
    own_rates: Mapping[int, Fraction] = field(default_factory=dict)
    origin: Origin | None = field(default=None, kw_only=True)
    as_seen: "Problem | None" = field(default=None, kw_only=True)
    unit_prices: UnitPrices | None = field(default=None, kw_only=True)
    restriction: Restriction | None = field(default=None, kw_only=True)
    measures: Mapping[str, Measure] = field(default_factory=dict, kw_only=True)
    items: UsedUp | None = field(default=None, kw_only=True)
    starting: bool = field(default=False, kw_only=True)
    unrated: str = field(default="", kw_only=True)

    def __post_init__(self) -> None:
        if not self.goals:
            raise UserError("no goal is given")
        object.__setattr__(self, "goals", tuple(dict.fromkeys(self.goals)))
        if self.rates is not None and not self.rates.keys() >= set(self.network.motions):
            object.__setattr__(self, "unrated", unrated_text(first_places(self.network), self.rates))
            object.__setattr__(self, "rates", None)

    @property
    def goal_nodes(self) -> tuple[ObjectNode, ...]:
        """The goals as object nodes."""
        return tuple(self.network.objects[goal] for goal in self.goals)

    def at_hand(self, node: ObjectNode) -> bool:
        """Whether an object node is in the kitchen.

        Parameters:
            node: The object node.
        """
        return self.network.object_id(node) in self.kitchen

    @cached_property
    def whole(self) -> "Problem":
        """The same problem over the whole network: of a store, all of it is read."""
        part = self.origin is not None and self.network.object_numbers
        return self.origin.posed_whole(self) if self.origin is not None and part else self

    @property
    def plain(self) -> "Problem":
        """The same problem without the data it was posed of, as another process can be handed it."""
        rates = None if self.rates is None else dict(self.rates)
        own_rates, measures = dict(self.own_rates), dict(self.measures)
        return replace(self, origin=None, rates=rates, own_rates=own_rates, measures=measures)

    def about(self, units: Iterable[FunctionalUnit]) -> "Problem":
        """Give the same problem over a network that has some units, as far as the data has them.

        For a store, what the units consist of is read.

        Parameters:
            units: The units.
        """
        part = self.origin is not None and self.network.object_numbers
        return self.origin.posed_about(self, units) if self.origin is not None and part else self

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
        """Give the same problem with other goals, container rule, kitchen, rates, prices or measures.

        Nothing is read or indexed again, except that a store is read as far as the new problem needs more.
        Whether items are used up stays as it is.

        Parameters:
            goals: The new goals: one object node or several, by name or as :class:`ObjectNode`.
            containers: The new container rule, ``strict`` or ``implied``.
            kitchen: Everything at hand: names, or a kitchen file as a :class:`~pathlib.Path`.
            adding: Names of object nodes to add to the kitchen.
            without: Names of object nodes to remove from the kitchen.
            rates: New success rates of some motions, above 0 and at most 1.
            unit_prices: New prices, from 0, of motions by name and of single units.
            measures: All measures of your own: files with rules for what units cost, or the rules themselves.

        Raises:
            UserError: for a name that means no object node or several, a value out of range, or a problem
                made by hand, which :func:`dataclasses.replace` varies.
        """
        if self.origin is None:
            raise UserError("this problem was put together by hand: dataclasses.replace makes another of it")
        changes = Changes(kitchen, adding, without, rates, unit_prices, measures)
        return self.origin.posed_anew(self, goals, containers, changes)

    def place(self, unit: FunctionalUnit) -> Source:
        """Give the first place where a unit was read, or a place in no file if the network does not have it.

        Parameters:
            unit: The unit.
        """
        number = self.network.unit_id(unit)
        return Source("-", 0) if number is None else self.network.sources[number][0]

    @property
    def conditions(self) -> str:
        """What every claim about this question holds under, in a few words: ``strict containers``."""
        said = conditions(self.containers, self.network.level, self.starting)
        return said if self.items is None else f"{said}, items used up"

    @cached_property
    def needs(self) -> tuple[tuple[int, ...], ...]:
        """For each unit, the ids of the inputs that the container rule asks for."""
        return network_sides(self.network, self.containers, self.utensils)[0]

    @cached_property
    def gives(self) -> tuple[tuple[int, ...], ...]:
        """For each unit, the ids of the outputs that it makes: all but the inputs it may skip."""
        return network_sides(self.network, self.containers, self.utensils)[1]

    @cached_property
    def makers(self) -> Sequence[tuple[int, ...]]:
        """For each object node, the units that make it under the container rule, in order.

        A restriction removes units, and adds the units of each required set, as if they made one node more.
        """
        makers = network_makers(self.network, self.containers, self.utensils)
        return makers if self.restriction is None else self.restriction.makers(makers)

    @cached_property
    def flows(self) -> tuple[Flow, ...]:
        """For each unit, what it asks for, uses up and adds; where items last, it uses up nothing."""
        items, network = self.items, self.network
        if items is None:
            return tuple(Flow(needs, (), gives) for needs, gives in zip(self.needs, self.gives, strict=True))
        return tuple(
            items.flow(network, unit, self.needs[unit], self.gives[unit], self.utensils)
            for unit in range(len(network))
        )

    def stock_of(self, o: int) -> int | None:
        """Give how many copies of a kitchen item there are, ``None`` where it never runs out.

        Parameters:
            o: The id of the object node.
        """
        return None if self.items is None else self.items.stock.get(self.network.objects[o])

    @cached_property
    def kitchen_seen(self) -> frozenset[int]:
        """What is at hand as the user's rules see it: what is only taken to be there is not part of it."""
        return self.kitchen if self.as_seen is None else self.kitchen & self.as_seen.kitchen

    @cached_property
    def endless(self) -> frozenset[int]:
        """The ids of the object nodes that never run out: where items last, all of the kitchen."""
        return frozenset(o for o in self.kitchen if self.stock_of(o) is None)

    def copies_taken(self, plan: Iterable[int]) -> dict[int, int]:
        """Give how many copies of each kitchen item that may run out a plan cannot do without.

        Parameters:
            plan: The ids of the units, in the order of execution.
        """
        taken = dict.fromkeys(self.kitchen - self.endless, 0)
        made = dict.fromkeys(taken, 0)
        for unit in plan:
            asks, uses, adds = self.flows[unit]
            for o in taken.keys() & asks:
                taken[o] = max(taken[o], 1 - made[o])
            for o in made.keys() & uses:
                made[o] -= 1
            for o in made.keys() & adds:
                made[o] += 1
        for o in taken.keys() & self.goals:
            taken[o] = max(taken[o], 1 - made[o])
        return taken

    @property
    def targets(self) -> tuple[int, ...]:
        """What a tree has to make: the goals, and one node more for each set that a restriction requires."""
        size, restriction = len(self.network.objects), self.restriction
        return (*self.goals, *range(size, size + (len(restriction.required) if restriction else 0)))

    def __eq__(self, other: object) -> bool:
        """Whether the same is asked: of an equal network, whichever file was read or built first."""
        if not isinstance(other, Problem):
            return NotImplemented
        return self is other or (
            self._asked == other._asked
            and self.network.is_like(other.network)
            and self.restriction is other.restriction
        )

    def __hash__(self) -> int:
        return hash((self.kitchen, self.goals, self.containers, len(self.network)))

    @property
    def _asked(self) -> tuple[object, ...]:
        """All that is asked, but for the network."""
        measures = {name: measure.text for name, measure in self.measures.items()}
        rules = self.containers, self.utensils, self.items, self.starting
        values = self.rates, self.own_rates, self.unit_prices, measures, self.as_seen
        return self.kitchen, self.goals, *rules, *values

    def __repr__(self) -> str:
        return f"<Problem: {' + '.join(map(str, self.goal_nodes))} ({self.conditions})>"

    def require_known_for(self, objectives: Collection[Objective]) -> None:
        """Require the rates and prices that objectives need.

        Parameters:
            objectives: The objectives.

        Raises:
            UserError: if rates, prices or the rules of a measure are missing, or if a rate is 0 and an
                objective has no value then.
        """
        for each in objectives:
            if each.row.needs is Known.MEASURES and each not in self.measures:
                raise UserError(
                    f"the objective {each} needs the rules of its measure: "
                    "give them with --measure FILE or in Python load(..., measures=FILE)"
                )
        by_rates = [each for each in objectives if each.row.needs is Known.RATES]
        sums = [str(each) for each in by_rates if not each.row.multiplies]
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
        by_prices = [str(each) for each in objectives if each.row.needs is Known.PRICES]
        if by_prices and self.unit_prices is None:
            raise UserError(
                f"the objective {by_prices[0]} needs the prices of the units: "
                "give a file of prices, with --unit-prices FILE or in Python load(..., unit_prices=FILE)"
            )
        if by_prices and self.unpriced:
            raise UserError(_unpriced_text(self.unpriced))

    def rate(self, unit: int) -> Fraction:
        """Give the success rate of a unit: its own, or that of its motion.

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
        """The price of each unit, ``None`` where it has none."""
        return (
            (None,) * len(self.network)
            if self.unit_prices is None
            else self.unit_prices.of_units(self.network)
        )

    def price(self, unit: int) -> Fraction:
        """Give the price of a unit.

        Parameters:
            unit: The id of the unit.

        Raises:
            ValueError: if its price is not known.
        """
        price = self.prices[unit]
        if price is None:
            raise ValueError(f"no price of unit {unit} is known")
        return price

    def measure(self, name: str, unit: int) -> int | Fraction:
        """Give what a unit costs by a measure of the user's own.

        Parameters:
            name: The name of the measure.
            unit: The id of the unit.

        Raises:
            ValueError: if there is no such measure.
            UserError: if its rules are wrong.
        """
        return self._costs_by(name)[unit]

    @cached_property
    def _known_costs(self) -> dict[str, Sequence[int | Fraction]]:
        return {}  # by measure

    def _costs_by(self, name: str) -> Sequence[int | Fraction]:
        """Give what each unit costs by a measure, worked out when it is first asked for."""
        if name not in self.measures:
            raise ValueError(f"no measure {name} is known")
        self.apply_measures()
        return self._known_costs[name]

    def apply_measures(self, deadline: Deadline | None = None) -> None:
        """Work out what units cost by the measures, unless it is known.

        Parameters:
            deadline: The limits.

        Raises:
            UserError: if rules are wrong.
            KeyboardInterrupt: at a limit.
        """
        for name in self.measures.keys() - self._known_costs.keys():
            self._known_costs[name] = self.measures[name].costs(self, deadline)

    @cached_property
    def unpriced(self) -> Sequence[Unpriced]:
        """The units that have no price, by motion: of a store, those of all of it."""
        network = self.network
        lacking = (unit for unit, price in enumerate(self.prices) if price is None)
        found = count_unpriced((network.motions[unit], network.sources[unit]) for unit in lacking)
        part = self.origin is not None and network.object_numbers
        return (self.origin.unpriced() if self.origin is not None and part else ()) or found

    def different_rates(self, units: Iterable[int]) -> set[Fraction]:
        """Give the success rates of some units, each once.

        Parameters:
            units: The ids of the units.

        Raises:
            ValueError: if no rates are known.
        """
        own, motions = self.own_rates, self.network.motions
        units = list(units)
        first = {motions[unit]: unit for unit in units if unit not in own}
        return {self.rate(unit) for unit in (*first.values(), *(unit for unit in units if unit in own))}

    def tree(self, units: Iterable[int]) -> TaskTree:
        """Make a tree from units.

        Parameters:
            units: The ids of the units, in the order of the tree.
        """
        return TaskTree(tuple(self.network.unit(unit) for unit in units))

    def costs(self, units: Iterable[int]) -> Costs:
        """Compute what a tree or a plan costs.

        Each unit of a tree counts once. Where items are used up, each execution counts, and so does each copy
        that cannot be done without of kitchen items that may run out.

        Parameters:
            units: The ids of the units; of a plan in the order of execution, with repeats.
        """
        chosen = sorted(set(units)) if self.items is None else list(units)
        taken = len({o for unit in chosen for o in self.needs[unit] if o in self.endless})
        if self.items is not None:
            taken += sum(self.copies_taken(chosen).values())
        known = {Known.MEASURES} | ({Known.RATES} if self.rates is not None else set())
        if self.unit_prices is not None and all(self.prices[unit] is not None for unit in chosen):
            known.add(Known.PRICES)
        more = map(Objective.of_measure, self.measures)
        return tree_costs(list(map(self.measured, chosen)), taken, known, more)

    def measured(self, unit: int) -> Measured:
        """Give a unit as objectives look at it.

        Parameters:
            unit: The id of the unit.
        """
        return _MeasuredUnit(self, unit)

    def figure(self, objective: Objective, unit: int) -> int | Fraction:
        """Give what a unit alone costs by an objective that adds up or multiplies costs of units.

        Parameters:
            objective: The objective.
            unit: The id of the unit.

        Raises:
            ValueError: if a rate or price is missing that the objective needs.
        """
        return objective.row.unit(_MeasuredUnit(self, unit))

    def figures(self, objective: Objective, units: Iterable[int]) -> Iterable[int | Fraction]:
        """Give what each of some units costs, as :meth:`figure` does.

        Parameters:
            objective: The objective.
            units: The ids of the units.

        Raises:
            ValueError: if a rate, price or measure is missing that the objective needs.
        """
        if objective.row.needs is Known.MEASURES:
            return map(self._costs_by(objective).__getitem__, units)
        return (self.figure(objective, unit) for unit in units)


class _MeasuredUnit(NamedTuple):
    """A unit of a problem, as objectives look at it."""

    problem: Problem
    unit: int

    @property
    def inputs(self) -> Iterable[ObjectNode]:
        """Its input object nodes."""
        network = self.problem.network
        return map(network.objects.__getitem__, network.inputs[self.unit])

    @property
    def rate(self) -> Fraction:
        """Its success rate."""
        return self.problem.rate(self.unit)

    @property
    def price(self) -> Fraction:
        """Its price."""
        return self.problem.price(self.unit)

    def measure(self, name: str) -> int | Fraction:
        """What it costs by a measure of the user's."""
        return self.problem.measure(name, self.unit)


def count_unpriced(units: Iterable[tuple[str, Sequence[Source]]]) -> list[Unpriced]:
    """Count units, of each the motion and the places of its copies, by motion."""
    found: dict[str, Unpriced] = {}
    for motion, sources in units:
        before = found.get(motion) or Unpriced(motion, 0, sources[0] if sources else Source("-", 0))
        found[motion] = before._replace(units=before.units + 1)
    return list(found.values())


def _unpriced_text(lacking: Sequence[Unpriced]) -> str:
    """Say which units have no price, and what to do."""
    lines = []
    for motion, units, source in lacking[:10]:
        more = "" if units == 1 else f", nor have {units - 1} more with this motion"
        lines.append(f"{source}:1: error: the unit {motion!r} has no price{more}")
    if len(lacking) > 10:
        lines.append(f"... and units of {len(lacking) - 10} more motions")
    lines.append(
        "add a line with the motion, a tab and its price to the file of prices (unit_prices.txt), or one for "
        "the single unit (docs/formats.md)"
    )
    return "\n".join(lines)


def first_places(network: Network) -> Iterable[tuple[str, Source]]:
    """Give the motion of each unit, and where it was first read."""
    for motion, copies in zip(network.motions, network.sources, strict=True):
        yield motion, copies[0] if copies else Source("-", 0)


def unrated_text(motions: Iterable[tuple[str, Source]], rates: Mapping[str, Fraction]) -> str:
    """Name every motion without a success rate and where it was first read; empty where all have one.

    ``motions`` may name a motion again; what counts is its first place.
    """
    missing: dict[str, Source] = {}
    for motion, source in motions:
        if motion not in rates:
            missing.setdefault(motion, source)
    if not missing:
        return ""
    lines = [
        f"{source}:1: error: the motion {motion!r} has no success rate"
        for motion, source in list(missing.items())[:10]
    ]
    if len(missing) > 10:
        lines.append(f"... and {len(missing) - 10} more motions")
    lines.append("add a line with the motion, a tab and its rate to the rates file (motion.txt)")
    return "\n".join(lines)


def unrated_remarks(motions: Iterable[tuple[str, Source]], rates: Mapping[str, Fraction]) -> list[str]:
    """Say that some motions have no success rate, so that no success is known."""
    lacking = [
        repr(motion) for motion in dict.fromkeys(motion for motion, _ in motions) if motion not in rates
    ]
    if not lacking:
        return []
    more = f" and {len(lacking) - _NAMED} more" if len(lacking) > _NAMED else ""
    named = f"{', '.join(lacking[:_NAMED])}{more}"
    return [f"warning: no success is known, since the rates file has no rate for {named}"]
