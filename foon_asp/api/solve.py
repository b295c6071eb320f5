"""The best tree for a problem, and what is proved of it."""

from collections.abc import Mapping, Sequence

from foon_asp.asp import Reporter
from foon_asp.asp.soft import solve_soft as find_soft
from foon_asp.asp.solver import solve as find
from foon_asp.dataset.paths import File, Files
from foon_asp.problem import Problem
from foon_asp.questions.answer import Answer, SoftAnswer
from foon_asp.questions.arguments import (
    Constants,
    Objectives,
    asked_with,
    chosen_objectives,
    file_weights,
    settings,
)
from foon_asp.questions.caller import caller
from foon_asp.reduce import parse_reductions


def solve(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    reductions: str = "all",
    clingo_options: Sequence[str] = (),
    reporter: Reporter | None = None,
) -> Answer:
    """Find the best task tree, and prove that none is better.

    ``objectives`` are names (``units``, ``inputs``, ``inputs+ingredients``, ``success``, ``kitchen``) of
    which the first counts most; ``units`` always decides last. ``constraints`` are files, or names of ours,
    whose ``#const`` are set by ``constants``; ``encodings`` is a folder of encodings to use instead of ours.
    ``time_limit`` is in seconds; at the limit, or when interrupted, the answer is the best tree so far with
    the proved bound. ``reductions`` (``all``, ``safe``, ``none`` or a list by commas) come before the search;
    ``clingo_options`` go to clingo. ``reporter`` hears of trees, bounds and warnings; without it, faults of
    constraints that stop nothing are warned of (:class:`FoonWarning`). Raises :class:`UserError`.
    """
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)._replace(
        reductions=parse_reductions(reductions), clingo_options=tuple(clingo_options)
    )
    return Answer._make(find(asked_with(problem, how), chosen, how, reporter or caller().reporter))


def solve_soft(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    soft: Mapping[File, int],
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
) -> SoftAnswer:
    """Find the tree that pays least for the constraints it breaks, and the best among those.

    ``soft`` gives the constraint files that may be broken, or names of ours, with their weights: each way of
    breaking a rule costs that much. Otherwise as :func:`solve`.
    """
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    return SoftAnswer._make(find_soft(problem.whole, chosen, how, file_weights(soft), caller().reporter))
