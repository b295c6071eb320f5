"""Linear programs over whole numbers: relaxed solutions, and what weights of rows prove by themselves."""

import math
from fractions import Fraction
from itertools import product
from random import Random
from typing import Any

import pytest

from foon_asp.bounds.whole_program import Relaxation, Solved, Stopped, WholeProgram

NOTHING = Solved(None, -math.inf)  # neither a solution nor a proof that there is none
NONE = Solved(None, math.inf)


def program(columns: int, *rows: tuple[dict[int, int], int], upper: dict[int, int] | None = None) -> Any:
    made = WholeProgram(columns)
    for parts, least in rows:
        made.row(parts, least)
    for column, most in (upper or {}).items():
        made.cap(column, most)
    return made


def test_a_relaxed_solution_and_the_bound_that_it_proves(capfd: pytest.CaptureFixture[str]) -> None:
    small = program(2, ({0: 1, 1: 1}, 3), upper={0: 2})
    assert small.solve({0: 2, 1: 3}) == Solved([2.0, 1.0], Fraction(7))
    before = small._highs
    assert small.solve({0: 2, 1: 3}) == Solved([2.0, 1.0], Fraction(7))
    assert small._highs is before  # which goes on from where it was
    assert small.solve({0: 2}) == Solved([0.0, 3.0], Fraction(0))
    assert small.solve({}).bound == 0
    small.lower[0] = 1
    assert small.solve({0: 2}) == Solved([1.0, 2.0], Fraction(2))
    assert program(1, ({0: 2}, 3)).solve({0: 1}) == Solved([1.5], Fraction(3, 2))
    assert capfd.readouterr() == ("", "")


def test_the_parts_of_an_open_row_are_told_later() -> None:
    later = program(2)
    assert (later.open_row((1, 0), 2), later._rows) == (0, [({1: 0, 0: 0}, 2)])
    assert later.row({0: 1}, 0) == 1
    later.change(0, {0: 4})
    assert later.solve({0: 1}) == Solved([0.5, 0.0], Fraction(1, 2))


def test_a_relaxation_in_floats_has_a_basis() -> None:
    small = program(2, ({0: 1, 1: 1}, 3), ({0: 1}, 1), upper={0: 2})
    assert small.relaxation({0: 2.5, 1: 3.0}) == Relaxation([2.0, 1.0], [3.0, 0.0], [1], [0])
    assert small.relaxation({0: 3.0, 1: 2.5}) == Relaxation([1.0, 2.0], [2.5, 0.5], [0, 1], [0, 1])
    assert (small.said(0), small.said(1)) == (({0: 1, 1: 1}, 3), ({0: 1}, 1))
    none = program(2, ({0: 3, 1: -1}, 1), ({0: -3, 1: 1}, 1)).relaxation({0: 1.0})
    assert (none.x, none.columns, none.rows) == (None, [], [])
    assert none.weights[0] == none.weights[1] > 0


def test_no_solution_is_proved_by_weights_and_never_taken_on_trust() -> None:
    assert program(1, ({0: 1}, 2), ({0: 1}, 0), upper={0: 1}).solve({0: 1}) == NONE
    assert program(2, ({0: 3, 1: -1}, 1), ({0: -3, 1: 1}, 1)).solve({}) == NONE
    assert program(2, ({0: 300, 1: -1}, 1), ({0: -3, 1: 1}, 1), upper={0: 0}).solve({1: 1}) == NONE
    assert program(1, ({0: 1}, 1)).solve({0: -1}) == NOTHING  # costs fall without end
    assert program(1, ({}, 1)).solve({0: 1}) == NOTHING  # of this HiGHS gives no weights
    crossed = program(2)
    crossed.lower[0], crossed.upper[0] = 2, 1
    assert crossed.solve({0: 1}) == NONE
    crossed.upper[0] = 2
    assert crossed.solve({0: 1}) == Solved([2.0, 0.0], Fraction(2))
    weightless = program(2, ({0: 3, 1: -1}, 1), ({0: -24, 1: 8}, 1))
    given: list[list[float]] = []

    def bound(_: object, weights: list[float], cutoff: float) -> Fraction:
        given.append(weights)
        return Fraction(cutoff)

    weightless._bound = bound
    assert weightless.solve({0: 1}) == NOTHING
    assert given == [[1.0, 0.125]]  # small and great weights are the same


def test_rows_and_columns_may_come_and_change_between_solutions() -> None:
    growing = program(2, ({0: 1, 1: 1}, 3))
    assert growing.solve({0: 2, 1: 3}).bound == 6
    assert growing.row({0: -1}, -1) == 1
    assert growing.solve({0: 2, 1: 3}).bound == 8
    growing.change(1, {0: -1})
    assert not growing._changed  # what is the same is not sent again
    growing.change(1, {})
    assert growing.solve({0: 2, 1: 3}) == Solved([3.0, 0.0], Fraction(6))
    growing.change(0, {0: 1})
    assert growing.solve({0: 2, 1: 1}).bound == 6
    growing.change(0, {0: 1, 1: 1})
    growing.change(1, {0: -2, 5: 9})  # a row keeps its columns
    assert growing.solve({0: 2, 1: 3}) == Solved([0.5, 2.5], Fraction(17, 2))
    assert not growing._changed
    assert growing.column(1, 4) == 2
    assert growing.columns == 3
    assert growing.row({2: 1, 1: -1}, 0) == 2
    assert growing.solve({0: 2, 1: 3, 2: 1}) == Solved([0.5, 2.5, 2.5], Fraction(11))
    assert growing.solve({2: -1}).bound == -4


def test_bounds_of_columns_only_get_tighter_and_are_copied_for_a_part() -> None:
    columns = WholeProgram(2)
    assert (columns.lower, columns.upper) == ([0, 0], [None, None])
    columns.cap(0, 5)
    columns.cap(0, 7)
    assert columns.upper == [5, None]
    columns.cap(0, 4)
    assert columns.with_bounds(0, 2, None) == ([2, 0], [4, None])
    assert columns.with_bounds(0, None, 3) == ([0, 0], [3, None])
    assert (columns.lower, columns.upper) == ([0, 0], [4, None])


def test_whole_optima_and_relaxed_ones_after_them() -> None:
    small = program(1, ({0: 2}, 3))
    assert small.whole_optimum({0: 1}) == [2.0]
    assert small.solve({0: 1}) == Solved([1.5], Fraction(3, 2))
    assert program(1, ({0: 2}, 1), ({0: -2}, -1)).whole_optimum({0: 1}) is None
    choose = Random(1)
    hard = program(5, *(({c: choose.randint(1, 99) for c in range(5)}, 700) for _ in range(2)))
    costs = {c: choose.randint(50, 99) for c in range(5)}
    best = hard.whole_optimum(costs)
    assert best is not None
    hard._expired = lambda: True
    assert hard.whole_optimum(costs) is None
    hard._expired = lambda: False
    assert hard.whole_optimum(costs) == best


def test_any_weights_prove_what_they_prove() -> None:
    two = program(2, ({0: 17, 1: 1}, 5), upper={1: 2})
    bound = two._bound
    assert bound({0: 17, 1: 1}, [1.0], math.inf) == 5
    assert bound({0: 17, 1: 1}, [0.5], math.inf) == Fraction(5, 2)
    assert bound({0: 17}, [1.0], math.inf) == 3  # all of column 1 is there for nothing
    assert bound({0: 16}, [1.0], math.inf) == -math.inf  # and without end, of column 0
    for useless in (-1.0, math.nan, math.inf):
        assert bound({0: 17}, [useless], math.inf) == 0
    two.lower[0] = 3
    assert bound({0: 17}, [0.5], math.inf) == Fraction(5, 2) - 1 + Fraction(51, 2)
    assert bound({}, [0.0], math.inf) == 0


def test_weights_are_rounded_no_further_than_needed() -> None:
    one = program(1, ({0: 7}, 5))
    seventh = one._bound({0: 1}, [1 / 7], math.inf)
    assert seventh == Fraction(5, 7)  # most weights are simple
    one = program(1, ({0: 1}, 5))
    fine = one._bound({0: 1}, [1 / 17], math.inf)
    assert fine == Fraction(5 * round(2**40 / 17), 2**40)
    rough = one._bound({0: 1}, [1 / 17], 0)
    assert rough == Fraction(5 * round(720720 / 17), 720720)  # more than was asked for
    assert rough < fine
    assert one._bound({0: 1}, [1 / 17], rough) == fine  # as much is not more


def test_bounds_hold_for_every_whole_solution() -> None:
    choose = Random(3)
    proved = 0
    for _ in range(60):
        columns = choose.randint(1, 3)
        rows = [
            ({c: choose.randint(-3, 4) for c in range(columns)}, choose.randint(-2, 5))
            for _ in range(choose.randint(1, 3))
        ]
        made = program(columns, *rows, upper=dict.fromkeys(range(columns), 3))
        costs = {c: choose.randint(-2, 5) for c in range(columns)}
        best = min(
            (
                sum(costs[c] * x[c] for c in costs)
                for x in product(range(4), repeat=columns)
                if all(sum(part * x[c] for c, part in parts.items()) >= least for parts, least in rows)
            ),
            default=math.inf,
        )
        solved = made.solve(costs)
        assert solved.bound <= best
        proved += solved.bound in {best, math.inf} or solved.bound > best - 1
        whole = made.whole_optimum(costs)
        found = math.inf if whole is None else sum(costs[c] * round(whole[c]) for c in costs)
        assert found == best
    assert proved > 45


class Lost:
    """HiGHS as it is where it gets lost in numbers: neither a solution nor a proof that there is none."""

    def __init__(self, highs: Any) -> None:
        self._highs = highs

    def getModelStatus(self) -> None:  # noqa: N802 (a name of HiGHS)
        """Give a status that says nothing."""

    def getDualRay(self) -> tuple[None, bool, list[float]]:  # noqa: N802
        """Give no ray."""
        return None, False, []

    def __getattr__(self, name: str) -> Any:
        return getattr(self._highs, name)


def test_where_highs_gets_lost_on_the_way_from_the_last_solution_it_begins_anew() -> None:
    made = program(1, ({0: 2}, 3))
    made.solve({0: 1})
    made._highs = Lost(made._highs)
    assert made.solve({0: 1}) == Solved([1.5], Fraction(3, 2))
    made._highs = Lost(made._highs)
    assert made.relaxation({0: 1}).x == [1.5]


def test_where_floats_prove_nothing_there_is_a_solution_that_fails_rows_by_a_little() -> None:
    wide = program(1, ({0: 1}, 2), ({0: -1}, -1), upper={0: 5})
    wide.solve({0: 1})
    assert wide._nearly() is None
    narrow = program(1, ({0: 10**9}, 10**9 + 100), ({0: -(10**9)}, -(10**9)))
    before = narrow.solve({0: 1})
    assert narrow._nearly() == [pytest.approx(1.0)]
    assert narrow.solve({0: 1}) == before  # the rows are as they were


def test_a_relaxation_ends_when_time_is_up(monkeypatch: pytest.MonkeyPatch) -> None:
    looks: list[bool] = []

    def expired() -> bool:
        looks.append(True)
        return len(looks) == 2

    monkeypatch.setattr("foon_asp.bounds.highs_run._STEPS", 1)
    rows = [{n: 1, n + 1: 2, (7 * n) % 30: 1} for n in range(29)]
    made = [WholeProgram(30, asked) for asked in (lambda: False, expired)]
    for one, (number, parts) in product(made, enumerate(rows)):
        one.row(parts, 1 + number % 3)
    costs = {n: 1 + n % 5 for n in range(30)}
    bound = made[0].solve(costs).bound
    with pytest.raises(Stopped):
        made[1].solve(costs)
    assert made[1].solve(costs).bound == bound  # goes on from where it was, until it ends
    assert len(looks) > 2
