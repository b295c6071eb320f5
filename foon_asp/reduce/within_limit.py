"""The best tree under a limit on how many of some units it has, or what these come to, by a price on each."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

from foon_asp.problem import Objective
from foon_asp.reduce.exact_costs import ExactCosts
from foon_asp.reduce.reduction import Reduced, at_costs
from foon_asp.reduce.wide import Wide

_PRICES = 2  # that are tried
_FEW = 1000  # units that clingo chooses from faster than another price is tried

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
    price more, and all bounds hold for that. ``None`` where nothing is known at the end.
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
        found = _asked(wide, wide.costs.priced(counts, ratio), objectives, expired, best, allowed)
        if found.tree is None:
            break
        better = taken(found.tree) <= most and wide.total(found.tree) < wide.total(best)
        best = found.tree if better else best
        if left is None or len(found.units) < len(left):
            left = frozenset(found.units)
        if taken(found.tree) > most and wide.total(found.tree) > wide.total(over):
            over = found.tree
        elif not better:
            break
        if len(left) <= _FEW:
            break
    return Limited(best, left)


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
) -> Reduced:
    found = at_costs(wide, objectives, costs, expired, known, below)
    if found.interrupted:
        raise KeyboardInterrupt
    return found
