"""Pareto fronts, held against brute force over every tree of small networks."""

import random
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import combinations
from pathlib import Path

import pytest

from foon_asp.asp import Reporter, Settings
from foon_asp.errors import UserError
from foon_asp.explain.pareto import Front, pareto_front
from foon_asp.network import FunctionalUnit
from foon_asp.problem import ContainerRule, Costs, Objective, Problem
from tests import oracle
from tests.random_problems import MOTIONS, random_problem
from tests.test_alternatives import choosing

RULES = list(ContainerRule)
SETS = [some for size in (2, 3) for some in combinations(Objective, size)]
Point = tuple[Fraction, ...]


def measures(problem: Problem, tree: tuple[FunctionalUnit, ...], objectives: Sequence[Objective]) -> Point:
    return tuple(oracle.measure(problem, tree, objective) for objective in objectives)


def nondominated(points: set[Point]) -> set[Point]:
    """Give the points than which none is as small everywhere."""
    return {
        p
        for p in points
        if not any(q != p and all(a <= b for a, b in zip(q, p, strict=True)) for q in points)
    }


def assert_agrees(front: Front, trees: Sequence[tuple[FunctionalUnit, ...]]) -> None:
    """Hold points, trees and their order against all trees that there are."""
    problem, objectives = front.problem, front.objectives
    everything = {measures(problem, tree, objectives) for tree in trees}
    assert front.complete
    shown = []
    for point in front.points:
        units = tuple(map(problem.network.unit, point.units))
        assert oracle.makes(problem, units)
        assert set(units) in map(set, trees)
        shown.append(measures(problem, units, objectives))
        same = [tree for tree in trees if measures(problem, tree, objectives) == shown[-1]]
        assert len(units) == min(map(len, same))
    assert shown == sorted(nondominated(everything))


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize(
    "seeds", [range(9300, 9330), pytest.param(range(9330, 9500), marks=pytest.mark.slow)]
)
def test_every_front_of_two_and_of_three_objectives(rule: ContainerRule, seeds: range) -> None:
    long = 0
    for seed in seeds:
        problem = choosing(seed, rule)
        trees = list(oracle.trees(problem))
        for objectives in random.Random(seed).sample(SETS, 4):
            front = pareto_front(problem, objectives)
            assert_agrees(front, trees)
            long += len(front.points) > 2
    assert long >= 3


@pytest.mark.parametrize("rule", RULES)
def test_fronts_for_several_goals(rule: ContainerRule) -> None:
    for seed in range(9500, 9530):
        problem = random_problem(seed, rule)
        made = [o for o in range(len(problem.network.objects)) if o not in problem.kitchen]
        problem = replace(problem, goals=tuple(random.Random(seed).sample(made, min(2, len(made)))))
        front = pareto_front(problem, (Objective.UNITS, Objective.SUCCESS, Objective.KITCHEN))
        assert_agrees(front, list(oracle.trees(problem)))


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("name", ["forbid", "require"])
def test_fronts_under_a_constraint(rule: ContainerRule, name: str) -> None:
    fewer = 0
    for seed in range(9600, 9630):
        problem = choosing(seed, rule)
        motion = random.Random(seed).choice(MOTIONS)

        def allowed(tree: tuple[FunctionalUnit, ...], motion: str = motion) -> bool:
            return any(unit.motion == motion for unit in tree) == (name == "require")

        word = {"forbid": "forbidden", "require": "required"}[name]
        settings = Settings(constraints=(Path(f"{name}_motion"),), constants=(f"{word}_motion={motion}",))
        trees = list(oracle.trees(problem, allowed))
        fewer += len(trees) < len(list(oracle.trees(problem)))
        for objectives in random.Random(seed).sample(SETS, 2):
            assert_agrees(pareto_front(problem, objectives, settings), trees)
    assert fewer >= 10
