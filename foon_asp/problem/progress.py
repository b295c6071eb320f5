"""How far a question is, for whoever wants to hear of it."""

from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

from foon_asp.problem.costs import Costs
from foon_asp.problem.objective import Objective


class Progress(NamedTuple):
    """How far a question is: the ``costs`` of the best tree so far, and the proved ``bounds`` by objective.

    Where several answers are asked for, ``done`` of ``total`` are found; while networks are read, these are
    bytes, and while one is built, units. ``total`` is 0 where there is nothing to count.

    Example:
        >>> heard = []
        >>> answer = foon_asp.solve(foon_asp.load().problem("ice"), on_progress=heard.append)
        >>> heard[-1].costs.units
        2
    """

    costs: Costs | None = None
    bounds: dict[Objective, int | Fraction] = {}  # noqa: RUF012 (never changed)
    done: int = 0
    total: int = 0


OnProgress = Callable[[Progress], object]
