"""The objective ``attempts``: how often units are executed until each has succeeded once."""

from dataclasses import replace
from fractions import Fraction

import pytest

from foon_asp.asp import Settings, Status, solve
from foon_asp.certificate import certify
from foon_asp.certificate.certificate import subject_of
from foon_asp.errors import UserError
from foon_asp.hypergraph import ALL, NONE, Reduction
from foon_asp.problem import ContainerRule, Objective
from foon_asp.proof import verifier
from tests.conftest import Cli
from tests.oracle import task_trees
from tests.support.random_problems import random_problem
from tests.support.ways_problem import ways

BY = (Objective.ATTEMPTS,)


@pytest.mark.parametrize("reductions", [ALL, NONE])
@pytest.mark.parametrize(
    ("one", "other", "attempts"),
    [
        (["0.5", "0.5"], ["0.2"], 4),  # twice two, or five
        (["1", "1"], ["0.25"], 2),
        (["0.5"], ["0.7"], Fraction(10, 7)),
        # rounded to what clingo can add, both weigh the same
        (["0.7"], ["0.7000000001"], Fraction(10**10, 7000000001)),
        (["0.7000000001"], ["0.7"], Fraction(10**10, 7000000001)),
    ],
)
def test_two_units_that_mostly_succeed_are_tried_less_than_one_that_seldom_does(
    one: list[str], other: list[str], attempts: Fraction, reductions: frozenset[Reduction]
) -> None:
    found = solve(ways(one, other), BY, Settings(reductions=reductions))
    assert found.status is Status.OPTIMAL
    assert found.costs is not None
    assert found.costs.measure(Objective.ATTEMPTS) == found.bounds[Objective.ATTEMPTS] == attempts


@pytest.mark.slow
@pytest.mark.parametrize("rule", ContainerRule)
def test_the_best_are_those_of_brute_force_and_proved(rule: ContainerRule) -> None:
    proved = 0
    for seed in range(30):
        problem = random_problem(seed, rule)
        trees = list(task_trees.trees(problem))
        found = solve(problem, BY)
        assert (found.units is None) == (not trees)
        if found.units is None or found.costs is None:
            continue
        least = min((task_trees.measure(problem, tree, "attempts"), len(tree)) for tree in trees)
        assert (found.costs.measure(Objective.ATTEMPTS), found.costs.units) == least
        certificate = certify(problem, (*BY, Objective.UNITS), found.units)
        if certificate is not None:
            verified = verifier.verify(certificate.content, subject_of(problem))
            assert verified.costs is not None
            assert verified.costs[0] == least[0]
            proved += 1
    assert proved > 10


@pytest.mark.parametrize("reductions", ["all", "none"])
def test_it_needs_rates_and_no_other_objective_that_is_rounded(cli: Cli, reductions: str) -> None:
    with pytest.raises(UserError, match="needs the success rates of the motions"):
        solve(replace(ways(["0.5"], ["0.2"]), rates=None), BY)
    # also where the reductions would have settled it
    ran = cli("solve", "--goal", "ice", "--objective", "attempts,success", "--reduce", reductions)
    assert ran.code == 2
    assert "the objectives attempts and success have to be rounded for the solver" in ran.err
    shown = cli("solve", "--goal", "macaroni", "--objective", "attempts", "--reduce", reductions)
    assert "optimal by attempts (strict containers): 9 units, 21 inputs" in shown.out
    assert "attempts ≈ 9.761" in shown.out


def test_what_never_succeeds_has_no_number_of_attempts() -> None:
    problem = ways(["0.5", "0.5"], ["0.2"])
    never = replace(problem, rates=dict.fromkeys(problem.rates or {}, Fraction(0)))
    with pytest.raises(UserError, match="a success rate is 0, for which the objective attempts has no value"):
        solve(never, BY)
    assert solve(never, (Objective.UNITS,)).units == (2,)
    costs = never.costs([2])
    assert Objective.ATTEMPTS not in costs.measures
    with pytest.raises(ValueError, match=r"^'attempts' cannot be computed: it needs rates above 0$"):
        costs.measure(Objective.ATTEMPTS)
    assert costs.measure(Objective.SUCCESS) == 0
