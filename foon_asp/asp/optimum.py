"""The best tree; or the best plan, where items are used up."""

from collections.abc import Sequence

from foon_asp.asp import solver
from foon_asp.asp.outcome import Outcome
from foon_asp.asp.reporter import Reporter
from foon_asp.asp.settings import Settings
from foon_asp.hypergraph import SolvedGoals
from foon_asp.problem import Objective, Problem


def solve(
    problem: Problem,
    objectives: Sequence[Objective] = (Objective.UNITS,),
    settings: Settings | None = None,
    reporter: Reporter | None = None,
    mattered: set[int] | None = None,
    solved: SolvedGoals | None = None,
) -> Outcome:
    """Return the best tree, or the best plan where items are used up, with what is proved about it.

    ``objectives`` are lexicographic; ``units`` decides last. At a limit, the outcome has the best tree or
    plan found. The other parameters are those of :func:`foon_asp.asp.solver.solve`; ``mattered`` and
    ``solved`` have no effect on plans. Raises the errors of that function and of
    :func:`foon_asp.plans.plan_search.solve_used_up`.
    """
    if problem.items is None:
        return solver.solve(problem, objectives, settings, reporter, mattered, solved)
    from foon_asp.plans.plan_search import solve_used_up  # noqa: PLC0415 (numpy and HiGHS)

    return solve_used_up(problem, objectives, settings, reporter)
