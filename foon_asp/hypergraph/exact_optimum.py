"""The simplex algorithm in rational numbers, from a basis that floats suggest to an exact optimum."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.hypergraph import tuning
from foon_asp.hypergraph.lexicographic import Lexicographic, Vector, multiply

_ZERO, _ONE = Fraction(), Fraction(1)

Matrix = Mapping[int, Mapping[int, Fraction]]
Limit = tuple[Mapping[int, Fraction], Fraction]


class ExactOptimum(NamedTuple):
    """The optimum of a covering problem. Values and duals of 0 are left out.

    ``x``: the value of each column that is not 0.
    ``duals``: the dual of each row that is not 0.
    ``value``: the cost of the solution. By duality, it equals the sum of the duals of covering rows, minus
    for each limit its dual times its amount.
    """

    x: dict[int, Fraction]
    duals: dict[int, Vector]
    value: Vector


class UnusableBasisError(Exception):
    """A basis is singular, or its solution is infeasible."""


def exact_optimum(
    rows: Sequence[Sequence[int]],
    costs: Sequence[Vector],
    order: Lexicographic,
    columns: Sequence[int],
    tight: Sequence[int],
    limits: Sequence[Limit] = (),
) -> ExactOptimum | None:
    """Solve a covering problem over ordered costs exactly, from a basis near the optimum.

    ``rows``: for each covering row, its columns.
    ``costs``: the cost of each column, none below 0.
    ``order``: the order of the costs.
    ``columns``, ``tight``: the first basis, as numbers of columns and of equally many tight rows.
    ``limits``: for each limit, a pair: the amounts that columns consume, by column, and the amount available.
    As rows, limits are numbered before ``rows``.

    Each step solves the basis anew, and Bland's rule prevents cycling. Returns ``None`` after
    ``tuning.PROOF.pivots`` steps, or if a basis is singular or infeasible.
    """
    basic_columns, tight_rows = set(columns), set(tight)
    all_rows = [{column: -amount for column, amount in amounts.items()} for amounts, _ in limits]
    all_rows += (dict.fromkeys(row, _ONE) for row in rows)
    row_minimums = [-max_amount for _, max_amount in limits] + [_ONE] * len(rows)
    try:
        for _ in range(tuning.PROOF.pivots):
            basis = _Basis(all_rows, row_minimums, costs, basic_columns, tight_rows)
            entering_variable = basis.entering_variable(order)
            if entering_variable is None:
                kept = {row: weight for row, weight in basis.duals.items() if order.sign(weight)}
                lp_values = {column: lp_value for column, lp_value in basis.x.items() if lp_value}
                value = order.total(multiply(weight, row_minimums[row]) for row, weight in kept.items())
                return ExactOptimum(lp_values, kept, value)
            for number, is_row in (entering_variable, basis.leaving_variable(*entering_variable)):
                (tight_rows if is_row else basic_columns).symmetric_difference_update({number})
    except UnusableBasisError:
        pass
    return None


class _Basis:
    """A basis: some columns and equally many tight rows, with its primal and dual solution.

    ``x``: the values of the basic columns. With them, tight rows hold with equality.
    ``slack``: the slack of each row.
    ``duals``: the duals of the tight rows. With them, basic columns have reduced cost 0.

    Raises :class:`UnusableBasisError` if the basis is singular, or a value or slack is negative.
    """

    def __init__(
        self,
        rows: Sequence[Mapping[int, Fraction]],
        row_minimums: Sequence[Fraction],
        costs: Sequence[Vector],
        columns: set[int],
        tight: set[int],
    ) -> None:
        self._rows, self._costs = rows, costs
        self._matrix = {r: {c: value for c, value in rows[r].items() if c in columns} for r in sorted(tight)}
        transposed: dict[int, dict[int, Fraction]] = {column: {} for column in sorted(columns)}
        for row, entries in self._matrix.items():
            for column, value in entries.items():
                transposed[column][row] = value
        self.x = {
            c: lp_value
            for c, (lp_value,) in solve_exactly(self._matrix, {r: (row_minimums[r],) for r in tight}).items()
        }
        self.duals = solve_exactly(transposed, {column: costs[column] for column in columns})
        self.slack = [
            sum((value * self.x[c] for c, value in row.items() if c in self.x), -row_minimums[r])
            for r, row in enumerate(rows)
        ]
        if any(value < 0 for value in (*self.x.values(), *self.slack)):
            raise UnusableBasisError

    def entering_variable(self, order: Lexicographic) -> tuple[int, bool] | None:
        """Return the number of the entering column or row by Bland's rule, and whether it is a row.

        The first column of negative reduced cost enters. If no reduced cost is negative, the slack of the
        first row of negative dual enters. Return ``None`` if no dual is negative either: the basis is
        optimal.
        """
        loads: dict[int, list[Vector]] = {}
        for row, weight in self.duals.items():
            for column, value in self._rows[row].items():
                if column not in self.x:  # basic columns have reduced cost 0
                    loads.setdefault(column, []).append(multiply(weight, value))
        for column in sorted(loads):
            if order.compare(order.total(loads[column]), self._costs[column]) > 0:
                return column, False
        return next(((row, True) for row in sorted(self.duals) if order.sign(self.duals[row]) < 0), None)

    def leaving_variable(self, number: int, is_row: bool) -> tuple[int, bool]:
        """Return the number of the column or row that leaves by the ratio test, and whether it is a row.

        The entering variable is column ``number`` or, if ``is_row`` is true, the slack of row ``number``.
        """
        entering_coefficients = [
            Fraction(-(row == number)) if is_row else coefficients.get(number, _ZERO)
            for row, coefficients in enumerate(self._rows)
        ]
        right_sides = {row: (entering_coefficients[row],) for row in self._matrix}
        decreases = {column: value for column, (value,) in solve_exactly(self._matrix, right_sides).items()}
        ratios = [(self.x[c] / f, False, c) for c, f in decreases.items() if f > 0]
        for row, slack in enumerate(self.slack):
            decrease = sum(
                (value * decreases[c] for c, value in self._rows[row].items() if c in decreases), _ZERO
            )
            decrease -= entering_coefficients[row]
            if decrease > 0:  # never in a tight row
                ratios.append((slack / decrease, True, row))
        _, leaves_row, leaving = min(ratios)  # there is one, as no cost is below 0
        return leaving, leaves_row


def solve_exactly(matrix: Matrix, right_sides: Mapping[int, Vector]) -> dict[int, Vector]:
    """Solve a sparse square system for several right-hand sides at once, by Gaussian elimination.

    ``matrix[i]`` maps the unknowns of row i to coefficients. ``right_sides[i]`` has the right-hand sides of
    row i. Returns the values of each unknown, one for each right-hand side. The shortest row is eliminated
    first, which keeps systems of cuts sparse. Raises :class:`UnusableBasisError` if the system is singular.
    """
    rows = {number: dict(row) for number, row in matrix.items()}
    sides = dict(right_sides)
    waiting = set(rows)
    pivots: list[tuple[int, int, Fraction]] = []
    while waiting:
        number = min(waiting, key=lambda n: (len(rows[n]), n))
        row = rows[number]
        if not row:
            raise UnusableBasisError
        unknown, pivot = row.popitem()
        pivots.append((number, unknown, pivot))
        waiting.remove(number)
        for other_number in waiting:
            other_row = rows[other_number]
            if unknown in other_row:
                factor = other_row.pop(unknown) / pivot
                for u, value in row.items():
                    other_row[u] = other_row.get(u, _ZERO) - factor * value
                    if not other_row[u]:
                        del other_row[u]
                sides[other_number] = _subtract_multiple(sides[other_number], factor, sides[number])
    solution: dict[int, Vector] = {}
    for number, unknown, pivot in reversed(pivots):
        right_side = sides[number]
        for u, value in rows[number].items():
            right_side = _subtract_multiple(right_side, value, solution[u])
        solution[unknown] = tuple(numerator / pivot for numerator in right_side)
    return solution


def _subtract_multiple(vector: Vector, factor: Fraction, other: Vector) -> Vector:
    """Return ``vector - factor * other``."""
    return tuple(a - factor * b for a, b in zip(vector, other, strict=True))
