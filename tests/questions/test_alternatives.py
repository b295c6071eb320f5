"""All optimal trees, the k best, those that differ most, regrets and menus: held against brute force."""

import random
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import combinations
from typing import Any

import pytest
from msgspec import UNSET

import foon_asp
from foon_asp.asp import Status
from foon_asp.network import FunctionalUnit
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.questions.alternatives import Alternatives, alternatives
from foon_asp.questions.regret import Removal, regret
from foon_asp.questions.solve import solve as solve_goals
from tests.conftest import Cli
from tests.oracle import task_trees
from tests.questions.recipes import posed
from tests.support.random_problems import (
    MOTIONS,
    RATES,
    UTENSILS,
    random_objectives,
    random_prices,
    random_problem,
)

RULES = list(ContainerRule)
Units = frozenset[FunctionalUnit]


def choosing(seed: int, rule: ContainerRule) -> Problem:
    """Make a problem with several makers for each of three steps, or a small one of any kind."""
    if seed % 4 == 0:
        return random_problem(seed, rule)
    rng = random.Random(seed)
    steps = [f"dough; {state}" for state in ("raw", "mixed", "risen", "baked")]
    others = ["salt", "yeast", "bowl"]
    units = []
    for line in range(8):
        step = line % 3 if line < 6 else rng.randrange(3)
        inputs = [steps[step], *rng.sample(others, rng.randrange(3))]
        outputs = [steps[step + 1], *rng.sample(others, rng.choice((0, 0, 1)))]
        units.append((rng.choice(MOTIONS), inputs, outputs))
    at_hand = [steps[0], *others[: rng.choice((2, 3, 3))]]
    there = {name for _, inputs, outputs in units for name in (*inputs, *outputs)}
    kitchen = [name for name in at_hand if name in there]
    foon = foon_asp.build(units, kitchen=kitchen, goals=steps[3], utensils=UTENSILS)
    problem = foon.problem(containers=rule)
    rates = {motion: Fraction(rng.choice(RATES)) for motion in MOTIONS}
    return replace(problem, rates=rates, unit_prices=random_prices(problem.network, seed))


def minimal_trees(problem: Problem, allowed: task_trees.Allowed = lambda _: True) -> list[Units]:
    """Give every allowed tree that holds no other allowed one."""
    found = [frozenset(tree) for tree in task_trees.trees(problem, allowed)]
    return [tree for tree in found if not any(other < tree for other in found)]


def key(problem: Problem, tree: Units, objectives: Sequence[str]) -> tuple[Fraction, ...]:
    return task_trees.key(problem, tuple(tree), list(objectives))


def sets_of(found: Alternatives) -> list[Units]:
    return [frozenset(tree) for tree in found.task_trees]


def drawn(seed: int) -> list[str]:
    if seed % 2:
        return ["units"]
    return [*map(str, random_objectives(random.Random(seed), random.Random(seed).choice((1, 1, 2))))]


@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES)
def test_all_optimal_trees_and_the_best_in_order(rule: ContainerRule) -> None:
    several = 0
    for seed in range(7000, 7020):
        problem = choosing(seed, rule)
        objectives = drawn(seed)
        motion = random.Random(seed).choice(problem.network.motions) if seed % 3 == 0 else ""

        def allowed(tree: tuple[FunctionalUnit, ...], motion: str = motion) -> bool:
            return all(unit.motion != motion for unit in tree)

        how: dict[str, Any] = {"constraints": [f':- use(U), motion(U,"{motion}").'] if motion else []}
        everything = minimal_trees(problem, allowed)
        expected = sorted(key(problem, tree, objectives) for tree in everything)
        ranked = alternatives(problem, objectives, best=1000, **how)
        assert ranked.complete
        trees = sets_of(ranked)
        assert set(trees) == set(everything)
        assert [key(problem, tree, objectives) for tree in trees] == expected
        optimal = alternatives(problem, objectives, limit=1000, **how)
        assert optimal.complete
        assert len(optimal.trees) == expected.count(expected[0]) if expected else not optimal.trees
        several += len(optimal.trees) > 1
        if optimal.trees:
            best = sets_of(optimal)
            unit = problem.network.unit
            assert frozenset(map(unit, optimal.in_every_optimal)) == frozenset.intersection(*best)
            assert frozenset(map(unit, optimal.in_some_optimal)) == frozenset.union(*best)
        for most in (1, 2):
            some = alternatives(problem, objectives, best=most, **how)
            assert [key(problem, tree, objectives) for tree in sets_of(some)] == expected[:most]
            cut = alternatives(problem, objectives, limit=most, **how)
            assert cut.complete == (len(optimal.trees) <= most)
    assert several >= 3


@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES)
def test_trees_that_differ_most(rule: ContainerRule) -> None:
    chosen = 0
    for seed in range(7200, 7220):
        problem = choosing(seed, rule)
        pool = minimal_trees(problem)
        if not pool:
            continue
        least = min(len(tree) for tree in pool)
        near = [tree for tree in pool if len(tree) * 2 <= least * 3]
        found = sets_of(alternatives(problem, different=3, within=50))
        assert len(found) == min(3, len(near))
        if len(near) > 3:
            chosen += 1
            assert spread(found) == max(spread(some) for some in combinations(near, 3))
    assert chosen >= 3


def spread(trees: Sequence[Units]) -> tuple[int, int]:
    distances = [len(one ^ other) for one, other in combinations(trees, 2)]
    return min(distances), sum(distances)


@pytest.mark.parametrize("rule", RULES)
def test_what_a_part_is_worth(rule: ContainerRule) -> None:
    pairs = 0
    for seed in range(7300, 7330):
        problem = random_problem(seed, rule)
        (objective,) = random.Random(seed).sample(sorted(map(str, Objective)), 1)
        everything = [frozenset(tree) for tree in task_trees.trees(problem)]
        motions = problem.network.motions
        found = regret(
            problem, objective, units=range(len(motions)), motions=sorted(set(motions)), pairs=True
        )
        if not everything:
            assert found.answer.status is Status.INFEASIBLE
            assert not found.regrets
            continue
        assert {each.unit.id for each in found.regrets if each.unit} == set(range(len(problem.network)))
        assert {each.motion for each in found.regrets if each.motion} == set(motions)
        for each in found.regrets:
            without, left = problem, list(map(tuple, everything))
            if each.unit is not None and each.unit.id is not None:
                left = [tree for tree in left if problem.network.unit(each.unit.id) not in tree]
            elif each.motion is not None:
                left = [tree for tree in left if each.motion not in {unit.motion for unit in tree}]
            else:
                pairs += each.part is Removal.PAIR
                gone = {node.id for node in (each.item, each.second_item) if node}
                without = replace(problem, kitchen=problem.kitchen - gone)
                left = list(task_trees.trees(without))
            expected = task_trees.best(left, without, [objective])
            assert (each.costs is None) == (expected is None)
            if each.costs is not None and expected is not None:
                sign = -1 if objective == Objective.SUCCESS else 1
                figure = Fraction(each.costs.measure(Objective(objective)))
                assert [sign * figure, each.costs.units] == list(expected)
    assert pairs >= 3


def test_rates_of_single_units_stay_where_others_are_left_out() -> None:
    problem = posed("water", "tea", "water > tea", "water > tea + foam", "water > tea + dregs")
    rates = dict.fromkeys(problem.network.motions, Fraction(1, 2))
    own = replace(problem, rates=rates, own_rates={1: Fraction(3, 4)})
    found = regret(own, "success", units=[0, 1])
    left = {each.unit.id: each.costs.success for each in found.regrets if each.costs and each.unit}
    assert left == {0: Fraction(3, 4), 1: Fraction(1, 2)}
    assert own.vary(containers="implied").own_rates == own.own_rates


def test_an_item_that_is_made_is_not_taken() -> None:
    """With dough at hand it is taken along with the water; without it, it is made of the water."""
    problem = posed("water + dough", "bread", "water > dough", "dough + water > bread")
    found = regret(problem, "kitchen")
    assert found.answer.costs is not None
    assert found.answer.costs.kitchen == 2
    left = {str(each.item): each.costs and (each.costs.kitchen, each.costs.units) for each in found.regrets}
    assert (left["water"], left["dough"]) == (None, (1, 2))
    assert "  -1 kitchen    dough\n" in found.text()


def test_many_goals_of_one_tree_are_not_solved_one_by_one() -> None:
    units = [("cut", ["loaf"], [f"slice {n}"]) for n in range(9)]
    foon = foon_asp.build(units, kitchen="loaf")
    few, many = (foon_asp.solve(foon.problem(*(f"slice {n}" for n in range(last)))) for last in (8, 9))
    assert isinstance(few.goals_alone, tuple)
    assert (len(few.goals_alone), few.sum_of_goals_alone) == (8, 8)
    assert many.goals_alone is UNSET
    assert isinstance(many.serves, tuple)
    assert len(many.serves) == 9
    assert "0 units shared; what each goal costs by itself: --all-goals" in many.text()


@pytest.mark.parametrize("rule", RULES)
def test_several_goals_have_the_joint_optimum_beside_the_single_ones(rule: ContainerRule) -> None:
    shared = 0
    for seed in range(7400, 7440):
        problem = random_problem(seed, rule)
        made = [o for o in range(len(problem.network.objects)) if o not in problem.kitchen]
        problem = replace(problem, goals=tuple(random.Random(seed).sample(made, min(2, len(made)))))
        found = solve_goals(problem, "inputs")
        if len(problem.goals) < 2:
            assert found.goals_alone is UNSET
            continue
        joint = task_trees.best(list(task_trees.trees(problem)), problem, ["inputs"])
        assert (found.costs is None) == (joint is None)
        if found.costs is None or joint is None:
            continue
        assert [found.costs.inputs, found.costs.units] == list(joint)
        total = found.sum_of_goals_alone
        ones = [replace(problem, goals=(goal,)) for goal in problem.goals]
        bests = [task_trees.best(list(task_trees.trees(one)), one, ["inputs"]) for one in ones]
        assert total == sum(best[0] for best in bests if best)
        assert isinstance(found.serves, tuple)
        for goal in problem.goals:  # what serves a goal makes it
            serving = [each.unit for each in found.serves if goal in {node.id for node in each.goals}]
            units = tuple(map(problem.network.unit, serving))
            assert task_trees.makes(replace(problem, goals=(goal,)), units)
        assert [each.unit for each in found.serves if each.goals] == list(found.ids or ())
        shared += any(len(each.goals) > 1 for each in found.serves)
    assert shared >= 2


def test_different_trees_are_grouped_by_where_they_part(cli: Cli) -> None:
    words = ["alternatives", "--goal", "macaroni", "--different", "3", "--within", "20"]
    said = cli(*words).out.splitlines()
    assert said[2] == "they part at macaroni; cooked; in [pot]"
    assert [line.split(" [")[0] for line in said[3:5]] == ["  trees 1, 2: tilt", "  tree 3: pour"]
    assert said[5].startswith("trees 1, 2 part at water; ")
    found = cli(*words, "--format", "json").json
    assert [[way["trees"] for way in each["ways"]] for each in found["partings"]] == [
        [[0, 1], [2]],
        [[0], [1]],
    ]
    for way in (way for parting in found["partings"] for way in parting["ways"]):
        made_by = {unit["id"] for unit in way["made_by"]}
        assert all(made_by <= {u["id"] for u in found["trees"][place]["units"]} for place in way["trees"])


def test_one_tree_is_counted_as_one(cli: Cli) -> None:
    two = alternatives(posed("a", "b", "a > b", "a > b + c")).text()
    assert "\n2 optimal trees by units, and no others: proved (strict containers): 1 unit, 1 input\n" in two
    said = cli("alternatives", "--goal", "macaroni", "--different", "3").out
    assert "\nthere is 1 tree and no more (strict containers)\n" in said
