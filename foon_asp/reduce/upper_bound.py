"""Trees that are good, found fast, with nothing in them that can be left out."""

from collections.abc import Callable, Collection, Iterator, Mapping
from heapq import heapify, heappop, heappush
from typing import TYPE_CHECKING

from foon_asp.reduce.derivation import derive
from foon_asp.reduce.graph import Graph
from foon_asp.reduce.support import Support

if TYPE_CHECKING:  # few questions need it
    from foon_asp.bounds.shared_costs import SharedCosts

_FINE = 1000  # steps of shares, and of costs that vary, that the estimates tell apart
_MOST = 160  # trees that chance leads to


def without_spare(graph: Graph, tree: Collection[int], cost: Callable[[int], int]) -> set[int]:
    """Leave out actions one by one, dear ones first, as long as the others still make the goals.

    All of the actions can run. What the cheapest ways to make the goals do not have goes first.
    """
    support = Support(graph, tree, cost)
    waiting = [(-cost(action), action) for action in support.left]
    heapify(waiting)
    needed: set[int] = set()  # and needed in every smaller tree as well
    while waiting:
        _, action = heappop(waiting)
        if action in support.left and action not in needed and support.replaceable(action):
            freed = support.leave_out(action)
            if freed is None:
                needed.add(action)
            for other in freed or ():  # it may not have been replaceable before
                heappush(waiting, (-cost(other), other))
    return support.left


def guessed(
    graph: Graph,
    actions: Collection[int],
    cost: Callable[[int], int],
    shares: Mapping[int, float],
    without: Collection[int],
) -> Iterator[set[int]]:
    """Return trees without some actions that use what a relaxed solution takes."""
    allowed = [a for a in actions if a not in without]

    def unshared(action: int) -> int:
        return 1 + cost(action) * int(_FINE * (1 - min(1.0, shares[action])))

    for added in (True, False):
        found = derive(graph, allowed, unshared, added).tree(graph, graph.goals)
        if found is not None:
            yield without_spare(graph, found, cost)


def _part(cost: int, share: float) -> int:
    """Return a share of a cost in steps, rounded down: a cost may be beyond all floats."""
    return cost * int(share * _FINE * _FINE) // _FINE


def following(
    graph: Graph, actions: Collection[int], cost: Callable[[int], int], shared: "SharedCosts"
) -> Iterator[set[int]]:
    """Return trees that follow a relaxed solution, by what it takes and by what cuts leave of the costs."""

    def unshared(action: int) -> int:
        return 1 + _part(cost(action), 1 - min(1.0, shared.shares[action]))

    def loose(action: int) -> int:
        return cost(action) + shared.reduced_costs[action]

    for price in (unshared, loose):
        for added in (True, False):
            found = derive(graph, actions, price, added).tree(graph, graph.goals)
            if found is not None:
                yield without_spare(graph, found, cost)


def varied(
    graph: Graph,
    actions: Collection[int],
    tree: set[int],
    cost: Callable[[int], int],
    enough: int,
    expired: Callable[[], bool],
    shares: Mapping[int, float],
    chance: Callable[[], float],
    tries: int,
) -> set[int]:
    """Look for a cheaper tree by chance, down to a cost that is ``enough``; gives the same if none is found.

    Some of the actions of a tree cost nothing, any number of them, and each other one costs half as much more
    or less than it does; half of the times, only some of the others are there, which takes less time. A tree
    that costs the same is the next to start from. Each other time, of all actions the ``shares`` that a
    relaxed solution takes cost nothing instead. Each action may be looked at ``tries`` times after the last
    better tree.
    """
    best = last = tree
    total = sum(map(cost, tree))
    ordered = sorted(actions)
    effort = tries * len(ordered)
    for _ in range(_MOST):
        if effort <= 0 or total <= enough or expired():
            break
        if chance() < 0.5:
            some = ordered
            untaken = ((a, (1 - min(1.0, shares[a])) * (0.5 + chance())) for a in some)
            price = {a: 1 + _part(cost(a), share) for a, share in untaken}
        else:
            share, part = chance(), 1.0 if chance() < 0.5 else chance() ** 2
            some = [a for a in ordered if chance() < part or a in last]
            price = {a: _part(cost(a), 0.5 + chance()) for a in some}
            price |= {a: 0 for a in sorted(last) if chance() < share}
        effort -= len(some)
        found = derive(graph, some, price, added=chance() < 0.5).tree(graph, graph.goals)
        slim = without_spare(graph, found or last, cost)
        slim_total = sum(map(cost, slim))
        if slim_total < total:
            best, effort = slim, tries * len(ordered)
        if slim_total <= total:
            last, total = slim, slim_total
    return best


def improved(
    graph: Graph,
    actions: Collection[int],
    tree: set[int],
    cost: Callable[[int], int],
    rest: Callable[[int], int],
    expired: Callable[[], bool],
    thorough: bool,
) -> set[int]:
    """Look for a cheaper tree among the actions; gives the same tree if none is found.

    First the trees that estimates lead to, by the costs and by what cuts leave of them; then, to be thorough,
    for each action of the best one, a tree without it that uses as much as it can of the others.
    """
    best = tree
    total = sum(map(cost, best))

    def offer(actions: Collection[int], price: Callable[[int], int], added: bool) -> None:
        nonlocal best, total
        found = derive(graph, actions, price, added).tree(graph, graph.goals)
        if found is not None:
            slim = without_spare(graph, found, cost)
            slim_total = sum(map(cost, slim))
            if slim_total < total:
                best, total = slim, slim_total

    for added in (True, False):
        offer(actions, cost, added)
        offer(actions, lambda a: rest(a) * total + cost(a), added)
    tried: set[int] = set()
    while thorough and not expired() and (untried := best - tried):
        action = max(untried, key=lambda a: (rest(a), cost(a), -a))
        tried.add(action)
        offer([a for a in actions if a != action], lambda a: 0 if a in best else cost(a), added=True)
    return best
