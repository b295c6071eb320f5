"""Cuts whose landmarks a relaxed solution does not hit, each beside those before."""

from collections.abc import Callable, Collection, Iterator
from typing import Any

from foon_asp.bounds.cut import Cut, Cutter

_HIT = 0.999  # a landmark of a greater share is taken to be hit


def missed_cuts(
    cutter: Cutter, used: Collection[int], shares: Any, costs: Any, chance: Callable[[], float]
) -> Iterator[Cut]:
    """Grow cuts that no action of ``used`` crosses, with no member in common, until one is hit.

    ``shares`` is an array of how much of each action the solution takes; those of a cut's members become 1.
    Actions of great shares stay out of landmarks where that can be, and of the others cheap ones, by an array
    of ``costs`` and by ``chance``.
    """
    import numpy as np  # noqa: PLC0415 (a part of HiGHS is there already)

    places = np.array(cutter.actions)
    costs = costs[places]
    while True:
        dear = costs * [0.5 + chance() for _ in places]
        cut = cutter.cut(used, places[np.lexsort((dear, -shares[places]))].tolist())
        if cut is None or shares[list(cut.members)].sum() >= _HIT:
            return
        shares[list(cut.members)] = 1.0
        yield cut
