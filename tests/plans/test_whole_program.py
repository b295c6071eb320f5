"""Linear programs over whole numbers: relaxed solutions, and what weights of rows prove by themselves."""

import math
from collections.abc import Callable
from fractions import Fraction
from itertools import product
from random import Random
from types import SimpleNamespace
from typing import Any

import highspy
import pytest

from foon_asp.hypergraph import highs_run
from foon_asp.hypergraph.highs_run import silent_highs
from foon_asp.plans import whole_program
from foon_asp.plans.whole_program import Relaxation, Solved, Stopped, WholeProgram

NOTHING = Solved(None, -math.inf)  # neither a solution nor a proof that there is none
NONE = Solved(None, math.inf)


def program(columns: int, *rows: tuple[dict[int, int], int], upper: dict[int, int] | None = None) -> Any:
    made = WholeProgram(columns)
    for parts, least in rows:
        made.add_row(parts, least)
    for column, most in (upper or {}).items():
        made.cap(column, most)
    return made


def test_a_relaxed_solution_and_the_bound_that_it_proves(capfd: pytest.CaptureFixture[str]) -> None:
    small = program(2, ({0: 1, 1: 1}, 3), upper={0: 2})
    assert small.solve({0: 2, 1: 3}) == Solved([2.0, 1.0], Fraction(7))
    assert small.solve({0: 2}) == Solved([0.0, 3.0], Fraction(0))
    assert small.solve({}).bound == 0
    small.lower[0] = 1
    assert small.solve({0: 2}) == Solved([1.0, 2.0], Fraction(2))
    assert program(1, ({0: 2}, 3)).solve({0: 1}) == Solved([1.5], Fraction(3, 2))
    assert capfd.readouterr() == ("", "")


def test_the_parts_of_an_open_row_are_told_later() -> None:
    later = program(2)
    assert (later.add_open_row((1, 0), 2), later.row_of(0)) == (0, ({1: 0, 0: 0}, 2))
    assert later.add_row({0: 1}, 0) == 1
    later.change_row(0, {0: 4})
    assert later.solve({0: 1}) == Solved([0.5, 0.0], Fraction(1, 2))


def test_a_relaxation_in_floats_has_a_basis() -> None:
    small = program(2, ({0: 1, 1: 1}, 3), ({0: 1}, 1), upper={0: 2})
    assert small.relaxation({0: 2.5, 1: 3.0}) == Relaxation([2.0, 1.0], [3.0, 0.0], [1], [0])
    assert small.relaxation({0: 3.0, 1: 2.5}) == Relaxation([1.0, 2.0], [2.5, 0.5], [0, 1], [0, 1])
    assert (small.row_of(0), small.row_of(1)) == (({0: 1, 1: 1}, 3), ({0: 1}, 1))
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


def test_rows_and_columns_may_come_and_change_between_solutions() -> None:
    growing = program(2, ({0: 1, 1: 1}, 3))
    assert growing.solve({0: 2, 1: 3}).bound == 6
    assert growing.add_row({0: -1}, -1) == 1
    assert growing.solve({0: 2, 1: 3}).bound == 8
    growing.change_row(1, {0: -1})
    growing.change_row(1, {})
    assert growing.solve({0: 2, 1: 3}) == Solved([3.0, 0.0], Fraction(6))
    growing.change_row(0, {0: 1})
    assert growing.solve({0: 2, 1: 1}).bound == 6
    growing.change_row(0, {0: 1, 1: 1})
    growing.change_row(1, {0: -2, 5: 9})  # a row keeps its columns
    assert growing.solve({0: 2, 1: 3}) == Solved([0.5, 2.5], Fraction(17, 2))
    assert growing.add_column(1, 4) == 2
    assert growing.column_count == 3
    assert growing.add_row({2: 1, 1: -1}, 0) == 2
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
    assert sum(costs[c] * best[c] for c in costs) > 0
    late = WholeProgram(1, lambda: True)
    late.add_row({0: 2}, 3)
    assert late.whole_optimum({0: 1}) is None


class Odd:
    """HiGHS, which says something else in answer to a few questions."""

    def __init__(self, **answers: Callable[[], object]) -> None:
        self._highs, self._answers = silent_highs(), answers

    def __getattr__(self, name: str) -> Any:
        return self._answers.get(name, getattr(self._highs, name))


def test_any_weights_prove_what_they_prove(monkeypatch: pytest.MonkeyPatch) -> None:
    weights = [0.0]
    solution = SimpleNamespace(dual_valid=True, col_value=[1.0], row_dual=weights)
    monkeypatch.setattr(whole_program, "silent_highs", lambda: Odd(getSolution=lambda: solution))

    def bound(of: WholeProgram, objective: dict[int, int], weight: float, cutoff: Any = math.inf) -> object:
        weights[0] = weight
        return of.solve(objective, cutoff).bound

    two = program(2, ({0: 17, 1: 1}, 5), upper={1: 2})
    assert bound(two, {0: 17, 1: 1}, 1.0) == 5
    assert bound(two, {0: 17, 1: 1}, 0.5) == Fraction(5, 2)
    assert bound(two, {0: 17}, 1.0) == 3  # all of column 1 is there for nothing
    assert bound(two, {0: 16}, 1.0) == -math.inf  # and without end, of column 0
    for useless in (-1.0, math.nan, math.inf):
        assert bound(two, {0: 17}, useless) == 0
    two.lower[0] = 3
    assert bound(two, {0: 17}, 0.5) == Fraction(5, 2) - 1 + Fraction(51, 2)
    # weights are rounded no further than needed, and most are simple
    assert bound(program(1, ({0: 7}, 5)), {0: 1}, 1 / 7) == Fraction(5, 7)
    one = program(1, ({0: 1}, 5))
    fine, rough = Fraction(5 * round(2**40 / 17), 2**40), Fraction(5 * round(720720 / 17), 720720)
    assert bound(one, {0: 1}, 1 / 17) == fine > rough
    assert bound(one, {0: 1}, 1 / 17, 0) == rough  # more than was asked for
    assert bound(one, {0: 1}, 1 / 17, rough) == fine  # as much is not more


@pytest.mark.parametrize("wrong", [False, True])
def test_bounds_hold_for_every_whole_solution(wrong: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    choose, statuses = Random(3), highspy.HighsModelStatus
    proved = 0

    def anything() -> list[float]:
        return [choose.choice((-1.0, 0.0, 1.0, 0.5, 1e300, math.nan, choose.random())) for _ in range(3)]

    def odd() -> Odd:
        return Odd(
            getModelStatus=lambda: choose.choice((statuses.kOptimal, statuses.kInfeasible)),
            getSolution=lambda: SimpleNamespace(dual_valid=True, col_value=anything(), row_dual=anything()),
            getDualRay=lambda: (None, choose.random() < 0.9, anything()),
        )

    for _ in range(60):
        columns = choose.randint(1, 3)
        rows = [
            ({c: choose.randint(-3, 4) for c in range(columns)}, choose.randint(-2, 5))
            for _ in range(3 if wrong else choose.randint(1, 3))
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
        whole = made.whole_optimum(costs)
        assert (math.inf if whole is None else sum(costs[c] * round(whole[c]) for c in costs)) == best
        with monkeypatch.context() as patched:
            if wrong:
                patched.setattr(whole_program, "silent_highs", odd)
            solved = made.solve(costs)
        assert solved.bound <= best
        proved += solved.bound in {best, math.inf} or solved.bound > best - 1
    assert wrong or proved > 45


def test_where_highs_gets_lost_it_begins_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[Odd] = []

    def lost_at_first() -> Any:
        """Return what finds neither a solution nor a proof that there is none, and then HiGHS."""
        made.append(Odd(getModelStatus=lambda: None, getDualRay=lambda: (None, False, [])))
        return made[0] if len(made) == 1 else silent_highs()

    monkeypatch.setattr(whole_program, "silent_highs", lost_at_first)
    assert program(1, ({0: 2}, 3)).solve({0: 1}) == Solved([1.5], Fraction(3, 2))
    made.clear()
    assert program(1, ({0: 2}, 3)).relaxation({0: 1}).x == [1.5]


def test_where_floats_prove_nothing_there_is_a_solution_that_fails_rows_by_a_little(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    narrow = program(1, ({0: 10**9}, 10**9 + 100), ({0: -(10**9)}, -(10**9)))
    wide = program(1, ({0: 1}, 2), ({0: -1}, -1))
    assert (narrow.solve({0: 1}), wide.solve({0: 1})) == (NONE, NONE)
    with monkeypatch.context() as patched:
        patched.setattr(
            whole_program, "silent_highs", lambda: Odd(getDualRay=lambda: (None, True, [0.0] * 2))
        )
        narrow, wide = (program(1, *map(each.row_of, range(2))) for each in (narrow, wide))
        for _ in range(2):
            x, bound = narrow.solve({0: 1})
            assert (x, bound) == ([pytest.approx(1.0)], -math.inf)
        assert wide.solve({0: 1}) == NOTHING
    assert narrow.solve({0: 1}) == NONE  # the rows are as they were


def test_a_relaxation_ends_when_time_is_up(monkeypatch: pytest.MonkeyPatch) -> None:
    looks: list[bool] = []

    def expired() -> bool:
        looks.append(True)
        return len(looks) == 2

    monkeypatch.setattr(highs_run, "RUN", highs_run.RUN._replace(steps=1))
    rows = [{n: 1, n + 1: 2, (7 * n) % 30: 1} for n in range(29)]
    made = [WholeProgram(30, asked) for asked in (lambda: False, expired)]
    for one, (number, parts) in product(made, enumerate(rows)):
        one.add_row(parts, 1 + number % 3)
    costs = {n: 1 + n % 5 for n in range(30)}
    bound = made[0].solve(costs).bound
    with pytest.raises(Stopped):
        made[1].solve(costs)
    assert made[1].solve(costs).bound == bound  # goes on from where it was, until it ends
    assert len(looks) > 2
