"""The result of a search."""

from enum import StrEnum
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from foon_asp.problem import Costs, Objective, Problem

if TYPE_CHECKING:  # few questions need it
    from foon_asp.hypergraph.proof_tree import Cases


class Status(StrEnum):
    """What is proved about an answer.

    ``OPTIMAL``: no tree is better, proved. ``FEASIBLE``: a limit was reached with a tree found.
    ``INFEASIBLE``: no tree exists, proved. ``UNKNOWN``: a limit was reached without a tree.

    Example:
        >>> foon_asp.solve(foon_asp.load().problem("apple pie")).status
        <Status.INFEASIBLE: 'infeasible'>
    """

    OPTIMAL = "optimal"
    FEASIBLE = "feasible"
    INFEASIBLE = "infeasible"
    UNKNOWN = "unknown"


class Proof(StrEnum):
    """What proves a claim.

    ``solver``: an exhausted search. ``cuts``: landmark cuts that leave nothing to search, at once or case by
    case; see docs/dev/reductions.md. ``counts``: where items are used up, no whole counts of executions cost
    less; see docs/plans.md. ``certificate``: a certificate that was verified without either.
    """

    SOLVER = "solver"
    CUTS = "cuts"
    COUNTS = "counts"
    CERTIFICATE = "certificate"


class Outcome(NamedTuple):
    """The answer to one ``problem`` under a list of ``objectives``, the most important first.

    ``status`` tells what is proved. ``units`` is the tree, by unit id in an order that executes, and
    ``costs`` what it costs; both are ``None`` if there is no tree. ``bounds`` gives for each objective in
    order the best value that any tree can still have (for ``success`` the greatest), as far as it is proved;
    an objective counts only among the trees that are best by those before it. ``seconds`` has the time of
    each phase. ``proof`` is what an ``optimal`` or ``infeasible`` answer is based on, otherwise ``None``.
    ``encodings`` is the folder that replaced the built-in encodings, if any: they then define what is best.
    ``certified`` are the objectives, from the first on, by which a certificate proves the tree the best.
    ``left`` counts the units that were left for the search, 0 if it was not needed. ``cuts`` are the sets of
    object nodes whose landmarks the reductions used for bounds; see :mod:`foon_asp.hypergraph`; goals that
    share landmarks leave them out. ``stopped`` names the limit that stopped an unproved answer, and what was
    being done. ``cases`` is the case split of a proof by cuts, if it has one: a unit, then the cases without
    the unit and the cases with it.

    Example:
        >>> answer = foon_asp.solve(foon_asp.load().problem("ice"))
        >>> isinstance(answer.outcome, foon_asp.Outcome), answer.proof
        (True, <Proof.CUTS: 'cuts'>)
    """

    problem: Problem
    objectives: tuple[Objective, ...]
    status: Status
    units: tuple[int, ...] | None
    costs: Costs | None
    bounds: dict[Objective, int | Fraction]
    seconds: dict[str, float]
    encodings: Path | None = None
    proof: Proof | None = None
    certified: tuple[Objective, ...] = ()
    left: int = 0
    cuts: tuple[tuple[int, ...], ...] = ()
    stopped: str | None = None
    cases: "Cases" = None
