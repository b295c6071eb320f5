"""Reduced-cost fixing: exclude actions that no tree below a given cost can have."""

from collections.abc import Callable, Container, Mapping
from heapq import heappop, heappush

from foon_asp.hypergraph.exact_costs import ExactCosts
from foon_asp.hypergraph.goal_graph import GoalGraph
from foon_asp.hypergraph.h_values import compute_h_values
from foon_asp.hypergraph.landmark_cuts import Cuts
from foon_asp.hypergraph.lazy_h_max import lazy_h_max_test


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
    """Return a superset of the allowed actions of irredundant trees of reduced cost up to ``limit``.

    In such a tree, a path leads from each action to a goal: each action makes a precondition of the next. So
    the reduced costs along the path add up to at most ``limit``. The paths are found by Dijkstra's algorithm
    from the goals.

    ``limit``: the greatest reduced cost; ``math.inf`` for no limit.
    ``h_actions``: the h-values of actions. With them, the first action of a path counts with its h-value
    instead of its reduced cost. Actions without an h-value are excluded.
    ``enough``: the number of actions at which the search ends. Then the result is no superset.
    ``min_reduced_cost``: a number that no reduced cost is below.
    ``reachable``: a test as returned by :func:`lazy_h_max_test`, used instead of ``h_actions``. An action is
    excluded if a precondition cannot be made at ``limit`` minus the reduced costs of the path.
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


def reduced_costs_of(costs: ExactCosts, cuts: Cuts) -> Callable[[int], int]:
    """Return a function that returns the reduced cost of an action by a cost partition."""
    reduced_costs = cuts.reduced_costs
    return lambda action: reduced_costs[action] if action in reduced_costs else costs(action)


def reduced_cost_fixing(
    graph: GoalGraph,
    allowed: Container[int],
    reduced_cost: Callable[[int], int],
    limit: int,
    expired: Callable[[], bool],
) -> set[int]:
    """Return a superset of the allowed actions of irredundant trees of reduced cost up to ``limit``.

    An action is excluded if its h_max plus the reduced costs of its cheapest path to a goal exceed the limit.
    Both are computed anew over the remaining actions until no more actions are excluded. If time is up, the
    superset is larger.
    """
    remaining = neighbourhood(
        graph, allowed, reduced_cost, limit, reachable=lazy_h_max_test(graph, allowed, reduced_cost)
    )
    while not expired():
        derivations = compute_h_values(graph, remaining, reduced_cost, h_add=False)
        narrowed = neighbourhood(graph, remaining, reduced_cost, limit, derivations.h_actions)
        if len(narrowed) == len(remaining):
            break
        remaining = narrowed
    return remaining
