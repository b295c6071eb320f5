"""The heuristics h_add and h_max (Bonet and Geffner 2001), and trees that follow their best achievers."""

from collections.abc import Callable, Collection, Iterable, Mapping
from heapq import heapify, heappop, heappush
from typing import NamedTuple

from foon_asp.hypergraph.goal_graph import GoalGraph
from foon_asp.problem import follow_achievers


class Derivations(NamedTuple):
    """The h-values and best achievers of the objects that some actions reach.

    ``h_objects``: the h-value of each object.
    ``best_achievers``: the achiever by which each object has its h-value. Following best achievers is
    acyclic.
    ``h_actions``: for each action, its cost plus the h-value of its preconditions.

    All three are in ascending order of h-values. Actions that cannot run, objects that are not reached, and
    initial objects are missing.
    """

    h_objects: dict[int, int]
    best_achievers: dict[int, int]
    h_actions: dict[int, int]

    def tree(self, graph: GoalGraph, objects: Iterable[int]) -> set[int] | None:
        """Return the actions that derive some objects by best achievers.

        Return ``None`` if one of the objects is not reached.
        """
        return follow_achievers(objects, self.best_achievers, graph.needs, graph.start)


def compute_h_values(
    graph: GoalGraph, actions: Collection[int], cost: Mapping[int, int] | Callable[[int], int], h_add: bool
) -> Derivations:
    """Return the h-values and best achievers of the objects that actions reach; no cost is below 0.

    The h-value of an object is that of its best achiever: the cost of the achiever plus the h-value of its
    preconditions. With ``h_add``, the h-values of the preconditions are added, so shared actions count more
    than once. Otherwise, their maximum is taken (h_max). Then no derivation costs less than the h-value
    (Bonet and Geffner 2001). The algorithm is Dijkstra's, generalized, with a bucket for each h-value.
    """
    price = cost.__getitem__ if isinstance(cost, Mapping) else cost
    needs, gives, start = graph.needs, graph.gives, graph.start
    consumers: dict[int, list[int]] = {}
    missing: dict[int, int] = {}
    buckets: dict[int, list[int]] = {}
    for action in actions:
        count = 0
        for o in needs[action]:
            if o not in start:
                count += 1
                if o in consumers:
                    consumers[o].append(action)
                else:
                    consumers[o] = [action]
        if count:
            missing[action] = count
        else:
            buckets.setdefault(price(action), []).append(action)
    h_values = list(buckets)
    heapify(h_values)
    h_objects: dict[int, int] = {}
    best_achievers: dict[int, int] = {}
    h_actions: dict[int, int] = {}
    no_consumers: list[int] = []
    while h_values:
        h_value = heappop(h_values)
        for action in buckets[h_value]:  # grows while it is walked through, where actions cost nothing
            h_actions[action] = h_value
            for o in gives[action]:
                if o in h_objects or o in start:
                    continue
                h_objects[o] = h_value
                best_achievers[o] = action
                for consumer in consumers.get(o, no_consumers):
                    count = missing[consumer] - 1
                    missing[consumer] = count
                    if count:
                        continue
                    before = (
                        sum([h_objects[n] for n in needs[consumer] if n in h_objects]) if h_add else h_value
                    )
                    total = price(consumer) + before
                    bucket = buckets.get(total)
                    if bucket is None:
                        buckets[total] = [consumer]
                        heappush(h_values, total)
                    else:
                        bucket.append(consumer)
    return Derivations(h_objects, best_achievers, h_actions)
