"""What units cost as whole numbers, by hand: exactly where that fits, to scale, or rounded down."""

from dataclasses import replace
from fractions import Fraction

import pytest

from foon_asp.encoding.cost_scales import Scales, cost_scale
from foon_asp.errors import UserError
from foon_asp.problem import Objective
from tests.problem.test_objectives import NEW
from tests.support.ways_problem import ways

UNITS, SUCCESS, TRIES = Objective.UNITS, Objective.SUCCESS, NEW["rounded"]


@pytest.mark.parametrize(
    ("costs", "scale", "exact", "weights"),
    [
        ([], 1, True, []),
        (["0.05", "1.5"], 20, True, [1, 30]),
        (["1/3", "3/4"], 12, True, [4, 9]),
        (["1/3", "2147483647/3"], 3, True, [1, 2**31 - 1]),
        (["1/3", "1/1000000007"], 3_000_000_021, True, [3, 1_000_000_007]),
        (["4", "13/1000000007"], 10**8, False, [1, 400_000_000]),
    ],
)
def test_costs_to_scale(costs: list[str], scale: int, exact: bool, weights: list[int]) -> None:
    found = cost_scale(map(Fraction, costs))
    assert found.scale == scale
    assert found.exact is exact
    assert list(found.weights.values()) == weights
    assert list(found.weights) == sorted(map(Fraction, costs))


@pytest.mark.parametrize("most", ["22.5", "2147483647.5", "10000000000"])
def test_dear_costs_are_rounded_so_that_they_fit(most: str) -> None:
    dear, fine = Fraction(most), Fraction(1, 10**9 + 7)
    found = cost_scale([dear, fine])
    assert not found.exact
    assert 2**31 - 2 <= found.weights[dear] <= 2**31 - 1
    assert found.weights[fine] == 0


def test_bounds_are_those_of_what_is_weighed() -> None:
    """Rates of 1/3 and 1 take 3 and 1 tries, which are whole; 0.7 takes 10/7."""
    problem = ways(["1/3", "1"], ["0.7"])
    scales = Scales(problem, range(3), [UNITS, TRIES])
    assert scales.rounded is None
    assert [scales.bound(o, 20) for o in (UNITS, TRIES)] == [20, Fraction(20, 7)]
    assert [scales.allows(TRIES, 28, tries) for tries in (3, 4, 5)] == [False, True, False]
    assert Scales(replace(problem, rates=None), range(3), [UNITS]).bound(SUCCESS, 5) == 1


def test_what_is_rounded_is_bounded_on_one_side() -> None:
    by_success = Scales(ways(["1/3", "1"], ["0.7"]), range(3), [UNITS, SUCCESS])
    assert by_success.rounded is SUCCESS
    assert by_success.allows(SUCCESS, 109_861_228, Fraction(1, 3))  # ln 3 = 1.0986122886...
    assert not by_success.allows(SUCCESS, 109_861_229, Fraction(1, 3))
    by_tries = Scales(ways(["1000000007/1000000008", "0.5"], ["0.7"]), range(3), [TRIES, UNITS])
    assert by_tries.rounded is TRIES
    assert by_tries.weight(TRIES, (0, 1)) == 300_000_000  # 1.000000000999... + 2
    assert by_tries.allows(TRIES, 300_000_000, 3 + Fraction(1, 10**9 + 7))
    assert not by_tries.allows(TRIES, 300_000_001, 3)
    for scales in (by_success, by_tries):  # how many units weigh less than they cost
        assert [scales.count_rounded(units) for units in ((0, 1), (1,), (0, 2))] == [1, 0, 2]
    assert by_tries.vector((0, 1, 1)) == by_tries.vector((1, 1, 0)) != by_tries.vector((0, 0, 1))


def test_bounds_are_put_on_what_is_exact() -> None:
    scales = Scales(ways(["1/3", "1"], ["0.7"]), range(3), [UNITS, TRIES])
    assert scales.cost_weight(UNITS, 4) == 4
    assert scales.cost_weight(TRIES, Fraction(30, 7)) == 30
    most = ways(["1/2147483647"], ["1"])
    assert Scales(most, [0], [TRIES]).cost_weight(TRIES, 5) == 5
    with pytest.raises(UserError, match="all units together cost more than fits into clingo's numbers"):
        Scales(most, [0, 1], [TRIES]).cost_weight(TRIES, 5)
    fine = Scales(ways(["1000000007/1000000008", "0.5"], ["0.7"]), range(3), [TRIES, UNITS])
    assert fine.cost_weight(UNITS, 4) == 4
    with pytest.raises(UserError) as refused:
        fine.cost_weight(TRIES, 4)
    assert str(refused.value) == (
        "the objective tries has to be rounded for the solver, so it cannot be bounded: leave it "
        "out, or the other objective that has to be rounded"
    )


@pytest.mark.parametrize("order", [[TRIES, SUCCESS], [SUCCESS, UNITS, TRIES]])
def test_one_objective_is_rounded_and_no_other(order: list[Objective]) -> None:
    with pytest.raises(UserError) as refused:
        Scales(ways(["1000000007/1000000008", "0.5"], ["0.7"]), range(3), order)
    assert str(refused.value) == (
        f"the objectives {order[0]} and {order[-1]} have to be rounded for the solver, which can settle only "
        "one such objective exactly: leave one of them out"
    )
    assert Scales(ways(["1"], ["1", "1"]), range(3), order).rounded is None
