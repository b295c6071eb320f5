"""The reduced-cost neighbourhood: actions that derivations below a given cost can use."""

from collections.abc import Callable, Container, Mapping
from heapq import heappop, heappush

from foon_asp.hypergraph.goal_graph import GoalGraph


def neighbourhood(
    graph: GoalGraph,
    allowed: Container[int],
    reduced_cost: Callable[[int], int],
    limit: float,
    h_actions: Mapping[int, int] | None = None,
    enough: int | None = None,
    min_reduced_cost: int = 0,
    reachable: Callable[[int, float], bool] | None = None,
) -> set[int]:
    """Return a superset of the allowed actions of irredundant derivations of reduced cost up to ``limit``.

    In such a derivation, a path leads from each action to a goal: each action makes a precondition of the
    next. So the reduced costs along the path add up to at most ``limit``. The paths are found by Dijkstra's
    algorithm from the goals.

    ``limit``: the greatest reduced cost; ``math.inf`` for no limit.
    ``h_actions``: h-values of actions. An action counts with its h-value, since no action of its derivation
    is on the path. Without them, it counts with its reduced cost.
    ``enough``: ends the search when this many actions are found. Then the result is no superset.
    ``min_reduced_cost``: no reduced cost is below it.
    ``reachable``: tests whether an object can be made at a reduced cost, if there are no ``h_actions``.
    """
    needs, achievers, start = graph.needs, graph.makers, graph.start
    buckets: dict[int, list[int]] = {0: list(graph.goals)}
    distances = [0]
    reached = set(start)
    kept: set[int] = set()
    while distances and distances[0] + min_reduced_cost <= limit:
        distance = heappop(distances)
        for target in buckets[distance]:  # grows while it is walked through
            if target in reached:
                continue
            reached.add(target)
            for action in achievers[target]:
                if action in kept or action not in allowed:
                    continue
                total = distance + reduced_cost(action)
                if total > limit:
                    continue
                if h_actions is not None:
                    h_action = h_actions.get(action)
                    if h_action is None or distance + h_action > limit:
                        continue
                if reachable is not None and not all(reachable(o, limit - total) for o in needs[action]):
                    continue
                kept.add(action)
                if total not in buckets:
                    buckets[total] = []
                    heappush(distances, total)
                buckets[total] += needs[action]
        if enough is not None and len(kept) >= enough:
            break
    return kept
