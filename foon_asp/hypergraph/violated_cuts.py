"""Separation of disjoint landmark cuts that an LP solution violates."""

from collections.abc import Callable, Collection, Iterator
from typing import Any

from foon_asp.hypergraph.covering import ROUGH_TOLERANCE
from foon_asp.hypergraph.cut import Cut, Cutter


def disjoint_violated_cuts(
    cutter: Cutter,
    used: Collection[int],
    lp_values: Any,
    costs: Any,
    random_number: Callable[[], float],
    tolerance: float = ROUGH_TOLERANCE,
) -> Iterator[Cut]:
    """Yield cuts that an LP solution violates, with disjoint landmarks and no action of ``used``.

    ``lp_values``: an array of the LP value of each action. It is changed in place: when a cut is yielded, the
    values of its landmark become 1.
    ``costs``: an array of the cost of each action.
    ``random_number``: returns numbers from 0 to 1.
    ``tolerance``: a cut is violated if the values of its landmark add up to less than ``1 - tolerance``.

    Landmarks avoid actions of great LP value. Among actions of equal value, they avoid cheap ones, where each
    cost counts times a random factor from 0.5 to 1.5. Ends when the next cut is not violated, or there is no
    other cut.
    """
    import numpy as np  # noqa: PLC0415 (a part of HiGHS is there already)

    actions = np.array(cutter.actions, dtype=int)
    costs = costs[actions]
    while True:
        random_costs = costs * [0.5 + random_number() for _ in actions]
        cut = cutter.cut(used, actions[np.lexsort((random_costs, -lp_values[actions]))].tolist())
        if cut is None or lp_values[list(cut.members)].sum() >= 1 - tolerance:
            return
        lp_values[list(cut.members)] = 1.0
        yield cut
