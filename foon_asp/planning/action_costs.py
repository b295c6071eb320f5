"""Action costs of a planning task: integers, exact wherever planners can add them up."""

import math
from collections.abc import Collection, Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.encoding.rate_scale import problem_scale
from foon_asp.errors import UserError
from foon_asp.problem import Objective, Problem, multiplies
from foon_asp.problem.number import INT32_MAX

_MAX_FACTOR = 10**6  # of costs that are rounded: more digits of a logarithm, but a smaller range of sums


class Scale(NamedTuple):
    """The scale by which the costs of an objective became integers.

    Each cost was multiplied by ``factor``. In a lexicographic list, the factor includes a weight by which the
    objective outweighs all less important ones. ``rounded`` says that the products were rounded, so that sums
    of costs are not exact. For an objective that multiplies, the costs are the negative logarithms of its
    values.
    """

    objective: Objective
    factor: Fraction
    rounded: bool


class ActionCosts(NamedTuple):
    """The integer costs of actions.

    ``units``: the cost of executing each unit, by unit id.
    ``item``: the cost of taking a kitchen item.
    ``scales``: the scale of each objective, in the order of the objectives.
    """

    units: dict[int, int]
    item: int
    scales: tuple[Scale, ...]

    @property
    def unit_cost(self) -> bool:
        """Whether each action costs 1, so that PDDL needs no costs."""
        return not self.item and set(self.units.values()) <= {1}


def action_costs(
    problem: Problem,
    objectives: Sequence[Objective],
    units: Sequence[int],
    items: int,
    tree: Collection[int],
    repeats: int = 1,
) -> ActionCosts:
    """Return integer costs by which a cheapest plan is a best one by a lexicographic list of objectives.

    A tree executes each of the ``units`` at most once, and takes at most ``items`` kitchen items. So each
    objective gets a weight above the greatest sum of all less important objectives. ``units`` and ``tree``
    are unit ids; ``tree`` is feasible. No plan is assumed to cost more than ``repeats`` times an upper bound.
    This bound is the cost of ``tree`` plus that of the most expensive unit. Costs that planners cannot add up
    exactly are rounded.

    Raises :class:`UserError` if even rounded costs are too large, and for a success rate of 0.
    """
    total: dict[int, int] = dict.fromkeys(units, 0)
    item, weight = 0, 1
    scales: list[Scale] = []
    for objective in reversed(objectives):
        max_cost = INT32_MAX // (2 * weight * repeats)
        costs, factor, rounded = _integer_costs(problem, objective, units, tree, max_cost)
        scales.insert(0, Scale(objective, factor * weight, rounded))
        for unit, cost in costs.items():
            total[unit] += cost * weight
        item += objective.row.item * weight
        upper_bound = sum(total[unit] for unit in tree) + max(total.values(), default=0)
        if upper_bound * repeats + items * item > INT32_MAX:
            raise UserError(
                f"by {', '.join(objectives)} plans cost more than the {INT32_MAX:,} that planners add up to: "
                "name fewer objectives, or costs with fewer digits"
            )
        weight = 1 + sum(total.values()) + items * item
    return ActionCosts(total, item, tuple(scales))


def _integer_costs(
    problem: Problem, objective: Objective, units: Sequence[int], tree: Collection[int], max_cost: int
) -> tuple[dict[int, int], Fraction, bool]:
    """Return the integer costs of units by an objective, their scale's factor, and whether they are rounded.

    The upper bound is the cost of ``tree`` plus that of the most expensive unit. If all costs are integers,
    the factor is 1. Otherwise it is their common denominator, if the upper bound times this factor is at most
    ``max_cost``. If not, the costs are rounded. The factor is then the greatest integer, from 1 to 1,000,000,
    that keeps the upper bound at most ``max_cost``; it is 1 if no integer does. For an objective that
    multiplies, see :func:`_logarithms`.
    """
    if multiplies(objective):
        return _logarithms(problem, units)
    figures = {unit: Fraction(problem.figure(objective, unit)) for unit in units}
    denominator = math.lcm(*(figure.denominator for figure in figures.values()))
    upper_bound = sum(figures[unit] for unit in tree) + max(figures.values(), default=Fraction(0))
    factor, rounded = Fraction(denominator), False
    if denominator > 1 and upper_bound * denominator > max_cost:
        factor, rounded = Fraction(max(1, min(_MAX_FACTOR, int(max_cost / upper_bound)))), True
    return {unit: round(figure * factor) for unit, figure in figures.items()}, factor, rounded


def _logarithms(problem: Problem, units: Sequence[int]) -> tuple[dict[int, int], Fraction, bool]:
    """Return the negative logarithms of success rates as integers, their scale's factor, and ``True``.

    ``True`` says that the integers are rounded. Raises :class:`UserError` for a rate of 0.
    """
    impossible = next((unit for unit in units if not problem.rate(unit)), None)
    if impossible is not None:
        raise UserError(
            f"the motion {problem.network.motions[impossible]!r} never succeeds (its rate is 0), for which "
            "there is no logarithm: leave its units out of the network, or name another objective"
        )
    scale = problem_scale(problem, units)
    weights = {unit: scale.weights[problem.rate(unit)] for unit in units}
    factor = min(_MAX_FACTOR, scale.scale)
    return (
        {unit: round(Fraction(weight * factor, scale.scale)) for unit, weight in weights.items()},
        Fraction(factor),
        True,
    )
