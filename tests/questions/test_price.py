"""The objective ``price``: the least sum of exact prices of units."""

import random
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.asp import Settings, Status, solve
from foon_asp.certificate import certify
from foon_asp.certificate.certificate import subject_of
from foon_asp.engines import ClaimedAnswer, cross_check
from foon_asp.errors import UserError
from foon_asp.hypergraph import ALL, NONE, Reduction
from foon_asp.network import FunctionalUnit, Network, UnitPrices
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.proof import verifier
from foon_asp.proof.certificate_header import seal
from foon_asp.proof.certificate_json import read_certificate
from foon_asp.proof.refusal import RefusedError
from foon_asp.questions.pareto import pareto
from tests.oracle import task_trees
from tests.oracle.test_optimum import assert_agrees
from tests.questions.test_pareto import assert_agrees as assert_front_agrees
from tests.support.random_problems import (
    FREE,
    HUGE,
    LONG,
    PRICES,
    TINY,
    random_problem,
    random_steps,
)
from tests.support.ways_problem import ways

BY = (Objective.PRICE,)
RULES = list(ContainerRule)
FAMILIES = {"sums": PRICES, "free": FREE, "tiny": TINY, "huge": HUGE, "long": LONG}


def priced_ways(one: list[str], other: list[str]) -> Problem:
    """Ask for a goal with two chains of units that make it, at these prices."""
    problem = ways(["1"] * len(one), ["1"] * len(other))
    prices = dict(zip(problem.network.motions, map(Fraction, (*one, *other)), strict=True))
    return replace(problem, unit_prices=UnitPrices(prices, {}))


def priced(network: Network, family: tuple[str, ...], seed: int) -> UnitPrices:
    """Draw prices of one family for all motions, and for some units."""
    rng = random.Random(seed)
    motions = {motion: Fraction(rng.choice(family)) for motion in dict.fromkeys(network.motions)}
    some = rng.sample(range(len(network)), len(network) // 3)
    return UnitPrices(motions, {network.unit(unit): Fraction(rng.choice(family)) for unit in some})


LARGEST = str(2**31 - 1)
HANDS: list[tuple[list[str], list[str], int]] = [
    (["0.1", "0.2"], ["0.3"], 1),  # as cheap, with fewer units
    (["0.1", "0.2"], ["0.30000000000000004"], 0),
    (["0", "0"], ["0.0000000000000000000000000000001"], 0),
    ([LARGEST, LARGEST, LARGEST], [str(3 * (2**31 - 1) + 1)], 0),  # the sums do not fit 32 bits
    ([LARGEST, LARGEST, LARGEST], [str(3 * (2**31 - 1) - 1)], 1),
    (["4294967296", "0.5"], ["1"], 1),  # 2**32, which wraps to 0
    (["1" + "0" * 40, "0.1"], ["1" + "0" * 40 + ".2"], 0),
    (["9" * 999, "1"], ["1" + "0" * 999 + "." + "0" * 998 + "1"], 0),
]


@pytest.mark.parametrize("reductions", [ALL, NONE])
@pytest.mark.parametrize(("one", "other", "best"), HANDS)
def test_sums_are_compared_to_the_last_digit(
    one: list[str], other: list[str], best: int, reductions: frozenset[Reduction]
) -> None:
    problem = priced_ways(one, other)
    chosen, first = (one, 0) if best == 0 else (other, len(one))
    found = solve(problem, BY, Settings(reductions=reductions))
    assert found.status is Status.OPTIMAL
    assert sorted(found.units or ()) == [*range(first, first + len(chosen))]
    assert found.bounds[Objective.PRICE] == sum(map(Fraction, chosen))


# --- against brute force


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("make", [random_problem, random_steps])
@pytest.mark.default_cases(
    "random_problem-strict-free", "random_problem-implied-tiny", "random_problem-strict-huge"
)
def test_the_best_are_those_of_brute_force_in_every_room(
    make: Callable[[int, ContainerRule], Problem], rule: ContainerRule, family: str
) -> None:
    for seed in range(8):
        problem = make(seed, rule)
        problem = replace(problem, unit_prices=priced(problem.network, FAMILIES[family], seed))
        trees = list(task_trees.trees(problem))
        for reductions in (ALL, NONE):
            assert_agrees(problem, ["price"], trees, Settings(reductions=reductions))
        second = ("units", "inputs", "kitchen", "inputs+ingredients")[seed % 4]
        assert_agrees(problem, ["price", second], trees)
        assert_agrees(problem, [second, "price"], trees, Settings(encodings=Path("by_need")))
        found = solve(problem, BY)
        if found.units is None:
            continue
        certificate = certify(problem, (*BY, Objective.UNITS), found.units)
        assert certificate is not None
        proved = verifier.verify(read_certificate(certificate.text()), subject_of(problem))
        assert (proved.claim, proved.costs) == ("optimal", task_trees.best(trees, problem, ["price"]))
        if seed % 4 == 0:
            clingo, *_ = cross_check(ClaimedAnswer(found))
            assert (clingo.engine, clingo.reason) == ("clingo", None)
        if seed % 4 == 1:
            assert_front_agrees(pareto(problem, "units,price"), trees)


# --- fronts, menus, levels, stores


@pytest.mark.parametrize(
    ("problem", "objective", "points"),
    [
        (priced_ways(["0.1", "0.2"], ["0.5"]), "price", [(1, Fraction(1, 2)), (2, Fraction(3, 10))]),
        (ways(["0.5", "0.5"], ["0.2"]), "attempts", [(1, 5), (2, 4)]),
    ],
)
def test_goals_add_up_and_a_front_trades(
    problem: Problem, objective: str, points: list[tuple[int, Fraction]]
) -> None:
    found = pareto(problem, ["units", objective])
    assert [*found.values] == points
    kitchen = next(iter(problem.kitchen))
    added = foon_asp.solve(replace(problem, goals=(*problem.goals, kitchen)), objective)
    assert added.sum_of_goals_alone == points[1][1]


def test_a_bound_on_sums_that_wrap_is_refused() -> None:
    """With the best tree by success for 2^31, clingo took "above 2^31 - 1" for "from -2^31 on"."""
    problem = ways(["1", "1"], ["0.5"])
    for first in (2**31 - 4, 2**31 - 1):
        prices = dict(zip(problem.network.motions, map(Fraction, (first, 1, 2)), strict=True))
        asked = replace(problem, unit_prices=UnitPrices(prices, {}))
        if first == 2**31 - 4:
            found = pareto(asked, "success,price")
            assert [point[1] for point in found.values] == [2147483645, 2]
    with pytest.raises(UserError, match="by the objective price all units together cost more than fits"):
        pareto(asked, "success,price")
    assert len(pareto(asked, "units,price").points) == 1  # what leads needs no bound


# --- what is refused


def test_no_other_objective_may_be_rounded() -> None:
    problem = priced_ways(["1" + "0" * 40, "0.1"], ["1"])
    rates = {motion: Fraction(7 * 10**9 + 1 + n, 10**10) for n, motion in enumerate(problem.network.motions)}
    with pytest.raises(UserError, match="the objectives price and attempts have to be rounded"):
        solve(replace(problem, rates=rates), (*BY, Objective.ATTEMPTS), Settings(reductions=NONE))


def forged(problem: Problem, **values: Any) -> Any:
    """Change a certificate of the first way, and seal it anew."""
    certificate = certify(problem, (*BY, Objective.UNITS), (0, 1))
    assert certificate is not None
    content = {**certificate.content, **values}
    return {**content, "seal": seal(content)}


def test_certificates_by_wrong_prices_are_refused() -> None:
    problem = priced_ways(["0.1", "0.2"], ["0.5"])
    prices = problem.unit_prices
    assert prices is not None
    given = subject_of(problem)
    for costs in (["1/5", 2], ["3/10", 3], [0, 2], ["0.3", 2]):
        with pytest.raises(RefusedError, match="the tree costs"):
            verifier.verify(forged(problem, costs=costs), given)
    one, two, other = problem.network.motions
    unit = problem.network.unit
    for wrong, said in (
        (None, "a claim needs prices, but none are given"),
        (UnitPrices({one: Fraction(1, 10), two: Fraction(1, 5)}, {}), "a unit has none of the prices"),
        (UnitPrices({**prices.motions, other: Fraction(-1)}, {}), "one of the prices is below 0"),
        (UnitPrices(prices.motions, {unit(2): Fraction(1, 5)}), "carries more than it costs|do not add up"),
        (UnitPrices(prices.motions, {unit(0): Fraction(0)}), "the tree costs"),
    ):
        priced = given._replace(prices=wrong)
        content = forged(problem, digests=priced.digests())
        with pytest.raises(RefusedError, match=said):
            verifier.verify(content, priced)
    # of a unit that is not here, and so of no account
    free = FunctionalUnit("go 0 0", unit(0).inputs, unit(0).inputs)
    also = UnitPrices(prices.motions, {free: Fraction(0), unit(2): Fraction(1, 2)})
    priced = given._replace(prices=also)
    content = forged(problem, digests=priced.digests())
    assert verifier.verify(content, priced).claim == "optimal"
