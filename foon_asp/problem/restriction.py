"""Restriction: the effect of rules on the units of a network, as removed units and required sets."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple, overload


@dataclass(frozen=True, eq=False, repr=False)
class Restriction:
    """Units that no tree may contain, and disjunctive action landmarks that rules add.

    ``removed`` takes the id of a unit and returns ``True`` if no tree may contain the unit. It is called at
    most once for each unit, when the unit is accessed. A tree has to contain and execute a unit of each set
    in ``required``; the unit need not lead to a goal. So a required set is like an additional goal whose
    achievers are its units.
    """

    removed: Callable[[int], bool]
    required: tuple[frozenset[int], ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "removed", cache(self.removed))

    def makers(self, makers: Sequence[tuple[int, ...]]) -> Sequence[tuple[int, ...]]:
        """Return the achievers of each object node, then the required sets, all without removed units."""
        return FilteredSets((*makers, *(tuple(sorted(units)) for units in self.required)), self.removed)


class Contradiction(NamedTuple):
    """The proof, before any search, that no tree satisfies the rules."""


class FilteredSets(Sequence[tuple[int, ...]]):
    """The unit sets of a restriction without removed units; a set is filtered at its first access."""

    def __init__(self, sets: Sequence[tuple[int, ...]], removed: Callable[[int], bool]) -> None:
        self._sets, self._removed = sets, removed
        self._filtered: dict[int, tuple[int, ...]] = {}

    def with_sets(self, others: Mapping[int, tuple[int, ...]]) -> "FilteredSets":
        """Return a copy with the sets in ``others`` at their positions; these sets are not filtered."""
        copy = FilteredSets(self._sets, self._removed)
        copy._filtered.update(others)
        return copy

    def __len__(self) -> int:
        return len(self._sets)

    @overload
    def __getitem__(self, index: int) -> tuple[int, ...]: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[tuple[int, ...]]: ...
    def __getitem__(self, index: int | slice) -> tuple[int, ...] | Sequence[tuple[int, ...]]:
        if isinstance(index, slice):
            return FilteredSets(self._sets[index], self._removed)
        units = self._filtered.get(index)
        if units is None:
            removed = self._removed
            units = self._filtered[index] = tuple([u for u in self._sets[index] if not removed(u)])
        return units
