"""The checker on hand-made trees, and against a naive second simulator."""

import random

import pytest

from foon_asp.network import TaskTree
from foon_asp.problem import ContainerRule
from foon_asp.proof.simulation import Obstacle, Verdict, simulate, simulate_for
from foon_asp.text.line_parser import parse_node
from tests.oracle import task_trees
from tests.proof.by_hand import recipe
from tests.support.random_problems import random_problem

AS_LISTED, REORDERED, NEVER = Verdict.AS_LISTED, Verdict.REORDERED, Verdict.NEVER
RING = ("b > c", "c > d", "d > b")
Found = tuple[int | None, str] | tuple[int | None, str, tuple[int, ...]]


def obstacle(found: Found | None) -> Obstacle | None:
    return found and Obstacle(found[0], parse_node(found[1]), *found[2:])


@pytest.mark.parametrize(
    ("units", "kitchen", "goal", "verdict", "order", "first", "to_blame"),
    [
        (("a > b", "b > c"), "a", "c", AS_LISTED, (0, 1), None, None),
        (("b > c", "a > b"), "a", "c", REORDERED, (1, 0), (0, "b"), None),
        (("a > b", "b > c"), "", "c", NEVER, (), (0, "a"), (0, "a")),
        (("a > b", "b > c"), "a", "d", NEVER, (0, 1), (None, "d"), (None, "d")),
        ((), "a", "a", AS_LISTED, (), None, None),
        ((), "a", "b", NEVER, (), (None, "b"), (None, "b")),
        # items do not run out, and units may repeat
        (("a > b", "a > b", "a + b > c"), "a", "c", AS_LISTED, (0, 1, 2), None, None),
        # a cycle is named, and only when it is to blame
        (RING, "a", "d", NEVER, (), (0, "b"), (0, "b", (0, 2, 1))),
        (("d + a > e", *RING), "a", "e", NEVER, (), (0, "d"), (0, "d", (2, 1, 3))),
        (("b > c", "d > b"), "a", "c", NEVER, (), (0, "b"), (0, "b")),
        (("a + b > c", "c > a"), "a", "c", NEVER, (), (0, "b"), (0, "b")),  # nobody waits for what is there
        (("b > b",), "a", "b", NEVER, (), (0, "b"), (0, "b", (0,))),
        # the first input that is not at hand
        (("a + b + c + d > e",), "ab", "e", NEVER, (), (0, "c"), (0, "c")),
        # the first waits for a unit that lacks something, and after that one for a cycle
        (("b + c > e", "d > b", "c > c"), "a", "e", NEVER, (), (0, "b"), (0, "b", (2,))),
    ],
)
def test_verdicts(
    units: tuple[str, ...],
    kitchen: str,
    goal: str,
    verdict: Verdict,
    order: tuple[int, ...],
    first: Found | None,
    to_blame: Found | None,
) -> None:
    tree = TaskTree(tuple(recipe(f"move: {unit}", goals=unit[0]).network.unit(0) for unit in units))
    there = frozenset(map(parse_node, kitchen))
    found = simulate(tree, there, (parse_node(goal),), ContainerRule.STRICT, frozenset())
    assert found == (verdict, order, obstacle(first), obstacle(to_blame))


def test_a_unit_that_the_network_does_not_have_waits_for_what_no_kitchen_has() -> None:
    foreign = recipe("move: e > b").network.unit(0)
    found = simulate_for(recipe("move: a > b", kitchen="a"), TaskTree((foreign,)))
    assert found == (NEVER, (), obstacle((0, "e")), obstacle((0, "e")))


def test_many_ways_to_the_same_missing_input_are_gone_once() -> None:
    """Each of two units waits for both of the next two: there are 2 ** 60 ways, and no cycle."""
    both = [f"left; {n} + right; {n}" for n in range(61)]
    steps = (f"move: {both[n]} > {made}" for n in range(60) for made in both[n + 1].split(" + "))
    problem = recipe(*reversed([*steps]), kitchen="a", goals="left; 60")
    missing = obstacle((0, "left; 59"))
    tree = TaskTree(tuple(map(problem.network.unit, range(120))))
    assert simulate_for(problem, tree) == (NEVER, (), missing, missing)


@pytest.mark.parametrize("rule", list(ContainerRule))
def test_random_trees_against_the_naive_simulator(rule: ContainerRule) -> None:
    for seed in range(400):
        problem, rng = random_problem(seed, rule), random.Random(seed)
        listed = [problem.network.unit(u) for u in range(len(problem.network))]
        chosen = tuple(rng.sample(listed, rng.randint(0, len(listed))))
        objects = problem.network.objects
        kitchen = {objects[o] for o in problem.kitchen}
        goals = tuple(objects[o] for o in problem.goals)
        result = simulate(TaskTree(chosen), frozenset(kitchen), goals, rule, problem.utensils)
        assert (result.verdict is not Verdict.NEVER) is task_trees.makes(problem, chosen)

        at_hand, runs = set(kitchen), True
        for step in chosen:
            runs = runs and task_trees.needed(step, rule, problem.utensils) <= at_hand
            at_hand |= task_trees.made(step, rule, problem.utensils)
        assert (result.verdict is Verdict.AS_LISTED) is (runs and set(goals) <= at_hand)

        at_hand = set(kitchen)
        for position in result.order:
            assert task_trees.needed(chosen[position], rule, problem.utensils) <= at_hand
            at_hand |= task_trees.made(chosen[position], rule, problem.utensils)
        if result.obstacle and result.obstacle.cycle:
            ring = result.obstacle.cycle
            for one, following in zip(ring, (*ring[1:], ring[0]), strict=True):
                lacks = task_trees.needed(chosen[one], rule, problem.utensils) - at_hand
                assert lacks & task_trees.made(chosen[following], rule, problem.utensils)
