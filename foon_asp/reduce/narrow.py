"""A few actions of a large network among which there is a tree."""

from collections.abc import Callable

from foon_asp.reduce.derivation import Derivations, derive
from foon_asp.reduce.graph import Graph


def narrow(
    graph: Graph, actions: set[int], cost: Callable[[int], int], most: int
) -> tuple[Derivations, set[int]] | None:
    """Add actions until a tree can be made of them: one more for each object that is wanted and not made.

    Those that lack least come first. Gives what the actions can make and the tree; ``None`` where there
    would be more than ``most`` actions, or where there is no tree.
    """
    needs, makers, start = graph.needs, graph.makers, graph.start
    chosen = set(actions)
    ranked: dict[int, list[int]] = {}  # for each wanted object the actions that give it, best last
    fresh = set(graph.goals)
    while len(chosen) <= most:
        while fresh:
            o = fresh.pop()
            if o in start:
                continue
            left = ranked.get(o)
            if left is None:
                left = ranked[o] = sorted(
                    makers[o], key=lambda a: (-sum(n not in start for n in needs[a]), -cost(a), -a)
                )
            if left:
                action = left.pop()
                chosen.add(action)
                fresh.update(n for n in needs[action] if n not in ranked)
        made = derive(graph, chosen, cost, added=False)
        tree = made.tree(graph, graph.goals)
        if tree is not None:
            return made, tree
        fresh = {o for o, left in ranked.items() if left and o not in made.cost}
        if not fresh:
            return None
    return None
