"""What actions cost in a planning task: whole numbers, exact wherever planners can add them up."""

import math
from collections.abc import Collection, Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.encoding.exact_success import problem_scale
from foon_asp.errors import UserError
from foon_asp.problem import Objective, Problem, multiplies

LARGEST = 2**31 - 1  # planners add up in 32 bits
_FINE = 10**6  # steps to 1 of a logarithm


class Scale(NamedTuple):
    """How an objective became whole numbers: each cost times ``factor``, and ``rounded`` or exact.

    An objective that multiplies has the logarithms of its factors there, with the sign turned. What counts
    more than others is multiplied once more, so that no sum of theirs outweighs it; ``factor`` says it all.
    """

    objective: Objective
    factor: Fraction
    rounded: bool


class ActionCosts(NamedTuple):
    """Costs of units by id, the cost of taking a kitchen item, and the scales of the objectives in order."""

    units: dict[int, int]
    item: int
    scales: tuple[Scale, ...]

    @property
    def unit_cost(self) -> bool:
        """Whether each action costs 1, which PDDL need not say."""
        return not self.item and set(self.units.values()) <= {1}


def action_costs(
    problem: Problem,
    objectives: Sequence[Objective],
    units: Sequence[int],
    items: int,
    tree: Collection[int],
    repeats: int = 1,
) -> ActionCosts:
    """Turn objectives into one cost an action, of which the least sum is the best tree.

    A tree has each of the ``units`` once at most, and takes each of the ``items`` once at most: so the
    objectives of a list can be added up, the more important ones multiplied by more than all others together
    can make. ``tree`` is one of the trees: no plan that a planner looks at for long costs more than some
    ``repeats`` of it. Fractions
    that planners cannot add up exactly are rounded. Raises :class:`UserError` where that does not help, and
    for a success rate of 0.
    """
    total: dict[int, int] = dict.fromkeys(units, 0)
    item, weight = 0, 1
    scales: list[Scale] = []
    for objective in reversed(objectives):
        room = LARGEST // (2 * weight * repeats)
        costs, factor, rounded = _whole(problem, objective, units, tree, room)
        scales.insert(0, Scale(objective, factor * weight, rounded))
        for unit, cost in costs.items():
            total[unit] += cost * weight
        item += objective.row.item * weight
        dear = sum(total[unit] for unit in tree) + max(total.values(), default=0)
        if dear * repeats + items * item > LARGEST:
            raise UserError(
                f"by {', '.join(objectives)} plans cost more than the {LARGEST:,} that planners add up to: "
                "name fewer objectives, or costs with fewer digits"
            )
        weight = 1 + sum(total.values()) + items * item
    return ActionCosts(total, item, tuple(scales))


def _whole(
    problem: Problem, objective: Objective, units: Sequence[int], tree: Collection[int], room: int
) -> tuple[dict[int, int], Fraction, bool]:
    """Give what units cost by an objective in whole numbers, the factor that makes it so, and if it rounds.

    A tree and the dearest unit should cost no more than ``room``.
    """
    if multiplies(objective):
        return _logarithms(problem, units)
    figures = {unit: Fraction(problem.figure(objective, unit)) for unit in units}
    common = math.lcm(*(figure.denominator for figure in figures.values()))
    dear = sum(figures[unit] for unit in tree) + max(figures.values(), default=Fraction(0))
    factor, rounded = Fraction(common), False
    if common > 1 and dear * common > room:
        factor, rounded = Fraction(max(1, min(_FINE, int(room / dear)))), True
    return {unit: round(figure * factor) for unit, figure in figures.items()}, factor, rounded


def _logarithms(problem: Problem, units: Sequence[int]) -> tuple[dict[int, int], Fraction, bool]:
    impossible = next((unit for unit in units if not problem.rate(unit)), None)
    if impossible is not None:
        raise UserError(
            f"the motion {problem.network.motions[impossible]!r} never succeeds (its rate is 0), for which "
            "there is no logarithm: leave its units out of the network, or name another objective"
        )
    scale = problem_scale(problem, units)
    weights = {unit: scale.weights[problem.rate(unit)] for unit in units}
    factor = min(_FINE, scale.scale)
    return (
        {unit: round(Fraction(w * factor, scale.scale)) for unit, w in weights.items()},
        Fraction(factor),
        True,
    )
