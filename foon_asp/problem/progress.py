"""Progress of a question, which callers can receive."""

from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

from foon_asp.problem.costs import Costs
from foon_asp.problem.objective import Objective


class Progress(NamedTuple):
    """The progress of a question: the ``costs`` of the incumbent, and the proved ``bounds`` by objective.

    Of questions with several answers, ``done`` of ``total`` answers are finished; while networks are read,
    they are bytes, and while one is built, units. ``total`` is 0 where nothing is counted. ``costs`` are
    ``None`` before the first tree.

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
