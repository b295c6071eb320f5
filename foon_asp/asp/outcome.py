"""The result of a search."""

from enum import StrEnum
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from foon_asp.problem import Costs, Objective, Problem

if TYPE_CHECKING:  # few questions need it
    from foon_asp.hypergraph.proof_tree import Cases


class Status(StrEnum):
    """The status of an answer: whether there is a tree, and what is proved.

    ``OPTIMAL``: it is proved that no tree is better.
    ``FEASIBLE``: a tree was found, and a limit was reached before a proof.
    ``INFEASIBLE``: it is proved that there is no tree.
    ``UNKNOWN``: a limit was reached before a tree was found.

    Example:
        >>> foon_asp.solve(foon_asp.load().problem("apple pie")).status
        <Status.INFEASIBLE: 'infeasible'>
    """

    OPTIMAL = "optimal"
    FEASIBLE = "feasible"
    INFEASIBLE = "infeasible"
    UNKNOWN = "unknown"


class Proof(StrEnum):
    """The kind of proof that a claim has.

    ``solver``: an exhausted search.
    ``cuts``: landmark cuts that leave nothing to search, at once or case by case; see docs/dev/reductions.md.
    ``counts``: where items are used up, no integer numbers of executions cost less; see docs/plans.md.
    ``certificate``: a verified certificate that takes no claim on trust.
    """

    SOLVER = "solver"
    CUTS = "cuts"
    COUNTS = "counts"
    CERTIFICATE = "certificate"


class Outcome(NamedTuple):
    """The answer to one ``problem`` under a list of ``objectives``, the most important first.

    ``status``: what is proved.
    ``units``, ``costs``: the tree, as unit ids in an order that executes, and its costs; ``None`` without a
    tree.
    ``bounds``: for each objective in order, the best value that any tree can still have, as far as it is
    proved. From the second objective on, only trees that are best by the earlier objectives count.
    ``seconds``: the time of each phase.
    ``encodings``: the folder that replaced the built-in encodings, ``None`` without one. Its encodings then
    define which tree is best.
    ``proof``: what proves an ``optimal`` or ``infeasible`` answer; ``None`` for other answers.
    ``certified``: the objectives, from the first on, by which a certificate proves the tree the best.
    ``left``: the number of units that were left for the search; 0 if no search was needed.
    ``cuts``: sets of object nodes, by id, whose landmarks the reductions used for bounds; see
    :mod:`foon_asp.hypergraph`. Empty for goals that were solved by shared landmarks.
    ``stopped``: the limit that stopped an unproved answer, and what was being done; ``None`` without one.
    ``cases``: the case split of a proof by cuts: a unit, then the cases without it and with it; ``None`` if
    the proof has no cases.

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
