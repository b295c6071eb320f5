"""The best tree for a problem, and the proof that none is better."""

from collections.abc import Mapping, Sequence
from typing import Annotated, Unpack

from foon_asp.asp import Reporter
from foon_asp.dataset.nearby import without_reading_more
from foon_asp.dataset.paths import File
from foon_asp.errors import UserError
from foon_asp.hypergraph import Reduction, parse_reductions
from foon_asp.problem import Problem
from foon_asp.questions.answer import Answer, SkippedGoal, answer_under_rules
from foon_asp.questions.durations import Durations, stated_durations
from foon_asp.questions.options import AMOUNT, ITEMS, SOFT, TREE
from foon_asp.questions.python_arguments import (
    Objectives,
    chosen_objectives,
    constraint_weights,
    over_whole_network,
    problem_for_rules,
    read_deferred,
    require_at_least,
)
from foon_asp.questions.python_options import CommonOptions, settings_of
from foon_asp.questions.question import TABLES, Kind, Option, Role, not_for_used_up_items, question
from foon_asp.questions.result import Result


def solve_or_each(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    soft: Mapping[File, int] | None = None,
    reductions: str = "all",
    certificate: File | None = None,
    cross_check: bool = False,
    skip_unreachable: bool = False,
    clingo_options: Sequence[str] = (),
    durations: Durations | None = None,
    retries: int | None = None,
    all_goals: bool = False,
    **options: Unpack[CommonOptions],
) -> Result:
    """Return the best tree for all goals, or with ``all_goals`` the best tree for each goal by itself.

    Raises :class:`UserError` if ``all_goals`` comes with an option for the tree of a single question.
    """
    if not all_goals:
        return solve(
            problem,
            objectives,
            soft=soft or None,
            reductions=reductions,
            certificate=certificate,
            cross_check=cross_check,
            skip_unreachable=skip_unreachable,
            clingo_options=clingo_options,
            durations=durations,
            retries=retries,
            **options,
        )
    from foon_asp.questions.all_goals import solve_all_goals  # noqa: PLC0415

    if skip_unreachable:
        raise UserError("--all-goals says of each goal whether it can be made: leave out --skip-unreachable")
    if soft or certificate is not None or cross_check or retries is not None:
        raise UserError(
            "--all-goals lists what each goal costs: ask for soft constraints, a certificate, a "
            "cross-check or retries of one goal (--goal)"
        )
    if reductions != "all" or clingo_options or durations is not None:
        raise UserError(
            "--all-goals takes no --reduce, --durations or options of clingo: they are for one goal (--goal)"
        )
    return solve_all_goals(problem, objectives, **options)


@question(
    *TREE,
    *ITEMS,
    AMOUNT,
    Option(
        "all_goals",
        "Solve every goal that --goal or the goals file names by itself, under each --objective by itself.",
        Kind.FLAG,
        Role.PROBLEM | Role.QUESTION,
        default=False,
    ),
    formats=(*TABLES, "foon", "steps", "steps-csv", "behaviour-tree"),
    command=solve_or_each,
    help_="""
    \b
    foon-asp solve --goal 'greek salad'
    foon-asp solve --goal macaroni --objective success --containers implied
    foon-asp solve --goal ice --constraint forbid_motion -c forbidden_motion=crush
    foon-asp solve --goal 'greek salad' --certificate proof.json
    foon-asp solve --goal ice --soft forbid_motion.lp=3 -c forbidden_motion=crush
    foon-asp solve --goal ice --goal omelet --skip-unreachable
    foon-asp solve --all-goals --objective units --objective success

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
    soft: Annotated[Mapping[File, int] | None, SOFT] = None,
    reductions: Annotated[
        str,
        Option(
            help="Reductions before the search; safe keeps every optimal tree. "
            f"LIST: {', '.join(Reduction)}.",
            flags=("--reduce",),
            metavar="all|safe|none|LIST",
        ),
    ] = "all",
    certificate: Annotated[
        File | None, Option(help="Also write a proof, which `foon-asp verify` checks.", kind=Kind.WRITTEN)
    ] = None,
    cross_check: Annotated[bool, Option()] = False,
    skip_unreachable: Annotated[bool, Option()] = False,
    clingo_options: Annotated[
        Sequence[str],
        Option(
            help="Options to pass to clingo unchanged; --stats prints its statistics.",
            kind=Kind.OPTIONS,
            many=True,
            metavar="[RECIPE|DIR|STORE]... [-- CLINGO OPTIONS]",
            positional=True,
        ),
    ] = (),
    durations: Annotated[
        Durations | None,
        Option(help="How long motions take, for the formats for robots.", kind=Kind.FILE, metavar="FILE"),
    ] = None,
    retries: Annotated[int | None, Option(metavar="N", least=0)] = None,
    reporter: Reporter | None = None,
    **options: Unpack[CommonOptions],
) -> Answer:
    """Find the best task tree for the goals of a problem, and prove that no other is better.

    At a limit, or when interrupted, the answer is the best tree so far, with a bound on the best one. Under
    ``soft`` constraints it is the best of the trees with the least penalty for broken constraints. For two to
    eight goals, the answer also has the best tree for each goal by itself.

    Parameters:
        reductions: What reduces the network before the search: ``all``, ``none``, ``safe`` (all that keep
            every optimal tree), or names of reductions separated by commas.
        certificate: The path of a file to write a certificate to: a proof of the answer that
            :func:`foon_asp.verify` checks without a solver. It is about the whole network. If
            there are no rules, only the part of a store that the proof touches is read; the certificate then
            names the digests that the store states. Where items are used up, the certificate has a plan, and
            a lower bound on the cost of every plan. If the plan costs more, it claims only a ``bound``.
        cross_check: Also ask other engines: bare clingo, HiGHS, Fast Downward and those of packages, if
            installed. They share what is left of the ``time_limit``; without one, each has a minute.
        skip_unreachable: Leave out goals that cannot be made from the kitchen, and list each with its cause.
            Constraints are not looked at for that. If no goal can be made, none is left out.
        clingo_options: Options to pass to clingo, for example ``["--opt-strategy=bb"]``.
        durations: How long motions take, for the formats for robots: a file as for :func:`schedule`, or
            seconds by motion.
        retries: Find which trees to follow if this many executions may fail, by their chance of success. The
            answer has the ``policy``; a behaviour tree has a branch for each tree.
        reporter: Receives trees, bounds and warnings during the search. Without it, a warning about a
            constraint is a :class:`FoonWarning`.

    Returns:
        The answer, with its ``status``, ``costs``, ``units`` and ``tree``; under ``soft`` constraints also
        with the ``penalty`` and the number of ways in which each constraint is broken. Its ``certificate`` is
        ``None`` unless one was requested and found.

    Raises:
        BugError: if a built-in engine finds a different optimum.
        UserError: for a wrong argument, constraint or weight, or an objective that needs rates or prices not
            given.

    Example:
        >>> answer = foon_asp.solve(foon_asp.load().problem("macaroni"), "success")
        >>> answer
        <Answer: optimal by success (strict containers): 11 units, 26 inputs, success ≈ 0.6293>
        >>> [unit.motion for unit in answer.tree][:3]
        ['open', 'turn on', 'fill']
    """
    chosen = chosen_objectives(problem, objectives)
    settings = settings_of(options)._replace(
        reductions=parse_reductions(reductions), clingo_options=tuple(clingo_options)
    )
    weights = constraint_weights(soft or {})
    seconds = stated_durations(durations)
    if soft is not None and problem.items is not None:
        raise not_for_used_up_items("solve --soft")
    if retries is not None and problem.items is not None:
        raise not_for_used_up_items("solve --retries")
    if retries is not None and soft is not None:
        raise UserError("retries are about the best trees; leave the soft constraints out")
    if soft is not None and certificate is not None:
        raise UserError("soft constraints have no certificates; leave one of them out")
    if cross_check:  # what only some answers need is imported for these
        from foon_asp.engines import find_engines  # noqa: PLC0415
        from foon_asp.questions.cross_check import cross_check_answer  # noqa: PLC0415

        problem, engines = over_whole_network(problem), find_engines()
    skipped: tuple[SkippedGoal, ...] = ()
    if skip_unreachable:
        from foon_asp.questions.unreachable_goals import without_unreachable  # noqa: PLC0415

        problem, skipped = without_unreachable(problem_for_rules(problem, settings))
    # without reading more of a large store
    has_several_goals = soft is None and len(without_reading_more(problem).goals) > 1
    if soft is not None:
        from foon_asp.questions.solve_soft import solve_under_soft_constraints  # noqa: PLC0415

        answer = solve_under_soft_constraints(read_deferred(problem), chosen, settings, weights)
    elif certificate is not None:
        from foon_asp.questions.certifying import solve_with_certificate  # noqa: PLC0415

        answer = solve_with_certificate(problem, chosen, settings, certificate)
    else:
        answer = answer_under_rules(problem, chosen, settings, reporter)
    if has_several_goals:
        from foon_asp.questions.several_goals import with_goals_apart  # noqa: PLC0415

        answer = with_goals_apart(answer, settings, problem)
    if skip_unreachable:
        answer = answer.having(skipped=skipped)
    answer = cross_check_answer(answer, settings, weights, engines) if cross_check else answer
    if retries is not None:
        from foon_asp.questions.retry_policy import with_policy  # noqa: PLC0415

        answer = with_policy(answer, require_at_least(retries, 0, "retries"), settings, **options)
    return answer.set_unserialized(durations=seconds)
