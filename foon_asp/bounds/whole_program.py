"""A linear program over whole numbers: solved in floats by HiGHS, bounded in whole numbers."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from foon_asp.bounds.highs_run import libraries, run, silent_highs

# What weights of rows are rounded to: parts of the first that suffices, since most weights are simple.
_PARTS = (720720, 2**40)
_GAP = 1e-6  # by which rows may fail, relatively, where floats find neither a solution nor a proof


class Stopped(Exception):  # noqa: N818 (no error: there is no time left)
    """Time is up, or floats led nowhere."""


class Solved(NamedTuple):
    """A relaxed solution ``x``, ``None`` if there is none, and a proved lower ``bound``.

    A solution with a bound of -infinity may fail rows by a little. The bound is infinite where it is proved
    that there is no solution, and -infinite where nothing is.
    """

    x: list[float] | None
    bound: float | Fraction


class Relaxation(NamedTuple):
    """A relaxed solution ``x`` in floats, ``None`` if there is none, and the ``weights`` of the rows.

    Those are of the optimum or, without a solution, of a combination of rows that has none. ``columns`` and
    ``rows`` are those of the basis: between them is the square system that the weights solve.
    """

    x: list[float] | None
    weights: list[float]
    columns: list[int]
    rows: list[int]


class WholeProgram:
    """Columns between ``lower`` and ``upper`` (``None`` is no bound), and rows of whole numbers.

    Each row says that its columns, times their parts, add up to at least a number. ``expired`` is asked now
    and then: when time is up, solving a relaxation raises :class:`Stopped`.
    """

    def __init__(self, columns: int, expired: Callable[[], bool] = lambda: False) -> None:
        self._library, self._np = libraries()
        self._highs: Any = None
        self._expired = expired
        self.lower: list[int] = [0] * columns
        self.upper: list[int | None] = [None] * columns
        self._rows: list[tuple[dict[int, int], int]] = []
        self._sent: int  # rows that HiGHS has
        self._changed: set[int] = set()

    @property
    def columns(self) -> int:
        """How many columns there are."""
        return len(self.lower)

    @property
    def is_empty(self) -> bool:
        """Whether some column has nothing between its bounds."""
        return any(most is not None and self.lower[c] > most for c, most in enumerate(self.upper))

    def column(self, lower: int, upper: int | None) -> int:
        """Add a column, and give its number."""
        self.lower.append(lower)
        self.upper.append(upper)
        self._highs = None
        return len(self.lower) - 1

    def row(self, parts: dict[int, int], least: int) -> int:
        """Add a row, and give its number."""
        self._rows.append((parts, least))
        return len(self._rows) - 1

    def open_row(self, columns: Iterable[int], least: int) -> int:
        """Add a row of some columns whose parts are told later, and give its number."""
        return self.row(dict.fromkeys(columns, 0), least)

    def change(self, row: int, parts: dict[int, int]) -> None:
        """Change the parts of the columns that a row has; without parts, all become 0."""
        now = self._rows[row][0]
        new = {column: parts.get(column, 0) for column in now}
        if new != now:
            self._rows[row] = new, self._rows[row][1]
            self._changed.add(row)

    def cap(self, column: int, most: int) -> None:
        """Bound a column from above, if it is not bounded more tightly."""
        known = self.upper[column]
        self.upper[column] = most if known is None else min(known, most)

    def with_bounds(
        self, column: int, lower: int | None, upper: int | None
    ) -> tuple[list[int], list[int | None]]:
        """Return the bounds of all columns with one changed."""
        lowers, uppers = list(self.lower), list(self.upper)
        if lower is not None:
            lowers[column] = lower
        if upper is not None:
            uppers[column] = upper
        return lowers, uppers

    def solve(self, objective: Mapping[int, int], cutoff: float = math.inf) -> Solved:
        """Solve the relaxation; a bound above ``cutoff`` is enough."""
        if self.is_empty:
            return Solved(None, math.inf)
        highs = self._run(objective)
        if highs.getModelStatus() == self._library.HighsModelStatus.kOptimal:
            solution = highs.getSolution()
            # of very large costs it may have none
            weights = list(solution.row_dual) if solution.dual_valid else [0.0] * len(self._rows)
            return Solved(list(solution.col_value), self._bound(objective, weights, cutoff))
        ray = [abs(weight) for weight in highs.getDualRay()[2]]
        largest = max(ray, default=0.0)
        if largest and self._bound({}, [weight / largest for weight in ray], 0) > 0:
            return Solved(None, math.inf)
        return Solved(self._nearly(), -math.inf)

    def _nearly(self) -> list[float] | None:
        """Return a solution of the rows but for a little, where floats find none and prove nothing.

        Rows with large parts may leave so narrow a gap that it is lost in floats.
        """
        highs, count = self._highs, len(self._rows)
        every, most = self._np.arange(count, dtype="int32"), self._np.full(count, self._library.kHighsInf)
        least = self._np.array([float(least) for _, least in self._rows])
        highs.changeRowsBounds(count, every, least - _GAP * self._np.maximum(1.0, abs(least)), most)
        self._run_to_the_end(highs)
        found = highs.getModelStatus() == self._library.HighsModelStatus.kOptimal
        x = list(highs.getSolution().col_value) if found else None
        self._highs = None
        return x

    def relaxation(self, objective: Mapping[int, float]) -> Relaxation:
        """Solve the relaxation, and give the weights of its rows, of which nothing is proved."""
        highs = self._run(objective)
        if highs.getModelStatus() == self._library.HighsModelStatus.kOptimal:
            solution, basis = highs.getSolution(), highs.getBasis()
            basic = self._library.HighsBasisStatus.kBasic
            return Relaxation(
                list(solution.col_value),
                list(solution.row_dual),
                [column for column, status in enumerate(basis.col_status) if status == basic],
                [row for row, status in enumerate(basis.row_status) if status != basic],
            )
        return Relaxation(None, [abs(weight) for weight in highs.getDualRay()[2]], [], [])

    def said(self, row: int) -> tuple[dict[int, int], int]:
        """Return a row: its parts, and what they add up to at least."""
        return self._rows[row]

    def whole_optimum(self, objective: Mapping[int, int]) -> list[float] | None:
        """Return the best whole solution by HiGHS' word; ``None`` if it finds none, or when time is up."""
        highs = self._send(objective)
        count = self.columns
        whole = self._library.HighsVarType.kInteger
        highs.changeColsIntegrality(
            count, self._np.arange(count, dtype="int32"), self._np.array([whole] * count)
        )
        highs.setOptionValue("presolve", "on")
        ended = not self._expired() and run(highs, self._expired, whole=True)
        found = ended and highs.getModelStatus() == self._library.HighsModelStatus.kOptimal
        values = list(highs.getSolution().col_value) if found else None
        self._highs = None
        return values

    def _run(self, objective: Mapping[int, int] | Mapping[int, float]) -> Any:
        """Let HiGHS solve the relaxation; anew where it got lost on the way from the solution before."""
        highs = self._send(objective)
        self._run_to_the_end(highs)
        if highs.getModelStatus() != self._library.HighsModelStatus.kOptimal and not highs.getDualRay()[1]:
            self._highs = None
            highs = self._send(objective)
            self._run_to_the_end(highs)
        return highs

    def _run_to_the_end(self, highs: Any) -> None:
        """Let HiGHS solve a relaxation, which has to end within the time that there is."""
        if not run(highs, self._expired):
            raise Stopped

    def _send(self, objective: Mapping[int, int] | Mapping[int, float]) -> Any:
        """Tell HiGHS what has changed."""
        np, inf = self._np, self._library.kHighsInf
        count = self.columns
        if self._highs is None:
            self._highs = silent_highs()
            for option, value in _OPTIONS.items():
                self._highs.setOptionValue(option, value)
            self._highs.addVars(count, np.zeros(count), np.full(count, inf))
            self._sent = 0
        highs = self._highs
        for parts, least in self._rows[self._sent :]:
            columns = np.array(list(parts), dtype="int32")
            highs.addRow(float(least), inf, len(parts), columns, np.array(list(parts.values()), dtype=float))
        for row in self._changed:
            for column, part in self._rows[row][0].items():
                highs.changeCoeff(row, column, float(part))
        self._sent = len(self._rows)
        self._changed.clear()
        every = np.arange(count, dtype="int32")
        upper = [inf if most is None else most for most in self.upper]
        highs.changeColsBounds(count, every, np.array(self.lower, dtype=float), np.array(upper, dtype=float))
        costs = np.zeros(count)
        for column, cost in objective.items():
            costs[column] = cost
        highs.changeColsCost(count, every, costs)
        return highs

    def _bound(
        self, objective: Mapping[int, int], weights: Sequence[float], cutoff: float
    ) -> float | Fraction:
        """Return the bound that weights of rows prove, whatever they are, computed in whole numbers."""
        best: float | Fraction = -math.inf
        for parts in _PARTS:
            scaled = [max(0, round(weight * parts)) if abs(weight) < 1e15 else 0 for weight in weights]
            total = 0
            left = dict.fromkeys(range(self.columns), 0)
            for column, cost in objective.items():
                left[column] = cost * parts
            for (row, least), weight in zip(self._rows, scaled, strict=True):
                if weight:
                    total += weight * least
                    for column, part in row.items():
                        left[column] -= weight * part
            for column, rest in left.items():
                cheapest = self.lower[column] if rest >= 0 else self.upper[column]
                if cheapest is None:
                    break
                total += rest * cheapest
            else:
                best = max(best, Fraction(total, parts))
                if best > cutoff:
                    break
        return best


_OPTIONS: dict[str, bool | str | float] = {
    "presolve": "off",
    "solver": "simplex",
    "threads": 1,
}
