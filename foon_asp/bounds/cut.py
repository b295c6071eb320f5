"""Landmarks by cutting: sets of actions one of which every derivation of the targets uses.

Take a set of objects with a target in it and nothing that is there from the start. The first action of a
derivation that gives one of them needs none of them. So every derivation uses an action that gives an
object of the set and needs none: those actions are a *landmark*, and the set is the *cut* that shows it.
Bonet and Helmert (2010) bound delete-free plans by hitting landmarks of this kind.
"""

import math
import sys
from collections.abc import Callable, Collection, Iterable, Mapping
from typing import NamedTuple

from foon_asp.bounds.hypergraph import Hypergraph


class Cut(NamedTuple):
    """A cut and its landmark: object numbers and action numbers, both ascending."""

    objects: tuple[int, ...]
    members: tuple[int, ...]


class Cutter:
    """Finds cuts before the targets of a hypergraph of which some actions are forbidden.

    ``targets`` that are there from the start are left out. ``actions`` are those that can run and that a
    target can need: only they are worth asking for, and every cut found holds for all actions that are not
    forbidden. ``hopeless`` is a cut without members where the targets cannot all be reached, or else
    ``None``. Building one takes time linear in the size of the hypergraph, and where it is known which
    objects are ``reachable``, of what the targets can need.
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
        lost = [o for o in self.targets if not reachable[o]]
        if lost:
            self.hopeless = self._shrink(lost[0], set(), reachable, {})
            return
        # what the targets can need, numbered anew: most of a large network is of no concern to them
        self._numbers: dict[int, int] = {}
        stack = list(self.targets)
        for o in stack:
            self._numbers[o] = len(self._numbers)
        chosen: set[int] = set()
        while stack:
            for action in graph.makers[stack.pop()]:
                if action in chosen or action in forbidden:
                    continue
                if all(reachable[o] for o in graph.needs[action]):
                    chosen.add(action)
                    for o in graph.needs[action]:
                        if not graph.at_start[o] and o not in self._numbers:
                            self._numbers[o] = len(self._numbers)
                            stack.append(o)
        self.actions = sorted(chosen)
        self._places = {action: place for place, action in enumerate(self.actions)}
        numbers = self._numbers
        self._gives = [[numbers[o] for o in set(graph.gives[a]) if o in numbers] for a in self.actions]
        self._takers: list[list[int]] = [[] for _ in numbers]
        self._missing = [0] * len(self.actions)
        for place, action in enumerate(self.actions):
            for o in {numbers[o] for o in graph.needs[action] if o in numbers}:
                self._takers[o].append(place)
                self._missing[place] += 1

    def reached_by(self, actions: Collection[int]) -> bool:
        """Whether these actions alone reach all targets."""
        return _Growth(self, self._missing).admit_all(self._places[a] for a in actions if a in self._places)

    def cut(self, keep: Iterable[int], order: Iterable[int]) -> Cut | None:
        """Find a cut whose landmark holds no action of ``keep`` and few others, late ones of ``order`` first.

        Grows a set of actions that does not reach the targets, ``keep`` first and then along ``order``, until
        none can be added; what is left out and needed is the landmark. ``None`` where ``keep`` alone
        reaches the targets, so that there is no such cut. Actions that are in neither are never members: name
        all of :attr:`actions` in ``order``.
        """
        growth = _Growth(self, self._missing)
        places = self._places
        if growth.admit_all(places[a] for a in keep if a in places):
            return None
        refused = {self.actions[place] for place in growth.refuse([places[a] for a in order])}
        reached = bytearray(self._reachable)
        takers: dict[int, int] = {}
        for o, number in self._numbers.items():
            reached[o] = growth.reached[number]
            takers[o] = len(self._takers[number])
        first = next(o for o in self.targets if not reached[o])
        return self._shrink(first, refused, reached, takers)

    def among(self, actions: Iterable[int]) -> tuple[int, ...] | None:
        """Give those of some actions that are not forbidden; ``None`` where one is not in :attr:`actions`."""
        left = tuple(a for a in actions if a not in self._forbidden)
        return left if self._places.keys() >= set(left) else None

    def widened(self, objects: Iterable[int]) -> Cut:
        """Return the cut of some objects before the targets, with more where that keeps its landmark small.

        An action that can never run lacks an object that nothing makes: with it in the cut, the action is no
        member. So a cut found among those actions that can run has the same members here.
        """
        graph, reachable = self._graph, self._reachable
        inside = {o for o in objects if not graph.at_start[o]}
        return self._closed(inside, lambda a: next((o for o in graph.needs[a] if not reachable[o]), None))

    def _shrink(self, target: int, members: set[int], reached: bytearray, takers: Mapping[int, float]) -> Cut:
        """Go back from an object that is not reached, only as far as is needed for the cut to hold.

        Every action that is no member and gives an object of the cut has to need one of the cut, and has one
        that is not reached; the one with the most takers is taken, which other actions need, too. Those that
        nothing makes have no number of takers, and come first.
        """

        def most_taken(action: int) -> int | None:
            if action in members:
                return None
            lacking = (o for o in self._graph.needs[action] if not reached[o])
            return max(lacking, key=lambda o: (takers.get(o, math.inf), -o))

        return self._closed({target}, most_taken)

    def _closed(self, inside: set[int], needed: Callable[[int], int | None]) -> Cut:
        """Return the cut of objects and of what ``needed`` tells of each action that would be a member."""
        graph, forbidden = self._graph, self._forbidden
        stack = list(inside)
        makers: set[int] = set()
        while stack:
            for action in graph.makers[stack.pop()]:
                if action in makers or action in forbidden:
                    continue
                makers.add(action)
                o = needed(action) if inside.isdisjoint(graph.needs[action]) else None
                if o is not None:
                    inside.add(o)
                    stack.append(o)
        landmark = sorted(a for a in makers if inside.isdisjoint(graph.needs[a]))
        return Cut(tuple(sorted(inside)), tuple(landmark))


class _Growth:
    """A set of actions that is closed step by step and never reaches the targets."""

    def __init__(self, cutter: Cutter, missing: list[int]) -> None:
        self._gives, self._takers = cutter._gives, cutter._takers
        self._missing = list(missing)
        self._waiting = bytearray(len(missing))  # admitted, and not run so far
        self.reached = bytearray(len(self._takers))
        self._decisive = bytearray(len(self._takers))  # with any of these alone the targets would be reached
        self._left = len(cutter.targets)  # targets are the first objects by number
        self._targets = len(cutter.targets)

    def admit_all(self, places: Iterable[int]) -> bool:
        """Admit actions; whether the targets are reached, after which the growth is of no more use."""
        return not self._left or bool(self.refuse(places, most=1))

    def refuse(self, places: Iterable[int], most: int = sys.maxsize) -> list[int]:
        """Admit actions one after the other, but not those with which the targets are reached.

        Gives these, and ends where there are ``most`` of them. What an object leads to is followed once:
        where it is to the targets, the next action that gives it is refused at once.
        """
        waiting, missing, gives = self._waiting, self._missing, self._gives
        reached, decisive, spread = self.reached, self._decisive, self._spread
        refused: list[int] = []
        for place in places:
            if missing[place]:
                waiting[place] = True
                continue
            new = [o for o in gives[place] if not reached[o]]
            if not new:
                continue
            for o in new:
                if decisive[o]:
                    break
            else:
                if spread(new) is not None:
                    continue
                self._learn(new)
            refused.append(place)
            if len(refused) == most:
                break
        return refused

    def _learn(self, refused: list[int]) -> None:
        """Record which of some objects that together reach the targets does so alone, if one does."""
        for o in refused:
            new = None if len(refused) == 1 else self._spread([o])
            if new is None:
                self._decisive[o] = True
                return
            self._take_back(new)

    def _spread(self, objects: list[int]) -> list[int] | None:
        """Reach objects, and what admitted actions make of them; gives all that are new.

        ``None``, and nothing changes, where the targets are reached.
        """
        waiting, missing, reached = self._waiting, self._missing, self.reached
        takers, targets = self._takers, self._targets
        new: list[int] = []
        for given in (stack := [objects]):  # grows while it is walked through
            for o in given:
                if reached[o]:
                    continue
                reached[o] = True
                new.append(o)
                if o < targets:
                    self._left -= 1
                for taker in takers[o]:
                    missing[taker] -= 1
                    if not missing[taker] and waiting[taker]:
                        stack.append(self._gives[taker])
                if not self._left or self._decisive[o]:
                    self._take_back(new)
                    return None
        return new

    def _take_back(self, new: list[int]) -> None:
        missing, reached = self._missing, self.reached
        for o in new:
            reached[o] = False
            if o < self._targets:
                self._left += 1
            for taker in self._takers[o]:
                missing[taker] += 1
