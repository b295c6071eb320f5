"""Exact optima of small covering problems, walked to from every basis there is."""

import random
from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations

import pytest

from foon_asp.hypergraph import tuning
from foon_asp.hypergraph.covering import Covering
from foon_asp.hypergraph.exact_optimum import ExactOptimum, exact_optimum
from foon_asp.hypergraph.lexicographic import Lexicographic, Vector

COUNT = Lexicographic([None])
ONE = Fraction(1)


def counts(*values: int) -> list[Vector]:
    return [(Fraction(value),) for value in values]


def lp_values(
    rows: Sequence[Sequence[int]], columns: Sequence[int], tight: Sequence[int]
) -> dict[int, Fraction] | None:
    """Return the shares of a basis by Cramer's rule, ``None`` where it is singular or not feasible."""

    def determinant(matrix: list[list[Fraction]]) -> Fraction:
        if not matrix:
            return ONE
        minors = [[line[:place] + line[place + 1 :] for line in matrix[1:]] for place in range(len(matrix))]
        return sum(
            ((-1) ** place * matrix[0][place] * determinant(minor) for place, minor in enumerate(minors)),
            Fraction(0),
        )

    square = [[Fraction(column in rows[row]) for column in columns] for row in tight]
    divisor = determinant(square)
    if not divisor:
        return None
    x = {
        column: determinant([[*line[:place], ONE, *line[place + 1 :]] for line in square]) / divisor
        for place, column in enumerate(columns)
    }
    covered = [sum(x.get(column, Fraction(0)) for column in row) for row in rows]
    return x if min([*x.values(), *covered], default=0) >= 0 and min(covered) >= 1 else None


def check(
    rows: Sequence[Sequence[int]], costs: Sequence[Vector], order: Lexicographic, found: ExactOptimum
) -> None:
    """Hold shares against weights: both are feasible, none is 0, and they come to the same."""
    assert all(share > 0 for share in found.x.values())
    assert all(sum(found.x.get(column, 0) for column in row) >= 1 for row in rows)
    assert all(order.sign(weight) > 0 for weight in found.duals.values())
    for column, cost in enumerate(costs):
        load = order.total(weight for row, weight in found.duals.items() if column in rows[row])
        assert order.compare(load, cost) <= 0
    assert order.total(found.duals.values()) == found.value
    paid = order.total(tuple(part * share for part in costs[column]) for column, share in found.x.items())
    assert order.compare(paid, found.value) == 0


@pytest.mark.parametrize("seed", range(12))
def test_from_every_feasible_basis_the_optimum_is_found(seed: int) -> None:
    rng = random.Random(seed)
    rows = [sorted(rng.sample(range(4), rng.randint(1, 3))) for _ in range(rng.randint(2, 4))]
    rates = [Fraction("0.7"), Fraction("0.49")]
    order = [COUNT, Lexicographic([None, None]), Lexicographic([rates, None])][seed % 3]
    costs = [tuple(Fraction(rng.randint(0, 3)) for _ in range(order.width)) for _ in range(4)]
    optima = []
    for size in range(1, 1 + len(rows)):
        for columns in combinations(range(4), size):
            for tight in combinations(range(len(rows)), size):
                found = exact_optimum(rows, costs, order, columns[::-1], tight[::-1])
                assert (found is None) == (lp_values(rows, columns, tight) is None)
                if found is not None:
                    check(rows, costs, order, found)
                    optima.append(found.value)
    assert len(optima) >= 2
    assert all(order.compare(optima[0], value) == 0 for value in optima)


@pytest.mark.parametrize("seed", range(8))
def test_from_a_basis_that_is_best_for_other_costs_the_optimum_is_found(seed: int) -> None:
    rng = random.Random(seed)
    rows = [sorted(rng.sample(range(9), rng.randint(2, 4))) for _ in range(9)]
    other = Covering([rng.uniform(1, 2) for _ in range(9)])
    for row in rows:
        other.add_row(row)
    near = other.solve()
    costs = counts(*(rng.randint(1, 9) for _ in range(9)))
    found = exact_optimum(rows, costs, COUNT, near.columns, near.rows)
    assert found is not None
    check(rows, costs, COUNT, found)


def test_a_walk_that_is_too_long_leads_nowhere(monkeypatch: pytest.MonkeyPatch) -> None:
    # from 1 of columns 0 and 1 over a half of each to 1 of columns 1 and 2: the third basis is the best
    rows, costs = [[0, 1], [1, 2], [0, 2]], counts(5, 1, 1)
    found = exact_optimum(rows, costs, COUNT, [0, 1], [1, 2])
    assert found == ({1: ONE, 2: ONE}, {0: (ONE,), 2: (ONE,)}, (Fraction(2),))
    monkeypatch.setattr(tuning, "PROOF", tuning.ProofTuning(pivots=3))
    assert exact_optimum(rows, costs, COUNT, [0, 1], [1, 2]) == found
    monkeypatch.setattr(tuning, "PROOF", tuning.ProofTuning(pivots=2))
    assert exact_optimum(rows, costs, COUNT, [0, 1], [1, 2]) is None


def test_nothing_to_cover_costs_nothing() -> None:
    assert exact_optimum([], counts(1, 2), COUNT, [], []) == ({}, {}, (Fraction(0),))


def test_costs_of_different_widths_are_an_error() -> None:
    with pytest.raises(ValueError, match="zip"):
        exact_optimum([[0, 1], [1]], [(ONE,), (ONE, ONE)], COUNT, [0, 1], [0, 1])


def test_the_exact_optimum_of_a_triangle_is_a_half_of_each() -> None:
    rows = [[0, 1], [0, 2], [1, 2]]
    costs = [(Fraction(1), Fraction(c)) for c in (1, 2, 3)]
    order = Lexicographic([None, None])
    for columns, tight in (([0, 1, 2], [0, 1, 2]), ([0, 1], [1, 2])):
        found = exact_optimum(rows, costs, order, columns, tight)
        assert found is not None
        assert found.x == dict.fromkeys(range(3), Fraction(1, 2))
        assert found.value == (Fraction(3, 2), Fraction(3))
    assert exact_optimum(rows, costs, order, [0], [2]) is None  # singular
    assert exact_optimum(rows, costs, order, [0], [0]) is None  # the last row is not covered
