"""Actions that another one can always stand in for."""

from collections import Counter
from collections.abc import Callable, Collection

from foon_asp.reduce.graph import Graph


def undominated(graph: Graph, actions: Collection[int], cost: Callable[[int], int]) -> set[int]:
    """Leave out every action of which another one left needs no more, gives all, and costs no more.

    In any tree the other can stand in for it, and the tree gets no dearer under the whole list of objectives,
    since ``cost`` compares by all of them. What nobody needs counts for nothing. Of actions that can stand in
    for each other, one is left.
    """
    start = graph.start
    needed = {a: frozenset(o for o in graph.needs[a] if o not in start) for a in actions}
    wanted = set(graph.goals).union(*needed.values())
    given = {a: frozenset(o for o in graph.gives[a] if o in wanted) for a in actions}
    left = set(actions)
    takers = Counter(o for needs in needed.values() for o in needs)
    made = Counter(o for gives in given.values() for o in gives)
    # by what they give and the need that fewest have: one that stands in for another shares that need with it
    makers: dict[tuple[int, int | None], list[int]] = {}
    for action in actions:
        need = min(needed[action], key=lambda o: (takers[o], o), default=None)
        for o in given[action]:
            makers.setdefault((o, need), []).append(action)
    for action in sorted(actions, key=lambda a: (cost(a), -a), reverse=True):
        gives = given[action]
        if not gives:
            left.discard(action)
            continue
        rarest = min(gives, key=lambda o: (made[o], o))
        if any(
            other != action
            and other in left
            and needed[other] <= needed[action]
            and gives <= given[other]
            and cost(other) <= cost(action)
            for need in (None, *needed[action])
            for other in makers.get((rarest, need), ())
        ):
            left.discard(action)
    return left
