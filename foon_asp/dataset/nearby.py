"""A question to a large store, of which only the units near the goals are read, until that is enough."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import fields, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol

from foon_asp.network import Network, ObjectNode, UnitPrices
from foon_asp.problem import Objective, Problem, UsedUp
from foon_asp.store.cone import Cone

if TYPE_CHECKING:  # plain answers do not need it
    from foon_asp.proof.verify import Subject
    from foon_asp.store.elsewhere import Elsewhere


class UnreadData(Protocol):
    """Data that questions are posed of, over as much as was read; ids are those of the whole network."""

    def problem(self, goals: Sequence[int], containers: str) -> Problem:
        """Ask for goals over all that they can need."""

    def among(self, units: Iterable[int], goals: Sequence[int], containers: str) -> Problem:
        """Ask for goals over a part of the network that has these units."""

    def nearby(self, goals: Sequence[int], containers: str, items: UsedUp | None, first: int) -> Problem:
        """Ask for goals, for which ``first`` units are read."""

    def elsewhere(self, containers: str, objective: Objective) -> "Elsewhere | None":
        """Look at all units, what they cost being counted by an objective."""

    def subject(self, everything: bool, goals: Iterable[int]) -> "Subject":
        """Return what a certificate speaks about."""


class Nearby:
    """A question over the units near its goals; what the others are good for is not known yet.

    ``data`` are asked under a container rule, and ``cone`` is what was read of the units that goals can need.
    """

    def __init__(self, data: UnreadData, cone: Cone, containers: str) -> None:
        self.data, self.containers = data, containers
        self._cone = cone
        self._problem: Problem | None = None  # over the units read so far
        self._relaxed: Problem | None = None

    @property
    def goals(self) -> tuple[int, ...]:
        """The goals, by id in the whole network."""
        return self._cone.goals

    def copied(self) -> "Nearby":
        """Return the same question, to be read on by itself."""
        other = Nearby(self.data, self._cone.copied(), self.containers)
        other._problem, other._relaxed = self._problem, self._relaxed
        return other

    @property
    def problem(self) -> Problem:
        """The question over the units read: its trees are trees of the whole network, but not all of them."""
        if self._problem is None:
            self._problem = self.among(self._cone.units)
        return self._problem

    def among(self, units: Iterable[int]) -> Problem:
        """Return the question over any units, by id in the whole network."""
        return self.data.among(units, self.goals, self.containers)

    def elsewhere(self, objective: Objective) -> "Elsewhere | None":
        """Look at all units, what they cost being counted by an objective; ``None`` if that cannot be."""
        return self.data.elsewhere(self.containers, objective)

    def subject(self) -> "Subject":
        """Return what a certificate of the answer speaks about."""
        return self.data.subject(False, self.goals)

    def whole(self) -> Problem:
        """Read all that the goals can need."""
        return self.data.problem(self.goals, self.containers) if self._cone.open else self.problem

    @property
    def relaxed(self) -> Problem:
        """The same question where all is at hand besides that units not read may make.

        The units read of any tree are enough for the goals there: what they need is at hand, made by one of
        them, or open. So there is no tree in the whole network that costs less than the best here, by
        objectives that only units add to.

        Rules of the user's do not see what is taken to be at hand, but the kitchen as it is: so they say of
        units here what they say of them in the whole network, if they do not ask what is available.
        """
        if self._relaxed is None:
            problem, open_ = self.problem, self._cone.open
            places = (o for o, number in enumerate(problem.network.object_numbers) if number in open_)
            kitchen = problem.kitchen.union(places)
            self._relaxed = replace(problem, kitchen=kitchen, as_seen=problem, origin=None)
        return self._relaxed

    def lacking(self, units: Iterable[int]) -> list[int]:
        """Return what a tree of the relaxed question takes that may not be there, by id in the whole network.

        ``units`` are in an order that executes there. A tree that lacks nothing is one of the question.
        """
        problem = self.problem
        there, lacking = set(problem.kitchen), set[int]()
        for unit in units:
            lacking.update(o for o in problem.needs[unit] if o not in there)
            there.update(problem.gives[unit])
        lacking.update(goal for goal in problem.goals if goal not in there)
        return sorted(map(problem.network.object_number, lacking))

    def grow(self, objects: Iterable[int], quickly: bool = False) -> None:
        """Read a tenth more units, or a fifth, which lead to these open objects, by id in the network."""
        self._cone.grow(objects, len(self._cone.units) // (5 if quickly else 10) + 1)
        self._problem = self._relaxed = None

    @property
    def units(self) -> int:
        """How many units were read."""
        return len(self._cone.units)

    def open_to(self, units: Iterable[int]) -> list[int]:
        """Return what units need, or are asked for, that may not be there, by id in the whole network."""
        problem, open_ = self.problem, self._cone.open
        needed = {o for unit in units for o in problem.needs[unit]}.union(problem.goals)
        return sorted(open_.intersection(map(problem.network.object_number, needed)))


class _ReadLater:
    """A field of a problem that is read when it is first looked at, unless the problem has its own value."""

    def __set_name__(self, owner: type, name: str) -> None:
        self._name, self._own = name, f"_own_{name}"

    def __get__(self, problem: "NearbyProblem | None", owner: type) -> Any:
        if problem is None:
            return self
        return getattr(problem, self._own) if problem.start is None else getattr(problem.read, self._name)

    def __set__(self, problem: "NearbyProblem", value: object) -> None:
        object.__setattr__(problem, self._own, value)  # a problem is frozen


class NearbyProblem(Problem):
    """A question to a large store: what its goals can need is read when it is first looked at.

    :meth:`near` has what is near the goals, for those that can do with it. One that is made of another with
    changes has values of its own.
    """

    network: Network = _ReadLater()  # type: ignore[assignment]
    kitchen: frozenset[int] = _ReadLater()  # type: ignore[assignment]
    goals: tuple[int, ...] = _ReadLater()  # type: ignore[assignment]
    unit_prices: UnitPrices | None = _ReadLater()  # type: ignore[assignment]

    start: Nearby | None = None
    """What is near the goals at first, as long as no more is read."""
    units_at_first: int = 0

    @classmethod
    def of(cls, start: Nearby, units_at_first: int) -> "NearbyProblem":
        """Make it of what is near its goals, for which about so many units are read at first."""
        problem = cls(**{field.name: getattr(start.problem, field.name) for field in fields(Problem)})
        for name, value in (("start", start), ("units_at_first", units_at_first)):
            object.__setattr__(problem, name, value)
        return problem

    @property
    def first(self) -> Problem | None:
        """The question over the units read at first."""
        return None if self.start is None else self.start.problem

    @cached_property
    def read(self) -> Problem:
        """The question over all that the goals can need."""
        assert self.start is not None
        return self.start.whole()

    def near(self) -> Nearby | None:
        """Return what is near the goals, for one question to read on from; ``None`` where all was read."""
        return None if self.start is None or "read" in vars(self) else self.start.copied()

    def each_goal(self) -> list[Problem]:
        """Return the question for each goal by itself, read as far as this one."""
        start = self.start
        if start is None or "read" in vars(self):
            return [replace(self, goals=(goal,)) for goal in self.goals]
        return [
            start.data.nearby((goal,), start.containers, None, self.units_at_first) for goal in start.goals
        ]

    @property
    def goal_nodes(self) -> tuple[ObjectNode, ...]:
        """The goals as object nodes."""
        return super().goal_nodes if self.first is None else self.first.goal_nodes

    @property
    def conditions(self) -> str:
        """What every claim about this question holds under, in a few words."""
        return super().conditions if self.first is None else self.first.conditions

    def require_known_for(self, objectives: Collection[Objective]) -> None:
        """Require the rates and prices that objectives need, as :meth:`Problem.require_known_for` does."""
        if self.first is None:
            super().require_known_for(objectives)
        else:
            self.first.require_known_for(objectives)


def shown(problem: Problem) -> Problem:
    """Return a problem that has the goals of another, without reading more."""
    if isinstance(problem, NearbyProblem):
        return problem.first or problem
    return problem
