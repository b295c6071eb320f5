"""From a basis that floats suggest to weights that are exact: simplex steps in rational numbers."""

from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.bounds.lexicographic import Lexicographic, Vector

_STEPS = 400  # from a float optimum it takes few; a walk of this length leads nowhere

_Row = dict[int, Fraction]


class ExactOptimum(NamedTuple):
    """The optimum of a covering problem: the share of each column and the weight of each row, where not 0.

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
    columns and by the rows that are tight in it, as many of them. Each step solves the basis anew, and by Bland's rule
    none comes back. ``None`` where the basis is singular or its solution not feasible, which floats can lead
    to, or when the walk is too long.
    """
    basic, tight_rows = sorted(columns), sorted(tight)
    used = sorted({column for row in rows for column in row})
    holders: dict[int, list[int]] = {column: [] for column in used}
    for number, row in enumerate(rows):
        for column in row:
            holders[column].append(number)
    for _ in range(_STEPS):
        if len(basic) != len(tight_rows):
            return None
        place_of_row = {row: place for place, row in enumerate(tight_rows)}
        place_of_column = {column: place for place, column in enumerate(basic)}
        by_row: list[_Row] = [
            {place_of_column[c]: Fraction(1) for c in rows[r] if c in place_of_column} for r in tight_rows
        ]
        by_column: list[_Row] = [
            {place_of_row[r]: Fraction(1) for r in holders.get(c, ()) if r in place_of_row} for c in basic
        ]
        one = [(Fraction(1),)] * len(tight_rows)
        shares = _solve(by_row, one)
        prices = _solve(by_column, [costs[c] for c in basic])
        if shares is None or prices is None:
            return None
        x = dict(zip(basic, (share for (share,) in shares), strict=True))
        slack = {
            number: sum((x[c] for c in row if c in x), Fraction(-1))
            for number, row in enumerate(rows)
            if number not in place_of_row
        }
        if min(x.values(), default=0) < 0 or min(slack.values(), default=0) < 0:
            return None
        weights = dict(zip(tight_rows, prices, strict=True))

        # Bland's rule: the first column or else the first row that would lower the cost comes in
        def reduced(column: int, weights: dict[int, Vector] = weights) -> Vector:
            loads = [weights[r] for r in holders[column] if r in weights]
            return tuple(c - sum(parts) for c, *parts in zip(costs[column], *loads, strict=True))

        entering = next((c for c in used if c not in x and order.sign(reduced(c)) < 0), None)
        leaving_row = None
        if entering is None:
            leaving_row = next((r for r in tight_rows if order.sign(weights[r]) < 0), None)
        if entering is None and leaving_row is None:
            kept = {row: weight for row, weight in weights.items() if any(weight)}
            value = tuple(map(sum, zip(order.zero, *kept.values(), strict=True)))
            return ExactOptimum({c: share for c, share in x.items() if share}, kept, value)

        # how the basic shares fall as the one that comes in rises by 1
        if entering is not None:
            side = [(Fraction(entering in rows[r]),) for r in tight_rows]
        else:
            side = [(Fraction(-(r == leaving_row)),) for r in tight_rows]
        falls = _solve(by_row, side)
        if falls is None:
            return None
        fall = dict(zip(basic, (f for (f,) in falls), strict=True))
        limits = [(x[c] / f, c, True) for c, f in fall.items() if f > 0]
        for row_number, space in slack.items():
            row = rows[row_number]
            lost = sum((fall[c] for c in row if c in fall), Fraction(0)) - (entering in row)
            if lost > 0:
                limits.append((space / lost, row_number, False))
        if not limits:
            return None
        _, number, is_column = min(limits, key=lambda limit: (limit[0], not limit[2], limit[1]))
        if is_column:
            basic.remove(number)
        else:
            tight_rows.append(number)
        if entering is not None:
            basic.append(entering)
        elif leaving_row is not None:
            tight_rows.remove(leaving_row)
        basic.sort()
        tight_rows.sort()
    return None


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
            sides[rival] = [b - factor * a if a else b for a, b in zip(sides[number], sides[rival], strict=True)]
        holders[unknown] = {number}
    solution: dict[int, Vector] = {}
    for number, unknown in reversed(pivots):
        side = sides[number]
        for u, value in left[number].items():
            if u != unknown:
                side = [b - value * a if a else b for a, b in zip(solution[u], side, strict=True)]
        solution[unknown] = tuple(side)
    return [solution[unknown] for unknown in range(len(left))]
