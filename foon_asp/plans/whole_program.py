"""A linear program over whole numbers: solved in floats by HiGHS, bounded in whole numbers."""

import math
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from foon_asp.hypergraph.highs_run import libraries, run, silent_highs

PARTS = (720720, 2**40)
"""Denominators of rounded weights; the first is tried first, as most weights are simple fractions."""

INTEGRALITY = 1e-6
"""Tolerance of whole values when branching, and relative tolerance of rows that floats violate."""


Bounds = tuple[list[int], list[int | None]]
"""The lower and the upper bounds of all columns; ``None`` is no upper bound."""


class Stopped(Exception):  # noqa: N818 (no error: there is no time left)
    """Raised if a search ends without a result.

    This is so if time is up, if the search has taken too many steps, or if solutions in floats decide
    nothing.
    """


class Solved(NamedTuple):
    """The result of solving a relaxation.

    ``x``: the value of each column in floats; ``None`` if no solution is found.
    ``bound``: a proved lower bound on the cost; infinity if it is proved that there is no solution. If
    nothing is proved, the bound is -infinity, and ``x`` may violate rows a little.
    """

    x: list[float] | None
    bound: float | Fraction


class Relaxation(NamedTuple):
    """The solution of a relaxation in floats, with weights of its rows.

    ``x``: the value of each column; ``None`` without a solution.
    ``weights``: the dual of each row or, without a solution, a Farkas combination of the rows.
    ``columns``, ``rows``: the basic columns and the tight rows, whose square system the weights solve.
    """

    x: list[float] | None
    weights: list[float]
    columns: list[int]
    rows: list[int]


def most_fractional(x: Sequence[float]) -> int | None:
    """Return the column whose value is the furthest from a whole number; ``None`` if all are whole."""
    halves = [(abs(value - math.floor(value) - 0.5), column) for column, value in enumerate(x)]
    half = min((h for h in halves if h[0] < 0.5 - INTEGRALITY), default=None)
    return None if half is None else half[1]


class WholeProgram:
    """An integer program to be minimized: columns with bounds, and rows. Both are numbered from 0.

    ``lower``, ``upper``: the bounds of each column, which may be changed; ``None`` for no upper bound.
    ``expired``: a function that returns whether time is up; solving then raises :class:`Stopped`.

    A row has whole coefficients of columns. It states that the weighted sum is at least a whole number.
    """

    def __init__(self, columns: int, expired: Callable[[], bool] = lambda: False) -> None:
        """Import HiGHS, and make a program without rows, whose columns are at least 0."""
        self._library, self._np = libraries()
        self._highs: Any = None
        self._expired = expired
        self.lower: list[int] = [0] * columns
        self.upper: list[int | None] = [None] * columns
        self._rows: list[tuple[dict[int, int], int]] = []
        self._sent: int  # number of rows that HiGHS has
        self._changed: set[int] = set()

    @property
    def column_count(self) -> int:
        """The number of columns."""
        return len(self.lower)

    @property
    def is_empty(self) -> bool:
        """Whether some column has no value between its bounds."""
        return any(upper is not None and self.lower[c] > upper for c, upper in enumerate(self.upper))

    def add_column(self, lower: int, upper: int | None) -> int:
        """Add a column with bounds, and return its number."""
        self.lower.append(lower)
        self.upper.append(upper)
        self._highs = None
        return len(self.lower) - 1

    def add_row(self, coefficients: dict[int, int], least: int) -> int:
        """Add a row: coefficients by column, and the least sum; return its number."""
        self._rows.append((coefficients, least))
        return len(self._rows) - 1

    def add_open_row(self, columns: Iterable[int], least: int) -> int:
        """Add a row whose coefficients :meth:`change_row` sets later; return its number."""
        return self.add_row(dict.fromkeys(columns, 0), least)

    def change_row(self, row: int, coefficients: dict[int, int]) -> None:
        """Replace the coefficients of a row; its columns that are not in ``coefficients`` get 0.

        Columns that the row does not have are ignored.
        """
        current = self._rows[row][0]
        new = {column: coefficients.get(column, 0) for column in current}
        if new != current:
            self._rows[row] = new, self._rows[row][1]
            self._changed.add(row)

    def cap(self, column: int, upper: int) -> None:
        """Bound a column from above, unless its upper bound is lower already."""
        current = self.upper[column]
        self.upper[column] = upper if current is None else min(current, upper)

    def with_bounds(self, column: int, lower: int | None, upper: int | None) -> Bounds:
        """Return a copy of the bounds of all columns, changed for one column; ``None`` keeps a bound."""
        lowers, uppers = list(self.lower), list(self.upper)
        if lower is not None:
            lowers[column] = lower
        if upper is not None:
            uppers[column] = upper
        return lowers, uppers

    def set_bounds(self, bounds: Bounds) -> None:
        """Set the bounds of columns; columns added after ``bounds`` were made keep theirs."""
        lower, upper = bounds
        self.lower[: len(lower)], self.upper[: len(upper)] = lower, upper

    def split_bounds(self, column: int, value: float) -> tuple[Bounds, Bounds]:
        """Return the bounds of two child nodes, for a column with a fractional value.

        In the first node, the column is at most the value rounded down. In the second, it is at least the
        value rounded up.
        """
        below = math.floor(value)
        return self.with_bounds(column, None, below), self.with_bounds(column, below + 1, None)

    def solve(self, objective: Mapping[int, int], cutoff: float = math.inf) -> Solved:
        """Return the solution of the relaxation and a proved bound.

        A bound that is above ``cutoff`` is not improved further. Raises :class:`Stopped` if time is up.
        """
        if self.is_empty:
            return Solved(None, math.inf)
        highs = self._run(objective)
        if highs.getModelStatus() == self._library.HighsModelStatus.kOptimal:
            solution = highs.getSolution()
            # very large costs may leave no dual solution
            weights = list(solution.row_dual) if solution.dual_valid else [0.0] * len(self._rows)
            return Solved(list(solution.col_value), self._bound(objective, weights, cutoff))
        ray = [abs(weight) for weight in highs.getDualRay()[2]]
        largest = max(ray, default=0.0)
        if largest and self._bound({}, [weight / largest for weight in ray], 0) > 0:
            return Solved(None, math.inf)
        return Solved(self._nearly_feasible(), -math.inf)

    def inverse_rows(self, x: Sequence[float]) -> Iterator[dict[int, float]]:
        """Yield rows of the inverse basis, for basic columns with a fractional value in ``x``.

        ``x`` is the solution that was returned last. A row of the inverse basis is a dictionary of weights in
        floats, by row of the program, without 0. The most fractional column comes first. If HiGHS has no
        basis, nothing is yielded.
        """
        halves = {column: abs(value - math.floor(value) - 0.5) for column, value in enumerate(x)}
        fractional = {column: half for column, half in halves.items() if half < 0.5 - INTEGRALITY}
        # HiGHS crashes if it is asked for basic variables and has no basis
        if self._highs is None or not fractional:
            return
        basic = [(index, int(column)) for index, column in enumerate(self._highs.getBasicVariables()[1])]
        basic = [(index, column) for index, column in basic if column in fractional]
        for index, _ in sorted(basic, key=lambda entry: fractional[entry[1]]):
            weights = self._highs.getBasisInverseRow(index)[1]
            yield {row: float(weights[row]) for row in self._np.flatnonzero(weights).tolist()}

    def _nearly_feasible(self) -> list[float] | None:
        """Return a solution that may violate rows a little; ``None`` if HiGHS finds no solution.

        This helps if rows with large coefficients leave a feasible region so small that floats miss it. The
        HiGHS instance is given up.
        """
        highs, count = self._highs, len(self._rows)
        rows, infinite = self._np.arange(count, dtype="int32"), self._np.full(count, self._library.kHighsInf)
        least = self._np.array([float(least) for _, least in self._rows])
        highs.changeRowsBounds(count, rows, least - INTEGRALITY * self._np.maximum(1.0, abs(least)), infinite)
        self._run_to_the_end(highs)
        is_optimal = highs.getModelStatus() == self._library.HighsModelStatus.kOptimal
        x = list(highs.getSolution().col_value) if is_optimal else None
        self._highs = None
        return x

    def relaxation(self, objective: Mapping[int, float]) -> Relaxation:
        """Return the solution of the relaxation in floats, the duals of its rows, and its basis.

        Raises :class:`Stopped` if time is up.
        """
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

    def row_of(self, row: int) -> tuple[dict[int, int], int]:
        """Return a row: its coefficients by column, and the least sum."""
        return self._rows[row]

    def without_rows(self, rows: Container[int]) -> "WholeProgram":
        """Return a program with equal columns and without ``rows``; its rows are numbered anew."""
        program = WholeProgram(0, self._expired)
        program.lower, program.upper = list(self.lower), list(self.upper)
        program._rows = [row for number, row in enumerate(self._rows) if number not in rows]
        return program

    def whole_optimum(
        self, objective: Mapping[int, int], sufficient_cost: float = -math.inf
    ) -> list[float] | None:
        """Return the optimal whole solution in floats.

        Return ``None`` if HiGHS finds no solution, or if time is up. The search ends at the first solution
        that costs at most ``sufficient_cost``.
        """
        highs = self._update_highs(objective)
        count = self.column_count
        integer_type = self._library.HighsVarType.kInteger
        highs.changeColsIntegrality(
            count, self._np.arange(count, dtype="int32"), self._np.array([integer_type] * count)
        )
        highs.setOptionValue("presolve", "on")
        highs.setOptionValue("mip_rel_gap", 0.0)
        highs.setOptionValue("objective_target", sufficient_cost)
        is_solved = not self._expired() and run(highs, self._expired, has_integers=True)
        status = self._library.HighsModelStatus
        is_optimal = is_solved and highs.getModelStatus() in {status.kOptimal, status.kObjectiveTarget}
        x = list(highs.getSolution().col_value) if is_optimal else None
        self._highs = None
        return x

    def _run(self, objective: Mapping[int, int] | Mapping[int, float]) -> Any:
        """Solve the relaxation with HiGHS; return the HiGHS instance.

        If a warm start gives neither an optimum nor a proof that no solution exists, solve it again from
        scratch. Raises :class:`Stopped` if time is up.
        """
        highs = self._update_highs(objective)
        self._run_to_the_end(highs)
        if highs.getModelStatus() != self._library.HighsModelStatus.kOptimal and not highs.getDualRay()[1]:
            self._highs = None
            highs = self._update_highs(objective)
            self._run_to_the_end(highs)
        return highs

    def _run_to_the_end(self, highs: Any) -> None:
        """Solve the relaxation that HiGHS has; raises :class:`Stopped` if time is up."""
        if not run(highs, self._expired):
            raise Stopped

    def _update_highs(self, objective: Mapping[int, int] | Mapping[int, float]) -> Any:
        """Bring the HiGHS instance up to date with columns, rows, bounds and costs; return it."""
        np, inf = self._np, self._library.kHighsInf
        count = self.column_count
        if self._highs is None:
            self._highs = silent_highs()
            for option, value in _OPTIONS.items():
                self._highs.setOptionValue(option, value)
            self._highs.addVars(count, np.zeros(count), np.full(count, inf))
            self._sent = 0
        highs = self._highs
        for coefficients, least in self._rows[self._sent :]:
            columns = np.array(list(coefficients), dtype="int32")
            factors = np.array(list(coefficients.values()), dtype=float)
            highs.addRow(float(least), inf, len(coefficients), columns, factors)
        for row in self._changed:
            for column, coefficient in self._rows[row][0].items():
                highs.changeCoeff(row, column, float(coefficient))
        self._sent = len(self._rows)
        self._changed.clear()
        all_columns = np.arange(count, dtype="int32")
        upper = [inf if bound is None else bound for bound in self.upper]
        highs.changeColsBounds(
            count, all_columns, np.array(self.lower, dtype=float), np.array(upper, dtype=float)
        )
        costs = np.zeros(count)
        for column, cost in objective.items():
            costs[column] = cost
        highs.changeColsCost(count, all_columns, costs)
        return highs

    def _bound(
        self, objective: Mapping[int, int], weights: Sequence[float], cutoff: float
    ) -> float | Fraction:
        """Return the bound on the cost that weights of rows prove (Lagrangian relaxation).

        If they prove no bound, return -infinity. The bound is computed in whole numbers, so it is valid for
        any weights; weights below 0 count as 0. They are rounded coarsely first, and finely if no bound above
        ``cutoff`` follows.
        """
        best: float | Fraction = -math.inf
        for denominator in PARTS:
            scaled = [max(0, round(weight * denominator)) if abs(weight) < 1e15 else 0 for weight in weights]
            total = 0
            reduced_costs = dict.fromkeys(range(self.column_count), 0)
            for column, cost in objective.items():
                reduced_costs[column] = cost * denominator
            for (row, least), weight in zip(self._rows, scaled, strict=True):
                if weight:
                    total += weight * least
                    for column, coefficient in row.items():
                        reduced_costs[column] -= weight * coefficient
            for column, reduced_cost in reduced_costs.items():
                cheapest = self.lower[column] if reduced_cost >= 0 else self.upper[column]
                if cheapest is None:
                    break
                total += reduced_cost * cheapest
            else:
                best = max(best, Fraction(total, denominator))
                if best > cutoff:
                    break
        return best


_OPTIONS: dict[str, bool | str | float] = {
    "presolve": "off",
    "solver": "simplex",
    "threads": 1,
}
