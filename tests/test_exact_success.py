"""The success objective is exact: rates built to collide, scales too coarse to tell trees apart."""

import math
from decimal import Decimal
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foon_asp.asp import Status, exact_success, solve
from foon_asp.asp.exact_success import rate_scale
from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Objective, Problem, parse_objectives
from tests import oracle
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


@pytest.mark.parametrize("rule", list(ContainerRule))
@pytest.mark.parametrize("scale", [1, 7])
def test_a_coarse_scale_still_gives_the_exact_optimum(
    scale: int, rule: ContainerRule, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(exact_success, "_SCALES", (scale,))
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
