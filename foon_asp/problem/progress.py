"""Reports on the progress of a question, which callers can receive."""

from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

from foon_asp.problem.costs import Costs
from foon_asp.problem.objective import Objective


class Progress(NamedTuple):
    """The progress of a question.

    ``costs``: the costs of the incumbent; ``None`` before the first tree.
    ``bounds``: the proved bound by each objective that has one.
    ``done``, ``total``: how much is done, out of how much. For a question with several answers, they count
    answers. While a network is read, they count bytes; while it is built, units. ``total`` is 0 if nothing is
    counted.

    Example:
        >>> reports = []
        >>> answer = foon_asp.solve(foon_asp.load().problem("ice"), on_progress=reports.append)
        >>> reports[-1].costs.units
        2
    """

    costs: Costs | None = None
    bounds: dict[Objective, int | Fraction] = {}  # noqa: RUF012 (never changed)
    done: int = 0
    total: int = 0


OnProgress = Callable[[Progress], object]
