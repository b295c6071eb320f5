"""The linear relaxation of hitting every landmark, in floats: where exact weights start from."""

import math
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Final, NamedTuple

from foon_asp.bounds.highs_run import libraries, run, silent_highs
from foon_asp.errors import BugError

_OPTIONS: Final[dict[str, bool | str | float]] = {
    "presolve": "off",
    "solver": "simplex",
    "threads": 1,
    "time_limit": math.inf,
    "primal_feasibility_tolerance": 1e-10,
    "dual_feasibility_tolerance": 1e-10,
}
_INSIDE: Final[dict[str, bool | str | float]] = {
    "solver": "ipm",
    "presolve": "on",
    "run_crossover": "off",
    "primal_feasibility_tolerance": 1e-7,
    "dual_feasibility_tolerance": 1e-7,
}
_CORNER: Final[dict[str, bool | str | float]] = _INSIDE | _OPTIONS | {"solver": "ipm", "run_crossover": "on"}
_SOON = 2.0  # seconds: steps of the interior point method cannot be continued


class UnsolvedError(BugError):
    """HiGHS ends a covering problem with something else than a solution."""


class Relaxed(NamedTuple):
    """A basic optimum: its value, the share ``x`` of every column, and its basis.

    ``columns`` are the basic columns and ``rows`` the rows that hold with equality by the basis: both have
    the same number, and the square matrix between them gives the solution and the weights of the rows.
    """

    value: float
    x: list[float]
    columns: list[int]
    rows: list[int]


class Weighed(NamedTuple):
    """An optimum, perhaps amid others: its value, the share ``x`` of each column, the weight of each row."""

    value: float
    x: list[float]
    weights: list[float]


class Covering:
    """Minimize the sum of ``costs[c] * x[c]``, ``x >= 0``, with ``x`` adding up to 1 or more in every row.

    A limit is a row of its own: the sum of ``amounts[c] * x[c]`` is not above it. Solved by HiGHS; rows are
    added between solutions, each of which starts from the one before.
    """

    def __init__(self, costs: Sequence[float]) -> None:
        highspy, np = libraries()
        self._library, self._array = highspy, np.array
        self._highs = silent_highs()
        self._set(_OPTIONS)
        self._cornered = True  # the last solution, if any
        count = len(costs)
        self._highs.addVars(count, np.zeros(count), np.full(count, highspy.kHighsInf))
        self._highs.changeColsCost(count, np.arange(count, dtype=np.int32), np.array(costs, dtype=float))

    def add(self, row: Sequence[int]) -> None:
        """Add a row: the columns of which at least one, or shares of several, have to be taken."""
        np_row = self._array(row, dtype="int32")
        ones = self._array([1.0] * len(row))
        self._highs.addRow(1.0, self._library.kHighsInf, len(row), np_row, ones)

    def limit(self, amounts: Mapping[int, Fraction], most: Fraction) -> None:
        """Add a row of a limit; what a column takes of it may be less than nothing."""
        columns = self._array(list(amounts), dtype="int32")
        takes = self._array([-float(amount) for amount in amounts.values()])
        self._highs.addRow(-float(most), self._library.kHighsInf, len(amounts), columns, takes)

    def bound(self, column: int, least: float, most: float) -> None:
        """Let a column take no less and no more than so much."""
        self._highs.changeColBounds(column, least, most)

    def demand(self, row: int, least: float) -> None:
        """Let a row ask for so much; 0 is nothing."""
        self._highs.changeRowBounds(row, least, self._library.kHighsInf)

    def _set(self, options: dict[str, bool | str | float]) -> None:
        for option, value in options.items():
            self._highs.setOptionValue(option, value)

    def inside(self, expired: Callable[[], bool] = lambda: False) -> Weighed | None:
        """Find an optimum amid all others: of many rows sooner than a corner, and less exact.

        ``None`` where nothing near enough to an optimum is found soon, or by the time that is up.
        """
        self._cornered = False
        self._run(_INSIDE, expired)
        if self._highs.getModelStatus() != self._library.HighsModelStatus.kOptimal:
            return None
        solution = self._highs.getSolution()
        value = float(self._highs.getObjectiveValue())
        return Weighed(value, list(solution.col_value), list(solution.row_dual))

    def _run(self, options: dict[str, bool | str | float], expired: Callable[[], bool]) -> None:
        self._set(options | {"time_limit": self._highs.getRunTime() + _SOON})
        run(self._highs, expired)

    def solve(self, expired: Callable[[], bool] = lambda: False) -> Relaxed:
        """Find a basic optimum of the rows so far; or, where time is up by then, what there is by then.

        ``expired`` is asked now and then.
        """
        highs = self._highs
        if not self._cornered:  # steps of the simplex algorithm would start from nothing
            self._cornered = True
            self._run(_CORNER, expired)
            self._set(_OPTIONS)
        ended = run(highs, expired)
        status = self._library.HighsModelStatus
        if ended and highs.getModelStatus() not in {status.kOptimal, status.kModelEmpty}:
            raise UnsolvedError(f"HiGHS ends a covering problem with {highs.getModelStatus()}")
        basis, solution = highs.getBasis(), highs.getSolution()
        basic = self._library.HighsBasisStatus.kBasic
        return Relaxed(
            float(highs.getObjectiveValue()),
            list(solution.col_value),
            [c for c, status in enumerate(basis.col_status) if status == basic],
            [r for r, status in enumerate(basis.row_status) if status != basic],
        )

    def weights(self) -> list[float]:
        """Return the weight of each row in the optimum found last."""
        return list(self._highs.getSolution().row_dual)
