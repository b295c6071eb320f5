"""The delete relaxation as a directed hypergraph: actions with preconditions and add effects, by number."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import cached_property


@dataclass(frozen=True, eq=False, repr=False)
class Hypergraph:
    """Actions ``0 .. len(needs) - 1`` over objects ``0 .. size - 1``.

    Action ``a`` has the preconditions ``needs[a]`` and the add effects ``gives[a]``. No object is ever
    consumed. ``start`` are the initial objects. ``known_makers`` are the achievers of each object; if they
    are ``None``, they are computed when needed.

    An object is *reachable* if some sequence of actions makes it from the initial objects. An action *can
    run* if all of its preconditions are reachable. A *derivation* of some objects is a set of actions that
    makes them from the initial objects. The objects to be made are the *targets*.
    """

    size: int
    needs: Sequence[Sequence[int]]
    gives: Sequence[Sequence[int]]
    start: Collection[int]
    known_makers: Sequence[Sequence[int]] | None = None

    @cached_property
    def at_start(self) -> bytearray:
        """A flag for each object: 1 if it is initial, else 0."""
        flags = bytearray(self.size)
        for o in self.start:
            flags[o] = True
        return flags

    @cached_property
    def makers(self) -> Sequence[Sequence[int]]:
        """The achievers of each object: the actions with it as an add effect."""
        return self._indices_by_object(self.gives) if self.known_makers is None else self.known_makers

    @cached_property
    def consumers(self) -> list[list[int]]:
        """The consumers of each object: the actions with it as a precondition."""
        return self._indices_by_object(self.needs)

    @cached_property
    def missing_counts(self) -> list[int]:
        """The number of non-initial preconditions of each action."""
        at_start = self.at_start
        return [sum(not at_start[o] for o in set(needed)) for needed in self.needs]

    def landmark_of(self, objects: frozenset[int]) -> tuple[int, ...]:
        """Return the landmark of a cut, ascending.

        It consists of the actions that achieve an object of the cut and need none of its objects.
        """
        makers, needs = self.makers, self.needs
        return tuple(sorted({a for o in objects for a in makers[o] if objects.isdisjoint(needs[a])}))

    def _indices_by_object(self, lists: Sequence[Sequence[int]]) -> list[list[int]]:
        """Return, for each object, the indices of the lists that contain it."""
        indices: list[list[int]] = [[] for _ in range(self.size)]
        for action, members in enumerate(lists):
            for o in set(members):
                indices[o].append(action)
        return indices

    def reach(self, forbidden: frozenset[int] = frozenset()) -> bytearray:
        """Return a flag for each object: 1 if it is reachable without the forbidden actions, else 0.

        Takes linear time.
        """
        missing = list(self.missing_counts)
        reached = bytearray(self.at_start)
        gives, consumers = self.gives, self.consumers
        ready = [a for a, count in enumerate(missing) if not count and a not in forbidden]
        for action in ready:  # grows while it is walked through
            for o in gives[action]:
                if not reached[o]:
                    reached[o] = True
                    for consumer in consumers[o]:
                        missing[consumer] -= 1
                        if not missing[consumer] and consumer not in forbidden:
                            ready.append(consumer)
        return reached
