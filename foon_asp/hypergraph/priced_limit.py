"""Lagrangian relaxation of a limit on a sum over the units of a tree: the limit becomes a price per unit."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

from foon_asp.hypergraph import tuning
from foon_asp.hypergraph.exact_costs import ExactCosts
from foon_asp.hypergraph.gap_bounded_subproblem import Subproblem
from foon_asp.hypergraph.reduction import Reduced, reduce_at_costs
from foon_asp.problem import LinearRow, Objective

Units = frozenset[int]


class WithinLimit(NamedTuple):
    """The result of a search for trees within a limit.

    ``tree``: the units of a tree within the limit; ``None`` if it is proved that every tree exceeds the
    limit.
    ``units``: all units that this tree and better trees within the limit can have; ``None`` if no unit is
    excluded.
    """

    tree: Units | None
    units: Units | None = None


def search_within_limit(
    subproblem: Subproblem,
    objectives: Sequence[Objective],
    tree: Units,
    row: LinearRow,
    expired: Callable[[], bool],
) -> WithinLimit | None:
    """Search for the best tree within an upper limit on a sum over units.

    ``tree``: the units of a tree that exceeds the limit.
    ``row``: the amount of each unit, and the limit on the sum of the amounts of a tree.

    A first tree within the limit is found by :func:`any_within_limit`. An amount of 1 gets the price at which
    this first tree and ``tree`` cost the same, as a Lagrange multiplier. This price raises the cost of a tree
    within the limit by at most the price times the limit. So lower bounds carry over. If many units remain at
    this price, lower prices that rise up to it are tried.

    If time is up, fewer units are excluded. Returns ``None`` if it stays open whether a tree within the limit
    exists. Raises ``KeyboardInterrupt`` if a search is interrupted.
    """
    first_result = any_within_limit(subproblem, row, expired)
    if first_result is None or first_result.tree is None:
        return first_result
    incumbent, exceeding = first_result.tree, tree
    remaining: Units | None = None
    for _ in range(tuning.PRICES.prices):
        price = -(
            -(subproblem.tree_cost(incumbent) - subproblem.tree_cost(exceeding))
            // (row.total(exceeding) - row.total(incumbent))
        )
        if price <= 0:
            break
        max_priced_cost = subproblem.tree_cost(incumbent) + price * row.bound
        reduced = _reduced_at(
            subproblem,
            subproblem.costs.with_price(row.weight, price),
            objectives,
            expired,
            incumbent,
            max_priced_cost,
            tuning.PRICES.rising_units,
        )
        if reduced.tree is None:
            break
        amount, total = row.total(reduced.tree), subproblem.tree_cost(reduced.tree)
        is_better = amount <= row.bound and total < subproblem.tree_cost(incumbent)
        incumbent = reduced.tree if is_better else incumbent
        if remaining is None or len(reduced.units) < len(remaining):
            remaining = frozenset(reduced.units)
        if len(remaining) > tuning.PRICES.rising_units:
            return _by_rising_prices(subproblem, objectives, incumbent, exceeding, row, expired)
        if amount > row.bound and total > subproblem.tree_cost(exceeding):
            exceeding = reduced.tree
        elif not is_better:
            break
        if len(remaining) <= tuning.PRICES.easy_units:
            break
    return WithinLimit(incumbent, remaining)


def _by_rising_prices(
    subproblem: Subproblem,
    objectives: Sequence[Objective],
    incumbent: Units,
    exceeding: Units,
    row: LinearRow,
    expired: Callable[[], bool],
) -> WithinLimit:
    """Search for trees within the limit that are better than ``incumbent``, at rising prices.

    ``incumbent`` is a tree within the limit, and ``exceeding`` a tree that exceeds it. Prices rise from about
    the cost of a unit to the price at which the two trees cost the same. The optimal tree at each price
    replaces one of the two. The price with the greatest lower bound determines the units of better trees.
    """
    next_price = Fraction(subproblem.tree_cost(exceeding), len(exceeding))
    greatest_bound: tuple[Fraction, Fraction] | None = None  # bound, and its price
    subproblem = _restricted_to_cost(subproblem, incumbent, expired)
    for _ in range(tuning.PRICES.rising_prices):
        tie_price = Fraction(
            subproblem.tree_cost(incumbent) - subproblem.tree_cost(exceeding),
            row.total(exceeding) - row.total(incumbent),
        )
        if tie_price <= 0:
            break
        price, next_price = min(tie_price, next_price), 2 * next_price
        reduced = _reduced_at(subproblem, subproblem.costs.with_price(row.weight, price), objectives, expired)
        if reduced.tree is None:
            break
        bound = Fraction(reduced.bound, price.denominator) - price * row.bound
        greatest_bound = max(greatest_bound or (bound, price), (bound, price))
        amount, total = row.total(reduced.tree), subproblem.tree_cost(reduced.tree)
        incumbent_at_price = subproblem.tree_cost(incumbent) + price * row.total(incumbent)
        is_tie = price == tie_price and total + price * amount >= incumbent_at_price
        if amount > row.bound:
            exceeding = reduced.tree
        elif total < subproblem.tree_cost(incumbent):
            incumbent = reduced.tree
            subproblem = _restricted_to_cost(subproblem, incumbent, expired)
        else:
            break
        if is_tie or amount == row.bound:
            break
    if greatest_bound is None:
        return WithinLimit(incumbent)
    _, price = greatest_bound
    max_priced_cost = subproblem.tree_cost(incumbent) * price.denominator + price.numerator * row.bound
    reduced = _reduced_at(
        subproblem,
        subproblem.costs.with_price(row.weight, price),
        objectives,
        expired,
        incumbent,
        max_priced_cost,
    )
    if reduced.tree is None:
        return WithinLimit(incumbent)
    is_within_limit = row.total(reduced.tree) <= row.bound
    if is_within_limit and subproblem.tree_cost(reduced.tree) < subproblem.tree_cost(incumbent):
        incumbent = reduced.tree
    return WithinLimit(incumbent, frozenset(reduced.units))


def _restricted_to_cost(subproblem: Subproblem, tree: Units, expired: Callable[[], bool]) -> Subproblem:
    """Return the subproblem over the actions of ``tree`` and of trees that cost no more."""
    remaining = subproblem.actions_within(subproblem.tree_cost(tree), expired)
    return replace(subproblem, remaining={*remaining, *subproblem.tree_actions(tree)})


def any_within_limit(
    subproblem: Subproblem, row: LinearRow, expired: Callable[[], bool]
) -> WithinLimit | None:
    """Search for any tree within the limit of ``row``, by minimizing the sum of its amounts.

    The search ends at the first tree within the limit. Returns ``WithinLimit(None)`` if a bound proves that
    there is no such tree. Returns ``None`` if the search ends with neither a tree nor a proof. Raises
    ``KeyboardInterrupt`` if the search is interrupted.
    """
    units_cost = ExactCosts(subproblem.problem, (Objective.UNITS,), subproblem.remaining)
    limit = units_cost.strict_upper_bound * (row.bound + 1)
    reduced = _reduced_at(
        subproblem,
        units_cost.with_price(row.weight, units_cost.strict_upper_bound, limit),
        (Objective.UNITS,),
        expired,
    )
    if reduced.bound >= limit:
        return WithinLimit(None)
    if reduced.tree is None or row.total(reduced.tree) > row.bound:
        return None
    return WithinLimit(reduced.tree)


def _reduced_at(
    subproblem: Subproblem,
    costs: ExactCosts,
    objectives: Sequence[Objective],
    expired: Callable[[], bool],
    known_tree: Units = frozenset(),
    below: int = 0,
    max_actions: float = math.inf,
) -> Reduced:
    """Return the result of :func:`reduce_at_costs`; raise ``KeyboardInterrupt`` if it is interrupted."""
    reduced = reduce_at_costs(subproblem, objectives, costs, expired, known_tree, below, max_actions)
    if reduced.interrupted:
        raise KeyboardInterrupt
    return reduced
