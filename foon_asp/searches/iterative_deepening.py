"""Iterative deepening: depth-limited depth-first search with backtracking and memoization (Korf 1985)."""

from foon_asp.deadline import Deadline
from foon_asp.problem import Problem, search_backward
from foon_asp.searches.breadth_first import breadth_first
from foon_asp.searches.retrieval import Ending, Retrieval
from foon_asp.searches.search_interface import SearchSettings


def iterative_deepening(problem: Problem, settings: SearchSettings) -> Retrieval:
    """Return an executable tree of least depth, or prove that none exists.

    A kitchen item has depth 0, a unit one more than its deepest precondition, an object the depth of its
    achiever; the depth of a tree is the depth of its deepest goal. For each depth limit, the achievers of an
    object are tried in file order, until all preconditions of an achiever are solved within the limit less
    one. Results are memoized, so that a limit takes at most one pass over the relevant units. If one more
    level solves no new object, the search ends: no further level solves any.

    At a limit of the ``settings`` the ending is ``unknown``. With ``published``, breadth-first retrieval is
    run, as the published programs do under this name.
    """
    if settings.published:
        return breadth_first(problem, settings)
    search = _DepthLimited(problem, Deadline(settings.time_limit, settings.memory_limit))
    limit = 0
    while True:
        try:
            if all(search.solve(goal, limit) for goal in problem.goals):
                return Retrieval(Ending.TREE, search.tree())
            if limit and not search.solves_more(limit):
                return Retrieval(Ending.NONE)
        except TimeoutError:
            return Retrieval(Ending.UNKNOWN)
        if limit == settings.depth_limit:
            return Retrieval(Ending.UNKNOWN)
        limit += 1


class _DepthLimited:
    """The depth-limited search, and its memo of results over all limits.

    ``failed[o]`` is the greatest limit within which object ``o`` cannot be made. ``solved[o]`` is the least
    limit within which ``o`` can be made, with its achiever. The preconditions of the achiever are solved
    within smaller limits, so that the achievers have no cycle.
    """

    def __init__(self, problem: Problem, deadline: Deadline) -> None:
        self.problem = problem
        self.deadline = deadline
        self.failed: dict[int, int] = {}
        self.solved: dict[int, tuple[int, int]] = {}
        _, relevant = search_backward(problem.goals, problem.makers, problem.needs, problem.kitchen)
        self.objects = sorted(relevant)

    def solve(self, goal: int, limit: int) -> bool:
        """Return whether an object can be made within a limit; without recursion, so that any depth works.

        Raises ``TimeoutError`` at the deadline.
        """
        answer = self._memoized(goal, limit)
        if answer is not None:
            return answer
        makers, needs = self.problem.makers, self.problem.needs
        # a frame: object, limit, index of the current achiever, index of its current precondition
        stack = [[goal, limit, 0, 0]]
        while stack:
            if self.deadline.passed:
                raise TimeoutError
            frame = stack[-1]
            o, bound, achiever, precondition = frame
            if o in self.solved and self.solved[o][0] <= bound:  # by another frame, within a smaller limit
                stack.pop()
                continue
            if achiever == len(makers[o]):
                self.failed[o] = max(bound, self.failed.get(o, -1))
                stack.pop()
                continue
            unit = makers[o][achiever]
            if precondition == len(needs[unit]):
                self.solved[o] = (bound, unit)
                stack.pop()
                continue
            answer = self._memoized(needs[unit][precondition], bound - 1)
            if answer is None:
                stack.append([needs[unit][precondition], bound - 1, 0, 0])
            elif answer:
                frame[3] += 1
            else:
                frame[2:] = [achiever + 1, 0]
        return goal in self.solved and self.solved[goal][0] <= limit

    def solves_more(self, limit: int) -> bool:
        """Return whether a relevant object can be made within this limit and not within the limit before."""
        earlier = {o for o in self.objects if o in self.solved and self.solved[o][0] < limit}
        return any(o not in earlier and self.solve(o, limit) for o in self.objects)

    def tree(self) -> tuple[int, ...]:
        """Return the achievers of the goals and of their preconditions, in an executable order."""
        levels: dict[int, int] = {}
        open_goals = list(self.problem.goals)
        while open_goals:
            o = open_goals.pop()
            if o in self.problem.kitchen:
                continue
            limit, unit = self.solved[o]
            if unit not in levels or levels[unit] > limit:
                levels[unit] = limit
                open_goals.extend(self.problem.needs[unit])
        return tuple(sorted(levels, key=lambda unit: (levels[unit], unit)))

    def _memoized(self, o: int, limit: int) -> bool | None:
        """Return whether an object can be made within a limit, or ``None`` where that is not known yet."""
        if o in self.problem.kitchen:
            return True
        if limit <= 0 or self.failed.get(o, -1) >= limit:
            return False
        if o in self.solved and self.solved[o][0] <= limit:
            return True
        return None
