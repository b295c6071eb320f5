"""The units of a network that goals can need, read backwards from these as far as asked for."""

from collections import deque
from collections.abc import Callable, Iterable

from foon_asp.garbage import uncollected


class Cone:
    """What goals can need, as far as it was read; everything is by id in the whole network.

    ``producers`` gives the units that make an object node, ``needs`` what a unit needs, and ``at_hand``
    whether a node is at hand. ``units`` are those read: all producers of each node that they or the goals
    need, but for the nodes at hand and those that are ``open``: some of their producers may be missing.
    """

    def __init__(
        self,
        goals: Iterable[int],
        producers: Callable[[int], Iterable[int]],
        needs: Callable[[int], Iterable[int]],
        at_hand: Callable[[int], bool],
    ) -> None:
        self.goals = tuple(goals)
        self.units: set[int] = set()
        self.open = {goal for goal in self.goals if not at_hand(goal)}
        self._closed: set[int] = set()
        self._producers, self._needs, self._at_hand = producers, needs, at_hand

    @uncollected()
    def grow(self, objects: Iterable[int], most: int | None = None) -> None:
        """Read the producers of open nodes, then of what these need, the nearest first.

        Ends when about ``most`` units more were read; ``None`` if all that follow are to be.
        """
        waiting = deque(objects)
        enough = None if most is None else len(self.units) + most
        while waiting and (enough is None or len(self.units) < enough):
            o = waiting.popleft()
            if o not in self.open:
                continue
            self.open.remove(o)
            self._closed.add(o)
            for unit in self._producers(o):
                if unit in self.units:
                    continue
                self.units.add(unit)
                for needed in self._needs(unit):
                    if needed not in self._closed and (needed in self.open or not self._at_hand(needed)):
                        self.open.add(needed)
                        waiting.append(needed)
