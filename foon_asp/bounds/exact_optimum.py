"""From a basis that floats suggest to weights that are exact: simplex steps in rational numbers."""

from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.bounds.lexicographic import Lexicographic, Vector

_STEPS = 400  # from a float optimum it takes few; a walk of this length leads nowhere

_Row = dict[int, Fraction]


class ExactOptimum(NamedTuple):
    """The optimum of a covering problem: the share of each column and the weight of each row, where above 0.

    ``value`` is the sum of the weights, and what the columns cost.
    """

    x: dict[int, Fraction]
    weights: dict[int, Vector]
    value: Vector


def exact_optimum(
    rows: Sequence[Sequence[int]],
    costs: Sequence[Vector],
    order: Lexicographic,
    columns: Sequence[int],
    tight: Sequence[int],
) -> ExactOptimum | None:
    """Solve a covering problem over ordered costs exactly, from a basis near the optimum.

    ``rows`` list the columns that cover them, ``costs`` are those of the columns. The basis is given by its
    columns and by the rows that are tight in it, as many of them. Each step solves the basis anew, and by
    Bland's rule none comes back. ``None`` where the basis is singular or its solution not feasible, which
    floats can lead to, or when the walk is too long.
    """
    basis: _Basis | None = _Basis(rows, costs, sorted(columns), sorted(tight))
    for _ in range(_STEPS):
        if basis is None or not basis.feasible:
            return None
        entering = basis.entering(order)
        if entering is None:
            kept = {row: weight for row, weight in basis.weights.items() if order.sign(weight)}
            shares = {column: share for column, share in basis.x.items() if share}
            return ExactOptimum(shares, kept, order.total(kept.values()))
        basis = basis.exchanged(*entering)
    return None


class _Basis:
    """Columns and as many tight rows, and what follows from them.

    ``x`` are the shares of the basic columns, by which the tight rows hold with equality; ``slack`` is by
    how much the other rows are exceeded; ``weights`` are those of the tight rows, by which the basic
    columns are loaded with just their costs. ``feasible`` is false where there is no solution or a negative
    share or slack.
    """

    def __init__(
        self, rows: Sequence[Sequence[int]], costs: Sequence[Vector], columns: list[int], tight: list[int]
    ) -> None:
        self._rows, self._costs, self._columns, self._tight = rows, costs, columns, tight
        self._holders: dict[int, list[int]] = {}
        for number, row in enumerate(rows):
            for column in row:
                self._holders.setdefault(column, []).append(number)
        self.x: dict[int, Fraction] = {}
        self.slack: dict[int, Fraction] = {}
        self.weights: dict[int, Vector] = {}
        self.feasible = False
        if len(columns) != len(tight):
            return
        row_places = {row: place for place, row in enumerate(tight)}
        column_places = {column: place for place, column in enumerate(columns)}
        one = Fraction(1)
        self._by_row = [{column_places[c]: one for c in rows[r] if c in column_places} for r in tight]
        by_column = [
            {row_places[r]: one for r in self._holders.get(c, ()) if r in row_places} for c in columns
        ]
        shares = _solve(self._by_row, [(one,)] * len(tight))
        weights = _solve(by_column, [costs[c] for c in columns])
        if shares is None or weights is None:
            return
        self.x = {column: share for column, (share,) in zip(columns, shares, strict=True)}
        self.slack = {
            number: sum((self.x[c] for c in row if c in self.x), -one)
            for number, row in enumerate(rows)
            if number not in row_places
        }
        self.weights = dict(zip(tight, weights, strict=True))
        self.feasible = min((*self.x.values(), *self.slack.values()), default=0) >= 0

    def entering(self, order: Lexicographic) -> tuple[int, bool] | None:
        """Give the first column loaded with more than it costs, or else the first row of negative weight.

        By Bland's rule; the flag says which of the two it is. ``None`` at the optimum.
        """
        for column in sorted(self._holders):
            if column not in self.x:
                loads = [self.weights[r] for r in self._holders[column] if r in self.weights]
                spare = [c - sum(parts) for c, *parts in zip(self._costs[column], *loads, strict=True)]
                if order.sign(spare) < 0:
                    return column, True
        row = next((r for r in self._tight if order.sign(self.weights[r]) < 0), None)
        return None if row is None else (row, False)

    def exchanged(self, number: int, is_column: bool) -> "_Basis | None":
        """Let a column in, or a row become slack, and let out what first falls to zero."""
        if is_column:
            side = [(Fraction(number in self._rows[r]),) for r in self._tight]
        else:
            side = [(Fraction(-(r == number)),) for r in self._tight]
        falls = _solve(self._by_row, side)
        if falls is None:
            return None
        fall = {column: value for column, (value,) in zip(self._columns, falls, strict=True)}
        limits = [(self.x[c] / f, 0, c) for c, f in fall.items() if f > 0]
        for row, space in self.slack.items():
            lost = sum((fall[c] for c in self._rows[row] if c in fall), Fraction(0))
            lost -= is_column and number in self._rows[row]
            if lost > 0:
                limits.append((space / lost, 1, row))
        if not limits:
            return None
        _, is_row, leaving = min(limits)
        columns, tight = {*self._columns}, {*self._tight}
        if is_column:
            columns.add(number)
        else:
            tight.remove(number)
        if is_row:
            tight.add(leaving)
        else:
            columns.remove(leaving)
        return _Basis(self._rows, self._costs, sorted(columns), sorted(tight))


def _solve(matrix: Sequence[_Row], right: Sequence[Vector]) -> list[Vector] | None:
    """Solve a sparse square system for several right sides at once; ``None`` where it is singular.

    ``matrix[i]`` maps unknowns to coefficients, ``right[i]`` is what row i gives. Row by row elimination, the
    shortest row first, which keeps systems of cuts sparse.
    """
    left = [dict(row) for row in matrix]
    sides = [list(side) for side in right]
    holders: dict[int, set[int]] = {}
    for number, row in enumerate(left):
        for unknown in row:
            holders.setdefault(unknown, set()).add(number)
    waiting = set(range(len(left)))
    pivots: list[tuple[int, int]] = []
    while waiting:
        number = min(waiting, key=lambda n: (len(left[n]), n))
        row = left[number]
        if not row:
            return None
        unknown = min(row, key=lambda u: (len(holders[u]), u))
        waiting.remove(number)
        pivots.append((number, unknown))
        pivot = row[unknown]
        if pivot != 1:
            for other in row:
                row[other] /= pivot
            sides[number] = [value / pivot for value in sides[number]]
        for rival in holders[unknown] - {number}:
            if rival not in waiting:
                continue
            other_row = left[rival]
            factor = other_row.pop(unknown)
            for u, value in row.items():
                if u == unknown:
                    continue
                new = other_row.get(u, Fraction(0)) - factor * value
                if new:
                    other_row[u] = new
                    holders[u].add(rival)
                elif u in other_row:
                    del other_row[u]
                    holders[u].discard(rival)
            sides[rival] = [
                b - factor * a if a else b for a, b in zip(sides[number], sides[rival], strict=True)
            ]
        holders[unknown] = {number}
    solution: dict[int, Vector] = {}
    for number, unknown in reversed(pivots):
        side = sides[number]
        for u, value in left[number].items():
            if u != unknown:
                side = [b - value * a if a else b for a, b in zip(solution[u], side, strict=True)]
        solution[unknown] = tuple(side)
    return [solution[unknown] for unknown in range(len(left))]
