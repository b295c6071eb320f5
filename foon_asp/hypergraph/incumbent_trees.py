"""Primal heuristics: good irredundant trees, found fast."""

from collections.abc import Callable, Collection, Iterator, Mapping
from heapq import heapify, heappop, heappush
from typing import TYPE_CHECKING

from foon_asp.hypergraph.goal_graph import GoalGraph
from foon_asp.hypergraph.h_values import compute_h_values
from foon_asp.hypergraph.support import Support

if TYPE_CHECKING:  # few questions need it
    from foon_asp.hypergraph.cost_partition import CostPartition


def irredundant_subset(graph: GoalGraph, tree: Collection[int], cost: Callable[[int], int]) -> set[int]:
    """Return an irredundant subset of a tree, by removing redundant actions, expensive ones first.

    All actions of the tree have to be able to run, and together they have to reach the goals. Best achievers
    by h_add are followed from the goals. Actions that are not reached in this way are removed first, all at
    once.
    """
    support = Support(graph, tree, cost)
    waiting = [(-cost(action), action) for action in support.actions]
    heapify(waiting)
    needed: set[int] = set()  # and so in every subset of the tree
    while waiting:
        _, action = heappop(waiting)
        if action in support.actions and action not in needed and support.is_replaceable(action):
            freed = support.remove(action)
            if freed is None:
                needed.add(action)
            for other in freed or ():  # they may have become replaceable
                heappush(waiting, (-cost(other), other))
    return support.actions


def trees_by_lp_values(
    graph: GoalGraph,
    actions: Collection[int],
    cost: Callable[[int], int],
    lp_values: Mapping[int, float],
    without: Collection[int],
) -> Iterator[set[int]]:
    """Yield an irredundant tree that follows h_add and one that follows h_max, both guided by LP values.

    For the h-values, the cost of an action is multiplied by 1 minus its LP value. Each action except those in
    ``without`` has to have an LP value. The trees have no action of ``without``. Yields nothing if there is
    no such tree.
    """
    allowed = [a for a in actions if a not in without]

    def price_by_lp_value(action: int) -> int:
        """Return about ``1000 * cost * (1 - LP value)`` for an action."""
        return 1 + _scaled_cost(cost(action), 1 - min(1.0, lp_values[action]))

    for h_add in (True, False):
        tree = compute_h_values(graph, allowed, price_by_lp_value, h_add).tree(graph, graph.goals)
        if tree is not None:
            yield irredundant_subset(graph, tree, cost)


def _scaled_cost(cost: int, share: float) -> int:
    """Return ``1000 * cost * share``, rounded down.

    It is computed in integers, since costs may exceed floats.
    """
    return cost * int(share * 1_000_000) // 1000


def trees_by_partition(
    graph: GoalGraph, actions: Collection[int], cost: Callable[[int], int], partition: "CostPartition"
) -> Iterator[set[int]]:
    """Yield up to four irredundant trees that follow an LP solution.

    They follow h_add or h_max, at one of two prices. The first price of an action is its cost times 1 minus
    its LP value. The second is about its reduced cost.
    """

    def price_by_lp_value(action: int) -> int:
        """Return about ``1000 * cost * (1 - LP value)`` for an action."""
        return 1 + _scaled_cost(cost(action), 1 - min(1.0, partition.lp_values[action]))

    def price_by_reduced_cost(action: int) -> int:
        """Return the reduced cost of an action, in parts, plus its cost, which decides among equal ones."""
        return cost(action) + partition.reduced_costs[action]

    for price in (price_by_lp_value, price_by_reduced_cost):
        for h_add in (True, False):
            tree = compute_h_values(graph, actions, price, h_add).tree(graph, graph.goals)
            if tree is not None:
                yield irredundant_subset(graph, tree, cost)


def perturbation_search(
    graph: GoalGraph,
    actions: Collection[int],
    tree: set[int],
    cost: Callable[[int], int],
    sufficient_cost: int,
    expired: Callable[[], bool],
    lp_values: Mapping[int, float],
    random_number: Callable[[], float],
    tries: int,
) -> set[int]:
    """Return a tree of ``actions`` cheaper than ``tree``, found by perturbation search, else ``tree``.

    Each round derives an irredundant tree by h_add or h_max at perturbed costs: each cost is multiplied by a
    random factor from 0.5 to 1.5. In half of the rounds, costs are also multiplied by 1 minus the LP values.
    In the other half, a random part of the current tree costs nothing. In some of them, only a random part of
    the other actions is allowed. A tree that costs no more than the current tree replaces it.

    ``random_number`` returns numbers from 0 to 1. Ends when a tree costs at most ``sufficient_cost``, or time
    is up. Also ends when each action was looked at ``tries`` times since the last improvement.
    """
    best = current_tree = tree
    total = sum(map(cost, tree))
    ordered_actions = sorted(actions)
    effort = tries * len(ordered_actions)
    while effort > 0 and total > sufficient_cost and not expired():
        if random_number() < 0.5:
            candidates = ordered_actions
            factors = ((a, (1 - min(1.0, lp_values[a])) * (0.5 + random_number())) for a in candidates)
            price = {a: 1 + _scaled_cost(cost(a), share) for a, share in factors}
        else:
            share, allowed_share = random_number(), 1.0 if random_number() < 0.5 else random_number() ** 2
            candidates = [a for a in ordered_actions if random_number() < allowed_share or a in current_tree]
            price = {a: _scaled_cost(cost(a), 0.5 + random_number()) for a in candidates}
            price |= {a: 0 for a in sorted(current_tree) if random_number() < share}
        effort -= len(candidates)
        derived = compute_h_values(graph, candidates, price, h_add=random_number() < 0.5).tree(
            graph, graph.goals
        )
        candidate = irredundant_subset(graph, derived or current_tree, cost)
        candidate_total = sum(map(cost, candidate))
        if candidate_total < total:
            best, effort = candidate, tries * len(ordered_actions)
        if candidate_total <= total:
            current_tree, total = candidate, candidate_total
    return best


def improve_locally(
    graph: GoalGraph,
    actions: Collection[int],
    tree: set[int],
    cost: Callable[[int], int],
    reduced_cost: Callable[[int], int],
    expired: Callable[[], bool],
    thorough: bool,
) -> set[int]:
    """Return a tree of ``actions`` cheaper than ``tree``, found by local search, else ``tree``.

    Four trees are tried first: those that follow h_add and h_max, by costs and by reduced costs. If
    ``thorough``, the search then tries to do without each action of the best tree. For that, it derives a
    tree without this action, while the other actions of the best tree cost nothing. This ends when all
    actions of the best tree were tried, or time is up.
    """
    best = tree
    total = sum(map(cost, best))

    def try_derived_tree(actions: Collection[int], price: Callable[[int], int], h_add: bool) -> None:
        """Derive a tree at some prices; if an irredundant subset of it is cheaper, make it ``best``."""
        nonlocal best, total
        derived = compute_h_values(graph, actions, price, h_add).tree(graph, graph.goals)
        if derived is not None:
            candidate = irredundant_subset(graph, derived, cost)
            candidate_total = sum(map(cost, candidate))
            if candidate_total < total:
                best, total = candidate, candidate_total

    for use_h_add in (True, False):
        try_derived_tree(actions, cost, use_h_add)
        try_derived_tree(actions, lambda a: reduced_cost(a) * total + cost(a), use_h_add)
    tried: set[int] = set()
    while thorough and not expired() and (untried := best - tried):
        action = max(untried, key=lambda a: (reduced_cost(a), cost(a), -a))
        tried.add(action)
        try_derived_tree(
            [a for a in actions if a != action], lambda a: 0 if a in best else cost(a), h_add=True
        )
    return best
