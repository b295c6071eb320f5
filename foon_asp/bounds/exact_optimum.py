"""From a basis that floats suggest to weights that are exact: simplex steps in rational numbers."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.bounds.lexicographic import Lexicographic, Vector, times

_STEPS = 400  # from a float optimum it takes few; a walk of this length leads nowhere
_ZERO, _ONE = Fraction(), Fraction(1)

Matrix = Mapping[int, Mapping[int, Fraction]]
Limit = tuple[Mapping[int, Fraction], Fraction]


class ExactOptimum(NamedTuple):
    """The optimum of a covering problem: the share of each column and the weight of each row, where above 0.

    ``value`` is the sum of the weights, those of limits times the limit below 0, and what the columns cost.
    """

    x: dict[int, Fraction]
    weights: dict[int, Vector]
    value: Vector


class NowhereError(Exception):
    """A basis is singular, or its solution not feasible."""


def exact_optimum(
    rows: Sequence[Sequence[int]],
    costs: Sequence[Vector],
    order: Lexicographic,
    columns: Sequence[int],
    tight: Sequence[int],
    limits: Sequence[Limit] = (),
) -> ExactOptimum | None:
    """Solve a covering problem over ordered costs exactly, from a basis near the optimum.

    ``rows`` list the columns that cover them, ``costs`` are those of the columns, none below 0. Before these
    rows come ``limits``: what each column takes of one, and how much there is. The basis is given by its
    columns and by the rows that are tight in it, as many of them. Each step solves the basis anew, and by
    Bland's rule none comes back. ``None`` where the basis is singular or its solution not
    feasible, which floats can lead to, or when the walk is too long.
    """
    inside, held = set(columns), set(tight)
    full = [{column: -amount for column, amount in amounts.items()} for amounts, _ in limits]
    full += (dict.fromkeys(row, _ONE) for row in rows)
    least = [-most for _, most in limits] + [_ONE] * len(rows)
    try:
        for _ in range(_STEPS):
            basis = _Basis(full, least, costs, inside, held)
            entering = basis.entering(order)
            if entering is None:
                kept = {row: weight for row, weight in basis.weights.items() if order.sign(weight)}
                shares = {column: share for column, share in basis.x.items() if share}
                value = order.total(times(weight, least[row]) for row, weight in kept.items())
                return ExactOptimum(shares, kept, value)
            for number, is_row in (entering, basis.leaving(*entering)):
                (held if is_row else inside).symmetric_difference_update({number})
    except NowhereError:
        pass
    return None


class _Basis:
    """Columns and as many tight rows, and what follows from them.

    ``x`` are the shares of the basic columns, by which the tight rows hold with equality; ``slack`` is by
    how much each row is exceeded; ``weights`` are those of the tight rows, by which the basic
    columns are loaded with just their costs. Raises :class:`NowhereError` where there is no solution or a
    negative share or slack.
    """

    def __init__(
        self,
        rows: Sequence[Mapping[int, Fraction]],
        least: Sequence[Fraction],
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
            c: share for c, (share,) in solve_exactly(self._matrix, {r: (least[r],) for r in tight}).items()
        }
        self.weights = solve_exactly(transposed, {column: costs[column] for column in columns})
        self.slack = [
            sum((value * self.x[c] for c, value in row.items() if c in self.x), -least[r])
            for r, row in enumerate(rows)
        ]
        if any(value < 0 for value in (*self.x.values(), *self.slack)):
            raise NowhereError

    def entering(self, order: Lexicographic) -> tuple[int, bool] | None:
        """Return the first column loaded with more than it costs, or else the first row of negative weight.

        By Bland's rule; the flag says whether it is a row. ``None`` at the optimum.
        """
        loads: dict[int, list[Vector]] = {}
        for row, weight in self.weights.items():
            for column, value in self._rows[row].items():
                if column not in self.x:  # those are loaded with just their costs
                    loads.setdefault(column, []).append(times(weight, value))
        for column in sorted(loads):
            if order.compare(order.total(loads[column]), self._costs[column]) > 0:
                return column, False
        return next(((row, True) for row in sorted(self.weights) if order.sign(self.weights[row]) < 0), None)

    def leaving(self, number: int, is_row: bool) -> tuple[int, bool]:
        """Return the column or row that first falls to zero as a column comes in or a row becomes slack."""
        gains = [
            Fraction(-(row == number)) if is_row else parts.get(number, _ZERO)
            for row, parts in enumerate(self._rows)
        ]
        side = {row: (gains[row],) for row in self._matrix}
        fall = {column: value for column, (value,) in solve_exactly(self._matrix, side).items()}
        limits = [(self.x[c] / f, False, c) for c, f in fall.items() if f > 0]
        for row, space in enumerate(self.slack):
            lost = sum((value * fall[c] for c, value in self._rows[row].items() if c in fall), _ZERO)
            lost -= gains[row]
            if lost > 0:  # never in a tight row
                limits.append((space / lost, True, row))
        _, leaves_row, leaving = min(limits)  # there is one, as no cost is below 0
        return leaving, leaves_row


def solve_exactly(matrix: Matrix, right: Mapping[int, Vector]) -> dict[int, Vector]:
    """Solve a sparse square system for several right sides at once.

    ``matrix[i]`` maps unknowns to coefficients, ``right[i]`` is what row i gives. Row by row elimination, the
    shortest row first, which keeps systems of cuts sparse. Raises :class:`NowhereError` where it is
    singular.
    """
    left = {number: dict(row) for number, row in matrix.items()}
    sides = dict(right)
    waiting = set(left)
    pivots: list[tuple[int, int, Fraction]] = []
    while waiting:
        number = min(waiting, key=lambda n: (len(left[n]), n))
        row = left[number]
        if not row:
            raise NowhereError
        unknown, pivot = row.popitem()
        pivots.append((number, unknown, pivot))
        waiting.remove(number)
        for rival in waiting:
            other = left[rival]
            if unknown in other:
                factor = other.pop(unknown) / pivot
                for u, value in row.items():
                    other[u] = other.get(u, _ZERO) - factor * value
                    if not other[u]:
                        del other[u]
                sides[rival] = _less(sides[rival], factor, sides[number])
    solution: dict[int, Vector] = {}
    for number, unknown, pivot in reversed(pivots):
        side = sides[number]
        for u, value in left[number].items():
            side = _less(side, value, solution[u])
        solution[unknown] = tuple(part / pivot for part in side)
    return solution


def _less(side: Vector, factor: Fraction, other: Vector) -> Vector:
    return tuple(b - factor * a for a, b in zip(other, side, strict=True))
