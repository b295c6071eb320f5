"""Trees that are good, found fast, with nothing in them that can be left out."""

from collections.abc import Callable, Collection, Iterable

from foon_asp.reduce.derivation import derive
from foon_asp.reduce.graph import Graph


def without_spare(graph: Graph, tree: Iterable[int], cost: Callable[[int], int]) -> set[int]:
    """Leave out actions one by one, dear ones first, as long as the others still make the goals."""
    left = set(tree)
    left = derive(graph, left, lambda _: 1, added=False).tree(graph, graph.goals) or left
    needed: set[int] = set()  # and needed in every smaller tree as well
    again = True
    while again:
        again = False
        for action in replaceable(graph, left, cost):
            if action in left and action not in needed:
                smaller = derive(graph, left - {action}, lambda _: 1, added=False).tree(graph, graph.goals)
                if smaller is None:
                    needed.add(action)
                else:
                    left = smaller
                    again = True
    return left


def replaceable(graph: Graph, tree: Collection[int], cost: Callable[[int], int]) -> list[int]:
    """Give the actions, dear ones first, all of whose outputs in use another action of the tree gives, too.

    As long as an action can be left out there is one among these: the last, in an order that executes, of
    those that would not run without it or be of use.
    """
    makers: dict[int, int] = {}
    for action in tree:
        for o in graph.gives[action]:
            makers[o] = makers.get(o, 0) + 1
    used = set(graph.goals).union(*(graph.needs[action] for action in tree)) - graph.start
    return sorted(
        (a for a in tree if all(makers[o] > 1 for o in graph.gives[a] if o in used)),
        key=lambda a: (-cost(a), a),
    )


def improved(
    graph: Graph,
    actions: Collection[int],
    tree: set[int],
    cost: Callable[[int], int],
    rest: Callable[[int], int],
    expired: Callable[[], bool],
    thorough: bool,
) -> set[int]:
    """Look for a cheaper tree among the actions; gives the tree itself where none is found.

    First the trees that estimates lead to, by the costs and by what cuts leave of them; then, to be thorough,
    for each action of the best one, a tree without it that uses as much as it can of the others.
    """
    best = tree
    total = sum(map(cost, best))

    def offer(found: set[int] | None) -> bool:
        nonlocal best, total
        if found is None:
            return False
        spare = replaceable(
            graph, found, cost
        )  # without these and what only they need is the least it can cost
        if not spare and sum(map(cost, found)) >= total:
            return False
        slim = without_spare(graph, found, cost)
        price = sum(map(cost, slim))
        if price >= total:
            return False
        best, total = slim, price
        return True

    large = total + 1
    for added in (True, False):
        for price in (cost, lambda a: rest(a) * large + cost(a)):
            offer(derive(graph, actions, price, added).tree(graph, graph.goals))
    tried: set[int] = set()
    again = thorough
    while again and not expired():
        again = False
        for action in sorted(best, key=lambda a: (-rest(a), -cost(a), a)):
            if action in tried or expired():
                continue
            tried.add(action)
            others = [a for a in actions if a != action]
            prices = dict.fromkeys(others, 0)
            prices.update((a, cost(a)) for a in others if a not in best)
            found = derive(graph, others, prices, added=True)
            if offer(found.tree(graph, graph.goals)):
                again = True
                tried &= best
                break
    return best
