"""A question to a large store, of which only the units near the goals are read, until that is enough."""

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cached_property

from foon_asp.problem import Problem
from foon_asp.store.cone import Cone

FIRST = 1000
"""About as many units are read at first."""


class Nearby:
    """A question over the units near its goals; what the others are good for is not known yet.

    ``cone`` is what was read, ``pose`` makes the question over it, and ``read_all`` over all that the goals
    can need.
    """

    def __init__(self, cone: Cone, pose: Callable[[Cone], Problem], read_all: Callable[[], Problem]) -> None:
        self._cone, self._pose, self._read_all = cone, pose, read_all

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
        """
        open_ = self._cone.open
        places = (o for o, number in enumerate(self.problem.network.object_numbers) if number in open_)
        return replace(self.problem, kitchen=self.problem.kitchen.union(places), origin=None)

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

    def grow(self, objects: Iterable[int]) -> None:
        """Read a fifth more units, which lead to these open objects, by id in the whole network."""
        self._cone.grow(objects, len(self._cone.units) // 5 + 1)
        for known in ("problem", "relaxed"):
            self.__dict__.pop(known, None)
