"""The cone of goals: the units of a network that the goals can need, read backwards from the goals."""

import copy
from collections import deque
from collections.abc import Container, Iterable, Sequence
from itertools import chain
from typing import Protocol

from foon_asp.garbage_collection import without_garbage_collection
from foon_asp.problem import ContainerRule
from foon_asp.store.tuning import STORE


class Producers(Protocol):
    """A network that is read node by node, as needed; ids are those in the whole network."""

    def producers_of(self, objects: Sequence[int]) -> list[list[int]]:
        """Return, for each of the nodes, the ids of the units that have it as an output."""

    def needs(
        self, units: Sequence[int], containers: ContainerRule, utensils: frozenset[str]
    ) -> list[list[int]]:
        """Return, for each of the units, the ids of the nodes that it needs under a container rule."""


class Cone:
    """The units that goals can need, as far as they were read. Ids are those in the whole network.

    A node is needed if it is a goal, or an input that a unit of the cone needs. The container rule, with its
    ``utensils``, says which inputs a unit needs.

    ``units``: the units that were read.
    ``open``: the needed nodes that are not ``available`` and whose producers were not read yet.
    """

    def __init__(
        self,
        goals: Iterable[int],
        network: Producers,
        containers: ContainerRule,
        utensils: frozenset[str],
        available: Container[int],
    ) -> None:
        """Start with no unit; the goals that are not ``available`` are open."""
        self.goals = tuple(goals)
        self.units: set[int] = set()
        self.open = {goal for goal in self.goals if goal not in available}
        self._closed: set[int] = set()
        self._network, self._available = network, available
        self._rule = containers, utensils

    def copy(self) -> "Cone":
        """Return a copy of the cone that grows independently."""
        other = copy.copy(self)
        other.units, other.open, other._closed = set(self.units), set(self.open), set(self._closed)
        return other

    @without_garbage_collection()
    def grow(self, objects: Iterable[int], max_units: int | None = None) -> None:
        """Read the units that make the open nodes among ``objects``, then the units that make their inputs.

        This continues backwards, breadth first, until about ``max_units`` units are added. ``None`` is no
        limit. A node is no longer open once all its producers were read.
        """
        queue = deque(objects)
        target_size = None if max_units is None else len(self.units) + max_units
        while queue and (target_size is None or len(self.units) < target_size):
            batch = [queue.popleft() for _ in range(min(len(queue), STORE.cone_nodes))]
            batch = [o for o in dict.fromkeys(batch) if o in self.open]
            producers = self._network.producers_of(batch)
            new = [unit for unit in dict.fromkeys(chain.from_iterable(producers)) if unit not in self.units]
            needs = dict(zip(new, self._network.needs(new, *self._rule), strict=True))
            for node, units in zip(batch, producers, strict=True):
                if target_size is not None and len(self.units) >= target_size:
                    break
                self.open.remove(node)
                self._closed.add(node)
                for unit in units:
                    if unit in self.units:
                        continue
                    self.units.add(unit)
                    for needed in needs[unit]:
                        if needed not in self._closed and (
                            needed in self.open or needed not in self._available
                        ):
                            self.open.add(needed)
                            queue.append(needed)
