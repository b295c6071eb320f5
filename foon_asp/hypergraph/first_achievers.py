"""First achievers of objects, by fact landmarks (Imai and Fukunaga 2015).

Object L is a *landmark* of object O if every derivation of O makes L. Suppose an add effect of an action is a
landmark of one of its preconditions. Then the effect was true before, so the action never achieves it first.
Such add effects can be removed: the same derivations remain, and fewer actions cross a cut. For example, an
action that only undoes another does not cross it.
"""

from collections import deque
from collections.abc import Callable, Iterable

from foon_asp.hypergraph import tuning
from foon_asp.hypergraph.hypergraph import Hypergraph

_STEPS = 1000  # actions processed between two looks at the time


class FirstAchievers:
    """A graph without the add effects that their action never achieves first.

    It is computed at construction, and is the attribute ``graph``. All actions of the given graph have to be
    able to run. In a large graph, only landmarks among the first objects are computed, so fewer add effects
    are removed. If time is up, none is removed.
    """

    def __init__(self, graph: Hypergraph, expired: Callable[[], bool] = lambda: False) -> None:
        self._given_graph = graph
        tracked_count = (
            graph.size
            if graph.size**2 <= tuning.RELAXATION.landmark_bits
            else tuning.RELAXATION.landmark_bits // graph.size
        )
        self._landmarks = _object_landmarks(graph, tracked_count, expired)
        self._landmarks_before = [self._landmarks_of(needed) for needed in graph.needs]
        self.graph = Hypergraph(
            graph.size,
            graph.needs,
            [
                [o for o in effects if not before >> o & 1] if before else effects
                for effects, before in zip(graph.gives, self._landmarks_before, strict=True)
            ],
            graph.start,
        )

    def _landmarks_of(self, objects: Iterable[int]) -> int:
        """Return the union of the landmarks of some objects, as a bit set."""
        made = 0
        for o in objects:
            made |= self._landmarks[o]
        return made

    def landmark_of(self, cut: frozenset[int]) -> list[int]:
        """Return the landmark of a cut of :attr:`graph`, ascending.

        It consists of the actions that cross the cut in this graph. An action is left out if an object of the
        cut is a landmark of its preconditions. Such an action cannot be the first to achieve an object of the
        cut.
        """
        achievers, needs, before = self.graph.makers, self.graph.needs, self._landmarks_before
        inside = _bit_set(cut)
        return sorted(
            {a for o in cut for a in achievers[o] if not before[a] & inside and cut.isdisjoint(needs[a])}
        )

    def widen(self, cut: frozenset[int]) -> frozenset[int]:
        """Extend a cut of :attr:`graph` to a cut of the original graph with the same landmark; return it.

        Suppose an action achieves an object of the cut, but never first. Then one of its preconditions has a
        landmark in the cut. This precondition is added, so that the action does not cross the cut.
        """
        widened, inside, stack = set(cut), _bit_set(cut), list(cut)
        needs, before, landmarks = self._given_graph.needs, self._landmarks_before, self._landmarks
        while stack:
            for action in self._given_graph.makers[stack.pop()]:
                if before[action] & inside and widened.isdisjoint(needs[action]):
                    precondition = next(o for o in needs[action] if landmarks[o] & inside)
                    widened.add(precondition)
                    stack.append(precondition)
        return frozenset(widened)


def _bit_set(objects: Iterable[int]) -> int:
    """Return a set of objects as an integer, in which bit ``o`` is 1 for each object ``o``."""
    bits = 0
    for o in objects:
        bits |= 1 << o
    return bits


def _object_landmarks(graph: Hypergraph, tracked_count: int, expired: Callable[[], bool]) -> list[int]:
    """Return for each object the bit set of its landmarks among the first ``tracked_count`` objects.

    The bit sets are a greatest fixpoint (Keyder, Richter and Helmert 2010). The landmarks of an object are
    the object itself and the landmarks that all its achievers share. The landmarks of an achiever are those
    of its preconditions. Initial and unreachable objects have empty bit sets. If time is up, all bit sets are
    empty.
    """
    own = [1 << o if o < tracked_count else 0 for o in range(graph.size)]
    landmarks: list[int | None] = [None] * graph.size
    missing = list(graph.missing_counts)
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
            for consumer in graph.consumers[o]:
                if previous is None:
                    missing[consumer] -= 1
                if not missing[consumer] and not queued[consumer]:
                    queued[consumer] = True
                    waiting.append(consumer)
    return [bits or 0 for bits in landmarks]
