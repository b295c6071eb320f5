"""Iterative deepening: depth-limited depth-first search with backtracking, deeper and deeper."""

from foon_asp.deadline import Deadline
from foon_asp.problem import Problem, backwards
from foon_asp.searches.breadth_first import breadth_first
from foon_asp.searches.retrieval import Ending, Retrieval
from foon_asp.searches.search import SearchSettings


def iterative_deepening(problem: Problem, settings: SearchSettings) -> Retrieval:
    """Find a tree that executes, of least depth, or show that there is none.

    A kitchen item has depth 0, a unit one more than the deepest input it needs, an object the depth of
    the unit that makes it; the depth of a tree is that of its deepest goal. For each limit in turn, every
    unit that makes an object is tried, in file order, until one has all its inputs within the limit less
    one. What failed at which limit, and what was found, is remembered, so a limit costs at most one pass
    over the units that can matter. When no object gets within reach by one more level, none ever will.

    Reaching a limit of the ``settings`` ends in ``unknown``. With ``published`` it is what the published
    programs do instead.
    """
    if settings.published:
        return breadth_first(problem, settings)
    search = _DepthLimited(problem, Deadline(settings.time_limit, settings.memory_limit))
    limit = 0
    while True:
        try:
            if all(search.within(goal, limit) for goal in problem.goals):
                return Retrieval(Ending.TREE, search.tree())
            if limit and not search.grows(limit):
                return Retrieval(Ending.NONE)
        except TimeoutError:
            return Retrieval(Ending.UNKNOWN)
        if limit == settings.depth_limit:
            return Retrieval(Ending.UNKNOWN)
        limit += 1


class _DepthLimited:
    """The depth-limited search, and what it remembers between limits.

    ``failed[o]`` is the greatest limit within which object ``o`` was shown not to be made. ``found[o]`` is
    the least limit within which it was, with the unit that makes it: the inputs of that unit were found
    within smaller limits, so following the units never runs in a circle.
    """

    def __init__(self, problem: Problem, deadline: Deadline) -> None:
        self.problem = problem
        self.deadline = deadline
        self.failed: dict[int, int] = {}
        self.found: dict[int, tuple[int, int]] = {}
        _, relevant = backwards(problem.goals, problem.makers, problem.needs, problem.kitchen)
        self.objects = sorted(relevant)

    def within(self, goal: int, limit: int) -> bool:
        """Whether an object can be made within a limit; a stack of its own, so depth is no matter."""
        answer = self._known(goal, limit)
        if answer is not None:
            return answer
        makers, needs = self.problem.makers, self.problem.needs
        # a frame: object, limit, number of the unit being tried, number of the input being looked at
        stack = [[goal, limit, 0, 0]]
        while stack:
            if self.deadline.passed:
                raise TimeoutError
            frame = stack[-1]
            o, bound, tried, looked = frame
            if o in self.found and self.found[o][0] <= bound:  # meanwhile, within a smaller limit
                stack.pop()
                continue
            if tried == len(makers[o]):
                self.failed[o] = max(bound, self.failed.get(o, -1))
                stack.pop()
                continue
            unit = makers[o][tried]
            if looked == len(needs[unit]):
                self.found[o] = (bound, unit)
                stack.pop()
                continue
            answer = self._known(needs[unit][looked], bound - 1)
            if answer is None:
                stack.append([needs[unit][looked], bound - 1, 0, 0])
            elif answer:
                frame[3] += 1
            else:
                frame[2:] = [tried + 1, 0]
        return goal in self.found and self.found[goal][0] <= limit

    def grows(self, limit: int) -> bool:
        """Whether some object that can matter is made within this limit and not within one less."""
        before = {o for o in self.objects if o in self.found and self.found[o][0] < limit}
        return any(o not in before and self.within(o, limit) for o in self.objects)

    def tree(self) -> tuple[int, ...]:
        """Follow the units found from the goals, and list them in an order that executes."""
        levels: dict[int, int] = {}
        waiting = list(self.problem.goals)
        while waiting:
            o = waiting.pop()
            if o in self.problem.kitchen:
                continue
            limit, unit = self.found[o]
            if unit not in levels or levels[unit] > limit:
                levels[unit] = limit
                waiting.extend(self.problem.needs[unit])
        return tuple(sorted(levels, key=lambda unit: (levels[unit], unit)))

    def _known(self, o: int, limit: int) -> bool | None:
        if o in self.problem.kitchen:
            return True
        if limit <= 0 or self.failed.get(o, -1) >= limit:
            return False
        if o in self.found and self.found[o][0] <= limit:
            return True
        return None
