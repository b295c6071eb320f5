"""Cheapest ways to make things when sharing is ignored: estimates, and trees that follow them."""

from collections.abc import Callable, Collection, Iterable, Mapping
from heapq import heapify, heappop, heappush
from typing import NamedTuple

from foon_asp.problem import follow
from foon_asp.reduce.graph import Graph


class Derivations(NamedTuple):
    """What some actions can make, cheapest first.

    ``cost[o]`` estimates what object ``o`` costs and ``maker[o]`` is the action that gives it for that;
    following the makers back never runs in a circle. ``before[a]`` is the estimate for action ``a`` with all
    that it needs; actions that cannot run are not there. What is there from the start is in none of them.
    """

    cost: dict[int, int]
    maker: dict[int, int]
    before: dict[int, int]

    def tree(self, graph: Graph, objects: Iterable[int]) -> set[int] | None:
        """Return the actions that make the objects by following the makers; ``None`` if one is not made."""
        return follow(objects, self.maker, graph.needs, graph.start)


def derive(
    graph: Graph, actions: Collection[int], cost: Mapping[int, int] | Callable[[int], int], added: bool
) -> Derivations:
    """Find cheapest derivations from the start by the given actions, with costs of zero or more.

    With ``added``, an action costs as much as all that it needs together and itself (h_add), which counts
    twice what is used twice; else as the dearest of its needs and itself (h_max), which no derivation goes
    below (Bonet and Geffner 2001). Dijkstra's algorithm, with a bucket for each figure.
    """
    price = cost.__getitem__ if isinstance(cost, Mapping) else cost
    needs, gives, start = graph.needs, graph.gives, graph.start
    takers: dict[int, list[int]] = {}
    missing: dict[int, int] = {}
    buckets: dict[int, list[int]] = {}
    for action in actions:
        count = 0
        for o in needs[action]:
            if o not in start:
                count += 1
                if o in takers:
                    takers[o].append(action)
                else:
                    takers[o] = [action]
        if count:
            missing[action] = count
        else:
            buckets.setdefault(price(action), []).append(action)
    figures = list(buckets)
    heapify(figures)
    costs: dict[int, int] = {}
    maker: dict[int, int] = {}
    before: dict[int, int] = {}
    nobody: list[int] = []
    while figures:
        figure = heappop(figures)
        for action in buckets[figure]:  # grows while it is walked through, where actions cost nothing
            before[action] = figure
            for o in gives[action]:
                if o in costs or o in start:
                    continue
                costs[o] = figure
                maker[o] = action
                for taker in takers.get(o, nobody):
                    count = missing[taker] - 1
                    missing[taker] = count
                    if not count:
                        own = price(taker)
                        if added:
                            total = own + sum([costs[n] for n in needs[taker] if n in costs])
                        else:
                            total = own + figure
                        waiting = buckets.get(total)
                        if waiting is None:
                            buckets[total] = [taker]
                            heappush(figures, total)
                        else:
                            waiting.append(taker)
    return Derivations(costs, maker, before)
