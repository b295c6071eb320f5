"""Costs of actions under a lexicographic list of objectives, as whole numbers."""

import math
from collections.abc import Callable, Collection, Iterable, Sequence
from copy import copy
from decimal import ROUND_CEILING, Context, Decimal
from fractions import Fraction
from itertools import pairwise

from foon_asp.hypergraph.coprime_base import coprime_base, factor_exponents
from foon_asp.hypergraph.landmark_cuts import Cuts
from foon_asp.hypergraph.lexicographic import Lexicographic
from foon_asp.problem import Costs, Objective, Problem, multiplies

_SCALE = 10**40  # scale of logarithms where rounding must not decide
_ROUNDED = 10**20  # more than the sum of all rounding errors at that scale
_FINE = Context(prec=60, rounding=ROUND_CEILING)
_SHOWN = Context(prec=18, rounding=ROUND_CEILING)  # of bounds on success


class TooFineError(Exception):
    """Some rates are 0, or have too many digits: rounding could hide a difference."""


class ExactCosts:
    """The cost of each action as one integer; sums of costs compare lexicographically.

    Call the object with an action for its cost. The cost by an additive objective is scaled to an integer.
    Then it is multiplied by a number greater than any sum of costs by the less important objectives.

    Where rates multiply, logarithms are added. The rates are products of the factors of a coprime base, whose
    logarithms are rounded to forty digits. So equal products have equal sums. The attribute ``doubt`` is
    greater than the sum of all rounding errors: sums that differ by more compare exactly. It is 0 if nothing
    is rounded.

    Raises :class:`TooFineError` if a rate is 0 or has a denominator above 10^9.
    """

    def __init__(self, problem: Problem, objectives: Sequence[Objective], actions: Collection[int]) -> None:
        self._problem, self._objectives = problem, tuple(objectives)
        self._multiplied = frozenset(filter(multiplies, self._objectives))
        self._units = units = len(problem.network)
        chosen = (a for a in actions if a < units)
        self._logarithms = _scaled_logarithms(problem.different_rates(chosen) if self._multiplied else set())
        self._denominators = {
            objective: self._common_denominator(objective, actions) for objective in self._objectives
        }
        last_first = self._objectives[::-1]
        self._factors = {last_first[0]: 1}
        for after, objective in pairwise(last_first):
            self._factors[objective] = self._factors[after] * (1 + self._upper_bound(after, actions))
        self.doubt = sum(_ROUNDED * self._factors[objective] for objective in self._multiplied)
        self._cache: dict[int, int] = {}
        self._actions = actions
        self._price: Callable[[int], int] | None = None
        self._multiplier = 1
        self._limit: int | None = None

    def with_price(
        self, counts: Callable[[int], int], price: int | Fraction, limit: int | None = None
    ) -> "ExactCosts":
        """Return these costs with ``price * counts(unit)`` added to the cost of each unit.

        If the price is a fraction, all costs are multiplied by its denominator. Actions that take kitchen
        items have no price. With a ``limit``, a search by these costs ends early: when a lower bound reaches
        the limit, or a tree costs less than it.
        """
        units, costs = self._units, copy(self)
        numerator, costs._multiplier = Fraction(price).as_integer_ratio()
        costs._cache, costs._limit, costs.doubt = {}, limit, self.doubt * costs._multiplier
        costs._price = lambda action: numerator * counts(action) if action < units else 0
        return costs

    @property
    def has_limit(self) -> bool:
        """Whether there is a limit, so that a search ends at the first tree that costs less."""
        return self._limit is not None

    @property
    def strict_upper_bound(self) -> int:
        """A number above the cost of every set of actions, without any price."""
        first = self._objectives[0]
        return self._factors[first] * (1 + self._upper_bound(first, self._actions))

    def _common_denominator(self, objective: Objective, actions: Collection[int]) -> int:
        """Return the common denominator of the costs of actions by an objective.

        It is 1 for an objective in whole numbers, and for one whose rates multiply.
        """
        if objective.row.whole or objective in self._multiplied:
            return 1
        return math.lcm(*{cost.denominator for cost in self._unit_costs(objective, actions)})

    def _upper_bound(self, objective: Objective, actions: Collection[int]) -> int:
        """Return an upper bound on the scaled cost, by one objective, of any subset of ``actions``."""
        if objective is Objective.UNITS:
            return len(actions)
        if objective in self._multiplied:
            return len(actions) * max(self._logarithms.values(), default=0)
        steps = self._denominators[objective]
        items = sum(a >= self._units for a in actions)
        return (
            sum(int(cost * steps) for cost in self._unit_costs(objective, actions))
            + objective.row.item * items
        )

    def _unit_costs(self, objective: Objective, actions: Collection[int]) -> Iterable[int | Fraction]:
        """Return the costs, by an objective, of the units among ``actions``."""
        return self._problem.figures(objective, (a for a in actions if a < self._units))

    def __call__(self, action: int) -> int:
        """Return the cost of an action, its price included; costs are cached."""
        cost = self._cache.get(action)
        if cost is None:
            cost = self._multiplier * sum(
                self._scaled_cost(o, action) * factor for o, factor in self._factors.items()
            )
            cost += self._price(action) if self._price else 0
            self._cache[action] = cost
        return cost

    def first_objective_bound(self, total: int) -> int | Fraction:
        """Return a bound on the first objective of trees, given a lower bound ``total`` on their costs.

        For an additive objective, it is a lower bound in the unit of the objective. For ``success``, it is an
        upper bound on the rate, at most 1.
        """
        figure = total // self._factors[self._objectives[0]]
        if self._objectives[0] not in self._multiplied:
            return self.unscale(self._objectives[0], figure)
        value = _FINE.next_plus(_FINE.exp(_FINE.divide(Decimal(_ROUNDED - figure), Decimal(_SCALE))))
        return min(Fraction(1), Fraction(_SHOWN.plus(value)))

    def proves_optimal(self, cuts: Cuts, tree: Collection[int]) -> bool:
        """Return whether a cost partition proves this tree optimal, exactly.

        If these costs have a limit, return whether the bound reaches the limit, or the tree costs less than
        the limit. If nothing is rounded, the bound is compared with the cost of the tree. Otherwise weights
        and reduced costs are recomputed exactly, as vectors of exponents of rates. The weight of each cut is
        then the reduced cost of its cheapest action.

        Return ``False`` if these vectors become too large, or if costs are rounded and have a price.
        """
        total = sum(map(self, tree))
        if self._limit is not None:
            return cuts.bound >= self._limit or total < self._limit
        if not self.doubt:
            return cuts.bound >= total
        if self._price or cuts.bound + self.doubt < total:  # a price is no product of rates
            return False
        rates = [rate for rate, weight in self._logarithms.items() if weight]
        order = Lexicographic([rates if o in self._multiplied else None for o in self._objectives])
        coordinates = {rate: i for i, rate in enumerate(rates)}
        vectors = _Vectors(self, coordinates)
        reduced_costs = {action: vectors.vector(action) for action in cuts.reduced_costs}
        slack = [0] * order.width
        for cut in cuts.cuts:
            weight = tuple(reduced_costs[cut.cheapest])
            if _is_too_large(weight) or order.sign(weight) < 0:
                return False
            for i, coordinate in enumerate(weight):
                if coordinate:
                    slack[i] += coordinate
                    for action in cut.members:
                        reduced_costs[action][i] -= coordinate
        if any(
            _is_too_large(reduced_cost) or order.sign(reduced_cost) < 0
            for reduced_cost in reduced_costs.values()
        ):
            return False
        for action in tree:
            for i, coordinate in enumerate(vectors.vector(action)):
                slack[i] -= coordinate
        return not _is_too_large(slack) and order.sign(slack) >= 0

    def combined_cost(self, costs: Costs) -> int:
        """Return the cost of a tree as one integer, from its costs by objective; a price is not added.

        Where rates multiply, rounding may make the result too great, but never too small.
        """
        total = 0
        for objective, factor in self._factors.items():
            measure = Fraction(costs.measure(objective))
            if objective in self._multiplied:
                figure = _logarithm(measure.denominator) - _logarithm(measure.numerator) + _ROUNDED
            else:
                figure = math.ceil(measure * self._denominators[objective])
            total += figure * factor
        return total * self._multiplier

    def scaled_costs(self, action: int) -> list[tuple[Objective, int]]:
        """Return for each objective a pair: the objective, and the scaled cost of an action by it.

        For ``success``, the cost is a rounded logarithm.
        """
        return [(objective, self._scaled_cost(objective, action)) for objective in self._objectives]

    def unscale(self, objective: Objective, figure: int) -> int | Fraction:
        """Return ``figure``, a sum of scaled costs by an additive objective, in the unit of the objective."""
        return figure if objective.row.whole else Fraction(figure, self._denominators[objective])

    def is_logarithm(self, figure: int, product: Fraction) -> bool:
        """Return whether ``figure``, a sum of rounded logarithms, is ``-log(product)`` up to rounding."""
        return abs(figure - _logarithm(product.denominator) + _logarithm(product.numerator)) < _ROUNDED

    def rate(self, action: int) -> Fraction:
        """Return the rate of an action; 1 for an action that takes a kitchen item, since it never fails."""
        if action >= self._units:
            return Fraction(1)
        return self._problem.rate(action)

    def _scaled_cost(self, objective: Objective, action: int) -> int:
        """Return the scaled cost of an action by one objective.

        Actions numbered after the units take one kitchen item each. They cost 1 by an objective that counts
        items, and 0 by any other.
        """
        if action >= self._units:
            return objective.row.item
        if objective in self._multiplied:
            return self._logarithms[self._problem.rate(action)]
        return int(self._problem.figure(objective, action) * self._denominators[objective])


def _is_too_large(vector: Sequence[int]) -> bool:
    """Return whether it would take too long to compare products of rates with these exponents."""
    return sum(map(abs, vector)) > 50_000


class _Vectors:
    """Costs as vectors: a coordinate for each additive objective, and one for each rate where rates multiply.

    ``coordinates``: the index of each rate among the coordinates of its objective.
    """

    def __init__(self, costs: ExactCosts, coordinates: dict[Fraction, int]) -> None:
        self._costs, self._coordinates = costs, coordinates

    def vector(self, action: int) -> list[int]:
        """Return the cost of an action as a vector.

        Where rates multiply, the vector has an exponent for each rate: 1 for the rate of the action, 0 for
        all others. A rate of 1 has no exponent of its own.
        """
        vector: list[int] = []
        for objective, figure in self._costs.scaled_costs(action):
            if multiplies(objective):
                exponents = [0] * len(self._coordinates)
                if figure:
                    exponents[self._coordinates[self._costs.rate(action)]] = 1
                vector += exponents
            else:
                vector.append(figure)
        return vector


class CoarseCosts:
    """Costs by a single objective, rounded down to small whole numbers, for estimates.

    Call the object with an action for its cost.
    """

    def __init__(self, problem: Problem, objective: Objective) -> None:
        self._problem, self._objective = problem, objective
        self._multiplied = multiplies(objective)
        self._of_rates: dict[int | str, int] = {}  # by motion, or by unit with a rate of its own

    def __call__(self, action: int) -> int:
        """Return the approximate cost of an action.

        Costs in whole numbers are exact. Costs in fractions, and ``-ln`` of rates, are in thousandths,
        rounded down. An action that takes a kitchen item costs 1 if the objective counts items, else 0.
        """
        problem = self._problem
        if action >= len(problem.network):
            return self._objective.row.item
        if self._multiplied:
            rated = action if action in problem.own_rates else problem.network.motions[action]
            cost = self._of_rates.get(rated)
            if cost is None:
                cost = self._of_rates[rated] = _coarse_logarithm(problem.rate(action))
            return cost
        figure = problem.figure(self._objective, action)
        return int(figure if self._objective.row.whole else figure * 1000)


def _coarse_logarithm(rate: Fraction) -> int:
    """Return ``-ln(rate)`` in thousandths, rounded down; 100,000 for a rate of 0."""
    if not rate:
        return 100_000
    return int((math.log(rate.denominator) - math.log(rate.numerator)) * 1000)  # a float may not hold it


def _scaled_logarithms(rates: set[Fraction]) -> dict[Fraction, int]:
    """Return for each rate ``-ln(rate)``, multiplied by ``10**40`` and rounded.

    The logarithms of the factors of a coprime base are rounded and added up. So equal products of rates have
    equal sums. Raises :class:`TooFineError` if a rate is 0 or has a denominator above 10^9.
    """
    # logarithms at this scale distinguish rates up to such denominators for sure
    if not all(0 < rate <= 1 and rate.denominator <= 10**9 for rate in rates):
        raise TooFineError
    base = coprime_base(n for rate in rates for n in rate.as_integer_ratio())
    logarithms = {factor: _logarithm(factor) for factor in base}

    def logarithm_of(number: int) -> int:
        """Return the scaled logarithm of a number, as the sum of the logarithms of its factors."""
        return sum(power * logarithms[f] for f, power in factor_exponents(number, base).items())

    return {rate: logarithm_of(rate.denominator) - logarithm_of(rate.numerator) for rate in rates}


def _logarithm(number: int) -> int:
    """Return the natural logarithm of a number, multiplied by ``10**40``, as an integer."""
    return int(_FINE.multiply(_FINE.ln(Decimal(number)), Decimal(_SCALE)))
