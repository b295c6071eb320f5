"""Extensions of a tree for the goals alone by a unit of each required set."""

from collections.abc import Callable, Collection
from dataclasses import replace

from foon_asp.hypergraph.goal_graph import GoalGraph
from foon_asp.hypergraph.h_values import derive
from foon_asp.hypergraph.lazy_h_max import within_reach
from foon_asp.hypergraph.reduced_cost_neighbourhood import neighbourhood
from foon_asp.hypergraph.restricted_subproblem import restricted_subproblem

_FIRST = 500  # actions nearest to the required sets, among which an extension is looked for


def extended(
    graph: GoalGraph, tree: Collection[int], cost: Callable[[int], int], max_actions: int
) -> set[int] | None:
    """Return a tree extended by a unit of each required set and its derivation, following h_add.

    ``None`` where no extension is found among ``max_actions`` actions.
    """
    towards = _towards_required(graph)
    price = _free(tree, cost)
    candidates = {
        *tree,
        *neighbourhood(towards, range(len(graph.needs)), price, sum(map(cost, tree)), enough=_FIRST),
    }
    extension = derive(towards, candidates, price, h_add=True).tree(towards, towards.goals)
    if extension is None:
        narrowed = restricted_subproblem(towards, candidates, price, max_actions)
        extension = None if narrowed is None else narrowed[1]
    return None if extension is None else {*tree, *extension}


def extensions(
    graph: GoalGraph,
    free: Collection[int],
    cost: Callable[[int], int],
    limit: int,
    expired: Callable[[], bool],
) -> set[int]:
    """Return the actions of extensions that cost up to ``limit`` where ``free`` actions cost nothing.

    The path from each action of an extension to a required set belongs to the extension, so its cost counts
    in full. So does the cost of the action's derivation, except free actions.
    """
    towards, price = _towards_required(graph), _free(free, cost)
    all_actions = range(len(graph.needs))
    remaining = neighbourhood(
        towards,
        all_actions,
        cost,
        limit,
        min_reduced_cost=1,
        reachable=within_reach(graph, all_actions, price),
    )
    while not expired():
        derivations = derive(graph, remaining.union(free), price, h_add=False)
        nearer = neighbourhood(towards, remaining, cost, limit, derivations.h_actions, min_reduced_cost=1)
        if len(nearer) == len(remaining):
            break
        remaining = nearer
    return remaining


def _towards_required(graph: GoalGraph) -> GoalGraph:
    return replace(graph, goals=tuple(graph.required), known_makers=graph.makers)


def _free(free: Collection[int], cost: Callable[[int], int]) -> Callable[[int], int]:
    return lambda action: 0 if action in free else cost(action)
