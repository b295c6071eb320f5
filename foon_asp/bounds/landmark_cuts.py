"""Lower bounds by landmark cuts, found where they are needed only.

Landmarks as in :mod:`foon_asp.bounds.cut`: of the actions that give an object of a set with a goal in it and
need none of the set, every derivation uses one. Costs are divided among landmarks as LM-cut does (Helmert and
Domshlak 2009): each takes from all of its members what the cheapest has left.
"""

import math
from collections import deque
from collections.abc import Callable, Container, Iterable, Mapping
from typing import NamedTuple

from foon_asp.bounds.hypergraph import Hypergraph

_FRESH = 64  # cuts, or one for each target, after which what is thought of how dear objects are is too old


class WeightedCut(NamedTuple):
    """A cut: its objects, its landmark, the member that had least cost left, and that cost as its weight."""

    objects: frozenset[int]
    members: tuple[int, ...]
    cheapest: int
    weight: int


class Cuts(NamedTuple):
    """Weighted cuts: their sum ``bound`` is what every derivation costs at least.

    ``left[a]`` is what the cuts leave of the cost of action ``a``; where it is not there, they take nothing.
    ``hopeless`` says that there is no derivation at all by the actions allowed, ``interrupted`` that ctrl-C
    ended the search for more: the bound holds, and ``left`` is of no use.
    """

    bound: int
    left: dict[int, int]
    cuts: list[WeightedCut]
    hopeless: bool = False
    interrupted: bool = False


def landmark_cuts(
    graph: Hypergraph,
    targets: Iterable[int],
    allowed: Container[int],
    cost: Callable[[int], int],
    dear: Mapping[int, int],
    expired: Callable[[], bool],
    guide: Callable[[Callable[[int], int]], Mapping[int, int]] | None = None,
    most: float = math.inf,
) -> Cuts:
    """Find weighted cuts before the targets, until what is left of the costs gives them all for nothing.

    Or until their landmarks have ``most`` members together, or about.

    Only ``allowed`` actions count, and all costs are above zero. ``dear`` says how dear each object is
    thought to be, those not in it dearer than all: a cut passes through the dearest object that an action
    needs. Each target in turn has a cut, the dearest first: more cuts of the dearest alone would take what
    others have cuts of their own for. ``guide`` tells how dear objects are from the costs of actions, and is
    asked now and then by what the cuts leave of them. What is made for nothing only grows, so that the time
    goes with what the cuts touch and not with the size of the graph.
    """
    needs, makers = graph.needs, graph.makers
    left: dict[int, int] = {}
    free = _Free(graph)
    found: list[WeightedCut] = []
    bound = effort = 0

    def rest_of(action: int) -> int:
        return left[action] if action in left else cost(action)

    def dearness(o: int) -> tuple[float, int]:
        return dear.get(o, math.inf), o

    remaining = deque(sorted(targets, key=dearness, reverse=True))
    fresh = max(_FRESH, len(remaining))
    try:
        while remaining and effort < most and not expired():
            target = remaining.popleft()
            if target in free.objects:
                continue
            remaining.append(target)
            if guide is not None and found and len(found) % fresh == 0:
                dear = guide(rest_of)
            zone = {target}
            stack = [target]
            edge: dict[int, None] = {}
            while stack:
                for action in makers[stack.pop()]:
                    if action not in allowed:
                        continue
                    if left.get(action, True):
                        edge[action] = None
                    elif zone.isdisjoint(needs[action]):
                        o = max(free.lacking(action), key=dearness)
                        zone.add(o)
                        stack.append(o)
            members = tuple(action for action in edge if zone.isdisjoint(needs[action]))
            if not members:
                return Cuts(bound, left, found, hopeless=True)
            rests = {action: rest_of(action) for action in members}
            cheapest = min(rests, key=rests.__getitem__)
            weight = rests[cheapest]
            bound += weight
            effort += len(members)
            found.append(WeightedCut(frozenset(zone), members, cheapest, weight))
            for action, rest in rests.items():
                left[action] = rest - weight
                if rest == weight:
                    free.release(action)
    except KeyboardInterrupt:
        return Cuts(bound, left, found, interrupted=True)
    return Cuts(bound, left, found)


class _Free:
    """What can be made for nothing, growing as actions run out of cost."""

    def __init__(self, graph: Hypergraph) -> None:
        self._graph = graph
        self.objects: set[int] = set()
        self._missing: dict[int, int] = {}
        self._waiting: dict[int, list[int]] = {}

    def lacking(self, action: int) -> list[int]:
        """Give what an action needs and what is neither free nor there from the start."""
        free, start = self.objects, self._graph.start
        return [o for o in self._graph.needs[action] if o not in free and o not in start]

    def release(self, action: int) -> None:
        """Let an action that has no cost left run as soon as all it needs is free."""
        lacking = self.lacking(action)
        self._missing[action] = len(lacking)
        for o in lacking:
            self._waiting.setdefault(o, []).append(action)
        stack = [] if lacking else [action]
        while stack:
            for o in self._graph.gives[stack.pop()]:
                self.objects.add(o)
                for taker in self._waiting.pop(o, ()):
                    self._missing[taker] -= 1
                    if not self._missing[taker]:
                        stack.append(taker)
