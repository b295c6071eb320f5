"""What units of a store cost, all of them at once, and which of them may matter under rules."""

import math
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from foon_asp.problem import Objective, Trait
from foon_asp.store.outline import FAR, Distances, Mask, Outline

_SCALE = 2**40  # of logarithms of success rates, which are counted in whole numbers


class Elsewhere:
    """What it takes to execute units, wherever they are in a network, besides what is there already.

    ``kitchen`` says of each node whether it is at hand, ``skipped`` whether units may do without it. Costs
    are counted by ``units``, or by ``success`` in logarithms, rounded so that no unit costs less than is
    said here. What a unit costs is its own and that of what leads to it along one way: the dearest of its
    inputs, each made by what makes it cheapest.
    """

    def __init__(
        self,
        outline: Outline,
        kitchen: Mask,
        skipped: Mask,
        rates: Mapping[str, Fraction] | None,
        objective: Objective,
    ) -> None:
        self._outline, self._kitchen, self._at_hand = outline, kitchen, kitchen | skipped
        motions = outline.motion_names
        each, self._step = [1] * len(motions), 1  # what to go on by
        if objective is Objective.SUCCESS and rates is not None:
            each = [
                min(least_cost(rates.get(motion, Fraction(1))), FAR - 1) for motion in outline.motion_names
            ]
            self._step = _SCALE // 8
        self._costs: NDArray[np.int64] = np.array(each, dtype=np.int64)

    def wanted(self, rows: Iterable[Iterable[Trait]]) -> Mask:
        """Return for each unit whether it may have all traits of one of some rows."""
        found = np.zeros(len(self._outline.motions), dtype=np.bool_)
        for row in {tuple(row) for row in rows}:
            found |= self._outline.with_all(row, self._kitchen)
        return found

    def nearest(
        self, wanted: Sequence[Mask], there: Collection[int], most: int, more: int
    ) -> tuple[list[int], list[int]]:
        """Return some of the cheapest units of each kind that is wanted, and what leads to these.

        ``there`` are units that cost nothing. Gives at most so many of each kind, of those that cost up to
        ``more`` steps more than the first, and what the first of each kind costs: :data:`FAR` where there
        is none.
        """
        free, beyond = self._outline.units(there), more * self._step

        of_kinds = [np.flatnonzero(each) for each in wanted]

        some = [of_kind for of_kind in of_kinds if len(of_kind)]

        def first(found: Distances, of_kinds: Sequence[NDArray[np.int64]]) -> list[int]:
            return [int(found[of_kind].min(initial=FAR)) for of_kind in of_kinds]

        found = self._distances(free, FAR, lambda found: max(first(found, some), default=0) + beyond)
        few = np.zeros(len(free), dtype=np.bool_)
        for of_kind in of_kinds:
            few[of_kind[np.argsort(found[of_kind], kind="stable")[:most]]] = True
        among = found < FAR
        units = self._outline.leading_to(few & among, self._kitchen, among & ~free)
        return np.flatnonzero(units).tolist(), first(found, of_kinds)

    def mattering(self, wanted: Sequence[Mask] | None, there: Collection[int], within: int) -> list[int]:
        """Return the units that cost no more than this and are wanted, or lead to one that is.

        ``there`` are units that cost nothing; any unit is wanted where ``wanted`` is ``None``.
        """
        if within < int(self._costs.min(initial=FAR)):
            return []
        free = self._outline.units(there)
        among = self._distances(free, within, None) < FAR
        units = among
        if wanted is not None:  # also what leads to units that are there: they may be reached by another way
            of_kinds = np.logical_or.reduce([np.zeros_like(free), *wanted])
            units = self._outline.leading_to(of_kinds & among, self._kitchen, among)
        units = units & ~free
        found: list[int] = np.flatnonzero(units).tolist()
        return found

    def _distances(self, free: Mask, most: int, enough: Callable[[Distances], int] | None) -> Distances:
        there = self._at_hand | self._outline.made_by(free)
        return self._outline.distances(there, self._costs, most, free, enough)


def least_cost(rate: Fraction) -> int:
    """Return what a rate above 0 costs, or less: its logarithm without the sign, in whole numbers."""
    exact, error = _logarithm(rate)
    return max(0, math.floor(exact) - error)


def most_cost(rate: Fraction) -> int:
    """Return what a rate above 0 costs, or more."""
    exact, error = _logarithm(rate)
    return math.ceil(exact) + error


def _logarithm(rate: Fraction) -> tuple[float, int]:
    """Return what a rate costs, and more than the error that this may have."""
    parts = math.log(rate.denominator), math.log(rate.numerator)
    return (parts[0] - parts[1]) * _SCALE, 2 + math.ceil(sum(parts) * _SCALE * 2**-50)
