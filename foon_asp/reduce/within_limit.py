"""The best tree under a limit on how many of some units it has, by a price on each of these."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

from foon_asp.problem import Objective
from foon_asp.reduce.exact_costs import ExactCosts
from foon_asp.reduce.reduction import Reduced, at_costs
from foon_asp.reduce.wide import Wide

_PRICES = 2  # that are tried

Units = frozenset[int]


class Limited(NamedTuple):
    """What prices tell of the trees within a limit.

    ``tree`` is one of them, and ``None`` where there is none. Better ones cost ``allowed`` at most, as
    ``wide`` measures trees, with a price.
    """

    tree: Units | None
    wide: Wide
    allowed: int


def limited(
    wide: Wide,
    objectives: Sequence[Objective],
    tree: Units,
    counts: Callable[[int], bool],
    most: int,
    expired: Callable[[], bool],
) -> Limited | None:
    """Look for the best tree of which a limit counts at most so many units; ``tree`` has more of them.

    First any tree within the limit is looked for, by a price on each unit that counts, so high that nothing
    else matters; or a bound says that there is none. Then the price is the ratio at which that tree and the
    one beyond the limit cost the same. With a price, a tree within the limit costs at most ``most`` times the
    price more, and all bounds hold for that. ``None`` where nothing is known at the end.
    """

    def taken(units: Units) -> int:
        return sum(map(counts, units))

    few = ExactCosts(wide.problem, (Objective.UNITS,), wide.left)
    most_of_all = few.beyond * (most + 1)
    found = _asked(wide, few.priced(counts, few.beyond, most_of_all), (Objective.UNITS,), expired)
    if found.bound >= most_of_all:
        return Limited(None, wide, 0)
    if found.tree is None or taken(found.tree) > most:
        return None
    best, over, least, price, measured = found.tree, tree, wide.cuts.bound, 0, wide
    for _ in range(_PRICES):
        ratio = -(-(wide.total(best) - wide.total(over)) // (taken(over) - taken(best)))
        told = _asked(wide, wide.costs.priced(counts, ratio), objectives, expired) if ratio > 0 else None
        if told is None or told.tree is None or told.wide is None:
            break
        if told.bound - ratio * most > least:
            least, price, measured = told.bound - ratio * most, ratio, told.wide
        if taken(told.tree) > most and wide.total(told.tree) > wide.total(over):
            over = told.tree
        elif taken(told.tree) <= most and wide.total(told.tree) < wide.total(best):
            best = told.tree
        else:
            break
    return Limited(best, measured, wide.total(best) + price * most)


def _asked(
    wide: Wide, costs: ExactCosts, objectives: Sequence[Objective], expired: Callable[[], bool]
) -> Reduced:
    found = at_costs(wide, objectives, costs, expired)
    if found.interrupted:
        raise KeyboardInterrupt
    return found
