"""The objective ``attempts``: how often units are executed until each has succeeded once."""

from dataclasses import replace
from fractions import Fraction

import pytest

from foon_asp.asp import Settings, Status, solve
from foon_asp.certificate import certify
from foon_asp.engines import Asked, cross_check
from foon_asp.errors import UserError
from foon_asp.problem import ContainerRule, Objective
from foon_asp.proof import verify
from foon_asp.questions.menu import menu
from foon_asp.questions.pareto import pareto
from foon_asp.reduce import ALL, NONE, Reduction
from tests import oracle
from tests.conftest import Cli
from tests.random_problems import random_problem
from tests.test_exact_success import two_ways

BY = (Objective.ATTEMPTS,)


@pytest.mark.parametrize("reductions", [ALL, NONE])
def test_two_units_that_mostly_succeed_are_tried_less_than_one_that_seldom_does(
    reductions: frozenset[Reduction],
) -> None:
    problem = two_ways(["0.5", "0.5"], ["0.2"])  # twice two, or five
    found = solve(problem, BY, Settings(reductions=reductions))
    assert found.units == (0, 1)
    assert found.costs is not None
    assert found.costs.measure(Objective.ATTEMPTS) == 4
    assert found.bounds[Objective.ATTEMPTS] == 4


def test_sums_that_differ_in_the_last_digit_are_told_apart() -> None:
    """Rounded to what clingo can add, both ways weigh the same."""
    for first, second, best in (("0.7", "0.7000000001", (1,)), ("0.7000000001", "0.7", (0,))):
        found = solve(two_ways([first], [second]), BY, Settings(reductions=NONE))
        assert (found.status, found.units) == (Status.OPTIMAL, best)


@pytest.mark.slow
@pytest.mark.parametrize("rule", ContainerRule)
def test_the_best_are_those_of_brute_force_and_proved(rule: ContainerRule) -> None:
    proved = 0
    for seed in range(60):
        problem = random_problem(seed, rule)
        trees = list(oracle.trees(problem))
        found = solve(problem, BY)
        assert (found.units is None) == (not trees)
        if found.units is None or found.costs is None:
            continue
        least = min((oracle.measure(problem, tree, "attempts"), len(tree)) for tree in trees)
        assert (found.costs.measure(Objective.ATTEMPTS), found.costs.units) == least
        certificate = certify(problem, (*BY, Objective.UNITS), found.units)
        if certificate is not None:
            given = problem.network, problem.kitchen, problem.rates, problem.utensils, problem.unit_prices
            verified = verify.verify(certificate.content, *given)
            assert verified.costs is not None
            assert verified.costs[0] == least[0]
            proved += 1
        if seed % 10 == 0:
            assert {check.engine: check.reason for check in cross_check(Asked(found))}["clingo"] is None
    assert proved > 20


def test_a_menu_adds_attempts_up_and_a_front_trades_them() -> None:
    problem = two_ways(["0.5", "0.5"], ["0.2"])
    found = pareto(problem, "units,attempts")
    assert [point.costs.key((Objective.UNITS, *BY)) for point in found.points] == [(1, 5), (2, 4)]
    kitchen = next(iter(problem.kitchen))
    assert "attempts" in menu(replace(problem, goals=(*problem.goals, kitchen)), "attempts").text()


def test_it_needs_rates_and_no_other_objective_that_is_rounded(cli: Cli) -> None:
    with pytest.raises(UserError, match="needs the success rates of the motions"):
        solve(replace(two_ways(["0.5"], ["0.2"]), rates=None), BY)
    ran = cli("solve", "--goal", "macaroni", "--objective", "attempts,success", "--reduce", "none")
    assert ran.code == 2
    assert "the objectives attempts and success have to be rounded for the solver" in ran.err
    shown = cli("solve", "--goal", "macaroni", "--objective", "attempts")
    assert "optimal by attempts (strict containers): 9 units, 21 inputs" in shown.out
    assert "attempts ≈ 9.761" in shown.out


def test_a_rate_of_one_is_one_attempt() -> None:
    found = solve(two_ways(["1", "1"], [str(Fraction(1, 4))]), BY)
    assert found.costs is not None
    assert found.costs.measure(Objective.ATTEMPTS) == 2


def test_what_never_succeeds_has_no_number_of_attempts() -> None:
    problem = two_ways(["0.5", "0.5"], ["0.2"])
    never = replace(problem, rates=dict.fromkeys(problem.rates or {}, Fraction(0)))
    with pytest.raises(UserError, match="a success rate is 0, for which the objective attempts has no value"):
        solve(never, BY)
    assert solve(never, (Objective.UNITS,)).units == (2,)
    costs = never.costs([2])
    assert Objective.ATTEMPTS not in costs.measures
    with pytest.raises(ValueError, match=r"^'attempts' cannot be computed: it needs rates above 0$"):
        costs.measure(Objective.ATTEMPTS)
    assert costs.measure(Objective.SUCCESS) == 0


def test_sums_of_more_digits_than_are_written_have_no_certificate() -> None:
    """Seven units of a rate with 900 digits each are tried 6,300 digits often."""
    rates = [f"0.{'9' * 899}{last}" for last in "1234567"]
    problem = two_ways(rates, ["0.1"])
    found = solve(problem, BY)
    assert found.status is Status.OPTIMAL
    assert found.units is not None
    assert certify(problem, (*BY, Objective.UNITS), found.units) is None
