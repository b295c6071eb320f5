"""The success objective is exact: rates built to collide, scales too coarse to tell trees apart."""

import math
from dataclasses import replace
from decimal import Context, Decimal
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foon_asp.asp import Settings, Status, solve
from foon_asp.encoding.rate_scale import RateScale, problem_scale, rate_scale
from foon_asp.errors import UserError
from foon_asp.hypergraph import NONE
from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Objective, Problem, parse_objectives
from foon_asp.questions.alternatives import alternatives
from foon_asp.questions.assist import assist
from tests.conftest import Cli


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


def motions(problem: Problem, objectives: list[str], how: Settings | None = None) -> set[str]:
    outcome = solve(problem, parse_objectives(objectives), how)
    assert outcome.status is Status.OPTIMAL
    assert outcome.units is not None
    return {problem.network.motions[unit].split()[0] for unit in outcome.units}


NEAR_1 = [
    (["0.99999999999"], ["0.999999999"]),  # both weigh 0 on a scale of 10^8
    (["0.9999999895"], ["0.999999991"] * 5),  # the chain weighs 0, the one unit 1
    (["1"], ["0." + "9" * 20]),
    (["0." + "9" * 30 + "8"], ["0." + "9" * 30, "0." + "9" * 30]),
    (["0." + "9" * 400], ["0." + "9" * 399 + "8"]),
    (["0.5", "0." + "9" * 12, "0." + "9" * 12], ["0.25", "1"]),
    (["0." + "0" * 400 + "1", "0." + "9" * 400], ["0." + "0" * 400 + "1", "0." + "9" * 399]),
    (["0." + "0" * 200 + "2"], ["0." + "0" * 200 + "1"]),
    (["0." + "0" * 39 + "1"], ["0.1"] * 41),
]


@pytest.mark.parametrize(
    "how",
    [
        Settings(),
        Settings(reductions=NONE),
        pytest.param(Settings(reductions=NONE, encodings=Path("by_need")), marks=pytest.mark.slow),
    ],
    ids=["reduced", "not reduced", "by need"],
)
@pytest.mark.parametrize(
    ("better", "worse"),
    [
        (["0.09"], ["0.3", "0.3"]),  # the same product, with fewer units
        (["0.3", "0.300000001"], ["0.09"]),
        (["0.5"] * 9, ["0.001953124999999999999"]),
        (["0." + "0" * 40 + "2"], ["0." + "0" * 40 + "1"]),
        *NEAR_1[:3],
        *NEAR_1[-3:],
    ],
)
def test_products_that_differ_late_are_told_apart(better: list[str], worse: list[str], how: Settings) -> None:
    for objectives in (["success"], ["kitchen", "success"]):
        assert motions(two_ways(better, worse), objectives, how) == {"one"}
        assert motions(two_ways(worse, better), objectives, how) == {"other"}


@pytest.mark.parametrize(("better", "worse"), NEAR_1)
def test_trees_come_in_order_next_to_1_and_0(better: list[str], worse: list[str]) -> None:
    for problem in (two_ways(better, worse), two_ways(worse, better)):
        ranked = alternatives(problem, "success", best=2)
        assert ranked.complete
        products = [math.prod(map(Fraction, way)) for way in (better, worse)]
        assert [tree.costs.success for tree in ranked.trees] == products
        found = assist(problem, most=1)  # where a person does the hardest unit
        assert found.complete
        for row in found.rows:
            assert row.success == max(
                math.prod(sorted(map(Fraction, way))[row.most :]) for way in (better, worse)
            )


@pytest.mark.parametrize("objective", ["success", "units"])
def test_products_of_long_rates_are_shown_in_full(cli: Cli, tmp_path: Path, objective: str) -> None:
    units, rates = "//\n", ""
    for step in range(6):
        units += f"O1\tdough\nS1\t{step}\nM1\tstir {step}\nO1\tdough\nS1\t{step + 1}\n//\n"
        rates += f"stir {step}\t0.{'9' * 900}{step + 1}\n"
    (tmp_path / "FOON.txt").write_text(units)
    (tmp_path / "motion.txt").write_text(rates)
    (tmp_path / "kitchen.json").write_text('[{"label": "dough", "states": ["0"]}]')
    asked = "--data", tmp_path, "--goal", "dough; 6", "--objective", objective
    shown = cli("solve", *asked, "--format", "json").json["costs"]["success"]["exact"]
    above, below = map(Decimal, shown.split("/"))
    exact = math.prod(1 - Fraction(10 - n, 10**901) for n in range(1, 7))
    assert exact == Fraction(above) / Fraction(below)


@pytest.mark.parametrize("rate", [Fraction(1, 2**4096), Fraction(2**4096, 3**3000)], ids=["1/2", "2/3"])
def test_exponents_that_clingo_could_not_add_up_are_refused(rate: Fraction) -> None:
    """Beside 1/2, the rate is a power of 4,096, and each of the units may have it."""
    rates = {"one 0": rate, "other 0": Fraction(1, 2)}
    problem = replace(two_ways(["0.5"], ["0.2"]), rates=rates)
    units = [0, 1] * 2**18
    assert problem_scale(problem, units[1:]).weights.keys() == {*rates.values()}
    with pytest.raises(UserError) as refused:
        problem_scale(problem, units)
    assert str(refused.value) == (
        "the success rates of the motions are too far apart: written as powers of common factors, "
        "the exponents of 524288 units add up to more than clingo's numbers hold"
    )


@pytest.mark.parametrize(
    ("rates", "scale", "weights"),
    [
        ([], 10**8, []),
        (["0.5", "1"], 10**8, [69_314_718, 0]),  # ln 2 = 0.693147180...
        (["1/1000000000"], 10**8, [2_072_326_583]),
        (["1/10000000000", "0.99"], 10**7, [230_258_509, 100_503]),  # 2,302,585,092 > 2^31
        (["0.99999"], 10**8, [1000]),  # -ln = 0.000010000050...
        (["0.999990001", "0.5"], 10**9, [9999, 693_147_180]),  # -ln = 0.0000099990499...
        (["0.999990001", "0.1"], 10**8, [999, 230_258_509]),  # 10^9 does not fit
        (["0.9999999", "0.999999"], 10**10, [1000, 10_000]),
        ([str(1 - Fraction(n, 10**60)) for n in (1, 2, 7)], 10**64, [10_000, 20_000, 70_000]),
        (["1/" + "1" + "0" * 300], 10**6, [690_775_527]),
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
@pytest.mark.parametrize("common", [12, 41, 84, 260])
@pytest.mark.parametrize("logarithm", ["1", "1e-8", "8.1234567e-40", "1.12358e-40", "9.8765e-41", "1e-81"])
def test_a_whole_number_is_just_reached_or_just_missed(logarithm: str, common: int) -> None:
    """Of two neighbours of such a power of e one weighs less than the whole number, the other does not."""
    context = Context(prec=2 * common + 200)
    middle = context.exp(-Decimal(logarithm))
    off = Decimal(logarithm).scaleb(-common)
    scale = RateScale(10 ** (9 - Decimal(logarithm).adjusted()), {}, {})
    whole = int(Decimal(logarithm) * scale.scale)
    assert scale.weigh(Fraction(context.add(middle, off))) == whole - 1
    assert scale.weigh(Fraction(context.subtract(middle, off))) == whole


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
    weight = RateScale(10**scale, {}, {}).weigh(1 - part)
    assert weight <= 10**scale * (part + part**2)
    assert weight + 1 > 10**scale * (part + part**2 / 2)


rates_strategy = st.lists(
    st.decimals(min_value=Decimal("0.001"), max_value=1, places=9).map(Fraction), min_size=1, max_size=6
)


@settings(deadline=None, derandomize=True)
@given(rates_strategy, rates_strategy)
def test_exponents_tell_products_apart_and_weights_bound_them(
    one: list[Fraction], other: list[Fraction]
) -> None:
    scale = rate_scale({*one, *other})
    same = math.prod(one) == math.prod(other)
    assert (scale.product_exponents(one) == scale.product_exponents(other)) is same
    bound = scale.success_bound(sum(scale.weights[rate] for rate in one))
    assert math.prod(one) <= bound <= 1
    assert bound <= math.prod(one) * Fraction(math.exp((len(one) + 1) / scale.scale))


@pytest.mark.parametrize(
    ("scale", "weight", "bound"),
    [
        (10, 0, "1"),
        (10, 5, "0.606530659712633425"),  # e^-0.5 = 0.606530659712633423603...
        (10**8, 69_314_718, "0.500000000279972656"),  # 0.500000000279972654784...
        (1, 1, "0.367879441171442323"),  # 0.367879441171442321595...
        (1, 10, "0.0000453999297624848517"),  # 0.0000453999297624848515355...
        (1, 2_303_000, "6.42949423195623958e-1000181"),  # below what decimals have by default
    ],
)
def test_bounds_on_success_by_hand(scale: int, weight: int, bound: str) -> None:
    """Rounded up at the eighteenth digit, and one more."""
    assert RateScale(scale, {}, {}).success_bound(weight) == Fraction(bound)


def test_success_needs_rates() -> None:
    unrated = replace(two_ways(["0.5"], ["0.4"]), rates=None)
    with pytest.raises(UserError, match="needs the success rates"):
        solve(unrated, (Objective.SUCCESS,))
    assert solve(unrated, (Objective.UNITS,)).status is Status.OPTIMAL
