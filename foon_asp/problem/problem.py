"""One question: a network, a kitchen, goals, rates and the container rule."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import NamedTuple, Protocol

from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, Network, ObjectNode, Source, TaskTree
from foon_asp.problem.containers import (
    ContainerRule,
    conditions,
    network_gives,
    network_makers,
    network_needs,
)
from foon_asp.problem.costs import Costs, tree_costs
from foon_asp.problem.number import Number
from foon_asp.problem.objective import Measured, Objective

Names = str | ObjectNode | Iterable[str | ObjectNode]
"""One object node or several: labels, one-line notation (``ice; crushed; in [drinking glass]``), or nodes."""


class Origin(Protocol):
    """The data that a problem was posed of."""

    def posed_anew(
        self,
        problem: "Problem",
        goals: Names | None,
        containers: str | None,
        *,
        kitchen: Names | Path | None,
        adding: Names,
        without: Names,
        rates: Mapping[str, Number] | None,
    ) -> "Problem":
        """Pose a problem of these data with changes; see :meth:`Problem.vary`."""

    def posed_whole(self, problem: "Problem") -> "Problem":
        """Pose a problem of these data over the whole network."""

    def posed_about(self, problem: "Problem", units: Iterable[FunctionalUnit]) -> "Problem":
        """Pose a problem of these data over what its goals and these units are made of."""


@dataclass(frozen=True, eq=False, repr=False)
class Problem:
    """What is asked, before any cut: goals, a kitchen and a container rule, over a network.

    :meth:`foon_asp.Foon.problem` makes one from names. ``kitchen`` and ``goals`` are object node ids, places
    in ``network.objects``; all goals have to be made by one tree; a goal that is named again counts once.
    ``rates`` gives the success rate of every motion, or is ``None`` where none are known. ``utensils``
    are the labels that the rule ``implied`` looks at. ``own_rates`` gives, by id, the rates of units that
    do not have that of their motion, as those that somebody else does; ask :meth:`rate` for any. Of a store,
    ``network`` is the part that can matter for the goals. ``origin`` is the data that it was posed of,
    ``None`` for a problem put together by hand. ``as_seen`` is the problem whose rates rules of the user's
    look at, where others count.
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

    def __post_init__(self) -> None:
        if not self.goals:
            raise UserError("no goal is given")
        object.__setattr__(self, "goals", tuple(dict.fromkeys(self.goals)))
        if self.rates is not None and not self.rates.keys() >= set(self.network.motions):
            network = self.network
            sources = (copies[0] for copies in network.sources)
            require_rates(zip(network.motions, sources, strict=True), self.rates)

    @property
    def goal_nodes(self) -> tuple[ObjectNode, ...]:
        """The goals as object nodes."""
        return tuple(self.network.objects[goal] for goal in self.goals)

    def at_hand(self, node: ObjectNode) -> bool:
        """Whether the kitchen has an object node."""
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
        return replace(self, origin=None, rates=rates, own_rates=dict(self.own_rates))

    def about(self, units: Iterable[FunctionalUnit]) -> "Problem":
        """Give the same problem over a network that has these units, as far as it is known to have them.

        Of a store, what they are made of is read.
        """
        part = self.origin is not None and self.network.object_numbers
        return self.origin.posed_about(self, units) if self.origin is not None and part else self

    def vary(
        self,
        goals: Names | None = None,
        containers: str | None = None,
        *,
        kitchen: Names | Path | None = None,
        adding: Names = (),
        without: Names = (),
        rates: Mapping[str, Number] | None = None,
    ) -> "Problem":
        """Give the same problem with other goals, another container rule, kitchen or rates.

        Nothing is read again, and nothing of the network is looked up anew; a store is read as far as the
        new question goes beyond the old one. The kitchen varies as in :meth:`foon_asp.Foon.vary`. Raises
        :class:`UserError` for names that mean nothing or too much, and for a problem put together by hand,
        of which :func:`dataclasses.replace` makes another.
        """
        if self.origin is None:
            raise UserError("this problem was put together by hand: dataclasses.replace makes another of it")
        return self.origin.posed_anew(
            self, goals, containers, kitchen=kitchen, adding=adding, without=without, rates=rates
        )

    def place(self, unit: FunctionalUnit) -> Source:
        """Give the first place where a unit was read; one of no network stands in no file."""
        number = self.network.unit_id(unit)
        return Source("-", 0) if number is None else self.network.sources[number][0]

    @property
    def conditions(self) -> str:
        """What every claim about this question holds under, in a few words: ``strict containers``."""
        return conditions(self.containers, self.network.level)

    @cached_property
    def needs(self) -> tuple[tuple[int, ...], ...]:
        """For each unit, the ids of the inputs that the container rule asks for."""
        return network_needs(self.network, self.containers, self.utensils)

    @cached_property
    def gives(self) -> tuple[tuple[int, ...], ...]:
        """For each unit, the ids of the outputs that it makes: all but the inputs it may skip."""
        return network_gives(self.network, self.containers, self.utensils)

    @cached_property
    def makers(self) -> tuple[tuple[int, ...], ...]:
        """For each object node, the units that make it under the container rule, in order."""
        return network_makers(self.network, self.containers, self.utensils)

    def __repr__(self) -> str:
        return f"<Problem: {' + '.join(map(str, self.goal_nodes))} ({self.conditions})>"

    def require_rates_for(self, objectives: Collection[Objective]) -> None:
        """Raise :class:`UserError` where one of the objectives needs success rates and none are known.

        So it does where one adds up what units cost by rates, and a rate is 0.
        """
        sums = [str(each) for each in objectives if each.row.needs_rates and not each.row.multiplies]
        if sums and 0 in {*(self.rates or {}).values(), *self.own_rates.values()}:
            raise UserError(
                f"a success rate is 0, by which the objective {sums[0]} has no number: leave it out"
            )
        if self.rates is None and any(objective.row.needs_rates for objective in objectives):
            raise UserError(
                "the objective success needs the success rates of the motions: "
                "give a rates file, with --rates FILE or in Python load(..., rates=FILE)"
            )

    def rate(self, unit: int) -> Fraction:
        """Give the success rate of a unit: its own where it has one, else that of its motion.

        Raises ``ValueError`` where no rates are known.
        """
        if self.rates is None:
            raise ValueError("no success rates are known")
        if unit in self.own_rates:
            return self.own_rates[unit]
        return self.rates[self.network.motions[unit]]

    def different_rates(self, units: Iterable[int]) -> set[Fraction]:
        """Give the rates that some units have, each once; raises ``ValueError`` where none are known."""
        own, motions = self.own_rates, self.network.motions
        units = list(units)
        first = {motions[unit]: unit for unit in units if unit not in own}
        return {self.rate(unit) for unit in (*first.values(), *(unit for unit in units if unit in own))}

    def tree(self, units: Iterable[int]) -> TaskTree:
        """Give units, by id and in the order given, as a tree."""
        return TaskTree(tuple(self.network.unit(unit) for unit in units))

    def costs(self, units: Iterable[int]) -> Costs:
        """Compute what a set of units costs; each unit counts once."""
        chosen = sorted(set(units))
        taken = {o for unit in chosen for o in self.needs[unit] if o in self.kitchen}
        return tree_costs(list(map(self.measured, chosen)), len(taken), self.rates is not None)

    def measured(self, unit: int) -> Measured:
        """Give a unit as objectives look at it."""
        return _MeasuredUnit(self, unit)

    def figure(self, objective: Objective, unit: int) -> int | Fraction:
        """Give what a unit alone costs by an objective, which adds it up or multiplies it.

        Raises ``ValueError`` where no rates are known that the objective needs.
        """
        return objective.row.unit(_MeasuredUnit(self, unit))


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


def require_rates(motions: Iterable[tuple[str, Source]], rates: Mapping[str, Fraction]) -> None:
    """Raise :class:`UserError` naming every motion without a success rate and where it was first read.

    ``motions`` may name a motion again; what counts is its first place.
    """
    missing: dict[str, Source] = {}
    for motion, source in motions:
        if motion not in rates:
            missing.setdefault(motion, source)
    if missing:
        lines = [
            f"{source}:1: error: the motion {motion!r} has no success rate"
            for motion, source in list(missing.items())[:10]
        ]
        if len(missing) > 10:
            lines.append(f"... and {len(missing) - 10} more motions")
        lines.append("add a line with the motion, a tab and its rate to the rates file (motion.txt)")
        raise UserError("\n".join(lines))
