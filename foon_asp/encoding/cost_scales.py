"""Costs of units as integers for clingo: unchanged, scaled, or rounded down and compared exactly later."""

import math
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import NamedTuple

from foon_asp.encoding.rate_scale import USUAL_SCALE, RateScale, problem_scale
from foon_asp.errors import UserError
from foon_asp.problem import Objective, Problem, multiplies
from foon_asp.problem.number import INT32_MAX


class CostScale(NamedTuple):
    """Integer weights of costs, for an objective whose costs are fractions and add up.

    ``scale``: the number by which costs are multiplied.
    ``exact``: whether no weight is rounded.
    ``weights``: the weight of each cost c, ``floor(scale * c)``.
    ``places``: the index of each cost in the vectors of :meth:`Scales.vector`.
    ``total``: the sum of the weights of all units.
    """

    scale: Fraction
    exact: bool
    weights: Mapping[Fraction, int]
    places: Mapping[Fraction, int]
    total: int


def cost_scale(costs: Iterable[Fraction]) -> CostScale:
    """Return the scale of the costs of units; ``costs`` has one for each unit.

    If the least common denominator turns all costs into integers of 32 bits, it is the scale, and weights are
    exact. Otherwise, weights are rounded down. The scale is then the greatest by which they fit into 32 bits,
    but at most 10^8. The sum of all weights may exceed 32 bits.
    """
    costs = list(costs)
    distinct_costs = sorted(set(costs))
    greatest = max(distinct_costs, default=Fraction(0))
    common_denominator = math.lcm(*(cost.denominator for cost in distinct_costs))
    exact = common_denominator * greatest <= INT32_MAX
    scale = Fraction(common_denominator) if exact else min(Fraction(USUAL_SCALE), INT32_MAX / greatest)
    weights = {cost: math.floor(scale * cost) for cost in distinct_costs}
    places = {cost: index for index, cost in enumerate(distinct_costs)}
    return CostScale(scale, exact, weights, places, sum(weights[cost] for cost in costs))


def require_one_rounded(problem: Problem, objectives: Iterable[Objective]) -> None:
    """Raise :class:`UserError` if two or more of the objectives have to be rounded.

    The objective ``success`` has to be rounded if some rate is not 1. Any other objective has to be rounded
    if no scale turns its costs into integers of 32 bits. All units of the network count, so that the error
    does not depend on the goals.
    """
    fractions = [objective for objective in objectives if multiplies(objective) or not objective.row.whole]
    if len(fractions) < 2:
        return
    costs = {
        objective: {Fraction(problem.figure(objective, unit)) for unit in range(len(problem.network))}
        for objective in fractions
    }
    rounded = [
        objective
        for objective in fractions
        if (costs[objective] - {1} if multiplies(objective) else not cost_scale(costs[objective]).exact)
    ]
    if len(rounded) > 1:
        raise too_many_rounded(rounded)


def too_many_rounded(objectives: Iterable[Objective]) -> UserError:
    """Return the error for several objectives that have to be rounded."""
    return UserError(
        f"the objectives {' and '.join(objectives)} have to be rounded for the solver, which can settle "
        "only one such objective exactly: leave one of them out"
    )


class Scales:
    """Integer weights of the units of a question for clingo, by objective.

    An objective is *rounded* if some cost by it has to be rounded down to become a weight.

    Attributes:
        rates: The scale of success rates; ``None`` if no rates are known.
        costs: The scales of objectives whose costs are fractions and add up.
        facts: The objectives whose costs clingo reads from facts ``cost/3``.
        rounded: The only objective that is rounded; ``None`` if no cost has to be rounded.
    """

    def __init__(self, problem: Problem, units: Iterable[int], objectives: Iterable[Objective] = ()) -> None:
        """Scale the rates of units and their costs by each objective.

        Raises :class:`UserError` if two of the objectives have to be rounded, and for rates that
        :func:`problem_scale` refuses.
        """
        units, objectives = list(units), list(objectives)
        self._problem, self._units = problem, units
        self.facts = [objective for objective in objectives if objective.row.is_fact]
        self.rates: RateScale | None = None if problem.rates is None else problem_scale(problem, units)
        self.costs: dict[Objective, CostScale] = {
            objective: cost_scale(Fraction(problem.figure(objective, unit)) for unit in units)
            for objective in objectives
            if not objective.row.whole and not multiplies(objective)
        }
        rounded = list(filter(self._rounds, objectives))
        if len(rounded) > 1:
            raise too_many_rounded(rounded)
        self.rounded: Objective | None = rounded[0] if rounded else None

    def weight(self, objective: Objective, units: Iterable[int]) -> int:
        """Return the total weight of units by an objective.

        By the objective ``kitchen``, an item that several of the units need counts once.
        """
        if multiplies(objective):
            assert self.rates is not None
            return sum(self.rates.weights[self._problem.rate(unit)] for unit in units)
        if objective in self.costs:
            weights = self.costs[objective].weights
            return sum(weights[Fraction(self._problem.figure(objective, unit))] for unit in units)
        problem, units = self._problem, list(units)
        items = (
            {o for unit in units for o in problem.needs[unit]} & problem.kitchen if objective.row.item else ()
        )
        return int(sum(problem.figure(objective, unit) for unit in units)) + objective.row.item * len(items)

    def cost_weight(self, objective: Objective, cost: int | Fraction) -> int:
        """Return the upper bound on weights that follows from an upper bound on costs by an objective.

        ``cost`` is the bound on costs. Raises :class:`UserError` if the objective is rounded. Also raises it
        if the weight of all units exceeds 32 bits, since clingo then ignores the bound.
        """
        if objective.row.whole:
            return int(cost)
        scale = self.costs[objective]
        if not scale.exact:
            raise UserError(
                f"the objective {objective} has to be rounded for the solver, so it cannot be bounded: leave "
                "it out, or the other objective that has to be rounded"
            )
        if scale.total > INT32_MAX:
            raise UserError(
                f"by the objective {objective} all units together cost more than fits into clingo's numbers, "
                "which have 32 bits, so no bound can be put on it: leave it out, or take fewer digits"
            )
        return int(scale.scale * cost)

    def count_rounded(self, units: Iterable[int]) -> int:
        """Return how many of the units have a weight by the rounded objective that was rounded down.

        Each of them adds an error below 1. By success, every unit with a rate other than 1 counts.
        """
        assert self.rounded is not None
        costs = (self._problem.figure(self.rounded, unit) for unit in units)
        if multiplies(self.rounded):
            return sum(rate != 1 for rate in costs)  # rates of weight 0 count, too
        scale, _, weights, *_ = self.costs[self.rounded]
        return sum(scale * cost != weights[Fraction(cost)] for cost in costs)

    def vector(self, units: Iterable[int]) -> dict[int, int]:
        """Return the vector of units, which determines their exact total by the rounded objective.

        For success, the entries are the exponents of the product of rates, by factor number
        (:class:`RateScale`). For any other objective, the entries are the numbers of units of each cost, by
        the index of the cost. Entries of 0 are included.
        """
        assert self.rounded is not None
        if multiplies(self.rounded):
            assert self.rates is not None
            return self.rates.product_exponents(map(self._problem.rate, units))
        places = self.costs[self.rounded].places
        vector = dict.fromkeys(places.values(), 0)
        for unit in units:
            vector[places[Fraction(self._problem.figure(self.rounded, unit))]] += 1
        return vector

    def unit_vector(self, unit: int) -> Mapping[int, int]:
        """Return the :meth:`vector` of one unit, without entries of 0."""
        assert self.rounded is not None
        if multiplies(self.rounded):
            assert self.rates is not None
            return self.rates.exponents[self._problem.rate(unit)]
        return {self.costs[self.rounded].places[Fraction(self._problem.figure(self.rounded, unit))]: 1}

    def unit_vectors(self) -> dict[int, Mapping[int, int]]:
        """Return the :meth:`unit_vector` of each unit of the question, by unit id."""
        return {unit: self.unit_vector(unit) for unit in self._units}

    def bound(self, objective: Objective, weight: int) -> int | Fraction:
        """Return the bound on the cost by an objective that follows from a lower bound on weights.

        ``weight`` is the lower bound on weights. For success, the result is an upper bound; it is 1 if no
        rates are known. For other objectives, the result is a lower bound.
        """
        if multiplies(objective):
            return Fraction(1) if self.rates is None else self.rates.success_bound(weight)
        return weight / self.costs[objective].scale if objective in self.costs else weight

    def allows(self, objective: Objective, weight: int, figure: int | Fraction) -> bool:
        """Return whether units of a total ``weight`` can have the cost ``figure`` by an objective.

        If the objective is not rounded, only the cost :meth:`bound` is possible. If it is rounded, this cost
        and all worse costs are possible.
        """
        bound = self.bound(objective, weight)
        if objective is not self.rounded:
            return figure == bound
        return figure <= bound if multiplies(objective) else figure >= bound

    def _rounds(self, objective: Objective) -> bool:
        """Whether weights by an objective are rounded down; by success, they are if some rate is below 1."""
        if multiplies(objective):
            # a weight of 0 may be a rate below 1
            return self.rates is not None and any(rate != 1 for rate in self.rates.weights)
        return objective in self.costs and not self.costs[objective].exact
