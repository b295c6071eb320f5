"""The linear relaxation of the hitting set problem over landmarks, solved in floats by HiGHS."""

import math
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Final, NamedTuple

from foon_asp.errors import BugError
from foon_asp.hypergraph import tuning
from foon_asp.hypergraph.highs_run import libraries, run, silent_highs

_OPTIONS: Final[dict[str, bool | str | float]] = {
    "presolve": "off",
    "solver": "simplex",
    "threads": 1,
    "time_limit": math.inf,
    "primal_feasibility_tolerance": 1e-10,
    "dual_feasibility_tolerance": 1e-10,
}
_INTERIOR_POINT: Final[dict[str, bool | str | float]] = {
    "solver": "ipm",
    "presolve": "on",
    "run_crossover": "off",
    "primal_feasibility_tolerance": 1e-7,
    "dual_feasibility_tolerance": 1e-7,
}
_VERTEX: Final[dict[str, bool | str | float]] = (
    _INTERIOR_POINT | _OPTIONS | {"solver": "ipm", "run_crossover": "on"}
)
TOLERANCE = 1e-6  # of the values of a basic solution
ROUGH_TOLERANCE = 1e-3  # of sums of the values of any solution


class UnsolvedError(BugError):
    """HiGHS ended a covering problem without a solution."""


class BasicSolution(NamedTuple):
    """A basic optimal solution: its cost ``value``, the values ``x`` of the columns, and its basis.

    ``columns`` are the numbers of the basic columns. ``rows`` are the numbers of equally many tight rows. The
    square matrix of ``rows`` and ``columns`` determines the solution and the duals.
    """

    value: float
    x: list[float]
    columns: list[int]
    rows: list[int]


class LpSolution(NamedTuple):
    """An optimal solution, basic or not.

    ``value``: the cost of the solution.
    ``x``: the value of each column.
    ``duals``: the dual of each row.
    """

    value: float
    x: list[float]
    duals: list[float]


class Covering:
    """A covering problem: minimize the sum of ``costs[c] * x[c]`` over all columns ``c``.

    No ``x[c]`` is below 0. There are two kinds of rows. A covering row requires that the values of some
    columns add up to at least 1. A limit requires that the sum of ``amounts[c] * x[c]`` is at most
    ``max_amount``. Rows are numbered from 0 as they are added. They can be added between solutions. HiGHS
    then continues from the last solution.
    """

    def __init__(self, costs: Sequence[float]) -> None:
        highspy, np = libraries()
        self._library, self._array = highspy, np.array
        self._highs = silent_highs()
        self._set_options(_OPTIONS)
        self._at_vertex = True  # whether the last solution, if any, is basic
        count = len(costs)
        self._highs.addVars(count, np.zeros(count), np.full(count, highspy.kHighsInf))
        self._highs.changeColsCost(count, np.arange(count, dtype=np.int32), np.array(costs, dtype=float))

    def add_row(self, row: Sequence[int]) -> None:
        """Add a covering row: the values of the columns in ``row`` add up to at least 1."""
        np_row = self._array(row, dtype="int32")
        ones = self._array([1.0] * len(row))
        self._highs.addRow(1.0, self._library.kHighsInf, len(row), np_row, ones)

    def add_limit(self, amounts: Mapping[int, Fraction], max_amount: Fraction) -> None:
        """Add a limit: the sum of amounts times values is at most ``max_amount``.

        ``amounts`` has the amount of each column; it may be negative.
        """
        columns = self._array(list(amounts), dtype="int32")
        takes = self._array([-float(amount) for amount in amounts.values()])
        self._highs.addRow(-float(max_amount), self._library.kHighsInf, len(amounts), columns, takes)

    def set_bounds(self, column: int, lower: float, upper: float) -> None:
        """Set the lower and the upper bound of the value of a column."""
        self._highs.changeColBounds(column, lower, upper)

    def set_row_minimum(self, row: int, lower: float) -> None:
        """Set the least sum of the values in a covering row, which is 1 at first.

        With 0, the row is redundant.
        """
        self._highs.changeRowBounds(row, lower, self._library.kHighsInf)

    def _set_options(self, options: dict[str, bool | str | float]) -> None:
        """Set options of HiGHS."""
        for option, value in options.items():
            self._highs.setOptionValue(option, value)

    def interior_point(self, expired: Callable[[], bool] = lambda: False) -> LpSolution | None:
        """Return an interior-point solution: less exact than a basic one, but faster with many rows.

        Return ``None`` if HiGHS does not converge within ``tuning.RELAXATION.run_seconds``, or before
        ``expired`` returns true.
        """
        self._at_vertex = False
        self._run(_INTERIOR_POINT, expired)
        if self._highs.getModelStatus() != self._library.HighsModelStatus.kOptimal:
            return None
        solution = self._highs.getSolution()
        value = float(self._highs.getObjectiveValue())
        return LpSolution(value, list(solution.col_value), list(solution.row_dual))

    def _run(self, options: dict[str, bool | str | float], expired: Callable[[], bool]) -> None:
        """Run HiGHS with these options, for at most ``tuning.RELAXATION.run_seconds``.

        Ends early when ``expired`` returns true. The options stay set.
        """
        self._set_options(options | {"time_limit": self._highs.getRunTime() + tuning.RELAXATION.run_seconds})
        run(self._highs, expired)

    def solve(self, expired: Callable[[], bool] = lambda: False) -> BasicSolution:
        """Return a basic optimal solution; if time is up, the basic solution that was reached.

        ``expired`` returns whether time is up. Raises :class:`UnsolvedError` if HiGHS ends without a solution
        although time is not up.
        """
        highs = self._highs
        if not self._at_vertex:  # steps of the simplex algorithm would start from nothing
            self._at_vertex = True
            self._run(_VERTEX, expired)
            self._set_options(_OPTIONS)
        ended = run(highs, expired)
        status = self._library.HighsModelStatus
        if ended and highs.getModelStatus() not in {status.kOptimal, status.kModelEmpty}:
            raise UnsolvedError(f"HiGHS ends a covering problem with {highs.getModelStatus()}")
        basis, solution = highs.getBasis(), highs.getSolution()
        basic = self._library.HighsBasisStatus.kBasic
        return BasicSolution(
            float(highs.getObjectiveValue()),
            list(solution.col_value),
            [c for c, status in enumerate(basis.col_status) if status == basic],
            [r for r, status in enumerate(basis.row_status) if status != basic],
        )

    def duals(self) -> list[float]:
        """Return the dual of each row in the last solution of :meth:`solve`."""
        return list(self._highs.getSolution().row_dual)
