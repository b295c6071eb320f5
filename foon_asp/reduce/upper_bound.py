"""Trees that are good, found fast, with nothing in them that can be left out."""

from collections.abc import Callable, Collection, Iterable

from foon_asp.reduce.derivation import derive
from foon_asp.reduce.graph import Graph


def without_spare(graph: Graph, tree: Iterable[int], cost: Callable[[int], int]) -> set[int]:
    """Leave out actions one by one, dear ones first, as long as the others still make the goals."""
    left = set(tree)
    left = derive(graph, left, lambda _: 1, added=False).tree(graph, graph.goals) or left
    for action in sorted(left, key=lambda a: (-cost(a), a)):
        if action in left:
            smaller = derive(graph, left - {action}, lambda _: 1, added=False).tree(graph, graph.goals)
            if smaller is not None:
                left = smaller
    return left


def improved(
    graph: Graph,
    actions: Collection[int],
    tree: set[int],
    cost: Callable[[int], int],
    rest: Callable[[int], int],
    expired: Callable[[], bool],
) -> set[int]:
    """Look for a cheaper tree among the actions; gives the tree itself where none is found.

    First the trees that estimates lead to, by the costs and by what cuts leave of them; then, for each
    action of the best one, a tree without it that uses as much as it can of the others.
    """
    best = tree
    total = sum(map(cost, best))

    def offer(found: set[int] | None) -> bool:
        nonlocal best, total
        if found is None:
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
    again = True
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
