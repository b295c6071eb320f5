"""What rules leave of a problem, in the words of its network."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple, overload


@dataclass(frozen=True, eq=False, repr=False)
class Restriction:
    """Units that no tree may have, and sets of units of each of which a tree has to have one.

    ``removed`` says of a unit, by id, whether no tree may have it; it is asked once of a unit, and only of
    those that are looked at. Of each set of ``required`` some unit has to be in the tree, and to execute. It
    need not lead to a goal: a required set is one more goal, which each of its units makes.
    """

    removed: Callable[[int], bool]
    required: tuple[frozenset[int], ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "removed", cache(self.removed))

    def makers(self, makers: Sequence[tuple[int, ...]]) -> Sequence[tuple[int, ...]]:
        """Give the units left that make each object node, and then those left of each required set."""
        return Left((*makers, *(tuple(sorted(units)) for units in self.required)), self.removed)


class Contradiction(NamedTuple):
    """That no tree keeps to the rules, found before any search."""


class Left(Sequence[tuple[int, ...]]):
    """What is left of sets of units, found when it is first asked for."""

    def __init__(self, sets: Sequence[tuple[int, ...]], removed: Callable[[int], bool]) -> None:
        self._sets, self._removed = sets, removed
        self._known: dict[int, tuple[int, ...]] = {}

    def instead(self, others: Mapping[int, tuple[int, ...]]) -> "Left":
        """Give the same with other sets in some places."""
        left = Left(self._sets, self._removed)
        left._known.update(others)
        return left

    def __len__(self) -> int:
        return len(self._sets)

    @overload
    def __getitem__(self, place: int) -> tuple[int, ...]: ...
    @overload
    def __getitem__(self, place: slice) -> Sequence[tuple[int, ...]]: ...
    def __getitem__(self, place: int | slice) -> tuple[int, ...] | Sequence[tuple[int, ...]]:
        if isinstance(place, slice):
            return Left(self._sets[place], self._removed)
        left = self._known.get(place)
        if left is None:
            removed = self._removed
            left = self._known[place] = tuple([u for u in self._sets[place] if not removed(u)])
        return left
