"""Iterative deepening: depth-limited depth-first search with backtracking and memoization (Korf 1985)."""

from foon_asp.deadline import Deadline
from foon_asp.problem import Problem, search_backward
from foon_asp.searches.breadth_first import breadth_first
from foon_asp.searches.retrieval import Ending, Retrieval
from foon_asp.searches.search_interface import SearchSettings


def iterative_deepening(problem: Problem, settings: SearchSettings) -> Retrieval:
    """Return an executable tree of least depth, or prove that none exists.

    A kitchen item has depth 0. An object has the depth of its achiever. A unit has the depth of its deepest
    precondition plus 1. The depth of a tree is that of its deepest goal.

    The depth limit grows from 0. An object is solved within a limit if all preconditions of an achiever are
    solved within the limit minus 1; achievers are tried in file order. Results are kept, so that each limit
    takes at most one pass over the relevant units. If no new object is solved within a limit, a larger limit
    does not help, and the search ends.

    At a limit of the ``settings`` (depth, time or memory), the ending is ``unknown``. With ``published``,
    breadth-first retrieval is run instead, as the published programs do under this name; it follows ``ties``.
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
    """The depth-limited search, which keeps its results over all limits.

    ``failed``: by object, the greatest limit within which it is known that the object cannot be made.
    ``solved``: by object, the limit within which it was made, and its achiever. The preconditions of the
    achiever are solved within smaller limits, so that the achievers have no cycle.
    ``objects``: the objects that the goals can need.
    """

    def __init__(self, problem: Problem, deadline: Deadline) -> None:
        self.problem = problem
        self.deadline = deadline
        self.failed: dict[int, int] = {}
        self.solved: dict[int, tuple[int, int]] = {}
        _, relevant = search_backward(problem.goals, problem.makers, problem.needs, problem.kitchen)
        self.objects = sorted(relevant)

    def solve(self, goal: int, limit: int) -> bool:
        """Return whether an object can be made within a depth limit; record it in ``solved`` and ``failed``.

        A stack replaces recursion, so that any depth works. Raises ``TimeoutError`` at the deadline.
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
        """Return whether some relevant object can be made within this limit, and not within smaller ones.

        The search ends with the first such object. Results are recorded as in :meth:`solve`. Raises
        ``TimeoutError`` at the deadline.
        """
        earlier = {o for o in self.objects if o in self.solved and self.solved[o][0] < limit}
        return any(o not in earlier and self.solve(o, limit) for o in self.objects)

    def tree(self) -> tuple[int, ...]:
        """Return the tree: the recorded achievers of the goals and, recursively, of their preconditions.

        All goals have to be solved. The unit ids are in an order that executes.
        """
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
        """Return whether an object can be made within a limit, if that needs no search; else ``None``.

        No search is needed for a kitchen item, for the limit 0, and where a result is recorded.
        """
        if o in self.problem.kitchen:
            return True
        if limit <= 0 or self.failed.get(o, -1) >= limit:
            return False
        if o in self.solved and self.solved[o][0] <= limit:
            return True
        return None
