"""Comparisons for many goals, in this process or in several."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial

from foon_asp.asp import Settings
from foon_asp.comparison.comparison import Comparison, compare
from foon_asp.errors import UserError
from foon_asp.problem import Problem, reach
from foon_asp.processes.pool import LostError, run_in_processes
from foon_asp.searches import Search, SearchSettings


def makeable(problem: Problem) -> list[int]:
    """Return the ids, in ascending order, of all object nodes that can be made and are not in the kitchen."""
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
    """Compare searches on each goal by itself; yield the comparisons in the order of the goals.

    ``goals`` are ids. ``time_limit`` is in seconds for each optimum; ``None`` for no limit. ``jobs`` is how
    many processes share the goals; the comparisons do not depend on it. Optima keep to the ``rules``.

    Raises :class:`UserError` where a process dies, usually because memory is full.
    """
    compare_goal = partial(_compare_on_goal, problem.plain, tuple(searches), settings, time_limit, rules)
    if jobs == 1:
        yield from map(compare_goal, enumerate(goals))
        return
    ready: dict[int, Comparison] = {}  # comparisons that wait for the one of an earlier goal
    next_number = 0
    for finished in run_in_processes(
        partial(partial, compare_goal), [*enumerate(goals)], min(jobs, len(goals))
    ):
        number, goal = finished.task
        if isinstance(finished.error, LostError):
            raise UserError(
                f"{problem.network.objects[goal]}: {finished.error}; fewer --jobs take less memory"
            )
        ready[number] = finished.get()
        while next_number in ready:
            yield ready.pop(next_number)
            next_number += 1


def _compare_on_goal(
    problem: Problem,
    searches: tuple[Search, ...],
    settings: SearchSettings,
    time_limit: float | None,
    rules: Settings | None,
    numbered: tuple[int, int],
) -> Comparison:
    """Compare the searches on one goal.

    ``numbered`` is a pair: an index, which is not used, and the id of the goal.
    """
    _, goal = numbered
    return compare(replace(problem, goals=(goal,)), searches, settings, time_limit, rules)
