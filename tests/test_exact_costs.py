"""What units and items cost as one whole number, and which bounds are met exactly, worked out by hand."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from fractions import Fraction
from math import prod

import pytest

from foon_asp.bounds.landmark_cuts import Cuts, WeightedCut
from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Known, Objective, Problem, levels
from foon_asp.problem.objective import Row
from foon_asp.reduce import exact_costs
from foon_asp.reduce.exact_costs import CoarseCosts, ExactCosts, TooFineError
from tests.test_objectives import made_up

UNITS, INPUTS, INGREDIENTS = Objective.UNITS, Objective.INPUTS, Objective.INPUTS_AND_INGREDIENTS
SUCCESS, KITCHEN = Objective.SUCCESS, Objective.KITCHEN
LN_2 = 6931471805599453094172321214581765680755  # 40 digits of its logarithm, from a table
LN_3 = 10986122886681096913952452369225257046474
LN_5 = 16094379124341003746007593332261876395256
ROUNDED = 10**20


def posed(*rates: str | Fraction, inputs: tuple[int, ...] = ()) -> Problem:
    """Ask for one thing that units make, each of a rate of its own and of one input, or as told."""
    builder = NetworkBuilder()
    goal = ObjectNode.of("goal")
    for place, _ in enumerate(rates):
        count = inputs[place] if inputs else 1
        needed = [ObjectNode.of("bowl", [str(n)], [], [("contains", ["egg", "salt"])]) for n in range(count)]
        builder.add(f"motion {place}", needed, [goal], Source("costs", place + 1))
    network = builder.build()
    asked = network.object_id(goal)
    assert asked is not None
    known = {f"motion {place}": Fraction(rate) for place, rate in enumerate(rates)}
    kitchen = frozenset(o for o in range(len(network.objects)) if o != asked)
    return Problem(network, kitchen, (asked,), known, frozenset(), ContainerRule.STRICT)


def costs_of(*rates: str | Fraction, objectives: tuple[Objective, ...] = (SUCCESS, UNITS)) -> ExactCosts:
    return ExactCosts(posed(*rates), objectives, range(len(rates)))


@pytest.mark.parametrize(
    ("objectives", "expected"),
    [
        # three units with 1, 2 and 3 inputs of two ingredients each, and three items
        ([UNITS], [1, 1, 1, 0, 0, 0]),
        ([INPUTS], [7 * 1 + 1, 7 * 2 + 1, 7 * 3 + 1, 0, 0, 0]),
        ([INGREDIENTS], [7 * 3 + 1, 7 * 6 + 1, 7 * 9 + 1, 0, 0, 0]),
        ([UNITS, INPUTS], [7 + 1, 7 + 2, 7 + 3, 0, 0, 0]),
        ([INPUTS, INGREDIENTS], [7 * 19 + 7 * 3 + 1, 7 * 38 + 7 * 6 + 1, 7 * 57 + 7 * 9 + 1, 0, 0, 0]),
        ([KITCHEN], [1, 1, 1, 7, 7, 7]),
        ([KITCHEN, INPUTS], [7 + 1, 14 + 1, 21 + 1, 49, 49, 49]),
        ([INPUTS, KITCHEN], [28 + 1, 56 + 1, 84 + 1, 7, 7, 7]),  # 28 is above all that three items cost
    ],
)
def test_an_objective_weighs_more_than_all_after_it(objectives: list[Objective], expected: list[int]) -> None:
    problem = posed("1", "1", "1", inputs=(1, 2, 3))
    costs = ExactCosts(problem, levels(tuple(objectives)), range(6))
    assert list(map(costs, range(6))) == expected
    assert list(map(costs, range(6))) == expected  # and again
    assert costs.doubt == 0
    total = sum(expected)
    assert costs.first(total) == sum(dict(costs.figures(a))[objectives[0]] for a in range(6))


def test_a_bound_on_a_sum_bounds_the_first_objective_from_below() -> None:
    costs = ExactCosts(posed("1", "1", "1"), (INPUTS, UNITS), range(6))
    assert [costs.first(total) for total in (0, 6, 7, 13, 14)] == [
        0,
        0,
        1,
        1,
        2,
    ]  # three units may come after


def test_figures_are_those_of_each_objective() -> None:
    problem = posed("0.5", "1", "1", inputs=(1, 2, 3))
    costs = ExactCosts(problem, (SUCCESS, KITCHEN, INPUTS, INGREDIENTS, UNITS), range(6))
    assert costs.figures(0) == [(SUCCESS, LN_2), (KITCHEN, 0), (INPUTS, 1), (INGREDIENTS, 3), (UNITS, 1)]
    assert costs.figures(2) == [(SUCCESS, 0), (KITCHEN, 0), (INPUTS, 3), (INGREDIENTS, 9), (UNITS, 1)]
    assert costs.figures(3) == [(SUCCESS, 0), (KITCHEN, 1), (INPUTS, 0), (INGREDIENTS, 0), (UNITS, 0)]
    assert [costs.rate(a) for a in (0, 2, 3, 5)] == [Fraction(1, 2), 1, 1, 1]


def test_rates_are_logarithms_of_forty_digits_by_their_factors() -> None:
    rates = ["1/2", "1/4", "2/3", "3/10", "9/20", "1"]
    costs = costs_of(*rates)
    figures = [dict(costs.figures(a))[SUCCESS] for a in range(6)]
    # the factors are 2, 3 and 10, with one rounding each
    ln_10 = LN_2 + LN_5
    assert abs(figures[3] - (ln_10 - LN_3)) < 9
    assert figures[0] == LN_2
    assert figures[1] == 2 * figures[0]
    assert figures[2] == LN_3 - LN_2
    assert figures[4] == figures[3] + figures[0] - LN_3 + 0 * figures[5]
    assert figures[5] == 0
    assert list(map(costs, range(6))) == [7 * figure + 1 for figure in figures]


@pytest.mark.parametrize(
    ("objectives", "doubt", "unit", "half"),
    [
        # of three units, counting after the products or before them
        ([SUCCESS], ROUNDED * 4, 1, 4),
        ([SUCCESS, INPUTS], ROUNDED * 16, 4 + 1, 16),
        ([INPUTS, SUCCESS], ROUNDED * 4, 4 * (1 + 3 * LN_2) + 1, 4),
        ([UNITS, SUCCESS], ROUNDED, 1 + 3 * LN_2, 1),
    ],
)
def test_rounding_is_doubted_as_much_as_a_product_weighs(
    objectives: list[Objective], doubt: int, unit: int, half: int
) -> None:
    costs = costs_of("1/2", "1", "1", objectives=levels(tuple(objectives)))
    assert costs.doubt == doubt
    assert costs(1) == unit
    assert costs(0) == unit + half * LN_2


@pytest.mark.parametrize("rate", [Fraction(1, 10**9), Fraction(10**9 - 1, 10**9), Fraction(1)])
def test_the_finest_rates_are_told_apart(rate: Fraction) -> None:
    costs = costs_of(rate, "1/2")
    assert dict(costs.figures(0))[SUCCESS] >= 0
    assert (costs.doubt > 0) == (costs.doubt == 3 * ROUNDED)


@pytest.mark.parametrize(
    "rate", [Fraction(0), Fraction(1, 10**9 + 1), Fraction(10**9, 10**9 + 1), Fraction(3, 2), Fraction(-1, 2)]
)
def test_rates_that_are_too_fine_or_none_are_refused(rate: Fraction) -> None:
    with pytest.raises(TooFineError):
        costs_of("1/2", rate)
    # where rates do not count, or the unit does not, nothing is refused
    assert costs_of("1/2", rate, objectives=(UNITS,))(1) == 1
    assert ExactCosts(posed("1/2", rate), (SUCCESS, UNITS), [0])(0) == 2 * LN_2 + 1


@pytest.mark.parametrize(
    ("rates", "expected"),
    [
        (["1/2"], "0.500000000000000001"),  # 18 digits, rounded up
        (["1/2", "1/4"], "0.125000000000000001"),
        (["1/3", "1/4"], "0.0833333333333333334"),
        (["1/100", "1/3"], "0.00333333333333333334"),
        (["1"], "1"),
        (["1", "1", "1"], "1"),
        (["9999999/10000000"], "0.999999900000000001"),
    ],
)
def test_a_bound_on_success_is_rounded_up(rates: list[str], expected: str) -> None:
    costs = costs_of(*rates)
    assert costs.first(sum(map(costs, range(len(rates))))) == Fraction(expected)


def test_a_bound_on_success_allows_for_rounding() -> None:
    costs = costs_of("1/2", "1")
    factor = 3  # two units may come after
    for figure in (0, 1, ROUNDED):
        assert costs.first(factor * figure) == 1
    # what is more than rounding comes to lowers the bound: 100 of it are 10 ** -18 of 1
    assert costs.first(factor * 101 * ROUNDED) == 1
    assert costs.first(factor * 102 * ROUNDED) == 1 - Fraction(1, 10**18)
    assert costs.first(factor * LN_2 - 1) == costs.first(factor * (LN_2 - 1))


def test_sums_of_logarithms_are_told_from_others_beyond_rounding() -> None:
    costs = costs_of("1/2", "1/3", "3/4")
    product = Fraction(1, 2) * Fraction(1, 3) * Fraction(3, 4)
    total = sum(dict(costs.figures(a))[SUCCESS] for a in range(3))
    assert costs.is_logarithm(total, product)
    for figure, of in ((3 * LN_2, product), (0, Fraction(1))):
        assert costs.is_logarithm(figure, of)
        assert costs.is_logarithm(figure + ROUNDED - 1, of)
        assert costs.is_logarithm(figure - ROUNDED + 1, of)
        assert not costs.is_logarithm(figure + ROUNDED, of)
        assert not costs.is_logarithm(figure - ROUNDED, of)
    assert not costs.is_logarithm(-3 * LN_2, product)
    assert costs.is_logarithm(LN_3 - LN_2, Fraction(2, 3))


def cut(members: tuple[int, ...], cheapest: int, weight: int) -> WeightedCut:
    return WeightedCut(frozenset({90}), members, cheapest, weight)


@contextmanager
def longest(factors: int, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Have products of no more factors compared."""
    with monkeypatch.context() as patched:
        patched.setattr(exact_costs, "_LONGEST", factors)
        yield


def test_bounds_without_rates_are_met_as_numbers() -> None:
    costs = costs_of("1/2", "1/2", objectives=(UNITS,))
    assert [costs.met(Cuts(bound, {}, []), {0, 1}) for bound in (0, 1, 2, 3)] == [False, False, True, True]


def test_a_bound_has_to_be_proved_by_products_of_rates() -> None:
    costs = costs_of("1/2", "1/4", "1/8")
    one, two, three = map(costs, range(3))
    # 1/2 in a cut of its own, and in one with the others what it has less than they
    own = Cuts(one, {0: 0}, [cut((0,), 0, one)])
    assert costs.met(own, {0}) is True
    assert costs.met(own, {1}) is False
    assert not costs.met(own._replace(bound=two), {1})  # so it is said, but not proved
    both = [cut((0, 1, 2), 0, one), cut((1, 2), 1, two - one)]
    assert costs.met(Cuts(two, {0: 0, 1: 0, 2: three - two}, both), {1}) is True
    assert costs.met(Cuts(two, {0: 0, 1: 0, 2: three - two}, both), {2}) is False
    assert costs.met(Cuts(two, {0: 0, 1: 0, 2: three - two}, both), {0}) is True
    # 1/2 and 1/4 are as good as 1/8, with one unit more
    apart = Cuts(one + two, {0: 0, 1: 0}, [cut((0,), 0, one), cut((1,), 1, two)])
    assert costs.met(apart, {2}) is True
    assert costs.met(apart, {0, 1}) is True
    assert costs.met(Cuts(three, {2: 0}, [cut((2,), 2, three)]), {0, 1}) is False
    assert costs.met(Cuts(three, {2: 0}, [cut((2,), 2, three)]), {2}) is True


def test_what_is_as_good_and_a_unit_less_is_no_bound_met() -> None:
    costs = costs_of("1", "1", "1/2", "1/3")
    one, _, half, _ = map(costs, range(4))
    assert one == 1
    assert costs.met(Cuts(2, {0: 0, 1: 0}, [cut((0,), 0, 1), cut((1,), 1, 1)]), {0, 1}) is True
    assert costs.met(Cuts(1, {0: 0}, [cut((0,), 0, 1)]), {0, 1}) is False
    assert costs.met(Cuts(1 + half, {0: 0, 2: 0}, [cut((0,), 0, 1), cut((2,), 2, half)]), {0, 2}) is True


def test_cuts_that_take_more_than_there_is_prove_nothing() -> None:
    # 0.9 and 0.900000001 differ by less than what is looked at anew
    costs = costs_of("0.9", "0.900000001", "0.9")
    first, second, third = map(costs, range(3))
    assert first == third > second
    both = cut((0, 1), 0, first)
    assert costs.met(Cuts(first, {0: 0, 1: second - first}, [both]), {0}) is False
    # nor does what takes back the surplus
    back = cut((1,), 1, second - first)
    assert costs.met(Cuts(second, {0: 0, 1: 0}, [both, back]), {1}) is False
    # a cut that is worth nothing does no harm
    fair = cut((0, 2), 0, first)
    nothing = cut((2,), 2, 0)
    assert costs.met(Cuts(first, {0: 0, 2: 0}, [fair, nothing]), {0}) is True
    # as many times as it is used, a cost is taken
    twice = [cut((0,), 0, first), cut((0, 2), 2, third)]
    assert costs.met(Cuts(first + third, {0: -first, 2: 0}, twice), {0, 2}) is False
    # a member that much is left of needs no second look, in whatever cut it is
    large = costs_of("1/2", "1/4")
    assert large.met(Cuts(large(0), {0: 0, 1: large(1) - large(0)}, [cut((1, 0), 0, large(0))]), {0}) is True


def test_products_of_very_many_factors_are_not_compared(monkeypatch: pytest.MonkeyPatch) -> None:
    costs = costs_of("1/2", "1/3", "1/5", objectives=(SUCCESS, UNITS))
    two, three, five = map(costs, range(3))
    left = {0: 0, 1: 0, 2: 0}
    apart = Cuts(two + three + five, left, [cut((0,), 0, two), cut((1,), 1, three), cut((2,), 2, five)])
    # a weight is a rate and a unit; so is what is left before; the tree is three of each
    with longest(2, monkeypatch):
        assert costs.met(apart, {0, 1, 2}) is True
    with longest(1, monkeypatch):
        assert costs.met(apart, {0, 1, 2}) is False
    # the second weight is one rate more and another less, and as many units
    nested = [cut((0, 1, 2), 0, two), cut((1, 2), 1, three - two), cut((2,), 2, five - three)]
    chain = Cuts(five, left, nested)
    with longest(2, monkeypatch):
        assert costs.met(chain, {2}) is True
    # what is proved is told from a tree of two more, by four; what is left of 2 is as much
    less = Cuts(two, {0: 0}, [cut((0,), 0, two)])
    for many, expected in ((2, True), (1, False)):
        with longest(many, monkeypatch):
            assert costs.met(less, {0}) is expected
    beside = Cuts(three - two, {1: 0}, [cut((1,), 1, three)])
    with longest(2, monkeypatch):
        assert costs.met(beside, {2}) is False


def test_coarse_costs_are_whole_and_below_what_they_guide_to() -> None:
    problem = replace(
        posed("0", "1/2", "1", "1/10", inputs=(1, 2, 3, 4)), own_rates={2: Fraction(2, 5), 3: Fraction(0)}
    )
    success = CoarseCosts(problem, SUCCESS)
    assert [success(a) for a in range(6)] == [100_000, 693, 916, 100_000, 0, 0]
    assert [CoarseCosts(problem, INPUTS)(a) for a in (0, 3, 4)] == [1, 4, 0]
    assert [CoarseCosts(problem, INGREDIENTS)(a) for a in (0, 3, 4)] == [3, 12, 0]
    assert [CoarseCosts(problem, KITCHEN)(a) for a in (0, 3, 4)] == [0, 0, 1]
    assert [CoarseCosts(replace(problem, rates=None, own_rates={}), UNITS)(a) for a in (0, 3, 4)] == [1, 1, 0]


TRIES = made_up(Row("tries", "attempts", lambda unit: 1 / unit.rate, needs=Known.RATES, whole=False))


def test_fractions_are_counted_in_steps_that_are_whole() -> None:
    problem = posed("1/2", "2/3", "1", inputs=(1, 2, 3))
    costs = ExactCosts(problem, (TRIES, UNITS), range(6))
    assert [dict(costs.figures(a))[TRIES] for a in range(6)] == [4, 3, 2, 0, 0, 0]  # halves
    assert list(map(costs, range(6))) == [7 * 4 + 1, 7 * 3 + 1, 7 * 2 + 1, 0, 0, 0]
    assert costs.doubt == 0
    assert [costs.total(TRIES, figure) for figure in (0, 1, 7)] == [0, Fraction(1, 2), Fraction(7, 2)]
    assert [costs.first(total) for total in (6, 7, 13, 49)] == [
        0,
        Fraction(1, 2),
        Fraction(1, 2),
        Fraction(7, 2),
    ]
    assert type(costs.total(UNITS, 3)) is int
    # before another one, it weighs as many steps as there are; only what is asked about counts
    assert ExactCosts(problem, (INPUTS, TRIES, UNITS), range(3))(1) == 2 * 4 * 10 + 4 * 3 + 1
    assert ExactCosts(problem, (TRIES, UNITS), [0, 2, 3, 4])(0) == 5 * 2 + 1


def test_coarse_costs_of_fractions_are_rounded_down() -> None:
    problem = posed("1/2", "2/3", "3/4", "1", inputs=(1, 2, 3, 1))
    assert [CoarseCosts(problem, TRIES)(a) for a in range(5)] == [2000, 1500, 1333, 1000, 0]


def test_where_no_unit_is_there_only_items_count() -> None:
    costs = ExactCosts(posed("1/2", "1", "1", inputs=(1, 2, 3)), (KITCHEN, SUCCESS, UNITS), [3, 4, 5])
    assert [costs(a) for a in (3, 4, 5)] == [4, 4, 4]


def test_what_an_action_costs_is_worked_out_once(monkeypatch: pytest.MonkeyPatch) -> None:
    counted: list[int] = []

    def figure(problem: Problem, objective: Objective, unit: int) -> int:
        counted.append(unit)
        return 5

    monkeypatch.setattr(Problem, "figure", figure)
    costs = costs_of("1", "1", objectives=(UNITS,))
    assert [costs(a) for a in (0, 1, 0, 1)] == [5, 5, 5, 5]
    assert counted == [0, 1]


def test_own_rates_of_units_count() -> None:
    problem = replace(posed("1/2", "1/2"), own_rates={1: Fraction(1, 3)})
    costs = ExactCosts(problem, (SUCCESS, UNITS), range(2))
    assert [costs.rate(a) for a in range(2)] == [Fraction(1, 2), Fraction(1, 3)]
    assert [costs(a) for a in range(2)] == [3 * LN_2 + 1, 3 * LN_3 + 1]
    assert prod(map(costs.rate, range(2))) == Fraction(1, 6)


def test_a_price_is_on_units_that_count_and_a_limit_is_met_by_a_bound_or_a_tree() -> None:
    costs = ExactCosts(posed("1", "1", "1", inputs=(1, 2, 3)), (INPUTS, KITCHEN, UNITS), range(6))
    plain = [28 + 1, 56 + 1, 84 + 1, 7, 7, 7]
    assert list(map(costs, range(6))) == plain
    priced = costs.priced(lambda action: action != 1, 1000)
    assert list(map(priced, range(6))) == [1029, 57, 1085, 7, 7, 7]
    assert list(map(costs, range(6))) == plain
    # more than all, which is a whole number of times what the first objective weighs
    assert sum(plain) < costs.beyond == 28 * 7
    assert [priced.met(Cuts(bound, {}, []), {0, 1}) for bound in (1085, 1086)] == [False, True]
    limited = costs.priced(lambda action: action != 1, 1000, 1086)
    assert [limited.met(Cuts(bound, {}, []), {0, 1}) for bound in (1085, 1086)] == [False, True]
    assert [limited.met(Cuts(0, {}, []), tree) for tree in ({0}, {2, 3}, {0, 1})] == [True, False, False]
    # at a fraction, all are whole
    third = costs.priced(lambda action: action != 1, Fraction(1, 3))
    assert list(map(third, range(6))) == [3 * 29 + 1, 3 * 57, 3 * 85 + 1, 21, 21, 21]
    halves = costs_of("1/2", "1/4")
    assert halves.priced(lambda action: True, Fraction(2, 3)).doubt == 3 * halves.doubt > 0
    # where rates are rounded, no bound proves anything with a price, which is no product of rates
    rounded = costs_of("1/2", "1/4").priced(lambda action: True, 5)
    assert [rounded.met(Cuts(rounded(0) + more, {}, []), {0}) for more in (-1, 0, 9)] == [False] * 3
