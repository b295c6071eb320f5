"""The checker on hand-made trees, and against a naive second simulator."""

import random

import pytest

from foon_asp.network import FunctionalUnit, NetworkBuilder, ObjectNode, Source, TaskTree
from foon_asp.problem import ContainerRule, Problem
from foon_asp.proof.simulation import Obstacle, Verdict, simulate, simulate_for
from tests import oracle
from tests.random_problems import random_problem

A, B, C, D, E = (ObjectNode.of(label) for label in "abcde")


def unit(inputs: list[ObjectNode], outputs: list[ObjectNode]) -> FunctionalUnit:
    return FunctionalUnit.of("move", inputs, outputs)


def verdict(units: list[FunctionalUnit], kitchen: list[ObjectNode], goal: ObjectNode) -> object:
    return simulate(TaskTree(tuple(units)), frozenset(kitchen), (goal,), ContainerRule.STRICT, frozenset())


def test_the_three_verdicts() -> None:
    first, second = unit([A], [B]), unit([B], [C])
    assert verdict([first, second], [A], C) == (Verdict.AS_LISTED, (0, 1), None, None)
    assert verdict([second, first], [A], C) == (Verdict.REORDERED, (1, 0), Obstacle(0, B), None)
    missing = Obstacle(0, A)
    assert verdict([first, second], [], C) == (Verdict.NEVER, (), missing, missing)
    goal = Obstacle(None, D)
    assert verdict([first, second], [A], D) == (Verdict.NEVER, (0, 1), goal, goal)
    assert verdict([], [A], A) == (Verdict.AS_LISTED, (), None, None)
    assert verdict([], [A], B) == (Verdict.NEVER, (), Obstacle(None, B), Obstacle(None, B))


def test_items_do_not_run_out_and_units_may_repeat() -> None:
    again = unit([A], [B])
    assert verdict([again, again, unit([A, B], [C])], [A], C) == (Verdict.AS_LISTED, (0, 1, 2), None, None)


def test_a_cycle_is_named_and_only_when_it_is_to_blame() -> None:
    ring = [unit([B], [C]), unit([C], [D]), unit([D], [B])]
    assert verdict(ring, [A], D) == (Verdict.NEVER, (), Obstacle(0, B), Obstacle(0, B, (0, 2, 1)))
    behind = [unit([D, A], [E]), *ring]
    assert verdict(behind, [A], E) == (Verdict.NEVER, (), Obstacle(0, D), Obstacle(0, D, (2, 1, 3)))
    lacking = [unit([B], [C]), unit([D], [B])]
    assert verdict(lacking, [A], C) == (Verdict.NEVER, (), Obstacle(0, B), Obstacle(0, B))
    again = [unit([A, B], [C]), unit([C], [A])]  # what is at hand, nobody waits for
    assert verdict(again, [A], C) == (Verdict.NEVER, (), Obstacle(0, B), Obstacle(0, B))
    itself = [unit([B], [B])]
    assert verdict(itself, [A], B) == (Verdict.NEVER, (), Obstacle(0, B), Obstacle(0, B, (0,)))


def test_the_missing_input_is_the_first_that_is_not_at_hand() -> None:
    missing = Obstacle(0, C)
    assert verdict([unit([A, B, C, D], [E])], [A, B], E) == (Verdict.NEVER, (), missing, missing)


def test_a_cycle_is_found_behind_what_nobody_makes() -> None:
    """The first unit waits for a unit that lacks something, and after that one for a circle."""
    first, dead, turning = unit([B, C], [E]), unit([D], [B]), unit([C], [C])
    ring = Obstacle(0, B, (2,))
    assert verdict([first, dead, turning], [A], E) == (Verdict.NEVER, (), Obstacle(0, B), ring)


def test_many_ways_to_the_same_missing_input_are_gone_once() -> None:
    """Each of two units waits for both of the next two: there are 2 ** 60 ways, and no circle."""
    steps = [(ObjectNode.of("left", [str(n)]), ObjectNode.of("right", [str(n)])) for n in range(61)]
    units = [unit(list(steps[n]), [made]) for n in range(60) for made in steps[n + 1]][::-1]
    missing = Obstacle(0, steps[59][0])
    assert verdict(units, [A], steps[60][0]) == (Verdict.NEVER, (), missing, missing)


def test_a_problem_has_its_own_kitchen_and_goals() -> None:
    builder = NetworkBuilder()
    for line, step in enumerate((unit([A], [B]), unit([C], [D]))):
        builder.add(step.motion, step.inputs, step.outputs, Source("plain", line))
    network = builder.build()
    a, b, c, d = (network.object_id(node) for node in (A, B, C, D))
    assert (a, b, c, d) == (0, 1, 2, 3)
    problem = Problem(network, frozenset({0}), (1,), None, frozenset())
    assert simulate_for(problem, TaskTree((unit([A], [B]),))) == (Verdict.AS_LISTED, (0,), None, None)
    missing = Obstacle(0, C)
    found = simulate_for(problem, TaskTree((unit([C], [D]), unit([A], [B]))))
    assert found == (Verdict.NEVER, (1,), missing, missing)
    goal = Obstacle(None, B)
    assert simulate_for(problem, TaskTree(())) == (Verdict.NEVER, (), goal, goal)
    foreign = Obstacle(0, E)  # the network does not have it, so the kitchen has none
    assert simulate_for(problem, TaskTree((unit([E], [B]),))) == (Verdict.NEVER, (), foreign, foreign)


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
        assert (result.verdict is not Verdict.NEVER) is oracle.makes(problem, chosen)

        at_hand, runs = set(kitchen), True
        for step in chosen:
            runs = runs and oracle.needed(step, rule, problem.utensils) <= at_hand
            at_hand |= oracle.made(step, rule, problem.utensils)
        assert (result.verdict is Verdict.AS_LISTED) is (runs and set(goals) <= at_hand)

        at_hand = set(kitchen)
        for position in result.order:
            assert oracle.needed(chosen[position], rule, problem.utensils) <= at_hand
            at_hand |= oracle.made(chosen[position], rule, problem.utensils)
        if result.obstacle and result.obstacle.cycle:
            ring = result.obstacle.cycle
            for one, following in zip(ring, (*ring[1:], ring[0]), strict=True):
                lacks = oracle.needed(chosen[one], rule, problem.utensils) - at_hand
                assert lacks & oracle.made(chosen[following], rule, problem.utensils)
