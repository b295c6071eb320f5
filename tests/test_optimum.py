"""The solver against the brute-force oracle, on small random networks with cycles."""

import random
from pathlib import Path

import pytest

from foon_asp.asp import Settings, Status, solve
from foon_asp.network import FunctionalUnit
from foon_asp.problem import ContainerRule, Objective, Problem, parse_objectives
from tests import oracle
from tests.random_problems import MOTIONS, random_problem

NETWORKS, CHUNK = 1000, 50
RULES = list(ContainerRule)
Tree = tuple[FunctionalUnit, ...]


def assert_agrees(
    problem: Problem, objectives: list[str], found: list[Tree], settings: Settings | None = None
) -> None:
    """Solve, and hold status and measures against the trees that brute force found."""
    outcome = solve(problem, parse_objectives(objectives), settings)
    expected = oracle.best(found, problem, objectives)
    if expected is None:
        assert outcome.status is Status.INFEASIBLE
        assert outcome.units is None
        return
    assert outcome.status is Status.OPTIMAL
    assert outcome.units is not None
    tree = tuple(map(problem.network.unit, outcome.units))
    assert oracle.makes(problem, tree)
    assert tree in found or set(tree) in [set(other) for other in found]
    assert oracle.key(problem, tree, objectives) == expected


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("first", range(0, NETWORKS, CHUNK))
def test_every_objective(first: int, rule: ContainerRule) -> None:
    for seed in range(first, first + CHUNK):
        problem = random_problem(seed, rule)
        found = list(oracle.trees(problem))
        for objective in Objective:
            assert_agrees(problem, [str(objective)], found)


@pytest.mark.parametrize("rule", RULES)
def test_lexicographic_lists(rule: ContainerRule) -> None:
    for seed in range(2000, 2150):
        problem = random_problem(seed, rule)
        found = list(oracle.trees(problem))
        objectives = random.Random(seed).sample(sorted(Objective), 3)
        assert_agrees(problem, [str(objective) for objective in objectives], found)


@pytest.mark.parametrize("rule", RULES)
def test_trees_by_need_have_the_same_optima(rule: ContainerRule) -> None:
    for seed in range(4000, 4200):
        problem = random_problem(seed, rule)
        found = list(oracle.trees(problem))
        for objective in Objective:
            assert_agrees(problem, [str(objective)], found, Settings(encodings=Path("by_need")))


def constraint(seed: int, problem: Problem) -> tuple[str, list[str], oracle.Allowed]:
    """Draw one of the ready-made constraints, its constants, and the same as a predicate on trees."""
    rng = random.Random(seed)
    motion, other = rng.choice(MOTIONS), rng.choice(MOTIONS)
    label = rng.choice([node.label for node in problem.network.objects])
    bound = rng.randint(0, 4)

    def has(unit: FunctionalUnit) -> bool:
        return any(node.label == label for node in (*unit.inputs, *unit.outputs))

    drawn: list[tuple[str, list[str], oracle.Allowed]] = [
        ("forbid_motion", [f"forbidden_motion={motion}"], lambda t: all(u.motion != motion for u in t)),
        ("forbid_object", [f"forbidden_object={label}"], lambda t: not any(map(has, t))),
        ("at_most_units", [f"max_units={bound}"], lambda t: len(t) <= bound),
        ("require_motion", [f"required_motion={other}"], lambda t: any(u.motion == other for u in t)),
        (
            "at_most_motion",
            [f"limited_motion={motion}", f"max_uses={bound // 2}"],
            lambda t: sum(u.motion == motion for u in t) <= bound // 2,
        ),
    ]
    return rng.choice(drawn)


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("first", range(0, NETWORKS, 10 * CHUNK))
def test_constraints(first: int, rule: ContainerRule) -> None:
    for seed in range(first, first + 10 * CHUNK):
        problem = random_problem(seed, rule)
        name, constants, allowed = constraint(seed, problem)
        objective = random.Random(seed).choice(sorted(Objective))
        settings = Settings(constraints=(Path(name),), constants=tuple(constants))
        assert_agrees(problem, [str(objective)], list(oracle.trees(problem, allowed)), settings)
