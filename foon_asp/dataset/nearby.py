"""A problem of a large store: the units near its goals are read first, and others only as needed."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import fields, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol

from foon_asp.network import Network, ObjectNode, UnitPrices
from foon_asp.problem import Objective, Problem, UsedUp
from foon_asp.store.cone import Cone

if TYPE_CHECKING:  # plain answers do not need it
    from foon_asp.proof.certificate_subject import Subject
    from foon_asp.store.unit_distances import UnitDistances


class UnreadData(Protocol):
    """A dataset whose problems may cover a part of its network; all ids are ids in the whole network."""

    def problem(self, goals: Sequence[int], containers: str) -> Problem:
        """Return the problem of goals over all units that they can need."""

    def problem_of_units(self, units: Iterable[int], goals: Sequence[int], containers: str) -> Problem:
        """Return the problem of goals over a part of the network that has at least these units."""

    def nearby(
        self, goals: Sequence[int], containers: str, items: UsedUp | None, units_at_first: int
    ) -> Problem:
        """Return the problem of goals, for which about ``units_at_first`` units near them were read."""

    def unit_distances(self, containers: str, objective: Objective) -> "UnitDistances | None":
        """Return for each unit a lower bound on the cost of any tree with it; ``None`` if unknown."""

    def subject(self, everything: bool, goals: Iterable[int]) -> "Subject":
        """Return what a certificate is about; see :meth:`Dataset.subject`."""


class Nearby:
    """A problem of a store over the units read so far, which are near its goals; :meth:`grow` reads more.

    A node is *open* if it is needed, but not all units that make it were read.

    ``cone``: the units read so far.
    ``data``: the dataset.
    ``containers``: the name of the container rule.
    """

    def __init__(self, data: UnreadData, cone: Cone, containers: str) -> None:
        self.data, self.containers = data, containers
        self._cone = cone
        self._problem: Problem | None = None  # over the units read so far
        self._relaxation: Problem | None = None

    @property
    def goals(self) -> tuple[int, ...]:
        """The goals, by id in the whole network."""
        return self._cone.goals

    def copy(self) -> "Nearby":
        """Return a copy with the same units read; reading more units in one does not affect the other."""
        other = Nearby(self.data, self._cone.copy(), self.containers)
        other._problem, other._relaxation = self._problem, self._relaxation
        return other

    @property
    def problem(self) -> Problem:
        """The problem over the units read so far; each of its trees is also a tree of the whole network."""
        if self._problem is None:
            self._problem = self.problem_of_units(self._cone.units)
        return self._problem

    def problem_of_units(self, units: Iterable[int]) -> Problem:
        """Return the problem over the given units, by id in the whole network."""
        return self.data.problem_of_units(units, self.goals, self.containers)

    def unit_distances(self, objective: Objective) -> "UnitDistances | None":
        """Return for each unit a lower bound on the cost of any tree with it; ``None`` if unknown."""
        return self.data.unit_distances(self.containers, objective)

    def subject(self) -> "Subject":
        """Return the network and kitchen that a certificate is about, without reading more units."""
        return self.data.subject(False, self.goals)

    def full_problem(self) -> Problem:
        """Return the problem over all units that the goals can need, and read those that were not read.

        If no node is open, this is :attr:`problem`.
        """
        return self.data.problem(self.goals, self.containers) if self._cone.open else self.problem

    @property
    def relaxation(self) -> Problem:
        """The relaxation of the problem in which all open nodes are available.

        For objectives that are sums over units, its optimum is a lower bound on the optimum of the whole
        network. The reason: from any tree of the whole network, the units that were read are a tree of the
        relaxation.

        User rules see the kitchen without the open nodes. So a rule that does not depend on the available
        nodes holds for the same units here as in the whole network.
        """
        if self._relaxation is None:
            problem, open_nodes = self.problem, self._cone.open
            local_ids = (o for o, number in enumerate(problem.network.object_numbers) if number in open_nodes)
            kitchen = problem.kitchen.union(local_ids)
            self._relaxation = replace(problem, kitchen=kitchen, as_seen=problem, origin=None)
        return self._relaxation

    def open_nodes_used(self, units: Iterable[int]) -> list[int]:
        """Return the open nodes that a tree of the relaxation needs and does not make.

        They are ids in the whole network, sorted. If the list is empty, the tree is also a tree of
        :attr:`problem`. ``units`` are the units of the tree, by id in :attr:`problem`, in an order that
        executes in the relaxation.
        """
        problem = self.problem
        available, used_nodes = set(problem.kitchen), set[int]()
        for unit in units:
            used_nodes.update(o for o in problem.needs[unit] if o not in available)
            available.update(problem.gives[unit])
        used_nodes.update(goal for goal in problem.goals if goal not in available)
        return sorted(map(problem.network.object_number, used_nodes))

    def grow(self, objects: Iterable[int], step: int) -> None:
        """Read more units that lead to ``objects``, open nodes by id in the whole network.

        If ``n`` units were read so far, about ``n // step + 1`` more are read. Then :attr:`problem` and
        :attr:`relaxation` are new problems over all units read, with other local ids.
        """
        self._cone.grow(objects, len(self._cone.units) // step + 1)
        self._problem = self._relaxation = None

    @property
    def unit_count(self) -> int:
        """The number of units read."""
        return len(self._cone.units)

    def open_nodes_needed(self, units: Iterable[int]) -> list[int]:
        """Return the open nodes among the goals and the inputs of units, by id in the whole network, sorted.

        ``units`` are ids in :attr:`problem`. Open nodes that one of the units makes are included.
        """
        problem, open_nodes = self.problem, self._cone.open
        needed = {o for unit in units for o in problem.needs[unit]}.union(problem.goals)
        return sorted(open_nodes.intersection(map(problem.network.object_number, needed)))


class _FieldReadLater:
    """A field of a :class:`NearbyProblem`, whose value is read at the first access to any such field.

    A problem without ``start`` has its own value of the field, and nothing is read.
    """

    def __set_name__(self, owner: type, name: str) -> None:
        self._name, self._own_name = name, f"_own_{name}"

    def __get__(self, problem: "NearbyProblem | None", owner: type) -> Any:
        """Return the value of :attr:`~NearbyProblem.full_problem`; without ``start``, the problem's own."""
        if problem is None:
            return self
        return (
            getattr(problem, self._own_name)
            if problem.start is None
            else getattr(problem.full_problem, self._name)
        )

    def __set__(self, problem: "NearbyProblem", value: object) -> None:
        object.__setattr__(problem, self._own_name, value)  # a problem is frozen


class NearbyProblem(Problem):
    """A problem of a large store; all units that its goals can need are read at the first access to a field.

    This holds for four fields: the network, the kitchen, the goals and the prices. Searches that need fewer
    units use :meth:`nearby` instead. A copy of the problem with changed fields has its own values: those
    passed to it. The copy reads nothing.
    """

    network: Network = _FieldReadLater()  # type: ignore[assignment]
    kitchen: frozenset[int] = _FieldReadLater()  # type: ignore[assignment]
    goals: tuple[int, ...] = _FieldReadLater()  # type: ignore[assignment]
    unit_prices: UnitPrices | None = _FieldReadLater()  # type: ignore[assignment]

    start: Nearby | None = None
    """The question over the units read at first; ``None`` for a problem with its own values."""
    units_at_first: int = 0

    @classmethod
    def of(cls, start: Nearby, units_at_first: int) -> "NearbyProblem":
        """Make a problem from ``start``, for which about ``units_at_first`` units were read."""
        problem = cls(**{field.name: getattr(start.problem, field.name) for field in fields(Problem)})
        for name, value in (("start", start), ("units_at_first", units_at_first)):
            object.__setattr__(problem, name, value)
        return problem

    @property
    def first_problem(self) -> Problem | None:
        """The problem over the units read at first; ``None`` for a problem with its own values."""
        return None if self.start is None else self.start.problem

    @cached_property
    def full_problem(self) -> Problem:
        """The problem over all units that the goals can need; the first access reads these units."""
        assert self.start is not None
        return self.start.full_problem()

    def nearby(self) -> Nearby | None:
        """Return a copy of ``start``, in which more units can be read without changing this problem.

        Return ``None`` if all units were read. Return ``None`` also for a changed copy of a problem, which
        reads no units.
        """
        return None if self.start is None or "full_problem" in vars(self) else self.start.copy()

    def single_goal_problems(self) -> list[Problem]:
        """Return a problem for each goal by itself, for which about ``units_at_first`` units are read.

        If all units of this problem were read, or if it has its own values, nothing is read: the new problems
        have its network.
        """
        start = self.start
        if start is None or "full_problem" in vars(self):
            return [replace(self, goals=(goal,)) for goal in self.goals]
        return [
            start.data.nearby((goal,), start.containers, None, self.units_at_first) for goal in start.goals
        ]

    @property
    def goal_nodes(self) -> tuple[ObjectNode, ...]:
        """The goals as object nodes."""
        return super().goal_nodes if self.first_problem is None else self.first_problem.goal_nodes

    @property
    def conditions(self) -> str:
        """The conditions of every claim about this problem, in a few words: container rule and level."""
        return super().conditions if self.first_problem is None else self.first_problem.conditions

    def require_known_for(self, objectives: Collection[Objective]) -> None:
        """Raise :class:`UserError` if an objective needs rates or prices that are not known.

        It does so as :meth:`Problem.require_known_for`, without reading more of the store.
        """
        if self.first_problem is None:
            super().require_known_for(objectives)
        else:
            self.first_problem.require_known_for(objectives)


def without_reading_more(problem: Problem) -> Problem:
    """Return a problem with the same goals and kitchen, whose fields are accessed without reading a store.

    For a :class:`NearbyProblem`, this is the problem over the units read at first. Any other problem is
    returned as it is.
    """
    if isinstance(problem, NearbyProblem):
        return problem.first_problem or problem
    return problem
