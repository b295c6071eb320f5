"""Extensions: units added to a tree for the goals, so that it has a unit of each required set.

The actions that these units need are a part of the extension.
"""

from collections.abc import Callable, Collection
from dataclasses import replace

from foon_asp.hypergraph.goal_graph import GoalGraph
from foon_asp.hypergraph.h_values import compute_h_values
from foon_asp.hypergraph.lazy_h_max import lazy_h_max_test
from foon_asp.hypergraph.reduced_cost_fixing import neighbourhood
from foon_asp.hypergraph.restricted_subproblem import restricted_subproblem

_FIRST = 500  # actions nearest to the required sets, among which an extension is looked for


def extend_tree(
    graph: GoalGraph, tree: Collection[int], cost: Callable[[int], int], max_actions: int
) -> set[int] | None:
    """Return the actions of a tree for the goals, together with the actions of an extension.

    The extension gives the tree a unit of each required set. It follows h_add, where actions of the tree cost
    nothing. It is first looked for among the actions nearest to the required sets. Then it is looked for in a
    restricted subproblem of at most ``max_actions`` actions. The result may have redundant actions. Returns
    ``None`` if no extension is found.
    """
    required_graph = _graph_of_required(graph)
    remaining_cost = _cost_without(tree, cost)
    candidates = {
        *tree,
        *neighbourhood(
            required_graph, range(len(graph.needs)), remaining_cost, sum(map(cost, tree)), enough=_FIRST
        ),
    }
    extension = compute_h_values(required_graph, candidates, remaining_cost, h_add=True).tree(
        required_graph, required_graph.goals
    )
    if extension is None:
        narrowed = restricted_subproblem(required_graph, candidates, remaining_cost, max_actions)
        extension = None if narrowed is None else narrowed[1]
    return None if extension is None else {*tree, *extension}


def actions_of_extensions(
    graph: GoalGraph,
    free: Collection[int],
    cost: Callable[[int], int],
    limit: int,
    expired: Callable[[], bool],
) -> set[int]:
    """Return a superset of the actions of all extensions that cost up to ``limit``.

    An extension has the actions that have to be added to a tree of ``free`` actions so that the tree has a
    unit of each required set. An action is excluded if its derivation and its path to a required set together
    cost more than ``limit``. In the derivation, ``free`` actions cost nothing. On the path, they count in
    full. If time is up, the superset is larger.
    """
    required_graph, remaining_cost = _graph_of_required(graph), _cost_without(free, cost)
    all_actions = range(len(graph.needs))
    remaining = neighbourhood(
        required_graph,
        all_actions,
        cost,
        limit,
        min_reduced_cost=1,
        reachable=lazy_h_max_test(graph, all_actions, remaining_cost),
    )
    while not expired():
        derivations = compute_h_values(graph, remaining.union(free), remaining_cost, h_add=False)
        narrowed = neighbourhood(
            required_graph, remaining, cost, limit, derivations.h_actions, min_reduced_cost=1
        )
        if len(narrowed) == len(remaining):
            break
        remaining = narrowed
    return remaining


def _graph_of_required(graph: GoalGraph) -> GoalGraph:
    """Return the graph with the required sets as its only goals."""
    return replace(graph, goals=tuple(graph.required), known_makers=graph.makers)


def _cost_without(free: Collection[int], cost: Callable[[int], int]) -> Callable[[int], int]:
    """Return a cost function by which the ``free`` actions cost nothing."""
    return lambda action: 0 if action in free else cost(action)
