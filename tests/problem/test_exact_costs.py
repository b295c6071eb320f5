"""What units and items cost as one whole number, and which bounds are met exactly, worked out by hand."""

import itertools
import random
from dataclasses import replace
from fractions import Fraction

import pytest

from foon_asp.hypergraph.exact_costs import CoarseCosts, ExactCosts, TooFineError
from foon_asp.hypergraph.landmark_cuts import Cuts, WeightedCut
from foon_asp.problem import ContainerRule, Objective, levels
from tests.oracle import task_trees
from tests.support.random_problems import random_objectives, random_problem
from tests.support.ways_problem import ways

UNITS, SUCCESS, KITCHEN = Objective.UNITS, Objective.SUCCESS, Objective.KITCHEN
LN_2 = 6931471805599453094172321214581765680755  # 40 digits of its logarithm, from a table
LN_3 = 10986122886681096913952452369225257046474
ROUNDED = 10**20


def costs_of(*rates: str, objectives: tuple[Objective, ...] = (SUCCESS, UNITS)) -> ExactCosts:
    """Count actions of one unit for each rate."""
    return ExactCosts(ways(*([rate] for rate in rates)), objectives, range(len(rates)))


def test_sums_are_in_the_order_of_the_objectives() -> None:
    """Trees of random problems: what costs more by the first objective that differs is the greater sum."""
    compared = 0
    for seed in range(24):
        rng = random.Random(seed)
        problem = random_problem(seed, rng.choice(list(ContainerRule)), units=6)
        problem = replace(problem, own_rates={0: Fraction(1, 3)})
        objectives = levels(random_objectives(rng, 3))
        items = len(problem.network)
        try:
            costs = ExactCosts(problem, objectives, range(items + len(problem.network.objects)))
        except TooFineError:
            continue
        sums: dict[tuple[int | Fraction, ...], int] = {}
        for tree in task_trees.trees(problem):
            units = [u for node in tree if (u := problem.network.unit_id(node)) is not None]
            used = {o for unit in units for o in problem.needs[unit]} & problem.kitchen
            total = sum(map(costs, [*units, *(items + o for o in used)]))
            measured = problem.costs(units)
            assert sums.setdefault(measured.key(objectives), total) == total
            bound, first = costs.first_objective_bound(total), measured.measure(objectives[0])
            assert first <= bound <= (first + Fraction(1, 10**17) if objectives[0] is SUCCESS else first)
            assert total <= costs.combined_cost(measured) <= total + 2 * costs.doubt
            assert total < costs.strict_upper_bound
        ordered = [sums[key] for key in sorted(sums)]
        assert all(more - less > costs.doubt for less, more in itertools.pairwise(ordered))
        compared += len(ordered) > 1
    assert compared > 8


@pytest.mark.parametrize("rate", ["0", "1/1000000001", "1000000000/1000000001", "3/2", "-1/2"])
def test_rates_that_are_too_fine_or_none_are_refused(rate: str) -> None:
    with pytest.raises(TooFineError):
        costs_of("1/2", rate)
    # where rates do not count, or the unit does not, nothing is refused
    assert costs_of("1/2", rate, objectives=(UNITS,))(1) == 1
    assert ExactCosts(ways(["1/2"], [rate]), (SUCCESS, UNITS), [0])(0) == 2 * LN_2 + 1
    assert costs_of("1/2", "1/1000000000").doubt


@pytest.mark.parametrize(
    ("rates", "expected"),
    [
        (["1/2"], "0.500000000000000001"),  # 18 digits, rounded up
        (["1/3", "1/4"], "0.0833333333333333334"),
        (["1", "1", "1"], "1"),
    ],
)
def test_a_bound_on_success_is_rounded_up(rates: list[str], expected: str) -> None:
    costs = costs_of(*rates)
    assert costs.first_objective_bound(sum(map(costs, range(len(rates))))) == Fraction(expected)


def test_a_bound_on_success_allows_for_rounding() -> None:
    costs = costs_of("1/2", "1")
    factor = 3  # two units may come after
    for figure in (0, 1, ROUNDED):
        assert costs.first_objective_bound(factor * figure) == 1
    # what is more than rounding comes to lowers the bound: 100 of it are 10 ** -18 of 1
    assert costs.first_objective_bound(factor * 101 * ROUNDED) == 1
    assert costs.first_objective_bound(factor * 102 * ROUNDED) == 1 - Fraction(1, 10**18)
    assert costs.first_objective_bound(factor * LN_2 - 1) == costs.first_objective_bound(factor * (LN_2 - 1))


def test_sums_of_logarithms_are_told_from_others_beyond_rounding() -> None:
    costs = costs_of("1/2", "1/3", "3/4")
    for figure, of in ((3 * LN_2, Fraction(1, 8)), (LN_3 - LN_2, Fraction(2, 3))):
        for off in (0, ROUNDED - 1, 1 - ROUNDED, ROUNDED, -ROUNDED):
            assert costs.is_logarithm(figure + off, of) == (abs(off) < ROUNDED)


def cut(members: tuple[int, ...], cheapest: int, weight: int) -> WeightedCut:
    return WeightedCut(frozenset({90}), members, cheapest, weight)


def test_a_bound_has_to_be_proved_by_products_of_rates() -> None:
    costs = costs_of("1/2", "1/4", "1/8")
    one, two, three = map(costs, range(3))
    # 1/2 in a cut of its own, and in one with the others what it has less than they
    own = Cuts(one, {0: 0}, [cut((0,), 0, one)])
    assert [costs.proves_optimal(own, {tree}) for tree in (0, 1)] == [True, False]
    assert not costs.proves_optimal(own._replace(bound=two), {1})  # so it is said, but not proved
    both = [cut((0, 1, 2), 0, one), cut((1, 2), 1, two - one)]
    proved = Cuts(two, {0: 0, 1: 0, 2: three - two}, both)
    assert [costs.proves_optimal(proved, {tree}) for tree in range(3)] == [True, True, False]
    # 1/2 and 1/4 are as good as 1/8, with one unit more
    apart = Cuts(one + two, {0: 0, 1: 0}, [cut((0,), 0, one), cut((1,), 1, two)])
    last = Cuts(three, {2: 0}, [cut((2,), 2, three)])
    for tree, met in (({2}, (True, True)), ({0, 1}, (True, False))):
        assert (costs.proves_optimal(apart, tree), costs.proves_optimal(last, tree)) == met


def test_what_is_as_good_and_a_unit_less_is_no_bound_met() -> None:
    costs = costs_of("1", "1", "1/2")
    assert costs(0) == 1
    assert costs.proves_optimal(Cuts(2, {0: 0, 1: 0}, [cut((0,), 0, 1), cut((1,), 1, 1)]), {0, 1}) is True
    assert costs.proves_optimal(Cuts(1, {0: 0}, [cut((0,), 0, 1)]), {0, 1}) is False


def test_cuts_that_take_more_than_there_is_prove_nothing() -> None:
    # 0.9 and 0.900000001 differ by less than what is looked at anew
    costs = costs_of("0.9", "0.900000001", "0.9")
    first, second, third = map(costs, range(3))
    assert first == third > second
    both = cut((0, 1), 0, first)
    assert costs.proves_optimal(Cuts(first, {0: 0, 1: second - first}, [both]), {0}) is False
    # nor does what takes back the surplus
    back = cut((1,), 1, second - first)
    assert costs.proves_optimal(Cuts(second, {0: 0, 1: 0}, [both, back]), {1}) is False
    # as many times as it is used, a cost is taken
    twice = [cut((0,), 0, first), cut((0, 2), 2, third)]
    assert costs.proves_optimal(Cuts(first + third, {0: -first, 2: 0}, twice), {0, 2}) is False
    # a cut that is worth nothing does no harm
    nothing = [cut((0, 2), 0, first), cut((2,), 2, 0)]
    assert costs.proves_optimal(Cuts(first, {0: 0, 2: 0}, nothing), {0}) is True


def test_coarse_costs_are_whole_and_below_what_they_guide_to() -> None:
    problem = replace(ways(["0"], ["1/2"], ["1"], ["3/4"]), own_rates={2: Fraction(2, 5)})
    success = CoarseCosts(problem, SUCCESS)
    assert [success(a) for a in range(5)] == [100_000, 693, 916, 287, 0]
    assert [CoarseCosts(problem, KITCHEN)(a) for a in (0, 4)] == [0, 1]
    assert [CoarseCosts(problem, UNITS)(a) for a in (0, 4)] == [1, 0]
    tries = CoarseCosts(problem, Objective.ATTEMPTS)
    assert [tries(a) for a in range(1, 5)] == [2000, 2500, 1333, 0]  # rounded down


def test_fractions_are_counted_in_steps_that_are_whole() -> None:
    problem = ways(["1/2"], ["2/3"], ["1"])
    costs = ExactCosts(problem, (Objective.ATTEMPTS, UNITS), range(4))
    assert list(map(costs, range(4))) == [5 * 4 + 1, 5 * 3 + 1, 5 * 2 + 1, 0]  # halves
    assert [costs.first_objective_bound(total) for total in (4, 5, 9, 35)] == [
        0,
        *[Fraction(1, 2)] * 2,
        Fraction(7, 2),
    ]
    # only what is asked about counts
    assert ExactCosts(problem, (Objective.ATTEMPTS, UNITS), [0, 2, 3])(0) == 4 * 2 + 1


def test_a_price_is_on_units_that_count_and_a_limit_is_met_by_a_bound_or_a_tree() -> None:
    problem = ways(["1"], ["1/2"], ["1/3"])  # which take 1, 2 and 3 attempts
    costs = ExactCosts(problem, (Objective.ATTEMPTS, KITCHEN, UNITS), range(4))
    plain = [10 + 1, 20 + 1, 30 + 1, 5]
    priced = costs.with_price(lambda action: action != 1, 1000)
    assert list(map(priced, range(4))) == [1011, 21, 1031, 5]
    assert list(map(costs, range(4))) == plain
    limited = costs.with_price(lambda action: action != 1, 1000, 1032)
    for each in (priced, limited):
        assert [each.proves_optimal(Cuts(bound, {}, []), {0, 1}) for bound in (1031, 1032)] == [False, True]
    assert [limited.proves_optimal(Cuts(0, {}, []), tree) for tree in ({0}, {2}, {0, 1})] == [
        True,
        True,
        False,
    ]
    # at a fraction, all are whole
    third = costs.with_price(lambda action: action != 1, Fraction(1, 3))
    assert list(map(third, range(4))) == [3 * 11 + 1, 3 * 21, 3 * 31 + 1, 15]
    # where rates are rounded, no bound proves anything with a price, which is no product of rates
    halves = costs_of("1/2", "1/4")
    rounded = halves.with_price(lambda action: True, Fraction(2, 3))
    assert rounded.doubt == 3 * halves.doubt > 0
    assert rounded.proves_optimal(Cuts(rounded(0), {0: 0}, [cut((0,), 0, rounded(0))]), {0}) is False
