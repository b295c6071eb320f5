"""Restriction: the effect of rules on the units of a network, as removed units and required sets."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple, overload


@dataclass(frozen=True, eq=False, repr=False)
class Restriction:
    """The units that rules exclude, and the sets of units that rules require (disjunctive action landmarks).

    ``removed`` is a function that takes the id of a unit and returns ``True`` if no tree may contain the
    unit. It is called at most once for each unit, since its results are cached. ``required`` are sets of
    units. From each set, a tree has to contain and execute a unit, even if this unit leads to no goal. So a
    required set is like an additional goal whose achievers are the units of the set.
    """

    removed: Callable[[int], bool]
    required: tuple[frozenset[int], ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "removed", cache(self.removed))

    def makers(self, makers: Sequence[tuple[int, ...]]) -> Sequence[tuple[int, ...]]:
        """Return the achievers of each object node, then the required sets, all without removed units.

        ``makers`` are the achievers without the restriction. Units of a required set are in ascending order.
        """
        return FilteredSets((*makers, *(tuple(sorted(units)) for units in self.required)), self.removed)


class Contradiction(NamedTuple):
    """The result that no tree satisfies the rules, known before any search."""


class FilteredSets(Sequence[tuple[int, ...]]):
    """A sequence of sets of units without the units that ``removed`` excludes.

    A set is filtered at the first access to it, and then kept.
    """

    def __init__(self, sets: Sequence[tuple[int, ...]], removed: Callable[[int], bool]) -> None:
        self._sets, self._removed = sets, removed
        self._filtered: dict[int, tuple[int, ...]] = {}

    def with_sets(self, replacements: Mapping[int, tuple[int, ...]]) -> "FilteredSets":
        """Return a copy with the sets in ``replacements`` at their positions; these sets are not filtered."""
        copy = FilteredSets(self._sets, self._removed)
        copy._filtered.update(replacements)
        return copy

    def __len__(self) -> int:
        return len(self._sets)

    @overload
    def __getitem__(self, index: int) -> tuple[int, ...]: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[tuple[int, ...]]: ...
    def __getitem__(self, index: int | slice) -> tuple[int, ...] | Sequence[tuple[int, ...]]:
        """Return a set as a tuple without removed units; for a slice, return a filtered sequence."""
        if isinstance(index, slice):
            return FilteredSets(self._sets[index], self._removed)
        units = self._filtered.get(index)
        if units is None:
            removed = self._removed
            units = self._filtered[index] = tuple([u for u in self._sets[index] if not removed(u)])
        return units
