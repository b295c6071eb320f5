"""What makes each thing in a tree, as actions are left out of it one by one."""

from collections.abc import Callable, Collection
from heapq import heapify, heappop, heappush

from foon_asp.reduce.derivation import derive
from foon_asp.reduce.graph import Graph


class Support:
    """A tree, and the cheapest way to make each thing in it by its actions alone (h_add).

    ``left`` are the actions that these ways have: those that do nothing for the goals are left out at once.
    ``figure[o]`` is what a thing in use costs by them. Where one more is left out, only what builds upon it
    is derived anew, from the rest: what actions make for each other in a circle is no support.
    """

    def __init__(self, graph: Graph, tree: Collection[int], cost: Callable[[int], int]) -> None:
        self._graph, self._cost = graph, cost
        self.figure, self._maker, self._before = found = derive(graph, tree, cost, added=True)
        self.left = found.tree(graph, graph.goals) or set()
        self._goals = frozenset(graph.goals)
        self._givers: dict[int, set[int]] = {}
        self._takers: dict[int, set[int]] = {}
        for action in self.left:
            for o in graph.gives[action]:
                self._givers.setdefault(o, set()).add(action)
            for o in graph.needs[action]:
                if o not in graph.start:
                    self._takers.setdefault(o, set()).add(action)
        self._jobs = dict.fromkeys(self.left, 0)  # how much of what is in use an action makes
        for o in self._goals | self._takers.keys():
            self._jobs[self._maker[o]] += 1

    def _in_use(self, o: int) -> bool:
        return bool(o in self._goals or self._takers.get(o))

    def replaceable(self, action: int) -> bool:
        """Whether each output of an action that is in use is given by another one, too.

        As long as an action can be left out this holds for one: the last, in an order that executes, of those
        that would not run without it or be of use.
        """
        return all(len(self._givers[o]) > 1 for o in self._graph.gives[action] if self._in_use(o))

    def leave_out(self, action: int) -> set[int] | None:
        """Leave out an action, and what is of no use without it.

        Gives the actions that gave something that is in use no more. ``None``, and nothing changes, where the
        others do not make the goals.
        """
        missing = {action: 0}  # of the actions that build upon it, how much that they need
        lost: set[int] = set()
        for unit in (stack := [action]):  # grows while it is walked through
            for o in self._graph.gives[unit]:
                if self._maker.get(o) == unit and o not in lost and self._in_use(o):
                    lost.add(o)
                    for taker in self._takers.get(o, ()):
                        if taker not in missing:
                            missing[taker] = 0
                            stack.append(taker)
                        missing[taker] += 1
        made, before = self._made_anew(lost, missing)
        if any(o in self._goals and o not in made for o in lost):
            return None
        for o, (figure, maker) in made.items():
            self._jobs[self._maker[o]] -= 1
            self._jobs[maker] += 1
            self.figure[o], self._maker[o] = figure, maker
        self._before.update(before)
        return self._drop([unit for unit in missing if not self._jobs[unit]])

    def _made_anew(
        self, lost: Collection[int], missing: dict[int, int]
    ) -> tuple[dict[int, tuple[int, int]], dict[int, int]]:
        """Derive what is lost from what is not; gives figures and makers, and figures of the actions.

        ``missing`` counts what the actions need that is lost.
        """
        made: dict[int, tuple[int, int]] = {}
        before: dict[int, int] = {}
        waiting = [(self._before[a], a, o) for o in lost for a in self._givers[o] if a not in missing]
        heapify(waiting)
        while waiting:
            figure, action, o = heappop(waiting)
            if o in made:
                continue
            made[o] = figure, action
            for taker in self._takers.get(o, ()):
                missing[taker] -= 1
                if not missing[taker]:
                    needs = (n for n in self._graph.needs[taker] if n not in self._graph.start)
                    total = self._cost(taker) + sum(
                        made[n][0] if n in made else self.figure[n] for n in needs
                    )
                    before[taker] = total
                    for given in self._graph.gives[taker]:
                        if given in lost:
                            heappush(waiting, (total, taker, given))
        return made, before

    def _drop(self, idle: list[int]) -> set[int]:
        """Drop actions that make nothing that is in use, and those that only they are for."""
        graph, left = self._graph, self.left
        freed: set[int] = set()
        while idle:
            action = idle.pop()
            left.remove(action)
            for o in graph.gives[action]:
                self._givers[o].discard(action)
            for o in graph.needs[action]:
                if o not in graph.start and action in self._takers[o]:
                    self._takers[o].remove(action)
                    if not self._in_use(o):
                        freed |= self._givers[o]
                        maker = self._maker[o]
                        self._jobs[maker] -= 1
                        if not self._jobs[maker]:
                            idle.append(maker)
        return freed & left
