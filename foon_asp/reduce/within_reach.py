"""Whether objects can be made at rests up to a limit, found only as far as somebody asks."""

import math
from collections.abc import Callable, Container

from foon_asp.reduce.graph import Graph

_DEEP = 100  # actions that build upon each other, beyond which nothing is looked at
_LOOKS = 200_000  # at actions, in all: in circles each object can be asked about at very many limits


def within_reach(
    graph: Graph, allowed: Container[int], rest: Callable[[int], int]
) -> Callable[[int, float], bool]:
    """Report an object and a limit whether allowed actions can make it at rests up to that.

    It takes as much as the dearest that its maker needs, and the maker (h_max): what ``derive`` finds of all
    objects at once. Here it is found from the object that is asked about downwards, and what a limit rules
    out is not looked at, which is most of a large network where the limit is low. ``True`` where it would be
    too deep, or take too long, to tell. ``rest(a)`` is what the cuts leave of the cost of action ``a``.
    """
    needs, makers, start = graph.needs, graph.makers, graph.start
    least: dict[int, float] = {}  # what objects take at least, as far as known
    enough: dict[int, float] = {}  # limits that were enough
    looks = _LOOKS

    def reached(o: int, limit: float, deep: int = _DEEP) -> bool:
        nonlocal looks
        if least.get(o, 0) > limit:
            return False
        if o in start or enough.get(o, math.inf) <= limit or looks < 0:
            return True
        lowest = math.inf
        for action in makers[o]:
            if action not in allowed:
                continue
            looks -= 1
            own: float = rest(action)
            if own <= limit:
                left = limit - own
                for needed in needs[action]:
                    if needed not in start and deep and not reached(needed, left, deep - 1):
                        missing = least[needed]
                        own = missing if missing == math.inf else own + missing  # whole numbers may be huge
                        break
                else:
                    enough[o] = limit
                    return True
            lowest = min(lowest, own)
        least[o] = lowest
        return False

    return reached
