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

    ``tree``: a tree within the limit; ``None`` if there is no such tree.
    ``units``: all units that better trees within the limit can have; ``None`` if no price excludes a unit.
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
    """Search for the best tree within an upper limit on a sum over units; ``tree`` exceeds the limit.

    ``row`` has the amounts of units and the limit on their sum. A first tree within the limit is found by
    :func:`any_within_limit`. The price of an amount of 1 is the Lagrange multiplier at which this tree and
    ``tree`` cost the same. It raises the cost of a tree within the limit by at most the price times the
    limit, so lower bounds carry over. If many units remain at this price, lower prices that rise up to it are
    tried.

    Returns ``None`` if neither a tree is found nor its absence proved.
    """
    first = any_within_limit(subproblem, row, expired)
    if first is None or first.tree is None:
        return first
    incumbent, exceeding = first.tree, tree
    remaining: Units | None = None
    for _ in range(tuning.PRICES.prices):
        ratio = -(
            -(subproblem.total(incumbent) - subproblem.total(exceeding))
            // (row.total(exceeding) - row.total(incumbent))
        )
        if ratio <= 0:
            break
        allowed = subproblem.total(incumbent) + ratio * row.bound
        reduced = _reduced_at(
            subproblem,
            subproblem.costs.with_price(row.weight, ratio),
            objectives,
            expired,
            incumbent,
            allowed,
            tuning.PRICES.rising_units,
        )
        if reduced.tree is None:
            break
        better = row.total(reduced.tree) <= row.bound and subproblem.total(reduced.tree) < subproblem.total(
            incumbent
        )
        incumbent = reduced.tree if better else incumbent
        if remaining is None or len(reduced.units) < len(remaining):
            remaining = frozenset(reduced.units)
        if len(remaining) > tuning.PRICES.rising_units:
            return _by_rising_prices(subproblem, objectives, incumbent, exceeding, row, expired)
        if row.total(reduced.tree) > row.bound and subproblem.total(reduced.tree) > subproblem.total(
            exceeding
        ):
            exceeding = reduced.tree
        elif not better:
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
    """Search for trees within the limit that are better than ``incumbent``; ``exceeding`` is beyond it.

    A question at a low price is about as quick as one without a price. Prices rise from about the cost of a
    unit to the price at which ``incumbent`` and ``exceeding`` cost the same. The optimal tree at a price
    replaces one of the two. The price with the greatest bound determines the units of better trees.
    """
    next_price = Fraction(subproblem.total(exceeding), len(exceeding))
    greatest: tuple[Fraction, Fraction] | None = None  # bound, and its price
    subproblem = _restricted_to_cost(subproblem, incumbent, expired)
    for _ in range(tuning.PRICES.rising_prices):
        tie = Fraction(
            subproblem.total(incumbent) - subproblem.total(exceeding),
            row.total(exceeding) - row.total(incumbent),
        )
        if tie <= 0:
            break
        price, next_price = min(tie, next_price), 2 * next_price
        reduced = _reduced_at(subproblem, subproblem.costs.with_price(row.weight, price), objectives, expired)
        if reduced.tree is None:
            break
        bound = Fraction(reduced.bound, price.denominator) - price * row.bound
        greatest = max(greatest or (bound, price), (bound, price))
        count, total = row.total(reduced.tree), subproblem.total(reduced.tree)
        tied = price == tie and total + price * count >= subproblem.total(incumbent) + price * row.total(
            incumbent
        )
        if count > row.bound:
            exceeding = reduced.tree
        elif total < subproblem.total(incumbent):
            incumbent = reduced.tree
            subproblem = _restricted_to_cost(subproblem, incumbent, expired)
        else:
            break
        if tied or count == row.bound:
            break
    if greatest is None:
        return WithinLimit(incumbent)
    _, price = greatest
    allowed = subproblem.total(incumbent) * price.denominator + price.numerator * row.bound
    reduced = _reduced_at(
        subproblem, subproblem.costs.with_price(row.weight, price), objectives, expired, incumbent, allowed
    )
    if reduced.tree is None:
        return WithinLimit(incumbent)
    if row.total(reduced.tree) <= row.bound and subproblem.total(reduced.tree) < subproblem.total(incumbent):
        incumbent = reduced.tree
    return WithinLimit(incumbent, frozenset(reduced.units))


def _restricted_to_cost(subproblem: Subproblem, tree: Units, expired: Callable[[], bool]) -> Subproblem:
    """Return the subproblem of the trees that cost no more than ``tree``."""
    remaining = subproblem.actions_within(subproblem.total(tree), expired)
    return replace(subproblem, remaining={*remaining, *subproblem.actions(tree)})


def any_within_limit(
    subproblem: Subproblem, row: LinearRow, expired: Callable[[], bool]
) -> WithinLimit | None:
    """Search for any tree that keeps to an upper limit on a sum, by minimizing the sum.

    Returns ``WithinLimit(None)`` if a bound proves that no tree is within the limit. Returns ``None`` if
    nothing is known.
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
    """Reduce the subproblem by :func:`reduce_at_costs`.

    Raises ``KeyboardInterrupt`` where that is interrupted.
    """
    reduced = reduce_at_costs(subproblem, objectives, costs, expired, known_tree, below, max_actions)
    if reduced.interrupted:
        raise KeyboardInterrupt
    return reduced
