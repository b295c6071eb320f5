"""What trees have beyond a tree for the goals, to have a unit of each required set as well."""

from collections.abc import Callable, Collection
from dataclasses import replace

from foon_asp.reduce.derivation import derive
from foon_asp.reduce.graph import Graph
from foon_asp.reduce.narrow import narrow
from foon_asp.reduce.near import near
from foon_asp.reduce.within_reach import within_reach

_FIRST = 500  # actions nearest to the required sets, among which an extension is looked for


def extended(graph: Graph, tree: Collection[int], cost: Callable[[int], int], most: int) -> set[int] | None:
    """Return a tree with what else it takes to have a unit of each required set, as cheaply as estimates say.

    ``None`` where none is found among ``most`` actions.
    """
    towards = _towards_required(graph)
    price = _free(tree, cost)
    few = {*tree, *near(towards, range(len(graph.needs)), price, sum(map(cost, tree)), most=_FIRST)}
    found = derive(towards, few, price, added=True).tree(towards, towards.goals)
    if found is None:
        narrowed = narrow(towards, few, price, most)
        found = None if narrowed is None else narrowed[1]
    return None if found is None else {*tree, *found}


def extensions(
    graph: Graph, free: Collection[int], cost: Callable[[int], int], limit: int, expired: Callable[[], bool]
) -> set[int]:
    """Return the actions that an extension of costs up to a limit can have, as if ``free`` ones cost nothing.

    All on a way from an action of it to a required set is of the extension, too, so that counts in full, and
    what the action builds upon does besides, but for free ones.
    """
    towards, price = _towards_required(graph), _free(free, cost)
    every = range(len(graph.needs))
    left = near(towards, every, cost, limit, least=1, within=within_reach(graph, every, price))
    while not expired():
        made = derive(graph, left.union(free), price, added=False)
        nearer = near(towards, left, cost, limit, made.before, least=1)
        if len(nearer) == len(left):
            break
        left = nearer
    return left


def _towards_required(graph: Graph) -> Graph:
    return replace(graph, goals=tuple(graph.required), known_makers=graph.makers)


def _free(free: Collection[int], cost: Callable[[int], int]) -> Callable[[int], int]:
    return lambda action: 0 if action in free else cost(action)
