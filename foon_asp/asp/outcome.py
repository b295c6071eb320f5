"""What a search ended with."""

from enum import StrEnum
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from foon_asp.problem import Costs, Objective, Problem


class Status(StrEnum):
    """How far the claim goes.

    ``optimal``: the search was exhausted, no tree is better. ``feasible``: a limit was reached with a tree
    in hand. ``infeasible``: proved that no tree exists. ``unknown``: a limit was reached without a tree.
    """

    OPTIMAL = "optimal"
    FEASIBLE = "feasible"
    INFEASIBLE = "infeasible"
    UNKNOWN = "unknown"


class Proof(StrEnum):
    """What a claim rests on.

    ``solver``: an exhausted search. ``cuts``: landmark cuts that leave nothing to search; see
    docs/reductions.md. ``certificate``: a certificate that was verified without either.
    """

    SOLVER = "solver"
    CUTS = "cuts"
    CERTIFICATE = "certificate"


class Outcome(NamedTuple):
    """The answer to one problem under a lexicographic list of objectives.

    ``units`` is the tree, by unit id in an executable order, and ``costs`` what it costs; both ``None``
    where there is no tree. ``bounds`` gives for each objective the best value that any tree can still have
    (for ``success`` the greatest), as far as it is proved, in the order of the list; an objective counts
    only among the trees that are best under those before it. ``seconds`` has the time of every phase.
    ``proof`` is what an ``optimal`` or ``infeasible`` answer rests on, ``None`` for the others.
    ``encodings`` is the folder whose encodings replaced ours, if one did: what is best is then what they say.
    ``certified`` are the objectives, from the first on, for which a certificate proves the tree best.
    ``left`` counts the units that the search had to choose from, 0 where nothing was left to search.
    ``cuts`` are the sets of object nodes whose landmarks the reductions bounded costs with; see
    :mod:`foon_asp.bounds`. ``stopped`` says at which limit an answer that is not proved was stopped, and
    while doing what, in words.
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
