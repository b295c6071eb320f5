"""Certificates under the ready-made constraints: found for every answer, and true by brute force."""

import random
from collections import Counter
from dataclasses import replace
from fractions import Fraction

import pytest

from foon_asp.asp import Proof, Status, solve
from foon_asp.certificate import Certificate, certify_outcome, coverage
from foon_asp.certificate.certificate import subject_of
from foon_asp.network import UnitPrices
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.proof.certificate_json import read_certificate
from foon_asp.proof.rule_meaning import LIBRARY
from foon_asp.proof.verifier import verify
from tests.oracle import task_trees
from tests.oracle.constraints import keeps, random_rule, settings_of
from tests.support.gap_problem import gap_problem
from tests.support.random_problems import MOTIONS, USUAL, random_problem


def leaves(proof: object) -> Counter[str]:
    """Count the kinds of leaves of a proof, and its branches by what they are about."""
    assert isinstance(proof, dict)
    if "branch" in proof:
        return Counter(proof["branch"].keys()) + leaves(proof["without"]) + leaves(proof["using"])
    return Counter(proof.keys())


def asked(seed: int, problem: Problem, objective: Objective) -> Certificate:
    """Solve and certify a problem under one or two random constraints, and hold both against all trees."""
    rng = random.Random(seed)
    drawn = {rule["rule"]: rule for rule in (random_rule(rng, problem) for _ in range(rng.choice([1, 1, 2])))}
    settings = settings_of([*drawn.values()])
    assert coverage(settings).not_covered == ()
    outcome, found = certify_outcome(solve(problem, (objective,), settings), settings)
    assert found is not None
    assert outcome.proof is Proof.CERTIFICATE
    claim = verify(read_certificate(found.text()), subject_of(problem))
    assert sorted(map(str, claim.rules)) == sorted(map(str, drawn.values()))
    kept = [t for t in task_trees.trees(problem) if all(keeps(problem, t, rule) for rule in drawn.values())]
    best = task_trees.best(kept, problem, [str(objective)])
    if best is None:
        assert (outcome.status, claim.claim) == (Status.INFEASIBLE, "infeasible")
    else:
        assert claim.claim == "optimal"
        assert claim.tree is not None
        tree = tuple(map(problem.network.unit, claim.tree))
        assert {*tree} in map(set, kept)
        assert task_trees.key(problem, tree, [str(objective)]) == best
    return found


@pytest.mark.parametrize("part", [60, pytest.param(1, marks=pytest.mark.slow)])
def test_every_answer_under_random_constraints(part: int) -> None:
    met: Counter[str] = Counter()
    for seed in range(0, 1200, part):
        problem = random_problem(seed, list(ContainerRule)[seed % 2])
        if seed % 3 == 0:
            prices = {motion: Fraction(place * place, 10) for place, motion in enumerate(MOTIONS)}
            problem = replace(problem, unit_prices=UnitPrices(prices, {}))
        found = asked(seed, problem, USUAL[seed % len(USUAL)])
        met[found.claim] += 1
        met.update(rule["rule"] for rule in found.content["rules"])
        met.update(leaves(found.content["proof"]))
    assert {"optimal", "infeasible", "weights", "hopeless"} <= met.keys()
    if part == 1:
        assert met.keys() >= LIBRARY.keys() | {"limits", "broken", "unit"}


@pytest.mark.slow
def test_gaps_under_constraints_are_closed_by_branching() -> None:
    met: Counter[str] = Counter()
    for seed in range(24):
        found = asked(seed, gap_problem(seed % 4, 3), list(Objective)[seed % 4])
        met.update(leaves(found.content["proof"]))
    assert met.keys() >= {"limits", "unit"}
