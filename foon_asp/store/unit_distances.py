"""Lower bounds on the cost of trees with a unit of a store, for all units at once."""

import math
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from foon_asp.problem import Objective, Trait
from foon_asp.store.outline import FAR, Distances, Mask, Outline

_SCALE = 2**40  # of logarithms of success rates, which are whole numbers


class UnitDistances:
    """The distances of all units of a network: lower bounds on the cost of a tree that has the unit.

    ``kitchen`` is the mask of the available nodes, ``skipped`` the mask of nodes that units do not need.
    Costs are units, or negative logarithms of success rates if the objective is ``success``, rounded down.
    The distance of a unit is its cost plus the largest distance of its inputs, where the distance of a node
    is the least of its producers (``h_max`` of Bonet and Geffner, Artificial Intelligence 129, 2001).
    """

    def __init__(
        self,
        outline: Outline,
        kitchen: Mask,
        skipped: Mask,
        rates: Mapping[str, Fraction] | None,
        objective: Objective,
    ) -> None:
        """Compute the cost of a unit of each motion."""
        self._outline, self._kitchen, self._available = outline, kitchen, kitchen | skipped
        motions = outline.motion_names
        costs, self._step = [1] * len(motions), 1  # the unit of ``max_steps``
        if objective is Objective.SUCCESS and rates is not None:
            costs = [
                min(least_cost(rates.get(motion, Fraction(1))), FAR - 1) for motion in outline.motion_names
            ]
            self._step = _SCALE // 8
        self._costs: NDArray[np.int64] = np.array(costs, dtype=np.int64)

    def matching(self, rows: Iterable[Iterable[Trait]]) -> Mask:
        """Return the mask of the units that may have all traits of a row, for at least one of the rows."""
        matching = np.zeros(len(self._outline.motions), dtype=np.bool_)
        for row in {tuple(row) for row in rows}:
            matching |= self._outline.with_all(row, self._kitchen)
        return matching

    def nearest(
        self, kinds: Sequence[Mask], executed: Collection[int], max_units: int, max_steps: int
    ) -> tuple[list[int], list[int]]:
        """Return the nearest units of each kind with the units that lead to them, and the least distances.

        ``executed`` are units that cost nothing. Of each kind, at most ``max_units`` units are chosen. Their
        distances exceed the least distance, or the greatest of several kinds, by at most
        ``max_steps`` steps. The least distance of a kind is :data:`FAR` where none of its units can be
        reached.
        """
        free_units, surplus = self._outline.units(executed), max_steps * self._step

        unit_ids = [np.flatnonzero(kind) for kind in kinds]

        nonempty = [ids for ids in unit_ids if len(ids)]

        def least_distances(distances: Distances, unit_ids: Sequence[NDArray[np.int64]]) -> list[int]:
            return [int(distances[ids].min(initial=FAR)) for ids in unit_ids]

        distances = self._distances(
            free_units, FAR, lambda distances: max(least_distances(distances, nonempty), default=0) + surplus
        )
        chosen = np.zeros(len(free_units), dtype=np.bool_)
        for ids in unit_ids:
            chosen[ids[np.argsort(distances[ids], kind="stable")[:max_units]]] = True
        reachable = distances < FAR
        units = self._outline.leading_to(chosen & reachable, self._kitchen, reachable & ~free_units)
        return np.flatnonzero(units).tolist(), least_distances(distances, unit_ids)

    def relevant(self, kinds: Sequence[Mask] | None, executed: Collection[int], max_cost: int) -> list[int]:
        """Return the units within a distance of ``max_cost`` that are of some kind or lead to such units.

        ``executed`` are units that cost nothing; they are not returned. ``None`` as ``kinds`` means all
        units.
        """
        if max_cost < int(self._costs.min(initial=FAR)):
            return []
        free_units = self._outline.units(executed)
        reachable = self._distances(free_units, max_cost, None) < FAR
        units = reachable
        if kinds is not None:  # also units that lead to executed ones, which may be reached in another way
            matching = np.logical_or.reduce([np.zeros_like(free_units), *kinds])
            units = self._outline.leading_to(matching & reachable, self._kitchen, reachable)
        units = units & ~free_units
        ids: list[int] = np.flatnonzero(units).tolist()
        return ids

    def _distances(
        self, executed: Mask, max_distance: int, limit: Callable[[Distances], int] | None
    ) -> Distances:
        """Return the distances of all units if the units ``executed`` and their outputs cost nothing."""
        available = self._available | self._outline.made_by(executed)
        return self._outline.distances(available, self._costs, max_distance, executed, limit)


def least_cost(rate: Fraction) -> int:
    """Return a lower bound on the cost of a rate above 0: its scaled negative logarithm, rounded down."""
    exact, error = _logarithm(rate)
    return max(0, math.floor(exact) - error)


def greatest_cost(rate: Fraction) -> int:
    """Return an upper bound on the cost of a rate above 0: its scaled negative logarithm, rounded up."""
    exact, error = _logarithm(rate)
    return math.ceil(exact) + error


def _logarithm(rate: Fraction) -> tuple[float, int]:
    """Return the scaled negative logarithm of a rate, and a bound on its error."""
    logarithms = math.log(rate.denominator), math.log(rate.numerator)
    return (logarithms[0] - logarithms[1]) * _SCALE, 2 + math.ceil(sum(logarithms) * _SCALE * 2**-50)
