"""What a derivation of less than a given cost can still use, by what cuts leave of the costs."""

from collections.abc import Callable, Container, Mapping
from heapq import heappop, heappush

from foon_asp.reduce.graph import Graph


def near(
    graph: Graph,
    allowed: Container[int],
    rest: Callable[[int], int],
    limit: float,
    before: Mapping[int, int] | None = None,
    most: int | None = None,
    least: int = 0,
    within: Callable[[int, float], bool] | None = None,
) -> set[int]:
    """Return the allowed actions that a derivation without spare actions, of rests up to ``limit``, can have.

    ``rest(a)`` is what the cuts leave of the cost of action ``a``. Such a derivation leads from each of its
    actions to a goal, each needing what the one before gives, so the rests along the way count (no action
    that ``a`` builds upon is among them). With ``before``, the least rests of an action with all that it
    needs, those count instead of its own. Dijkstra's algorithm from the goals, which goes no farther than the
    limit lets it, and only until it has ``most`` actions, if given; ``limit`` is
    ``math.inf`` where there is none. No rest is below ``least``. ``within`` says of an object and what
    is left of the limit whether that can make it, where there is no ``before``.
    """
    needs, makers, start = graph.needs, graph.makers, graph.start
    buckets: dict[int, list[int]] = {0: list(graph.goals)}
    figures = [0]
    reached = set(start)
    kept: set[int] = set()
    while figures and figures[0] + least <= limit:
        figure = heappop(figures)
        for target in buckets[figure]:  # grows while it is walked through
            if target in reached:
                continue
            reached.add(target)
            for action in makers[target]:
                if action in kept or action not in allowed:
                    continue
                total = figure + rest(action)
                if total > limit:
                    continue
                if before is not None:
                    taken = before.get(action)
                    if taken is None or figure + taken > limit:
                        continue
                if within is not None and not all(within(o, limit - total) for o in needs[action]):
                    continue
                kept.add(action)
                if total not in buckets:
                    buckets[total] = []
                    heappush(figures, total)
                buckets[total] += needs[action]
        if most is not None and len(kept) >= most:
            break
    return kept
