"""Comparisons for many goals, in this process or several, as they come."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial

from foon_asp.asp import Settings
from foon_asp.comparison.comparison import Comparison, compare
from foon_asp.errors import UserError
from foon_asp.problem import Problem, reach
from foon_asp.processes.pool import LostError, share
from foon_asp.searches import Search, SearchSettings


def makeable(problem: Problem) -> list[int]:
    """List every object node that can be made and is not in the kitchen; the goals do not matter."""
    return sorted(o for o in reach(problem).makers if o not in problem.kitchen)


def compare_goals(
    problem: Problem,
    goals: Sequence[int],
    searches: Sequence[Search],
    settings: SearchSettings,
    time_limit: float | None = None,
    jobs: int = 1,
    rules: Settings | None = None,
) -> Iterator[Comparison]:
    """Compare the searches on each goal by itself, in order of the goals, and under rules of the user's.

    With more than one job, processes share the goals; the rows are the same.
    """
    work = partial(_compare, problem.plain, tuple(searches), settings, time_limit, rules)
    if jobs == 1:
        yield from map(work, enumerate(goals))
        return
    ready: dict[int, Comparison] = {}  # those that wait for an earlier goal
    sent = 0
    for done in share(partial(partial, work), [*enumerate(goals)], min(jobs, len(goals))):
        number, goal = done.task
        if isinstance(done.error, LostError):
            raise UserError(f"{problem.network.objects[goal]}: {done.error}; fewer --jobs take less memory")
        ready[number] = done.get()
        while sent in ready:
            yield ready.pop(sent)
            sent += 1


def _compare(
    problem: Problem,
    searches: tuple[Search, ...],
    settings: SearchSettings,
    time_limit: float | None,
    rules: Settings | None,
    numbered: tuple[int, int],
) -> Comparison:
    _, goal = numbered
    return compare(replace(problem, goals=(goal,)), searches, settings, time_limit, rules)
