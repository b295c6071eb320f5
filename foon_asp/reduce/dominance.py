"""Actions that another one can always stand in for."""

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence

from foon_asp.reduce.graph import Graph

_FEW = 20  # actions that are looked at one by one


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
    rare = {o: place for place, o in enumerate(sorted(takers, key=lambda o: (takers[o], o)))}
    ordered = {a: sorted(needed[a], key=rare.__getitem__) for a in actions}
    alike = _Needs(ordered, given)
    made_by = {o: (made[o], o) for o in made}.__getitem__
    prices = {a: cost(a) for a in actions}
    for action in sorted(actions, key=lambda a: (prices[a], -a), reverse=True):
        gives, price = given[action], prices[action]
        if not gives:
            left.discard(action)
            continue
        rarest = min(gives, key=made_by)
        for other in alike.within(ordered[action], rarest):
            if other != action and prices[other] <= price and other in left and gives <= given[other]:
                left.discard(action)
                break
    return left


class _Needs:
    """Actions by their needs, in a tree of sets (a set-trie, Savnik 2013): rare needs branch first."""

    def __init__(self, ordered: Mapping[int, Sequence[int]], given: Mapping[int, frozenset[int]]) -> None:
        self._given = given
        self._below: dict[tuple[int, int], int] = {}  # by place and need, the place below it
        self._at: list[list[int]] = [[]]
        self._by_given: dict[int, dict[int, list[int]]] = {}
        for action, needs in ordered.items():
            place = 0
            for need in needs:
                below = self._below.setdefault((place, need), len(self._at))
                if below == len(self._at):
                    self._at.append([])
                place = below
            self._at[place].append(action)

    def within(self, needs: Sequence[int], gives: int) -> Iterator[int]:
        """Return the actions that need no more; of many, only those that give something."""
        at, below = self._at, self._below
        places = [0]  # those below which the needs so far lead
        yield from at[0] if len(at[0]) <= _FEW else self._giving(0).get(gives, ())
        for need in needs:
            for place in [below[place, need] for place in places if (place, need) in below]:
                places.append(place)
                found = at[place]
                yield from found if len(found) <= _FEW else self._giving(place).get(gives, ())

    def _giving(self, place: int) -> dict[int, list[int]]:
        if place not in self._by_given:
            givers: dict[int, list[int]] = {}
            for action in self._at[place]:
                for o in self._given[action]:
                    givers.setdefault(o, []).append(action)
            self._by_given[place] = givers
        return self._by_given[place]
