"""The best tree for a problem, and the proof that none is better."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from foon_asp.asp import Reporter
from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel
from foon_asp.errors import UserError
from foon_asp.problem import Problem
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.answer import Answer, answered_under
from foon_asp.questions.arguments import (
    Constants,
    Objectives,
    chosen_objectives,
    constraint_weights,
    read,
    settings,
    whole,
)
from foon_asp.questions.contract import TABLES, Kind, Option, not_built, question
from foon_asp.questions.options import CONTAINERS, GOALS, ITEMS, LIMITS, OBJECTIVES, RULES, SOFT
from foon_asp.questions.posing import one_problem_or_nearby
from foon_asp.questions.result import Result
from foon_asp.reduce import Reduction, parse_reductions

if TYPE_CHECKING:
    from foon_asp.engines import Engine
    from foon_asp.questions.certify import Certified
    from foon_asp.questions.solve_soft import SoftAnswer


def solve_and_more(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    soft: Mapping[File, int] | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    reductions: str = "all",
    certificate_file: File | None = None,
    cross_check: bool = False,
    clingo_options: Sequence[str] = (),
) -> Result:
    """Solve as ``foon-asp solve`` does: also under soft constraints, with a certificate, or checked.

    What only some answers need is imported for these.
    """
    how = settings(constraints, constants, encodings, time_limit, memory_limit)._replace(
        reductions=parse_reductions(reductions), clingo_options=tuple(clingo_options)
    )
    chosen = chosen_objectives(problem, objectives)
    if problem.items is not None and soft:
        raise not_built("solve --soft")
    if soft and certificate_file is not None:
        raise UserError("soft constraints have no certificates; leave one of them out")
    engines: tuple[Engine, ...] = ()
    if cross_check:
        from foon_asp.engines import find_engines  # noqa: PLC0415

        problem, engines = whole(problem), find_engines()
    found: Answer | SoftAnswer | Certified
    if soft:
        from foon_asp.questions.solve_soft import softly_answered  # noqa: PLC0415

        found = softly_answered(read(problem), chosen, how, constraint_weights(soft))
    elif certificate_file is not None:
        from foon_asp.questions.certify import certified  # noqa: PLC0415

        found = certified(problem, chosen, how).written(certificate_file)
    else:
        found = answered_under(problem, chosen, how)
    if not cross_check:
        return found
    from foon_asp.questions.cross_check import checked_or_reported  # noqa: PLC0415

    return checked_or_reported(found, how, constraint_weights(soft or {}), engines)


@question(
    GOALS,
    OBJECTIVES,
    CONTAINERS,
    *ITEMS,
    *RULES,
    SOFT,
    *LIMITS,
    Option(
        "reductions",
        f"Reductions before the search; safe keeps every optimal tree. LIST: {', '.join(Reduction)}.",
        default="all",
        flags=("--reduce",),
        metavar="all|safe|none|LIST",
    ),
    Option(
        "certificate_file",
        "Also write a proof of the answer that `foon-asp verify` checks without a solver.",
        Kind.FILE,
        flags=("--certificate",),
    ),
    Option(
        "cross_check",
        "Also ask other engines: bare clingo, HiGHS, Fast Downward and those of packages, if installed.",
        Kind.FLAG,
    ),
    Option(
        "clingo_options",
        "Options to pass to clingo unchanged.",
        Kind.OPTIONS,
        many=True,
        metavar="[RECIPE|DIR|STORE]... [-- CLINGO OPTIONS]",
        positional=True,
    ),
    formats=(*TABLES, "foon", "steps"),
    pose=one_problem_or_nearby,
    command=solve_and_more,
    help_="""
    \b
    foon-asp solve --goal 'greek salad'
    foon-asp solve --goal macaroni --objective success --containers implied
    foon-asp solve --goal ice --constraint forbid_motion -c forbidden_motion=crush
    foon-asp solve --goal ice --soft forbid_motion.lp=3 -c forbidden_motion=crush

    Rules without a head (:- ...) in a --soft file may be broken: each way to break one, with other values of
    its variables, costs the weight. The lowest sum of weights comes before all objectives.

    Exits with 0 when the tree is proved optimal, 1 when no tree exists, 2 for bad input, 3 when stopped
    at a limit.
    """,
)
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
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Answer:
    """Find the best task tree for the goals of a problem, and prove that no other is better.

    At a limit, or when interrupted, the answer is the best tree so far, with a bound on the best one.

    Parameters:
        reductions: What reduces the network before the search: ``all``, ``none``, ``safe`` (all that keep
            every optimal tree), or names of reductions separated by commas.
        clingo_options: Options to pass to clingo, for example ``["--opt-strategy=bb"]``.
        reporter: Receives trees, bounds and warnings during the search. Without it, a warning about a
            constraint is a :class:`FoonWarning`.

    Returns:
        The answer, with its ``status``, ``costs`` and ``tree``.

    Raises:
        UserError: for a wrong argument or constraint, or an objective that needs rates or prices not given.

    Example:
        >>> answer = foon_asp.solve(foon_asp.load().problem("macaroni"), "success")
        >>> answer
        <Answer: optimal by success (strict containers): 11 units, 26 inputs, success ≈ 0.6293>
        >>> [unit.motion for unit in answer.tree][:3]
        ['open', 'turn on', 'fill']
    """
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)._replace(
        reductions=parse_reductions(reductions), clingo_options=tuple(clingo_options)
    )
    return answered_under(problem, chosen, how, reporter)
