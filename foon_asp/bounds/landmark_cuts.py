"""Lower bounds by landmark cuts, found where they are needed only.

Landmarks as in :mod:`foon_asp.bounds.cut`: of the actions that give an object of a set with a goal in it and
need none of the set, every derivation uses one. Costs are divided among landmarks as LM-cut does (Helmert and
Domshlak 2009): each takes from all of its members what the cheapest has left.
"""

import math
from collections import deque
from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from typing import NamedTuple

from foon_asp.bounds.hypergraph import Hypergraph

_FRESH = 64  # cuts, or one for each target, after which what is thought of how dear objects are is too old
# times that the guide is asked for as many cuts as there are objects: it looks at all of them each time, and
# asked more often it would make cuts quadratic (benchmarks/shapes.py, grid by kitchen)
_GUIDES = 32


class WeightedCut(NamedTuple):
    """A cut: objects, its landmark, the member that had least cost left, and that cost as its weight.

    ``own`` are its objects but those of the cut ``after`` it, whose members all need one of them.
    """

    own: frozenset[int]
    members: tuple[int, ...]
    cheapest: int
    weight: int
    after: "WeightedCut | None" = None

    @property
    def objects(self) -> frozenset[int]:
        """All objects, of which one is a target: put together when asked for, since a chain has many."""
        found, cut = [self.own], self.after
        while cut is not None:
            found.append(cut.own)
            cut = cut.after
        return frozenset().union(*found)


class Cuts(NamedTuple):
    """Weighted cuts: their sum ``bound`` is what every derivation costs at least.

    ``left[a]`` is what the cuts leave of the cost of action ``a``; where it is not there, they take nothing.
    ``hopeless`` says that there is no derivation at all by the actions allowed, ``interrupted`` that ctrl-C
    ended the search for more: the bound holds, and ``left`` is of no use.
    """

    bound: int
    left: dict[int, int]
    cuts: list[WeightedCut]
    hopeless: bool = False
    interrupted: bool = False


class _Level:
    """Objects that every derivation makes, and the growing zone of the cuts before the last of them.

    ``edge`` are actions that give an object of the zone, need none and cost something. ``cut`` is the latest
    of this zone, or the one that all of this level is before.
    """

    def __init__(self, objects: Sequence[int], after: WeightedCut | None) -> None:
        self.objects = list(objects)
        self.after = after
        self.begin()

    def begin(self) -> None:
        """Forget the zone."""
        self.zone: set[int] = set()
        self.edge: dict[int, None] = {}
        self.cut = self.after


class _Target:
    """A target, and upon it levels of what is before it in every derivation; ``behind`` are their zones."""

    def __init__(self, target: int) -> None:
        self.levels = [_Level([target], None)]
        self.behind: set[int] = set()

    def level(self, free: Container[int]) -> _Level | None:
        """Return the level whose last object needs a cut, which is not free; ``None`` where all are."""
        while self.levels:
            level = self.levels[-1]
            if level.objects and level.objects[-1] not in free:
                return level
            if level.objects:
                level.objects.pop()
                level.begin()
                continue
            self.levels.pop()
            if self.levels:
                self.behind -= self.levels[-1].zone
        return None

    def add(self, needed: Sequence[int]) -> None:
        """Go on before what all members of the latest cut need, its last object first."""
        if needed:
            self.behind |= self.levels[-1].zone
            self.levels.append(_Level(needed, self.levels[-1].cut))


def landmark_cuts(
    graph: Hypergraph,
    targets: Iterable[int],
    allowed: Container[int],
    cost: Callable[[int], int],
    dear: Mapping[int, int],
    expired: Callable[[], bool],
    guide: Callable[[Callable[[int], int]], Mapping[int, int]] | None = None,
    most: float = math.inf,
) -> Cuts:
    """Find weighted cuts before the targets, until what is left of the costs gives them all for nothing.

    Or until their landmarks have ``most`` members together, or about.

    Only ``allowed`` actions count, and all costs are above zero. ``dear`` says how dear each object is
    thought to be, those not in it dearer than all: a cut passes through the dearest object that an action
    needs. Each target in turn has a cut, the dearest first: more cuts of the dearest alone would take what
    others have cuts of their own for. ``guide`` tells how dear objects are from the costs of actions, and is
    asked now and then by what the cuts leave of them. What is made for nothing only grows, so that the time
    goes with what the cuts touch and not with the size of the graph.
    """
    search = _Search(graph, allowed, cost, dear)
    remaining = deque(_Target(o) for o in sorted(targets, key=search.dearness, reverse=True))
    fresh = max(_FRESH, len(remaining))  # how many cuts there are when the guide is asked
    effort = 0
    try:
        while remaining and effort < most and not expired():
            target = remaining.popleft()
            level = target.level(search.free.objects)
            if level is None:
                continue
            remaining.append(target)
            if guide is not None and len(search.cuts) >= fresh:
                search.dear = guide(search.rest_of)
                waiting = sum(len(each.objects) for each in target.levels)
                fresh = len(search.cuts) + max(_FRESH, len(remaining), waiting, len(search.dear) // _GUIDES)
                level.begin()
            cut = search.cut(level, target.behind)
            if cut is None:
                return Cuts(search.bound, search.left, search.cuts, hopeless=True)
            effort += len(cut.members)
            target.add(search.needed_by_all(cut.members))
    except KeyboardInterrupt:
        return Cuts(search.bound, search.left, search.cuts, interrupted=True)
    return Cuts(search.bound, search.left, search.cuts)


class _Search:
    """What cuts have taken of the costs so far, and the next cut."""

    def __init__(
        self, graph: Hypergraph, allowed: Container[int], cost: Callable[[int], int], dear: Mapping[int, int]
    ) -> None:
        self._graph, self._allowed, self._cost = graph, allowed, cost
        self.dear = dear
        self.left: dict[int, int] = {}
        self.free = _Free(graph)
        self.cuts: list[WeightedCut] = []
        self.bound = 0

    def rest_of(self, action: int) -> int:
        """Return what the cuts leave of the cost of an action."""
        return self.left[action] if action in self.left else self._cost(action)

    def dearness(self, o: int) -> tuple[float, int]:
        """Return a key by which objects are ordered, the dearest last."""
        return self.dear.get(o, math.inf), o

    def cut(self, level: _Level, behind: set[int]) -> WeightedCut | None:
        """Add the next cut of a level; ``None`` where no action crosses it."""
        new = self._grown(level, behind)
        while new is None:
            level.begin()
            new = self._grown(level, behind)
        needs = self._graph.needs
        members = tuple(action for action in level.edge if level.zone.isdisjoint(needs[action]))
        if not members:
            return None
        level.edge = dict.fromkeys(members)
        rests = {action: self.rest_of(action) for action in members}
        cheapest = min(rests, key=rests.__getitem__)
        weight = rests[cheapest]
        level.cut = WeightedCut(frozenset(new), members, cheapest, weight, level.cut)
        self.bound += weight
        self.cuts.append(level.cut)
        for action, rest in rests.items():
            self.left[action] = rest - weight
            if rest == weight:
                self.free.release(action)
        return level.cut

    def needed_by_all(self, members: Sequence[int]) -> list[int]:
        """Return what all members of a cut need and what is not free, the dearest last."""
        needs = self._graph.needs
        common = set(self.free.lacking(members[0])).intersection(*(needs[action] for action in members))
        return sorted(common, key=self.dearness)

    def _grown(self, level: _Level, behind: set[int]) -> list[int] | None:
        """Let a zone grow through what costs nothing; ``None`` where it holds what is free by now."""
        needs, makers, left = self._graph.needs, self._graph.makers, self.left
        zone, edge = level.zone, level.edge
        new = [] if zone else [level.objects[-1]]
        zone.update(new)
        passed = [action for action in edge if not left.get(action, True)]
        for action in passed:
            del edge[action]
        place = 0
        while True:
            for action in passed:
                if not zone.isdisjoint(needs[action]):
                    continue
                lacking = self.free.lacking(action)
                if not lacking:
                    return None
                dearest = max(lacking, key=self.dearness)
                zone.add(dearest)
                new.append(dearest)
            if place == len(new):
                return new
            passed = []
            for action in makers[new[place]]:
                if action in self._allowed and behind.isdisjoint(needs[action]):
                    if left.get(action, True):
                        edge[action] = None
                    else:
                        passed.append(action)
            place += 1


class _Free:
    """What can be made for nothing, growing as actions run out of cost."""

    def __init__(self, graph: Hypergraph) -> None:
        self._graph = graph
        self.objects: set[int] = set()
        self._missing: dict[int, int] = {}
        self._waiting: dict[int, list[int]] = {}

    def lacking(self, action: int) -> list[int]:
        """Return what an action needs and what is neither free nor there from the start."""
        free, start = self.objects, self._graph.start
        return [o for o in self._graph.needs[action] if o not in free and o not in start]

    def release(self, action: int) -> None:
        """Let an action that has no cost left run as soon as all it needs is free."""
        lacking = self.lacking(action)
        self._missing[action] = len(lacking)
        for o in lacking:
            self._waiting.setdefault(o, []).append(action)
        stack = [] if lacking else [action]
        while stack:
            for o in self._graph.gives[stack.pop()]:
                self.objects.add(o)
                for taker in self._waiting.pop(o, ()):
                    self._missing[taker] -= 1
                    if not self._missing[taker]:
                        stack.append(taker)
