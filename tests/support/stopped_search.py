"""A solver that is stopped: the first searches come to their end, and the next one does not."""

from collections.abc import Callable, Sequence

from foon_asp.asp import Outcome, Reporter, Settings, solve
from foon_asp.deadline import Deadline
from foon_asp.problem import Objective, Problem


def stopped_after(
    searches: int, interrupted: Callable[[Problem], bool]
) -> Callable[[Problem, Sequence[Objective], Settings, Reporter], Outcome]:
    """Give a ``solve`` that ends some searches; later ones are interrupted, or stopped by a time limit."""
    left = iter(range(searches))

    def solve_or_stop(
        problem: Problem, objectives: Sequence[Objective], settings: Settings, reporter: Reporter
    ) -> Outcome:
        if next(left, None) is not None:
            return solve(problem, objectives, settings, reporter)
        if interrupted(problem):
            raise KeyboardInterrupt
        return solve(problem, objectives, settings._replace(deadline=Deadline(0.0)), reporter)

    return solve_or_stop
