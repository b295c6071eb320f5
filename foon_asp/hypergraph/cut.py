"""Disjunctive action landmarks from cuts: every derivation of the targets uses one of their actions.

Take a set of objects that contains a target and no initial object. In any derivation, the first action that
achieves an object of the set needs no object of the set. Actions that achieve an object of the set and need
none *cross* the set. So every derivation has a crossing action. The crossing actions are a *landmark*, and
the set is its *cut*. Bonet and Helmert (2010) bound delete-free plans by hitting sets of landmarks of this
kind.
"""

import math
import sys
from collections.abc import Callable, Collection, Iterable, Mapping
from typing import NamedTuple

from foon_asp.hypergraph.hypergraph import Hypergraph


class Cut(NamedTuple):
    """A cut and its landmark.

    ``objects``: the numbers of its objects, ascending.
    ``members``: the numbers of the landmark actions, ascending.
    """

    objects: tuple[int, ...]
    members: tuple[int, ...]


class Cutter:
    """Finds cuts for the targets of a hypergraph, as if the ``forbidden`` actions did not exist.

    ``targets``: the targets that are not initial.
    ``actions``: the relevant actions. They can run and lead to a target.
    ``hopeless``: a cut with an empty landmark if a target cannot be reached, else ``None``. If there is such
    a cut, ``actions`` is empty, and :meth:`widen` is the only method that may be called.

    Landmarks contain every crossing action that is not forbidden.

    ``reachable``: a flag for each object that is reachable without the forbidden actions. Construction takes
    time linear in the size of the hypergraph. If ``reachable`` is given, the time is linear in the size of
    the relevant part.
    """

    def __init__(
        self,
        graph: Hypergraph,
        targets: Iterable[int],
        forbidden: frozenset[int] = frozenset(),
        reachable: bytearray | None = None,
    ) -> None:
        self._graph = graph
        self._forbidden = forbidden
        self.targets = sorted({o for o in targets if not graph.at_start[o]})
        reachable = graph.reach(forbidden) if reachable is None else reachable
        self._reachable = reachable
        self.actions: list[int] = []
        self.hopeless: Cut | None = None
        unreachable = [o for o in self.targets if not reachable[o]]
        if unreachable:
            self.hopeless = self._grow_small_cut(unreachable[0], set(), reachable, {})
            return
        # relevant objects are numbered anew: a large network has few of them
        self._numbers: dict[int, int] = {}
        stack = list(self.targets)
        for o in stack:
            self._numbers[o] = len(self._numbers)
        relevant: set[int] = set()
        while stack:
            for action in graph.makers[stack.pop()]:
                if action in relevant or action in forbidden:
                    continue
                if all(reachable[o] for o in graph.needs[action]):
                    relevant.add(action)
                    for o in graph.needs[action]:
                        if not graph.at_start[o] and o not in self._numbers:
                            self._numbers[o] = len(self._numbers)
                            stack.append(o)
        self.actions = sorted(relevant)
        self._positions = {action: i for i, action in enumerate(self.actions)}
        numbers = self._numbers
        self._gives = [[numbers[o] for o in set(graph.gives[a]) if o in numbers] for a in self.actions]
        self._consumers: list[list[int]] = [[] for _ in numbers]
        self._missing = [0] * len(self.actions)
        for i, action in enumerate(self.actions):
            for o in {numbers[o] for o in graph.needs[action] if o in numbers}:
                self._consumers[o].append(i)
                self._missing[i] += 1
        self._consumer_counts = {o: len(self._consumers[number]) for o, number in numbers.items()}

    def reached_by(self, actions: Collection[int]) -> bool:
        """Return whether these actions alone reach all targets; only those in :attr:`actions` count."""
        return _Growth(self, self._missing).reaches_targets_with(
            self._positions[a] for a in actions if a in self._positions
        )

    def cut(self, keep: Iterable[int], order: Iterable[int]) -> Cut | None:
        """Return a cut with a small landmark that has no action of ``keep``.

        Grows a set of actions that does not reach all targets: first by ``keep``, then by the actions of
        ``order`` one by one. An action with which all targets would be reached is refused. The landmark
        consists of refused actions, so actions late in ``order`` are more likely to be in it. ``order``
        should contain all of :attr:`actions`.

        Returns ``None`` if the actions of ``keep`` alone reach all targets.
        """
        growth = _Growth(self, self._missing)
        positions = self._positions
        if growth.reaches_targets_with(positions[a] for a in keep if a in positions):
            return None
        refused = {self.actions[i] for i in growth.admit([positions[a] for a in order])}
        reached = bytearray(self._reachable)
        for o in [o for o, is_reached in zip(self._numbers, growth.reached, strict=True) if not is_reached]:
            reached[o] = False
        target = next(o for o in self.targets if not reached[o])
        return self._grow_small_cut(target, refused, reached, self._consumer_counts)

    def without_forbidden(self, actions: Iterable[int]) -> tuple[int, ...] | None:
        """Return the given actions without forbidden ones, in the same order.

        Return ``None`` if a remaining action is not in :attr:`actions`.
        """
        remaining = tuple(a for a in actions if a not in self._forbidden)
        return remaining if self._positions.keys() >= set(remaining) else None

    def widen(self, objects: Iterable[int]) -> Cut:
        """Return the cut of some objects, with unreachable objects added so that its landmark is small.

        Initial objects are left out. If an action that cannot run crosses the cut, an unreachable
        precondition of the action is added. Then the action no longer crosses. So a cut that was found among
        the actions that can run keeps its landmark.
        """
        graph, reachable = self._graph, self._reachable
        inside = {o for o in objects if not graph.at_start[o]}
        return self._extend_to_cut(
            inside, lambda a: next((o for o in graph.needs[a] if not reachable[o]), None)
        )

    def _grow_small_cut(
        self, target: int, members: set[int], reached: bytearray, consumer_counts: Mapping[int, float]
    ) -> Cut:
        """Return a small cut of an unreached target, grown backwards; its landmark is within ``members``.

        ``members``: the actions that may be in the landmark.
        ``reached``: a flag for each object; the cut consists of objects that are not reached.
        ``consumer_counts``: the number of consumers of each object.

        If an action not among ``members`` crosses the cut, one of its unreached preconditions is added to the
        cut. Then the action no longer crosses the cut. The precondition with the most consumers is chosen,
        since it helps against other actions as well. Objects without a count are chosen first.
        """

        def most_consumed(action: int) -> int | None:
            """Return the unreached precondition with the most consumers.

            Return ``None`` if ``members`` has the action.
            """
            if action in members:
                return None
            lacking = (o for o in self._graph.needs[action] if not reached[o])
            return max(lacking, key=lambda o: (consumer_counts.get(o, math.inf), -o))

        return self._extend_to_cut({target}, most_consumed)

    def _extend_to_cut(self, inside: set[int], needed: Callable[[int], int | None]) -> Cut:
        """Extend the set ``inside`` of objects in place; return it as a cut with its landmark.

        For each crossing action, ``needed`` returns a precondition to add to the set. If ``needed`` returns
        ``None``, the action stays in the landmark.
        """
        graph, forbidden = self._graph, self._forbidden
        stack = list(inside)
        achievers: set[int] = set()
        while stack:
            for action in graph.makers[stack.pop()]:
                if action in achievers or action in forbidden:
                    continue
                achievers.add(action)
                o = needed(action) if inside.isdisjoint(graph.needs[action]) else None
                if o is not None:
                    inside.add(o)
                    stack.append(o)
        landmark = sorted(a for a in achievers if inside.isdisjoint(graph.needs[a]))
        return Cut(tuple(sorted(inside)), tuple(landmark))


class _Growth:
    """A set of actions, grown one by one, that never reaches all targets.

    Actions are given by their position in :attr:`Cutter.actions`, and objects by their number in the cutter.
    ``reached``: a flag for each object: 1 if the admitted actions reach it, else 0.
    """

    def __init__(self, cutter: Cutter, missing: list[int]) -> None:
        self._gives, self._consumers = cutter._gives, cutter._consumers
        self._missing = list(missing)
        self._waiting = bytearray(len(missing))  # admitted, with preconditions missing
        self.reached = bytearray(len(self._consumers))
        self._decisive = bytearray(
            len(self._consumers)
        )  # objects each of which alone would reach the targets
        self._unreached = len(cutter.targets)  # targets have the first numbers
        self._targets = len(cutter.targets)

    def reaches_targets_with(self, actions: Iterable[int]) -> bool:
        """Admit actions one by one; return whether some action was refused.

        An action is refused if all targets would be reached with it. Ends at the first such action. Also
        returns ``True`` if there are no targets. After ``True``, this object must not be used any more.
        """
        return not self._unreached or bool(self.admit(actions, max_refused=1))

    def admit(self, actions: Iterable[int], max_refused: int = sys.maxsize) -> list[int]:
        """Admit actions one by one, and return the refused ones.

        An action is refused if all targets would be reached with it. Ends after ``max_refused`` refusals. An
        action whose preconditions are not reached yet is admitted, and takes effect once they are.

        Decisive objects are recorded: reaching one of them would suffice to reach all targets. So later
        actions that achieve a decisive object are refused at once.
        """
        waiting, missing, gives = self._waiting, self._missing, self._gives
        reached, decisive, reach_from = self.reached, self._decisive, self._reach_from
        refused: list[int] = []
        for action in actions:
            if missing[action]:
                waiting[action] = True
                continue
            newly_reached = [o for o in gives[action] if not reached[o]]
            if not newly_reached:
                continue
            for o in newly_reached:
                if decisive[o]:
                    break
            else:
                if reach_from(newly_reached) is not None:
                    continue
                self._record_decisive(newly_reached)
            refused.append(action)
            if len(refused) == max_refused:
                break
        return refused

    def _record_decisive(self, refused: list[int]) -> None:
        """Record the first of the ``refused`` objects that alone suffices to reach all targets.

        The object is recorded as decisive. If no object alone suffices, nothing changes.
        """
        for o in refused:
            unreached = self._unreached
            newly_reached = None if len(refused) == 1 else self._reach_from([o])
            if newly_reached is None:
                self._decisive[o] = True
                return
            self._unreach(newly_reached)
            self._unreached = unreached

    def _reach_from(self, objects: list[int]) -> list[int] | None:
        """Mark objects as reached, and the objects that admitted actions then make; return all marked ones.

        Objects that were reached before are left out. If all targets would be reached, nothing changes, and
        the result is ``None``.
        """
        waiting, missing, reached = self._waiting, self._missing, self.reached
        consumers, gives, decisive, targets = self._consumers, self._gives, self._decisive, self._targets
        unreached = self._unreached
        newly_reached: list[int] = []
        for batch in (stack := [objects]):  # grows while it is walked through
            for o in batch:
                if reached[o]:
                    continue
                reached[o] = True
                newly_reached.append(o)
                if o < targets:
                    unreached -= 1
                for consumer in consumers[o]:
                    missing[consumer] = lacking = missing[consumer] - 1
                    if not lacking and waiting[consumer]:
                        stack.append(gives[consumer])
                if not unreached or decisive[o]:
                    self._unreach(newly_reached)
                    return None
        self._unreached = unreached
        return newly_reached

    def _unreach(self, newly_reached: list[int]) -> None:
        """Mark objects as unreached again, and correct the counts of missing preconditions."""
        missing, reached = self._missing, self.reached
        for o in newly_reached:
            reached[o] = False
            for consumer in self._consumers[o]:
                missing[consumer] += 1
