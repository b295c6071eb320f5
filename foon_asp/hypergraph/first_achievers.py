"""First achievers of objects, by fact landmarks (Imai and Fukunaga 2015).

An object that every derivation of another object makes is a *landmark* of it. An add effect that is a
landmark of the action's preconditions was true before, so the action never achieves it first. Without these
add effects the same derivations remain, and fewer actions cross a cut: actions that only undo others do not.
"""

from collections import deque
from collections.abc import Callable, Iterable

from foon_asp.hypergraph import tuning
from foon_asp.hypergraph.hypergraph import Hypergraph

_STEPS = 1000  # actions processed between two looks at the time


class FirstAchievers:
    """A graph all of whose actions can run, without add effects that they never achieve first.

    In large graphs, only landmarks among the first objects are computed; where time is up, no landmarks are.
    """

    def __init__(self, graph: Hypergraph, expired: Callable[[], bool] = lambda: False) -> None:
        self._plain = graph
        tracked = (
            graph.size
            if graph.size**2 <= tuning.RELAXATION.landmark_bits
            else tuning.RELAXATION.landmark_bits // graph.size
        )
        self._landmarks = _landmarks(graph, tracked, expired)
        self._before = [self._of(needed) for needed in graph.needs]
        self.graph = Hypergraph(
            graph.size,
            graph.needs,
            [
                [o for o in effects if not before >> o & 1] if before else effects
                for effects, before in zip(graph.gives, self._before, strict=True)
            ],
            graph.start,
        )

    def _of(self, objects: Iterable[int]) -> int:
        """Return the landmarks of some objects together, as a bit set."""
        made = 0
        for o in objects:
            made |= self._landmarks[o]
        return made

    def members(self, cut: frozenset[int]) -> list[int]:
        """Return the landmark of a cut: the first achievers of its objects."""
        achievers, needs, before = self.graph.makers, self.graph.needs, self._before
        inside = _bits(cut)
        return sorted(
            {a for o in cut for a in achievers[o] if not before[a] & inside and cut.isdisjoint(needs[a])}
        )

    def widened(self, cut: frozenset[int]) -> frozenset[int]:
        """Return a cut with objects added so that its crossing actions are just its first achievers.

        For an action that achieves an object of the cut but not first, a precondition is added that has a
        landmark in the cut.
        """
        widened, inside, stack = set(cut), _bits(cut), list(cut)
        needs, before, landmarks = self._plain.needs, self._before, self._landmarks
        while stack:
            for action in self._plain.makers[stack.pop()]:
                if before[action] & inside and widened.isdisjoint(needs[action]):
                    late = next(o for o in needs[action] if landmarks[o] & inside)
                    widened.add(late)
                    stack.append(late)
        return frozenset(widened)


def _bits(objects: Iterable[int]) -> int:
    """Return a set of objects as a bit set."""
    bits = 0
    for o in objects:
        bits |= 1 << o
    return bits


def _landmarks(graph: Hypergraph, tracked: int, expired: Callable[[], bool]) -> list[int]:
    """Return the landmarks of each object among the first ``tracked`` ones, as bit sets.

    A greatest fixpoint: an object has itself and the landmarks common to all its achievers, an achiever has
    the landmarks of its preconditions (Keyder, Richter and Helmert 2010).
    """
    own = [1 << o if o < tracked else 0 for o in range(graph.size)]
    landmarks: list[int | None] = [None] * graph.size
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
            before |= landmarks[o] or 0
        for o in graph.gives[action]:
            previous = landmarks[o]
            if graph.at_start[o] or previous == own[o]:
                continue
            landmarks[o] = current = (before if previous is None else before & previous) | own[o]
            if current == previous:
                continue
            for consumer in graph.takers[o]:
                if previous is None:
                    missing[consumer] -= 1
                if not missing[consumer] and not queued[consumer]:
                    queued[consumer] = True
                    waiting.append(consumer)
    return [bits or 0 for bits in landmarks]
