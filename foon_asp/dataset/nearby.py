"""A question to a large store, of which only the units near the goals are read, until that is enough."""

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import fields, replace
from functools import cached_property
from typing import TYPE_CHECKING

from foon_asp.network import Network, ObjectNode, UnitPrices
from foon_asp.problem import Objective, Problem
from foon_asp.store.cone import Cone

if TYPE_CHECKING:  # plain answers do not need it
    from foon_asp.proof.verify import Subject
    from foon_asp.store.elsewhere import Elsewhere

FIRST = 1000
"""About as many units are read at first."""


class Nearby:
    """A question over the units near its goals; what the others are good for is not known yet.

    ``cone`` is what was read, ``pose`` makes the question over it, ``read_all`` over all that the goals can
    need, and ``among`` over any units, by id in the whole network. ``elsewhere`` looks at all units, what
    they cost being counted by an objective; it gives ``None`` where that cannot be done. ``subject`` gives
    what a certificate of the answer speaks about.
    """

    def __init__(
        self,
        cone: Cone,
        pose: Callable[[Cone], Problem],
        read_all: Callable[[], Problem],
        among: Callable[[Iterable[int]], Problem],
        elsewhere: "Callable[[Objective], Elsewhere | None]",
        subject: "Callable[[], Subject]",
    ) -> None:
        self._cone, self._pose, self._read_all, self.subject = cone, pose, read_all, subject
        self.among, self.elsewhere = among, elsewhere

    @cached_property
    def problem(self) -> Problem:
        """The question over the units read: its trees are trees of the whole network, but not all of them."""
        return self._pose(self._cone)

    @cached_property
    def relaxed(self) -> Problem:
        """The same question where all is at hand besides that units not read may make.

        The units read of any tree are enough for the goals there: what they need is at hand, made by one of
        them, or open. So there is no tree in the whole network that costs less than the best here, by
        objectives that only units add to.

        Rules of the user's do not see what is taken to be at hand, but the kitchen as it is: so they say of
        units here what they say of them in the whole network, if they do not ask what is available.
        """
        open_ = self._cone.open
        places = (o for o, number in enumerate(self.problem.network.object_numbers) if number in open_)
        kitchen = self.problem.kitchen.union(places)
        return replace(self.problem, kitchen=kitchen, as_seen=self.problem, origin=None)

    def whole(self) -> Problem:
        """Read all that the goals can need."""
        return self._read_all()

    def lacking(self, units: Iterable[int]) -> list[int]:
        """Give what a tree of the relaxed question takes that may not be there, by id in the whole network.

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
        self._grow(objects, len(self._cone.units) // (5 if quickly else 10) + 1)

    @property
    def units(self) -> int:
        """How many units were read."""
        return len(self._cone.units)

    def open_to(self, units: Iterable[int]) -> list[int]:
        """Give what units need, or are asked for, that may not be there, by id in the whole network."""
        problem, open_ = self.problem, self._cone.open
        needed = {o for unit in units for o in problem.needs[unit]}.union(problem.goals)
        return sorted(open_.intersection(map(problem.network.object_number, needed)))

    def _grow(self, objects: Iterable[int], more: int) -> None:
        self._cone.grow(objects, more)
        self._forget()

    def _forget(self) -> None:
        for known in ("problem", "relaxed"):
            self.__dict__.pop(known, None)


class NearbyProblem(Problem):
    """A question to a large store: what its goals can need is read when it is first looked at.

    :meth:`near` has what is near the goals, for those that can do with it.
    """

    first: Problem | None = (
        None  # over some of the units; ``None`` where this was made of another with changes
    )

    @classmethod
    def of(cls, near: Nearby, again: Callable[[Sequence[int]], Problem]) -> "NearbyProblem":
        """Make it of what was read near its goals; ``again`` asks for goals by id in the whole network."""
        problem, first = cls.__new__(cls), near.problem
        known = {field.name: getattr(first, field.name) for field in fields(Problem)}
        for name in ("network", "kitchen", "goals", "unit_prices"):  # below
            del known[name]
        problem.__dict__.update(known, first=first, _unasked=[near], _again=again, _read=near.whole)
        return problem

    def near(self) -> Nearby | None:
        """Give what is near the goals, for one question to read on from; ``None`` where all was read."""
        if self.first is None or "_all" in self.__dict__:
            return None
        unasked: list[Nearby] = self.__dict__["_unasked"]
        if unasked:
            return unasked.pop()
        again = self._asked_again(self.first.goals)
        return again.near() if isinstance(again, NearbyProblem) else None

    def each_goal(self) -> list[Problem]:
        """Give the question for each goal by itself, read as far as this one."""
        if self.first is None or "_all" in self.__dict__:
            return [replace(self, goals=(goal,)) for goal in self.goals]
        return [self._asked_again((goal,)) for goal in self.first.goals]

    def _asked_again(self, goals: Iterable[int]) -> Problem:
        assert self.first is not None
        found: Problem = self.__dict__["_again"]([*map(self.first.network.object_number, goals)])
        return found

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

    @cached_property
    def _all(self) -> Problem:
        found: Problem = self.__dict__["_read"]()
        return found

    # Each gives way to a value of its own in a problem that is made of this one with changes.

    @cached_property
    def network(self) -> Network:
        """The network of all that the goals can need."""
        return self._all.network

    @cached_property
    def kitchen(self) -> frozenset[int]:
        """What of it is at hand."""
        return self._all.kitchen

    @cached_property
    def goals(self) -> tuple[int, ...]:
        """The goals."""
        return self._all.goals

    @cached_property
    def unit_prices(self) -> UnitPrices | None:
        """The prices of its units."""
        return self._all.unit_prices


def shown(problem: Problem) -> Problem:
    """Give a problem that has the goals of another, without reading more."""
    if isinstance(problem, NearbyProblem):
        return problem.first or problem
    return problem
