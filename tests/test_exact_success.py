"""The success objective is exact: rates built to collide, scales too coarse to tell trees apart."""

import math
from decimal import Context, Decimal
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foon_asp.asp import Settings, Status, solve
from foon_asp.encoding import exact_success
from foon_asp.encoding.exact_success import rate_scale
from foon_asp.errors import UserError
from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Objective, Problem, parse_objectives
from foon_asp.questions.alternatives import alternatives
from foon_asp.questions.assist import assist
from foon_asp.reduce import ALL, NONE, Reduction
from tests import oracle
from tests.conftest import Cli
from tests.random_problems import random_problem


def two_ways(one: list[str], other: list[str]) -> Problem:
    """Ask for a goal with two chains of units that make it, with the given success rates."""
    builder = NetworkBuilder()
    rates: dict[str, Fraction] = {}
    goal = ObjectNode.of("goal")
    for name, chain in (("one", one), ("other", other)):
        before = ObjectNode.of("start")
        for step, rate in enumerate(chain):
            after = goal if step == len(chain) - 1 else ObjectNode.of(name, [str(step)])
            motion = f"{name} {step}"
            rates[motion] = Fraction(rate)
            builder.add(motion, [before], [after], Source("chains", step + 1))
            before = after
    network = builder.build()
    start, end = network.object_id(ObjectNode.of("start")), network.object_id(goal)
    assert start is not None
    assert end is not None
    return Problem(network, frozenset({start}), (end,), rates, frozenset(), ContainerRule.STRICT)


def motions(problem: Problem, objectives: list[str]) -> set[str]:
    outcome = solve(problem, parse_objectives(objectives))
    assert outcome.status is Status.OPTIMAL
    assert outcome.units is not None
    return {problem.network.motions[unit].split()[0] for unit in outcome.units}


def test_equal_products_are_told_apart_by_units_alone() -> None:
    assert motions(two_ways(["0.3", "0.3"], ["0.09"]), ["success"]) == {"other"}
    assert motions(two_ways(["0.09"], ["0.3", "0.3"]), ["success"]) == {"one"}
    assert motions(two_ways(["0.1", "0.9", "0.5"], ["0.3", "0.15"]), ["success"]) == {"other"}


@pytest.mark.parametrize(
    ("better", "worse"),
    [
        (["0.090000001"], ["0.3", "0.3"]),
        (["0.3", "0.300000001"], ["0.09"]),
        (["0.3", "0.3"], ["0.089999999"]),
        (["0.5"] * 9, ["0.001953124999999999999"]),
        (["0.001953125000000000001"], ["0.5"] * 9),
    ],
)
def test_products_that_differ_late_are_told_apart(better: list[str], worse: list[str]) -> None:
    assert motions(two_ways(better, worse), ["success"]) == {"one"}
    assert motions(two_ways(worse, better), ["success"]) == {"other"}


NEAR_1 = [
    (["0.99999999999"], ["0.999999999"]),  # both weigh 0 on a scale of 10^8
    (["0.9999999895"], ["0.999999991"] * 5),  # the chain weighs 0, the one unit 1
    (["1"], ["0." + "9" * 20]),
    (["0." + "9" * 31], ["0." + "9" * 30]),
    (["0." + "9" * 30 + "8"], ["0." + "9" * 30, "0." + "9" * 30]),
    (["0." + "9" * 39], ["0." + "9" * 38]),
    (["0." + "9" * 400], ["0." + "9" * 399 + "8"]),
    (["0.5", "0." + "9" * 13], ["0.5", "0." + "9" * 12]),
    (["0.5", "0." + "9" * 12, "0." + "9" * 12], ["0.25", "1"]),
    (["0." + "0" * 400 + "1", "0." + "9" * 400], ["0." + "0" * 400 + "1", "0." + "9" * 399]),
    (["0." + "0" * 200 + "2"], ["0." + "0" * 200 + "1"]),
    (["0." + "0" * 39 + "1"], ["0.1"] * 41),
]


@pytest.mark.parametrize(("better", "worse"), NEAR_1)
@pytest.mark.parametrize("encodings", [None, Path("by_need")])
@pytest.mark.parametrize("reductions", [ALL, NONE])
@pytest.mark.sampled(5)
def test_rates_next_to_1_and_0_are_told_apart(
    better: list[str], worse: list[str], encodings: Path | None, reductions: frozenset[Reduction]
) -> None:
    for problem, way in ((two_ways(better, worse), "one"), (two_ways(worse, better), "other")):
        for objectives in (["success"], ["kitchen", "success"], ["success", "inputs"]):
            how = Settings(encodings=encodings, reductions=reductions)
            outcome = solve(problem, parse_objectives(objectives), how)
            assert outcome.status is Status.OPTIMAL
            assert outcome.units is not None
            assert {problem.network.motions[unit].split()[0] for unit in outcome.units} == {way}


@pytest.mark.parametrize(("better", "worse"), NEAR_1)
def test_trees_come_in_order_next_to_1_and_0(better: list[str], worse: list[str]) -> None:
    for problem in (two_ways(better, worse), two_ways(worse, better)):
        ranked = alternatives(problem, "success", best=2)
        assert ranked.complete
        first, second = (tree.costs.success for tree in ranked.trees)
        assert first is not None
        assert second is not None
        assert first == max(math.prod(map(Fraction, way)) for way in (better, worse))
        assert first > second
        assert alternatives(problem, "success", best=1).trees == ranked.trees[:1]


@pytest.mark.parametrize(("better", "worse"), NEAR_1)
def test_a_person_helps_next_to_1_and_0(better: list[str], worse: list[str]) -> None:
    for problem in (two_ways(better, worse), two_ways(worse, better)):
        found = assist(problem, most=1)
        assert found.complete
        for row in found.rows:
            assert row.success == max(
                math.prod(sorted(map(Fraction, way))[row.most :]) for way in (better, worse)
            )


def test_products_of_long_rates_are_shown_in_full(cli: Cli, tmp_path: Path) -> None:
    units, rates = "//\n", ""
    for step in range(6):
        units += f"O1\tdough\nS1\t{step}\nM1\tstir {step}\nO1\tdough\nS1\t{step + 1}\n//\n"
        rates += f"stir {step}\t0.{'9' * 900}{step + 1}\n"
    (tmp_path / "FOON.txt").write_text(units)
    (tmp_path / "motion.txt").write_text(rates)
    (tmp_path / "kitchen.json").write_text('[{"label": "dough", "states": ["0"]}]')
    for objective in ("success", "units"):
        ran = cli(
            "solve", "--data", tmp_path, "--goal", "dough; 6", "--objective", objective, "--format", "json"
        )
        assert ran.code == 0
        above, below = map(Decimal, ran.json["costs"]["success"]["exact"].split("/"))
        assert math.prod(1 - Fraction(10 - n, 10**901) for n in range(1, 7)) == Fraction(above) / Fraction(
            below
        )


@pytest.mark.parametrize(("exponent", "units"), [(2**31 - 1, 1), (-(2**31) + 1, 1), (2**30 - 1, 2)])
def test_exponents_that_clingo_can_add_up_are_taken(
    exponent: int, units: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = two_ways(["0.1", "0.3"], ["0.2"])
    monkeypatch.setattr(exact_success, "_exponents", lambda rates: {rate: {0: exponent} for rate in rates})
    assert set(exact_success.problem_scale(problem, range(units)).weights) == {
        problem.rate(unit) for unit in range(units)
    }


@pytest.mark.parametrize(("exponent", "units"), [(2**31, 1), (-(2**31), 1), (2**30, 2), (2**31 // 3 + 1, 3)])
def test_exponents_that_clingo_could_not_add_up_are_refused(
    exponent: int, units: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = two_ways(["0.1", "0." + "0" * 200 + "1"], ["0.2"])
    assert solve(problem, (Objective.SUCCESS,)).status is Status.OPTIMAL
    monkeypatch.setattr(
        exact_success, "_exponents", lambda rates: {rate: {0: 0, 1: exponent} for rate in rates}
    )
    with pytest.raises(UserError) as refused:
        exact_success.problem_scale(problem, range(units))
    assert str(refused.value) == (
        "the success rates of the motions are too far apart: written as powers of common factors, "
        f"the exponents of {units} units add up to more than clingo's numbers hold"
    )


def test_no_units_have_a_scale_too() -> None:
    scale = exact_success.problem_scale(two_ways(["0.5"], ["0.4"]), [])
    assert scale == (10**8, {}, {})


@pytest.mark.parametrize(
    ("rates", "scale", "weights"),
    [
        ([], 10**8, []),
        (["1"], 10**8, [0]),
        (["0.5", "1"], 10**8, [69_314_718, 0]),  # ln 2 = 0.693147180...
        (["0.1", "0.5"], 10**8, [230_258_509, 69_314_718]),  # ln 10 = 2.302585092...
        (["1/1000000000"], 10**8, [2_072_326_583]),
        (["1/10000000000"], 10**7, [230_258_509]),  # on the next finer scale 2,302,585,092 > 2^31
        (["1/10000000000", "0.99"], 10**7, [230_258_509, 100_503]),  # -ln 0.99 = 0.010050335...
        (["0.99999"], 10**8, [1000]),  # -ln = 0.000010000050...
        (["0.999990001"], 10**9, [9999]),  # -ln = 0.0000099990499...
        (["0.999990001", "0.5"], 10**9, [9999, 693_147_180]),
        (["0.999990001", "0.1"], 10**8, [999, 230_258_509]),  # 10^9 does not fit
        (["0.9999", "0.999999"], 10**9, [100_005, 1000]),
        (["0.9999999", "0.999999"], 10**10, [1000, 10_000]),
    ],
)
def test_scales_and_weights_by_hand(rates: list[str], scale: int, weights: list[int]) -> None:
    found = rate_scale(list(map(Fraction, rates)))
    assert found.scale == scale
    assert [found.weights[Fraction(rate)] for rate in rates] == weights


@pytest.mark.parametrize(("weight", "scale"), [("2147483646.5", 10**8), ("2147483647.5", 10**7)])
def test_weights_are_below_what_clingo_holds(weight: str, scale: int) -> None:
    """The greatest weight that is given out is 2^31 - 2 on a scale of 10^8."""
    rate = Fraction(Context(prec=60).exp(-Decimal(weight) / 10**8))
    found = rate_scale({rate})
    assert found.scale == scale
    assert found.weights[rate] == int(Decimal(weight) * scale / 10**8)


# The digits that a rate has in common with the power of e which would weigh a whole number.
@pytest.mark.parametrize("common", [12, 37, 41, 43, 60, 81, 84, 130, 260])
@pytest.mark.parametrize(
    "logarithm",
    ["1", "3", "1e-8", "7.9431e-20", "8.1234567e-40", "1.12358e-40", "9.8765e-41", "8.7654321e-80", "1e-81"],
)
def test_a_whole_number_is_just_reached_or_just_missed(logarithm: str, common: int) -> None:
    """Of two neighbours of such a power of e one weighs less than the whole number, the other does not."""
    context = Context(prec=2 * common + 200)
    middle = context.exp(-Decimal(logarithm))
    off = Decimal(logarithm).scaleb(-common)
    scale = 10 ** (9 - Decimal(logarithm).adjusted())
    whole = int(Decimal(logarithm) * scale)
    assert exact_success._weight(Fraction(context.add(middle, off)), scale) == whole - 1
    assert exact_success._weight(Fraction(context.subtract(middle, off)), scale) == whole


@pytest.mark.parametrize("zeros", [1, 8, 30, 39, 40, 41, 100])
def test_weights_next_to_1_are_rounded_down(zeros: int) -> None:
    for tenths in (1, 5, 9, 11, 15, 19):
        assert (
            exact_success._weight(1 - Fraction(tenths, 10 ** (zeros + 9)), 10 ** (zeros + 8)) == tenths // 10
        )


def test_exponents_by_hand() -> None:
    """0.3 is 3/10 and 0.09 is 3^2/10^2; 0.7 brings 7 along, and 0.5 takes 10 apart."""
    three, nine, seven, half = Fraction("0.3"), Fraction("0.09"), Fraction("0.7"), Fraction("0.5")
    two = rate_scale({three, nine, Fraction(1)})
    assert sorted(two.exponents[three].values()) == [-1, 1]
    assert sorted(two.exponents[nine].values()) == [-2, 2]
    assert two.exponents[Fraction(1)] == {}
    assert two.product_exponents([]) == {0: 0, 1: 0}
    assert two.product_exponents([three, three]) == two.product_exponents([nine]) == two.exponents[nine]
    assert sorted(two.product_exponents([three, nine, three, Fraction(1)]).values()) == [-4, 4]
    four = rate_scale([three, seven, half])
    assert sorted(four.exponents[three].values()) == sorted(four.exponents[seven].values()) == [-1, -1, 1]
    assert list(four.exponents[half].values()) == [-1]
    assert sorted(four.product_exponents([three, seven, half]).values()) == [-3, -2, 1, 1]
    (of_two,) = four.exponents[half]
    assert four.exponents[three][of_two] == -1
    assert rate_scale({Fraction(8, 27), Fraction(4, 9)}).product_exponents([Fraction(8, 27)] * 2) == (
        rate_scale({Fraction(8, 27), Fraction(4, 9)}).product_exponents([Fraction(4, 9)] * 3)
    )


@pytest.mark.parametrize("rate", [Fraction(0), Fraction(-1, 2), Fraction(3, 2)])
def test_what_is_no_rate_is_refused(rate: Fraction) -> None:
    with pytest.raises(ValueError, match="above 0"):
        rate_scale({rate})


@settings(deadline=None, derandomize=True)
@given(
    st.integers(min_value=1, max_value=10**9),
    st.integers(min_value=9, max_value=120),
    st.integers(min_value=0, max_value=130),
)
def test_weights_next_to_1_are_exact(lost: int, zeros: int, scale: int) -> None:
    """Hold a weight against bounds of the logarithm that are fractions: x + x^2/2 < -ln(1 - x) < x + x^2."""
    part = Fraction(lost, 10 ** (zeros + 1))
    weight = exact_success._weight(1 - part, 10**scale)
    assert weight <= 10**scale * (part + part**2)
    assert weight + 1 > 10**scale * (part + part**2 / 2)


@pytest.mark.parametrize("scale", [1, 2, 3, 10, 1000, 10**8])
@pytest.mark.parametrize("rate", ["1", "0.99", "0.9", "1/3", "0.37", "0.36", "1/1000000000", "0.999999999"])
def test_weights_of_every_scale_are_rounded_down(rate: str, scale: int) -> None:
    """Half a hundred digits of the logarithm are enough to know the whole part."""
    exact = Fraction(rate)
    context = Context(prec=50)
    logarithm = -context.ln(context.divide(exact.numerator, exact.denominator))
    assert exact_success._weight(exact, scale) == math.floor(Fraction(logarithm) * scale)


def test_a_scale_is_as_fine_as_the_dearest_rate_lets_it_be() -> None:
    for digits in (1, 9, 10, 90, 100, 900, 9_000):
        scale = rate_scale({Fraction(1, 10**digits), Fraction(1, 2)})
        most = scale.scale * digits * math.log(10)
        assert most < 2**31 <= max(10 * most, 10**8 * most / scale.scale)
        assert scale.scale in {10**k for k in range(9)}


def test_a_scale_is_finer_next_to_1_alone() -> None:
    assert rate_scale({Fraction(17, 20), Fraction(1)}).scale == 10**8
    for zeros in (30, 60, 500):
        near = {1 - Fraction(n, 10**zeros) for n in (1, 2, 7)}
        assert list(rate_scale(near).weights.values()) == [70_000, 20_000, 10_000]
    assert min(rate_scale({*near, Fraction(1, 2)}).weights.values()) == 0


def test_rounding_alone_would_choose_the_worse_tree() -> None:
    # Twelve equal rates, each rounded down by almost 1, look cheaper than one rate that is better.
    rate = max(
        (Fraction(n, 1000) for n in range(100, 1000)),
        key=lambda r: -(10**8) * math.log(r) % 1,
    )
    chain = [f"{float(rate):.3f}"] * 12
    product = rate**12
    alone = Decimal(product.numerator) / Decimal(product.denominator) * (1 + Decimal("3e-8"))
    problem = two_ways(chain, [str(alone)])
    assert problem.rates is not None
    weights = rate_scale(set(problem.rates.values())).weights
    assert sum(weights[problem.rates[f"one {n}"]] for n in range(12)) < weights[problem.rates["other 0"]]
    assert problem.rates["other 0"] > product
    assert motions(problem, ["success"]) == {"other"}


@pytest.mark.slow
@pytest.mark.parametrize("rule", list(ContainerRule))
@pytest.mark.parametrize("scale", [1, 7])
@pytest.mark.sampled(6)
def test_a_coarse_scale_still_gives_the_exact_optimum(
    scale: int, rule: ContainerRule, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(exact_success, "_scale", lambda _: scale)
    for seed in range(3000, 3150):
        problem = random_problem(seed, rule)
        found = list(oracle.trees(problem))
        for objectives in (["success"], ["kitchen", "success"], ["success", "inputs"]):
            expected = oracle.best(found, problem, objectives)
            outcome = solve(problem, parse_objectives(objectives))
            if expected is None:
                assert outcome.status is Status.INFEASIBLE
            else:
                assert outcome.units is not None
                tree = tuple(map(problem.network.unit, outcome.units))
                assert oracle.key(problem, tree, objectives) == expected


rates_strategy = st.lists(
    st.decimals(min_value=Decimal("0.001"), max_value=1, places=9).map(Fraction), min_size=1, max_size=6
)


@pytest.mark.slow
@settings(deadline=None, derandomize=True)
@given(rates_strategy)
def test_weights_round_down_by_less_than_one(rates: list[Fraction]) -> None:
    scale = rate_scale(set(rates))
    for rate in rates:
        exact = -scale.scale * math.log(rate)
        assert scale.weights[rate] <= exact + 1e-4
        assert scale.weights[rate] > exact - 1 - 1e-4
        assert 0 <= scale.weights[rate] < 2**31


@settings(deadline=None, derandomize=True)
@given(rates_strategy, rates_strategy)
def test_exponents_tell_products_apart(one: list[Fraction], other: list[Fraction]) -> None:
    scale = rate_scale({*one, *other})
    same = math.prod(one) == math.prod(other)
    assert (scale.product_exponents(one) == scale.product_exponents(other)) is same


@settings(deadline=None, derandomize=True)
@given(rates_strategy)
def test_the_bound_on_success_holds(rates: list[Fraction]) -> None:
    scale = rate_scale(set(rates))
    bound = scale.success_bound(sum(scale.weights[rate] for rate in rates))
    assert math.prod(rates) <= bound <= 1


@pytest.mark.parametrize(
    ("scale", "weight", "bound"),
    [
        (10, 0, "1"),
        (10**30, 1, "1"),
        (10, 5, "0.606530659712633425"),  # e^-0.5 = 0.606530659712633423603...
        (10**8, 69_314_718, "0.500000000279972656"),  # 0.500000000279972654784...
        (1, 1, "0.367879441171442323"),  # 0.367879441171442321595...
        (1, 10, "0.0000453999297624848517"),  # 0.0000453999297624848515355...
    ],
)
def test_bounds_on_success_by_hand(scale: int, weight: int, bound: str) -> None:
    """Rounded up at the eighteenth digit, and one more."""
    assert exact_success.RateScale(scale, {}, {}).success_bound(weight) == Fraction(bound)


def test_a_bound_on_next_to_nothing_is_close() -> None:
    """A thousand units of 10^-999 and more are below what decimals have by default."""
    bound = exact_success.RateScale(1, {}, {}).success_bound(2_303_000)  # ln 2 * 3,322,526.7
    assert bound.denominator.bit_length() - bound.numerator.bit_length() >= 3_322_526


def test_tiny_rates_still_fit() -> None:
    scale = rate_scale({Fraction(1, 10**300), Fraction(1, 2)})
    assert max(scale.weights.values()) < 2**31
    assert motions(two_ways(["0." + "0" * 40 + "1"], ["0." + "0" * 40 + "2"]), ["success"]) == {"other"}


def test_success_needs_rates() -> None:
    problem = two_ways(["0.5"], ["0.4"])
    unrated = Problem(
        problem.network, problem.kitchen, problem.goals, None, problem.utensils, problem.containers
    )
    with pytest.raises(Exception, match="needs the success rates"):
        solve(unrated, (Objective.SUCCESS,))
    assert solve(unrated, (Objective.UNITS,)).status is Status.OPTIMAL
