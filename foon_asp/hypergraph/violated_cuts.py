"""Separation of disjoint landmark cuts that an LP solution violates."""

from collections.abc import Callable, Collection, Iterator
from typing import Any

from foon_asp.hypergraph.covering import ROUGH_TOLERANCE
from foon_asp.hypergraph.cut import Cut, Cutter


def disjoint_violated_cuts(
    cutter: Cutter,
    used: Collection[int],
    shares: Any,
    costs: Any,
    random_number: Callable[[], float],
    tolerance: float = ROUGH_TOLERANCE,
) -> Iterator[Cut]:
    """Yield violated cuts with disjoint landmarks and no action of ``used``, until a grown cut is satisfied.

    ``shares`` is an array of the LP value of each action; the values of a cut's landmark actions become 1.
    Actions of great values are kept out of landmarks first, then cheap ones, by the array ``costs`` times a
    factor from 0.5 to 1.5 by ``random_number``. A landmark whose values lack no more than ``tolerance`` is
    satisfied.
    """
    import numpy as np  # noqa: PLC0415 (a part of HiGHS is there already)

    actions = np.array(cutter.actions, dtype=int)
    costs = costs[actions]
    while True:
        random_costs = costs * [0.5 + random_number() for _ in actions]
        cut = cutter.cut(used, actions[np.lexsort((random_costs, -shares[actions]))].tolist())
        if cut is None or shares[list(cut.members)].sum() >= 1 - tolerance:
            return
        shares[list(cut.members)] = 1.0
        yield cut
