"""Actions that need objects and give objects, as plain lists of numbers."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import cached_property


@dataclass(frozen=True, eq=False, repr=False)
class Hypergraph:
    """Actions ``0 .. len(needs) - 1`` over objects ``0 .. size - 1``.

    Action ``a`` can run once every object of ``needs[a]`` is at hand, and then those of ``gives[a]`` are.
    ``start`` are the objects that are at hand from the beginning; no object is ever used up.
    ``known_makers`` are the actions that give each object, where they are known already.
    """

    size: int
    needs: Sequence[Sequence[int]]
    gives: Sequence[Sequence[int]]
    start: Collection[int]
    known_makers: Sequence[Sequence[int]] | None = None

    @cached_property
    def at_start(self) -> bytearray:
        """A 1 for every object that is at hand from the beginning."""
        flags = bytearray(self.size)
        for o in self.start:
            flags[o] = True
        return flags

    @cached_property
    def makers(self) -> Sequence[Sequence[int]]:
        """For each object the actions that give it."""
        return self._owners(self.gives) if self.known_makers is None else self.known_makers

    @cached_property
    def takers(self) -> list[list[int]]:
        """For each object the actions that need it."""
        return self._owners(self.needs)

    @cached_property
    def missing(self) -> list[int]:
        """For each action, how many of the objects it needs are not there from the start."""
        at_start = self.at_start
        return [sum(not at_start[o] for o in set(needed)) for needed in self.needs]

    def crossing(self, objects: frozenset[int]) -> tuple[int, ...]:
        """Return the actions that give one of some objects and need none of them, ascending."""
        makers, needs = self.makers, self.needs
        return tuple(sorted({a for o in objects for a in makers[o] if objects.isdisjoint(needs[a])}))

    def _owners(self, lists: Sequence[Sequence[int]]) -> list[list[int]]:
        owners: list[list[int]] = [[] for _ in range(self.size)]
        for action, members in enumerate(lists):
            for o in set(members):
                owners[o].append(action)
        return owners

    def reach(self, forbidden: frozenset[int] = frozenset()) -> bytearray:
        """Close the start under all actions but the forbidden ones, in linear time.

        Gives a 1 for every object at hand then.
        """
        missing = list(self.missing)
        reached = bytearray(self.at_start)
        gives, takers = self.gives, self.takers
        ready = [a for a, count in enumerate(missing) if not count and a not in forbidden]
        for action in ready:  # grows while it is walked through
            for o in gives[action]:
                if not reached[o]:
                    reached[o] = True
                    for taker in takers[o]:
                        missing[taker] -= 1
                        if not missing[taker] and taker not in forbidden:
                            ready.append(taker)
        return reached
