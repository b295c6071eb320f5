"""The solver against the brute-force oracle, on small random networks with cycles."""

import random
from fractions import Fraction
from pathlib import Path

import pytest

from foon_asp.asp import Settings, Status, solve
from foon_asp.network import FunctionalUnit, ObjectNode
from foon_asp.problem import ContainerRule, Objective, Problem, parse_objectives
from tests import oracle
from tests.random_problems import MOTIONS, random_objectives, random_problem

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
@pytest.mark.sampled(20)
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
        objectives = random_objectives(random.Random(seed), 3)
        assert_agrees(problem, [str(objective) for objective in objectives], found)


@pytest.mark.parametrize(
    "seeds", [range(4000, 4020), pytest.param(range(4020, 4200), marks=pytest.mark.slow)]
)
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.sampled(2)
def test_trees_by_need_have_the_same_optima(rule: ContainerRule, seeds: range) -> None:
    for seed in seeds:
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

    food = rng.choice(["flour", "salt", "dough", "butter"])
    rates = problem.rates or {}

    def holds(node: ObjectNode) -> bool:
        return node.label == food or any(food in contents.ingredients for contents in node.contents)

    def nodes_of(tree: Tree) -> list[ObjectNode]:
        return [node for unit in tree for node in (*unit.inputs, *unit.outputs)]

    def no_food(tree: Tree) -> bool:
        goals = [problem.network.objects[goal] for goal in problem.goals]
        return not any(map(holds, [*nodes_of(tree), *goals]))

    def utensils(tree: Tree) -> set[str]:
        return {node.label for node in nodes_of(tree)} & problem.utensils

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
        ("require_object", [f"required_object={label}"], lambda t: any(map(has, t))),
        ("forbid_ingredient", [f"forbidden_ingredient={food}"], no_food),
        ("require_ingredient", [f"required_ingredient={food}"], lambda t: any(map(holds, nodes_of(t)))),
        ("at_most_utensils", [f"max_utensils={bound // 2}"], lambda t: len(utensils(t)) <= bound // 2),
        ("least_rate", ["least_rate=250000"], lambda t: all(rates[u.motion] >= Fraction(1, 4) for u in t)),
        (
            "before",
            [f"earlier_motion={motion}", f"later_motion={other}"],
            lambda t: motion == other or waits(problem, t, motion, other),
        ),
        ("require_intermediate", [f"required_intermediate={label}"], lambda t: passed_on(problem, t, label)),
    ]
    return rng.choice(drawn)


def waits(problem: Problem, tree: Tree, earlier: str, later: str) -> bool:
    """Whether no order that begins without the earlier motion comes to run the later one, naively."""
    at_hand = {problem.network.objects[o] for o in problem.kitchen}
    others = [unit for unit in tree if unit.motion != earlier]
    for _ in others:
        for unit in others:
            if oracle.needed(unit, problem.containers, problem.utensils) <= at_hand:
                at_hand |= oracle.made(unit, problem.containers, problem.utensils)
    ran = [u for u in others if oracle.needed(u, problem.containers, problem.utensils) <= at_hand]
    return all(unit.motion != later for unit in ran)


def passed_on(problem: Problem, tree: Tree, label: str) -> bool:
    """Whether some unit makes, out of something else, what another unit needs and the kitchen lacks."""
    at_hand = {problem.network.objects[o] for o in problem.kitchen}
    return any(
        node in oracle.needed(user, problem.containers, problem.utensils)
        for maker in tree
        for node in oracle.made(maker, problem.containers, problem.utensils) - set(maker.inputs) - at_hand
        if node.label == label
        for user in tree
    )


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize(
    "first", [0, *(pytest.param(n * CHUNK, marks=pytest.mark.slow) for n in (3, 6, 9, 12, 15))]
)
@pytest.mark.sampled(2)
def test_constraints(first: int, rule: ContainerRule) -> None:
    for seed in range(first, first + 3 * CHUNK):
        problem = random_problem(seed, rule)
        name, constants, allowed = constraint(seed, problem)
        objective = random.Random(seed).choice(sorted(Objective))
        settings = Settings(constraints=(Path(name),), constants=tuple(constants))
        assert_agrees(problem, [str(objective)], list(oracle.trees(problem, allowed)), settings)
