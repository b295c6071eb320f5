"""A restricted subproblem: a few actions of a large network that contain a tree."""

from collections.abc import Callable

from foon_asp.hypergraph.goal_graph import GoalGraph
from foon_asp.hypergraph.h_values import Derivations, compute_h_values


def restricted_subproblem(
    graph: GoalGraph, actions: set[int], cost: Callable[[int], int], max_actions: int
) -> tuple[Derivations, set[int]] | None:
    """Extend a set of actions until it contains a tree; return its derivations by h_max, and the tree.

    Each round adds an achiever of each relevant object that is not reached. Achievers with the fewest
    non-initial preconditions come first. The set ``actions`` itself is not changed. Returns ``None`` if there
    is no tree, or more than ``max_actions`` actions would be needed.
    """
    needs, achievers, start = graph.needs, graph.makers, graph.start
    chosen = set(actions)
    ranked: dict[int, list[int]] = {}  # by relevant object, its achievers not yet added, best last
    unreached = set(graph.goals)
    while len(chosen) <= max_actions:
        while unreached:
            o = unreached.pop()
            if o in start:
                continue
            candidates = ranked.get(o)
            if candidates is None:
                candidates = ranked[o] = sorted(
                    achievers[o], key=lambda a: (-sum(n not in start for n in needs[a]), -cost(a), -a)
                )
            if candidates:
                action = candidates.pop()
                chosen.add(action)
                unreached.update(n for n in needs[action] if n not in ranked)
        derivations = compute_h_values(graph, chosen, cost, h_add=False)
        tree = derivations.tree(graph, graph.goals)
        if tree is not None:
            return derivations, tree
        unreached = {o for o, candidates in ranked.items() if candidates and o not in derivations.h_objects}
        if not unreached:
            return None
    return None
