"""Lower bounds on the cost of trees that have a certain unit, for all units of a store at once."""

import math
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from foon_asp.problem import Objective, Trait
from foon_asp.store.outline import FAR, Distances, Mask, Outline

_SCALE = 2**40  # of natural logarithms of success rates, which become integers


class UnitDistances:
    """The distances of all units of a network: lower bounds on the cost of a tree that has the unit.

    The distance of a unit is its cost plus the largest distance of its inputs. The distance of a node is the
    least one of its producers (``h_max`` of Bonet and Geffner, Artificial Intelligence 129, 2001). It is 0
    for nodes in the mask ``kitchen``, which are available, and in ``skipped``, which units do not need.

    The cost of a unit is usually 1. For the ``objective`` ``success`` with ``rates``, it is the negative
    logarithm of the rate of the motion. This cost is scaled to an integer and rounded down. A motion without
    a rate then costs 0.
    """

    def __init__(
        self,
        outline: Outline,
        kitchen: Mask,
        skipped: Mask,
        rates: Mapping[str, Fraction] | None,
        objective: Objective,
    ) -> None:
        """Compute the cost of a unit for each motion."""
        self._outline, self._kitchen, self._available = outline, kitchen, kitchen | skipped
        motions = outline.motion_names
        costs, self._step = [1] * len(motions), 1  # the unit of ``max_steps``
        if objective is Objective.SUCCESS and rates is not None:
            costs = [
                min(least_cost(rates.get(motion, Fraction(1))), FAR - 1) for motion in outline.motion_names
            ]
            self._step = _SCALE // 8
        self._costs: NDArray[np.int64] = np.array(costs, dtype=np.int64)

    def units_matching(self, rows: Iterable[Iterable[Trait]]) -> Mask:
        """Return the mask of the units that may have all traits of at least one row of traits."""
        matching = np.zeros(len(self._outline.motions), dtype=np.bool_)
        for row in {tuple(row) for row in rows}:
            matching |= self._outline.units_with_traits(row, self._kitchen)
        return matching

    def nearest_units(
        self, kinds: Sequence[Mask], executed: Collection[int], max_units: int, max_steps: int
    ) -> tuple[list[int], list[int]]:
        """Return the nearest units of each kind with the units that lead to them, and the least distances.

        ``kinds``: masks of units.
        ``executed``: the ids of units that cost nothing.
        ``max_units``: how many units of each kind are chosen at most.
        ``max_steps``: how many steps farther a chosen unit may be than the nearest unit of the farthest kind.
        A step is the cost of one unit, or for ``success`` 1/8 of a natural logarithm.

        The first list has the ids of all chosen units and of units that lead to them. The second list has the
        least distance of each kind. It is :data:`FAR` if no unit of the kind can be reached.
        """
        free_units, surplus = self._outline.unit_mask(executed), max_steps * self._step
        unit_ids = [np.flatnonzero(kind) for kind in kinds]
        nonempty = [ids for ids in unit_ids if len(ids)]

        def least_distances(distances: Distances, unit_ids: Sequence[NDArray[np.int64]]) -> list[int]:
            """Return the least distance in each array of unit ids; :data:`FAR` for an empty one."""
            return [int(distances[ids].min(initial=FAR)) for ids in unit_ids]

        distances = self._distances(
            free_units, FAR, lambda distances: max(least_distances(distances, nonempty), default=0) + surplus
        )
        chosen = np.zeros(len(free_units), dtype=np.bool_)
        for ids in unit_ids:
            chosen[ids[np.argsort(distances[ids], kind="stable")[:max_units]]] = True
        reachable = distances < FAR
        units = self._outline.units_leading_to(chosen & reachable, self._kitchen, reachable & ~free_units)
        return np.flatnonzero(units).tolist(), least_distances(distances, unit_ids)

    def relevant_units(
        self, kinds: Sequence[Mask] | None, executed: Collection[int], max_cost: int
    ) -> list[int]:
        """Return the ids of units that may be in a cheap enough tree with a unit of one of the kinds.

        These are the units of the ``kinds``, and the units that lead to them. All have a distance of at most
        ``max_cost``.

        ``kinds``: masks of units; ``None`` if the tree may have any units.
        ``executed``: the ids of units that cost nothing; they are not returned.
        ``max_cost``: the greatest cost of a tree. If every motion costs more, the list is empty.
        """
        if max_cost < int(self._costs.min(initial=FAR)):
            return []
        free_units = self._outline.unit_mask(executed)
        reachable = self._distances(free_units, max_cost, None) < FAR
        units = reachable
        if kinds is not None:  # also units that lead to executed ones, which may be reached in another way
            matching = np.logical_or.reduce([np.zeros_like(free_units), *kinds])
            units = self._outline.units_leading_to(matching & reachable, self._kitchen, reachable)
        units = units & ~free_units
        ids: list[int] = np.flatnonzero(units).tolist()
        return ids

    def _distances(
        self, executed: Mask, max_distance: int, limit: Callable[[Distances], int] | None
    ) -> Distances:
        """Return the distances of all units, where the units ``executed`` and their outputs cost nothing.

        ``max_distance`` and ``limit`` are those of :meth:`.Outline.unit_distances`.
        """
        available = self._available | self._outline.nodes_made_by(executed)
        return self._outline.unit_distances(available, self._costs, max_distance, executed, limit)


def least_cost(rate: Fraction) -> int:
    """Return an integer that is a lower bound on the cost of a rate above 0.

    The cost is the negative natural logarithm of the rate, times 2**40.
    """
    exact, error = _logarithm(rate)
    return max(0, math.floor(exact) - error)


def greatest_cost(rate: Fraction) -> int:
    """Return an integer that is an upper bound on the cost of a rate above 0.

    The cost is the negative natural logarithm of the rate, times 2**40.
    """
    exact, error = _logarithm(rate)
    return math.ceil(exact) + error


def _logarithm(rate: Fraction) -> tuple[float, int]:
    """Return the negative natural logarithm of a rate, scaled by ``_SCALE``, and a bound on its error."""
    logarithms = math.log(rate.denominator), math.log(rate.numerator)
    return (logarithms[0] - logarithms[1]) * _SCALE, 2 + math.ceil(sum(logarithms) * _SCALE * 2**-50)
