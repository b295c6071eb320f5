"""The units of a network that goals can need, read backwards from these as far as asked for."""

import copy
from collections import deque
from collections.abc import Container, Iterable, Sequence
from itertools import chain
from typing import Protocol

from foon_asp.garbage import uncollected
from foon_asp.problem import ContainerRule

_TOGETHER = 200  # nodes whose producers are read by one query: a cone reads at most so many too many


class Producers(Protocol):
    """A network of which producers are read as far as asked for; ids are those of the whole network."""

    def producers_of(self, objects: Sequence[int]) -> list[list[int]]:
        """Return the units that make each of some nodes."""

    def needs(
        self, units: Sequence[int], containers: ContainerRule, utensils: frozenset[str]
    ) -> list[list[int]]:
        """Return what each of some units needs."""


class Cone:
    """What goals can need, as far as it was read; everything is by id in the whole network.

    ``units`` are those read: all producers of each node that they or the goals need under the container
    rule, but for the nodes ``at_hand`` and those that are ``open``: some of their producers may be missing.
    """

    def __init__(
        self,
        goals: Iterable[int],
        network: Producers,
        containers: ContainerRule,
        utensils: frozenset[str],
        at_hand: Container[int],
    ) -> None:
        self.goals = tuple(goals)
        self.units: set[int] = set()
        self.open = {goal for goal in self.goals if goal not in at_hand}
        self._closed: set[int] = set()
        self._network, self._at_hand = network, at_hand
        self._rule = containers, utensils

    def copied(self) -> "Cone":
        """Return another cone that has read as much."""
        other = copy.copy(self)
        other.units, other.open, other._closed = set(self.units), set(self.open), set(self._closed)
        return other

    @uncollected()
    def grow(self, objects: Iterable[int], most: int | None = None) -> None:
        """Read the producers of open nodes, then of what these need, the nearest first.

        Ends when about ``most`` units more were read; ``None`` if all that follow are to be.
        """
        waiting = deque(objects)
        enough = None if most is None else len(self.units) + most
        while waiting and (enough is None or len(self.units) < enough):
            nearest = [waiting.popleft() for _ in range(min(len(waiting), _TOGETHER))]
            nearest = [o for o in dict.fromkeys(nearest) if o in self.open]
            producers = self._network.producers_of(nearest)
            new = [unit for unit in dict.fromkeys(chain.from_iterable(producers)) if unit not in self.units]
            needs = dict(zip(new, self._network.needs(new, *self._rule), strict=True))
            for made, units in zip(nearest, producers, strict=True):
                if enough is not None and len(self.units) >= enough:
                    break
                self.open.remove(made)
                self._closed.add(made)
                for unit in units:
                    if unit in self.units:
                        continue
                    self.units.add(unit)
                    for needed in needs[unit]:
                        if needed not in self._closed and (
                            needed in self.open or needed not in self._at_hand
                        ):
                            self.open.add(needed)
                            waiting.append(needed)
