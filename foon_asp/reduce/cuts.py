"""Lower bounds by landmark cuts, found where they are needed only.

Landmarks as in :mod:`foon_asp.bounds.cut`: of the actions that give an object of a set with a goal in it and
need none of the set, every derivation uses one. Costs are divided among landmarks as LM-cut does (Helmert and
Domshlak 2009): each takes from all of its members what the cheapest has left.
"""

from collections.abc import Callable, Container, Mapping
from typing import NamedTuple

from foon_asp.reduce.graph import Graph


class WeightedCut(NamedTuple):
    """A cut: its objects, the actions of its landmark, the one that had least cost left, and that as weight."""

    objects: frozenset[int]
    members: tuple[int, ...]
    cheapest: int
    weight: int


class Cuts(NamedTuple):
    """Weighted cuts: their sum ``bound`` is what every derivation costs at least.

    ``left[a]`` is what the cuts leave of the cost of action ``a``; where it is not there, they take nothing.
    ``hopeless`` says that there is no derivation at all by the actions allowed.
    """

    bound: int
    left: dict[int, int]
    cuts: list[WeightedCut]
    hopeless: bool = False


def landmark_cuts(
    graph: Graph,
    allowed: Container[int],
    cost: Callable[[int], int],
    dear: Mapping[int, int],
    expired: Callable[[], bool],
) -> Cuts:
    """Find weighted cuts before the goals, until the rest of the costs lets all goals through for nothing.

    Only ``allowed`` actions count, and all costs are above zero. ``dear`` says how dear each object is
    thought to be: a cut passes through the dearest object that an action needs. What is made for nothing only
    grows, so that the time goes with what the cuts touch and not with the size of the graph.
    """
    needs, gives, makers, start = graph.needs, graph.gives, graph.makers, graph.start
    left: dict[int, int] = {}
    free: set[int] = set()
    lacking: dict[int, int] = {}
    waiting: dict[int, list[int]] = {}
    found: list[WeightedCut] = []
    bound = 0
    goals = sorted(graph.goals, key=lambda o: (dear.get(o, 0), o))

    def release(action: int) -> None:
        """Let an action that has no cost left run as soon as all it needs is free."""
        count = 0
        for o in needs[action]:
            if o not in free and o not in start:
                count += 1
                waiting.setdefault(o, []).append(action)
        lacking[action] = count
        stack = [] if count else [action]
        while stack:
            for o in gives[stack.pop()]:
                if o not in free and o not in start:
                    free.add(o)
                    for taker in waiting.pop(o, ()):
                        lacking[taker] -= 1
                        if not lacking[taker]:
                            stack.append(taker)

    while goals and not expired():
        if goals[-1] in free:
            goals.pop()
            continue
        zone = {goals[-1]}
        stack = [goals[-1]]
        edge: dict[int, None] = {}
        passed: set[int] = set()
        while stack:
            for action in makers[stack.pop()]:
                if action in passed or action in edge or action not in allowed:
                    continue
                if left.get(action, 1):
                    edge[action] = None
                    continue
                passed.add(action)
                needed = needs[action]
                if zone.isdisjoint(needed):
                    o = max(
                        (o for o in needed if o not in free and o not in start),
                        key=lambda o: (dear.get(o, 0), o),
                    )
                    zone.add(o)
                    stack.append(o)
        members = tuple(action for action in edge if zone.isdisjoint(needs[action]))
        if not members:
            return Cuts(bound, left, found, hopeless=True)
        rests = [left[a] if a in left else cost(a) for a in members]
        weight = min(rests)
        bound += weight
        found.append(WeightedCut(frozenset(zone), members, members[rests.index(weight)], weight))
        for action, rest in zip(members, rests, strict=True):
            left[action] = rest - weight
            if rest == weight:
                release(action)
    return Cuts(bound, left, found)
