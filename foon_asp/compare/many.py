"""Comparisons for many goals, in this process or several, as they come."""

import multiprocessing
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace

from foon_asp.asp import Settings
from foon_asp.compare.comparison import Comparison, compare
from foon_asp.problem import Problem, reach
from foon_asp.search import Search, SearchSettings

Work = tuple[Problem, tuple[Search, ...], SearchSettings, float | None, Settings | None]

_work: Work | None = None  # of this worker process, set once when it starts


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
    work = problem.plain, tuple(searches), settings, time_limit, rules
    if jobs == 1:
        for goal in goals:
            yield _compare(work, goal)
        return
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(jobs, context, initializer=_begin, initargs=(work,)) as pool:
        try:
            yield from pool.map(_compare_here, goals, chunksize=4)
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def _compare(work: Work, goal: int) -> Comparison:
    problem, searches, settings, time_limit, rules = work
    return compare(replace(problem, goals=(goal,)), searches, settings, time_limit, rules)


def _begin(work: Work) -> None:
    global _work  # noqa: PLW0603 (one question per worker process, which serves no other)
    _work = work


def _compare_here(goal: int) -> Comparison:
    assert _work is not None
    return _compare(_work, goal)
