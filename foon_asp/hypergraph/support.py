"""The cheapest achievers in a tree, updated as actions are removed one by one."""

from collections.abc import Callable, Collection
from heapq import heapify, heappop, heappush

from foon_asp.hypergraph.goal_graph import GoalGraph
from foon_asp.hypergraph.h_values import compute_h_values


class Support:
    """A tree with the h_add values and best achievers of its objects, updated when actions are removed.

    ``actions``: the actions that are still in the tree. At first, they are those found by following best
    achievers from the goals.
    ``h_objects``: the h_add value of each object. Values of objects that are not in use may be outdated.

    An object is *in use* if it is a goal or a precondition of an action in the tree. When an action is
    removed, only objects derived by it are derived anew. They are derived from the other objects, so that
    actions of a cycle do not support each other.
    """

    def __init__(self, graph: GoalGraph, tree: Collection[int], cost: Callable[[int], int]) -> None:
        self._graph, self._cost = graph, cost
        self.h_objects, self._best_achiever, self._h_actions = derivations = compute_h_values(
            graph, tree, cost, h_add=True
        )
        self.actions = derivations.tree(graph, graph.goals) or set()
        self._goals = frozenset(graph.goals)
        self._achievers: dict[int, set[int]] = {}
        self._consumers: dict[int, set[int]] = {}
        for action in self.actions:
            for o in graph.gives[action]:
                self._achievers.setdefault(o, set()).add(action)
            for o in graph.needs[action]:
                if o not in graph.start:
                    self._consumers.setdefault(o, set()).add(action)
        self._supported = dict.fromkeys(self.actions, 0)  # number of objects in use with this best achiever
        for o in self._goals | self._consumers.keys():
            self._supported[self._best_achiever[o]] += 1

    def _is_in_use(self, o: int) -> bool:
        """Return whether an object is a goal or a precondition of an action in the tree."""
        return bool(o in self._goals or self._consumers.get(o))

    def is_replaceable(self, action: int) -> bool:
        """Return whether each object in use that an action makes has another achiever in the tree.

        A tree with redundant actions has a replaceable action.
        """
        return all(len(self._achievers[o]) > 1 for o in self._graph.gives[action] if self._is_in_use(o))

    def remove(self, action: int) -> set[int] | None:
        """Remove an action, and the actions that are of no use without it.

        Returns the remaining actions that achieve an object that is no longer in use. They may be redundant
        now. If the other actions do not reach the goals, the tree does not change, and the result is
        ``None``.
        """
        missing = {action: 0}  # number of lost preconditions of each action derived by it
        lost: set[int] = set()
        for unit in (stack := [action]):  # grows while it is walked through
            for o in self._graph.gives[unit]:
                if self._best_achiever.get(o) == unit and o not in lost and self._is_in_use(o):
                    lost.add(o)
                    for consumer in self._consumers.get(o, ()):
                        if consumer not in missing:
                            missing[consumer] = 0
                            stack.append(consumer)
                        missing[consumer] += 1
        rederived, h_actions = self._rederive(lost, missing)
        if any(o in self._goals and o not in rederived for o in lost):
            return None
        for o, (h_value, achiever) in rederived.items():
            self._supported[self._best_achiever[o]] -= 1
            self._supported[achiever] += 1
            self.h_objects[o], self._best_achiever[o] = h_value, achiever
        self._h_actions.update(h_actions)
        return self._remove_idle([unit for unit in missing if not self._supported[unit]])

    def _rederive(
        self, lost: Collection[int], missing: dict[int, int]
    ) -> tuple[dict[int, tuple[int, int]], dict[int, int]]:
        """Derive lost objects anew, and return the new h_add values of objects and of actions.

        ``missing`` has the number of lost preconditions of each action that has some; it is changed in place.
        The first result maps each object that is reached to its h_add value and best achiever. The second
        maps actions to their h_add values.
        """
        rederived: dict[int, tuple[int, int]] = {}
        h_actions: dict[int, int] = {}
        waiting = [(self._h_actions[a], a, o) for o in lost for a in self._achievers[o] if a not in missing]
        heapify(waiting)
        while waiting:
            h_value, action, o = heappop(waiting)
            if o in rederived:
                continue
            rederived[o] = h_value, action
            for consumer in self._consumers.get(o, ()):
                missing[consumer] -= 1
                if not missing[consumer]:
                    needs = (n for n in self._graph.needs[consumer] if n not in self._graph.start)
                    total = self._cost(consumer) + sum(
                        rederived[n][0] if n in rederived else self.h_objects[n] for n in needs
                    )
                    h_actions[consumer] = total
                    for effect in self._graph.gives[consumer]:
                        if effect in lost:
                            heappush(waiting, (total, consumer, effect))
        return rederived, h_actions

    def _remove_idle(self, idle: list[int]) -> set[int]:
        """Remove ``idle`` actions, and the best achievers that only they needed.

        An action is idle if it is no best achiever of an object in use. Returns the remaining actions that
        achieve an object that is no longer in use.
        """
        graph, actions = self._graph, self.actions
        freed: set[int] = set()
        while idle:
            action = idle.pop()
            actions.remove(action)
            for o in graph.gives[action]:
                self._achievers[o].discard(action)
            for o in graph.needs[action]:
                if o not in graph.start and action in self._consumers[o]:
                    self._consumers[o].remove(action)
                    if not self._is_in_use(o):
                        freed |= self._achievers[o]
                        achiever = self._best_achiever[o]
                        self._supported[achiever] -= 1
                        if not self._supported[achiever]:
                            idle.append(achiever)
        return freed & actions
