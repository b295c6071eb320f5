"""The solver against the brute-force oracle, on small random networks with cycles."""

import random
from pathlib import Path

import pytest

from foon_asp.asp import Settings, Status, solve
from foon_asp.network import FunctionalUnit
from foon_asp.problem import ContainerRule, Objective, Problem, parse_objectives
from tests.oracle import task_trees
from tests.oracle.constraints import keeps, random_rule, settings_of
from tests.support.random_problems import random_objectives, random_problem

NETWORKS, CHUNK = 1000, 50
RULES = list(ContainerRule)
Tree = tuple[FunctionalUnit, ...]


def assert_agrees(
    problem: Problem, objectives: list[str], found: list[Tree], settings: Settings | None = None
) -> None:
    """Solve, and hold status and measures against the trees that brute force found."""
    outcome = solve(problem, parse_objectives(objectives), settings)
    expected = task_trees.best(found, problem, objectives)
    if expected is None:
        assert outcome.status is Status.INFEASIBLE
        assert outcome.units is None
        return
    assert outcome.status is Status.OPTIMAL
    assert outcome.units is not None
    tree = tuple(map(problem.network.unit, outcome.units))
    assert task_trees.makes(problem, tree)
    assert tree in found or set(tree) in [set(other) for other in found]
    assert task_trees.key(problem, tree, objectives) == expected


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("first", range(0, NETWORKS, CHUNK))
@pytest.mark.default_cases("650-strict", "650-implied")
def test_every_objective(first: int, rule: ContainerRule) -> None:
    for seed in range(first, first + CHUNK):
        problem = random_problem(seed, rule)
        found = list(task_trees.trees(problem))
        for objective in Objective:
            assert_agrees(problem, [str(objective)], found)


@pytest.mark.parametrize("rule", RULES)
def test_lexicographic_lists(rule: ContainerRule) -> None:
    for seed in range(2000, 2150):
        problem = random_problem(seed, rule)
        found = list(task_trees.trees(problem))
        objectives = random_objectives(random.Random(seed), 3)
        assert_agrees(problem, [str(objective) for objective in objectives], found)


@pytest.mark.parametrize(
    "seeds", [range(4000, 4020), pytest.param(range(4020, 4120), marks=pytest.mark.slow)]
)
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.default_cases("strict-seeds0", "implied-seeds0")
def test_trees_by_need_have_the_same_optima(rule: ContainerRule, seeds: range) -> None:
    for seed in seeds:
        problem = random_problem(seed, rule)
        found = list(task_trees.trees(problem))
        for objective in Objective:
            assert_agrees(problem, [str(objective)], found, Settings(encodings=Path("by_need")))


def constraint(seed: int, problem: Problem) -> tuple[str, list[str], task_trees.Allowed]:
    """Draw one of the ready-made constraints, its constants, and the same as a predicate on trees."""
    rule = random_rule(random.Random(seed), problem)
    return rule["rule"], [*settings_of([rule]).constants], lambda tree: keeps(problem, tree, rule)


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize(
    "first", [0, *(pytest.param(n * CHUNK, marks=pytest.mark.slow) for n in (3, 6, 9, 12, 15))]
)
@pytest.mark.default_cases("0-strict", "0-implied")
def test_constraints(first: int, rule: ContainerRule) -> None:
    for seed in range(first, first + 3 * CHUNK):
        problem = random_problem(seed, rule)
        name, constants, allowed = constraint(seed, problem)
        objective = random.Random(seed).choice(sorted(Objective))
        settings = Settings(constraints=(Path(name),), constants=tuple(constants))
        assert_agrees(problem, [str(objective)], list(task_trees.trees(problem, allowed)), settings)
