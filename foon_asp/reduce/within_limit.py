"""The best tree under a limit on how many of some units it has, or what these come to, by a price on each."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

from foon_asp.problem import Objective
from foon_asp.reduce.exact_costs import ExactCosts
from foon_asp.reduce.reduction import Reduced, at_costs
from foon_asp.reduce.wide import Wide

_PRICES = 2  # that are tried
_FEW = 1000  # units that clingo chooses from faster than another price is tried
_MANY = 2000  # units that are too many for it, so that prices rise
_RISING = 8  # prices at most while they do
_LOW = Fraction(3, 2)  # times what a unit costs is the lowest of these

Units = frozenset[int]


class Limited(NamedTuple):
    """What prices tell of the trees within a limit.

    ``tree`` is one of them, and ``None`` where there is none. Better ones have no units but these; ``units``
    are ``None`` where no price tells.
    """

    tree: Units | None
    units: Units | None = None


def limited(
    wide: Wide,
    objectives: Sequence[Objective],
    tree: Units,
    counts: Callable[[int], int],
    most: int,
    expired: Callable[[], bool],
) -> Limited | None:
    """Look for the best tree of units that count at most so much together; those of ``tree`` count more.

    First any tree within the limit is looked for, by a price so high that nothing else matters on what each
    unit counts; or a bound says that there is none. Then the price is the ratio at which that tree and the
    one beyond the limit cost the same. With a price, a tree within the limit costs at most ``most`` times the
    price more, and all bounds hold for that. Where that price leaves many units, others rise up to it.
    ``None`` where nothing is known at the end.
    """

    def taken(units: Units) -> int:
        return sum(map(counts, units))

    first = least(wide, counts, most, expired)
    if first is None or first.tree is None:
        return first
    best, over = first.tree, tree
    left: Units | None = None
    for _ in range(_PRICES):
        ratio = -(-(wide.total(best) - wide.total(over)) // (taken(over) - taken(best)))
        if ratio <= 0:
            break
        allowed = wide.total(best) + ratio * most
        found = _asked(wide, wide.costs.priced(counts, ratio), objectives, expired, best, allowed, _MANY)
        if found.tree is None:
            break
        better = taken(found.tree) <= most and wide.total(found.tree) < wide.total(best)
        best = found.tree if better else best
        if left is None or len(found.units) < len(left):
            left = frozenset(found.units)
        if len(left) > _MANY:
            return _by_rising_prices(wide, objectives, best, over, counts, most, expired)
        if taken(found.tree) > most and wide.total(found.tree) > wide.total(over):
            over = found.tree
        elif not better:
            break
        if len(left) <= _FEW:
            break
    return Limited(best, left)


def _by_rising_prices(
    wide: Wide,
    objectives: Sequence[Objective],
    best: Units,
    over: Units,
    counts: Callable[[int], int],
    most: int,
    expired: Callable[[], bool],
) -> Limited:
    """Look for better trees than one within the limit, ``best``, from another beyond it.

    A question at a low price is about as quick as one without a price. They rise, from about what a unit
    costs, to the one at which ``best`` and ``over`` cost the same; the best tree there comes instead of one
    of these two. The price of the greatest bound tells what better trees than ``best`` can have.
    """

    def taken(units: Units) -> int:
        return sum(map(counts, units))

    rising = _LOW * wide.total(over) / len(over)
    greatest: tuple[Fraction, Fraction] | None = None  # bound, and its price
    wide = _up_to(wide, best, expired)
    for _ in range(_RISING):
        tie = Fraction(wide.total(best) - wide.total(over), taken(over) - taken(best))
        if tie <= 0:
            break
        price, rising = min(tie, rising), 2 * rising
        found = _asked(wide, wide.costs.priced(counts, price), objectives, expired)
        if found.tree is None:
            break
        bound = Fraction(found.bound, price.denominator) - price * most
        greatest = max(greatest or (bound, price), (bound, price))
        count, total = taken(found.tree), wide.total(found.tree)
        tied = price == tie and total + price * count >= wide.total(best) + price * taken(best)
        if count > most:
            over = found.tree
        elif total < wide.total(best):
            best = found.tree
            wide = _up_to(wide, best, expired)
        else:
            break
        if tied or count == most:
            break
    if greatest is None:
        return Limited(best)
    _, price = greatest
    allowed = wide.total(best) * price.denominator + price.numerator * most
    found = _asked(wide, wide.costs.priced(counts, price), objectives, expired, best, allowed)
    if found.tree is None:
        return Limited(best)
    if taken(found.tree) <= most and wide.total(found.tree) < wide.total(best):
        best = found.tree
    return Limited(best, frozenset(found.units))


def _up_to(wide: Wide, tree: Units, expired: Callable[[], bool]) -> Wide:
    """Leave what trees have that cost no more than one."""
    left = wide.actions_within(wide.total(tree), expired)
    return replace(wide, left={*left, *wide.actions(tree)})


def least(wide: Wide, counts: Callable[[int], int], most: int, expired: Callable[[], bool]) -> Limited | None:
    """Look for any tree of units that count at most so much together, among those that count least.

    Or a bound says that there is none. ``None`` where nothing is known at the end.
    """
    few = ExactCosts(wide.problem, (Objective.UNITS,), wide.left)
    most_of_all = few.beyond * (most + 1)
    found = _asked(wide, few.priced(counts, few.beyond, most_of_all), (Objective.UNITS,), expired)
    if found.bound >= most_of_all:
        return Limited(None)
    if found.tree is None or sum(map(counts, found.tree)) > most:
        return None
    return Limited(found.tree)


def _asked(
    wide: Wide,
    costs: ExactCosts,
    objectives: Sequence[Objective],
    expired: Callable[[], bool],
    known: Units = frozenset(),
    below: int = 0,
    many: float = math.inf,
) -> Reduced:
    found = at_costs(wide, objectives, costs, expired, known, below, many)
    if found.interrupted:
        raise KeyboardInterrupt
    return found
