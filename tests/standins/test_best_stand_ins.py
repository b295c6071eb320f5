"""The best tree with stand-ins is that of brute force, with a certificate that holds."""

import os
import random
from dataclasses import replace
from fractions import Fraction

import pytest

import foon_asp
from foon_asp.certificate.certificate import subject_of
from foon_asp.errors import BugError
from foon_asp.network import STAND_IN, Edit, ObjectNode, StandInTable
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.proof import verifier
from foon_asp.standins import with_stand_ins
from tests.oracle import stand_ins
from tests.support.random_problems import random_problem

PRICES = (None, Fraction(1, 2), Fraction(1), Fraction(1), Fraction(2), Fraction(7, 3))
SEEDS = pytest.mark.parametrize(
    "seeds", [range(80), pytest.param(range(80, 5000), marks=pytest.mark.slow)], ids=["few", "many"]
)


def random_table(problem: Problem, seed: int) -> StandInTable:
    """Make a table in which prices collide, and some pairs are listed."""
    rng = random.Random(f"table {seed}")
    usual = StandInTable.usual()
    edits = {edit: rng.choice(PRICES) for edit in usual.edits}
    words = {
        (Edit.FEWER_STATE, "empty"): rng.choice(PRICES),
        (Edit.MORE_INGREDIENT, "salt"): rng.choice(PRICES),
    }
    labels = sorted({node.label for node in problem.network.objects})
    pairs: dict[tuple[str | ObjectNode, str | ObjectNode], Fraction | None] = {}
    for _ in range(4 if len(labels) > 1 else 0):
        label, other = rng.sample(labels, 2)
        pairs[label, other] = rng.choice(PRICES)
    for _ in range(2):
        node, other_node = rng.sample(problem.network.objects, 2)
        pairs[node, other_node] = rng.choice(PRICES)
    return StandInTable(edits, words, pairs)


def posed(seed: int) -> tuple[Problem, StandInTable]:
    """Make a problem that often lacks something, and a table for it."""
    rule = [*ContainerRule][seed % 2]
    problem = random_problem(seed, rule, units=7)
    return problem, random_table(problem, seed)


@SEEDS
def test_the_best_tree_is_that_of_brute_force(seeds: range) -> None:
    with_some = 0
    for seed in seeds:
        problem, table = posed(seed)
        extended = with_stand_ins(problem, table)
        answer = foon_asp.solve(extended, "dissimilarity,units")
        expected = stand_ins.best(problem, table, ("dissimilarity", "units"))
        if expected is None:
            assert answer.status == "infeasible", seed
            continue
        assert answer.costs is not None
        assert answer.costs.key((Objective.DISSIMILARITY, Objective.UNITS)) == expected, seed
        with_some += expected[0] > 0
    assert with_some > len(seeds) // 10


@SEEDS
def test_every_pair_gives_the_best_tree_by_other_objectives(seeds: range) -> None:
    for seed in list(seeds)[::3]:
        problem, table = posed(seed)
        extended = with_stand_ins(problem, table, everything=True)
        answer = foon_asp.solve(extended, "inputs,dissimilarity,units")
        expected = stand_ins.best(problem, table, ("inputs", "dissimilarity", "units"))
        order = Objective.INPUTS, Objective.DISSIMILARITY, Objective.UNITS
        assert (answer.costs and answer.costs.key(order)) == expected, seed


def test_certificates_hold_and_no_stand_in_may_be_missing() -> None:
    """Without a stand-in of the best tree, what is proved of the other trees is refused."""
    missing = 0
    for seed in range(45):
        problem, table = posed(seed)
        extended = with_stand_ins(problem, table)
        answer = foon_asp.solve(extended, "dissimilarity,units", certificate=os.devnull)
        assert answer.certificate is not None, seed
        verifier.verify(answer.certificate.content, subject_of(extended))
        network = extended.network
        for unit in [u for u in answer.ids or () if network.motions[u] == STAND_IN]:
            missing += 1
            smaller = replace(extended, network=replace(network.without([unit]), unit_numbers=()))
            with pytest.raises(BugError, match="refused: a stand-in is missing"):
                foon_asp.solve(smaller, "dissimilarity,units", certificate=os.devnull)
    assert missing > 5
