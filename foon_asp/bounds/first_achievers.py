"""Who can be the first to make an object: not an action that builds upon it.

An object that every derivation of another one makes is a *landmark* of it. What an action gives and is a
landmark of what it needs was there before, so it gives that to no effect (Imai and Fukunaga 2015). Without
such gifts the same derivations remain, and far fewer actions cross a cut: those that undo others do not.
"""

from collections import deque
from collections.abc import Callable, Iterable

from foon_asp.bounds.hypergraph import Hypergraph

_BITS = 400_000_000  # of all objects together: landmarks are looked for among as many objects as that allows
_STEPS = 1000  # actions looked at, from one question whether time is up to the next


class FirstAchievers:
    """A graph all of whose actions can run, without what they give to no effect.

    What is known of landmarks is among the first objects of large graphs alone, and nothing where time is up.
    """

    def __init__(self, graph: Hypergraph, expired: Callable[[], bool] = lambda: False) -> None:
        self._plain = graph
        among = graph.size if graph.size**2 <= _BITS else _BITS // graph.size
        self._landmarks = _landmarks(graph, among, expired)
        self._before = [self._of(needed) for needed in graph.needs]
        self.graph = Hypergraph(
            graph.size,
            graph.needs,
            [
                [o for o in given if not before >> o & 1] if before else given
                for given, before in zip(graph.gives, self._before, strict=True)
            ],
            graph.start,
        )

    def _of(self, objects: Iterable[int]) -> int:
        """Return what is made by the time that some objects are, a bit for each object."""
        made = 0
        for o in objects:
            made |= self._landmarks[o]
        return made

    def members(self, cut: frozenset[int]) -> list[int]:
        """Return the landmark of a cut: who can be the first to make something of it."""
        makers, needs, before = self.graph.makers, self.graph.needs, self._before
        inside = _bits(cut)
        return sorted(
            {a for o in cut for a in makers[o] if not before[a] & inside and cut.isdisjoint(needs[a])}
        )

    def widened(self, cut: frozenset[int]) -> frozenset[int]:
        """Return a cut with what is made only after something of it, so that it has these members for all.

        That is added where an action that gives something of the cut needs it.
        """
        wide, inside, stack = set(cut), _bits(cut), list(cut)
        needs, before, landmarks = self._plain.needs, self._before, self._landmarks
        while stack:
            for action in self._plain.makers[stack.pop()]:
                if before[action] & inside and wide.isdisjoint(needs[action]):
                    late = next(o for o in needs[action] if landmarks[o] & inside)
                    wide.add(late)
                    stack.append(late)
        return frozenset(wide)


def _bits(objects: Iterable[int]) -> int:
    bits = 0
    for o in objects:
        bits |= 1 << o
    return bits


def _landmarks(graph: Hypergraph, among: int, expired: Callable[[], bool]) -> list[int]:
    """Return for each object which of the first ones every derivation makes by the time that it is made.

    The greatest sets of which each has the object itself, and else only what the needs of all its makers have
    (Keyder, Richter and Helmert 2010).
    """
    own = [1 << o if o < among else 0 for o in range(graph.size)]
    found: list[int | None] = [None] * graph.size
    missing = list(graph.missing)
    waiting = deque(action for action, count in enumerate(missing) if not count)
    queued = bytearray(not count for count in missing)
    steps = 0
    while waiting:
        steps += 1
        if steps % _STEPS == 0 and expired():
            return [0] * graph.size
        action = waiting.popleft()
        queued[action] = False
        before = 0
        for o in graph.needs[action]:
            before |= found[o] or 0
        for o in graph.gives[action]:
            known = found[o]
            if graph.at_start[o] or known == own[o]:
                continue
            found[o] = now = (before if known is None else before & known) | own[o]
            if now == known:
                continue
            for taker in graph.takers[o]:
                if known is None:
                    missing[taker] -= 1
                if not missing[taker] and not queued[taker]:
                    queued[taker] = True
                    waiting.append(taker)
    return [bits or 0 for bits in found]
