"""All optimal trees, the k best, those that differ most, regrets and menus: held against brute force."""

import random
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import combinations

import pytest

from foon_asp.asp import Status
from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.questions.alternatives import Alternatives, alternatives
from foon_asp.questions.menu import menu
from foon_asp.questions.regret import Part, regret
from tests import oracle
from tests.conftest import Cli
from tests.random_problems import (
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
    steps = [ObjectNode.of("dough", [state]) for state in ("raw", "mixed", "risen", "baked")]
    others = [ObjectNode.of(label) for label in ("salt", "yeast", "bowl")]
    builder = NetworkBuilder()
    for line in range(8):
        step = line % 3 if line < 6 else rng.randrange(3)
        inputs = [steps[step], *rng.sample(others, rng.randrange(3))]
        outputs = [steps[step + 1], *rng.sample(others, rng.choice((0, 0, 1)))]
        builder.add(rng.choice(MOTIONS), inputs, outputs, Source("random", line + 1))
    network = builder.build()
    at_hand = [steps[0], *others[: rng.choice((2, 3, 3))]]
    kitchen = frozenset(o for node in at_hand if (o := network.object_id(node)) is not None)
    rates = {motion: Fraction(rng.choice(RATES)) for motion in MOTIONS}
    goal = network.object_id(steps[3])
    assert goal is not None
    prices = random_prices(network, seed)
    return Problem(network, kitchen, (goal,), rates, UTENSILS, rule, unit_prices=prices)


def minimal_trees(problem: Problem, allowed: oracle.Allowed = lambda _: True) -> list[Units]:
    """Give every allowed tree that holds no other allowed one."""
    found = [frozenset(tree) for tree in oracle.trees(problem, allowed)]
    return [tree for tree in found if not any(other < tree for other in found)]


def key(problem: Problem, tree: Units, objectives: Sequence[str]) -> tuple[Fraction, ...]:
    return oracle.key(problem, tuple(tree), list(objectives))


def sets_of(found: Alternatives) -> list[Units]:
    return [frozenset(map(found.problem.network.unit, tree.units)) for tree in found.trees]


def drawn(seed: int) -> list[str]:
    if seed % 2:
        return ["units"]
    return [*map(str, random_objectives(random.Random(seed), random.Random(seed).choice((1, 1, 2))))]


@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.sampled(2)
def test_all_optimal_trees_and_the_best_in_order(rule: ContainerRule) -> None:
    several = 0
    for seed in range(7000, 7018):
        problem = choosing(seed, rule)
        objectives = drawn(seed)
        expected = sorted(key(problem, tree, objectives) for tree in minimal_trees(problem))
        ranked = alternatives(problem, objectives, best=1000)
        assert ranked.complete
        trees = sets_of(ranked)
        assert set(trees) == set(minimal_trees(problem))
        assert len(trees) == len(set(trees))
        assert [key(problem, tree, objectives) for tree in trees] == expected
        optimal = alternatives(problem, objectives, limit=1000)
        assert optimal.complete
        assert len(optimal.trees) == expected.count(expected[0]) if expected else not optimal.trees
        several += len(optimal.trees) > 1
        if optimal.trees:
            best = sets_of(optimal)
            unit = problem.network.unit
            assert frozenset(map(unit, optimal.in_every)) == frozenset.intersection(*best)
            assert frozenset(map(unit, optimal.in_some)) == frozenset.union(*best)
        for most in (1, 2):
            some = alternatives(problem, objectives, best=most)
            assert [key(problem, tree, objectives) for tree in sets_of(some)] == expected[:most]
            cut = alternatives(problem, objectives, limit=most)
            assert cut.complete == (len(optimal.trees) <= most)
    assert several >= 3


@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES)
def test_constraints_hold_for_alternatives(rule: ContainerRule) -> None:
    for seed in range(7100, 7120):
        problem = choosing(seed, rule)
        motion = random.Random(seed).choice(problem.network.motions)

        def allowed(tree: tuple[FunctionalUnit, ...], motion: str = motion) -> bool:
            return all(unit.motion != motion for unit in tree)

        expected = minimal_trees(problem, allowed)
        constants = {"forbidden_motion": motion}
        found = alternatives(problem, "success", best=1000, constraints="forbid_motion", constants=constants)
        assert set(sets_of(found)) == set(expected)


@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.sampled(2)
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
    def moved(tree: Sequence[FunctionalUnit]) -> set[str]:
        return {unit.motion for unit in tree}

    pairs = 0
    for seed in range(7300, 7330):
        problem = random_problem(seed, rule)
        (objective,) = random.Random(seed).sample(sorted(map(str, Objective)), 1)
        everything = [frozenset(tree) for tree in oracle.trees(problem)]
        motions = problem.network.motions
        found = regret(
            problem, objective, units=range(len(motions)), motions=sorted(set(motions)), pairs=True
        )
        if not everything:
            assert found.outcome.status is Status.INFEASIBLE
            assert not found.regrets
            continue
        assert {r.id for r in found.regrets if r.part is Part.UNIT} == set(range(len(problem.network)))
        for each in found.regrets:
            if each.part is Part.UNIT:
                gone = problem.network.unit(each.id)
                left, without = [tuple(tree) for tree in everything if gone not in tree], problem
            elif each.part is Part.MOTION:
                left, without = (
                    [t for t in map(tuple, everything) if motions[each.id] not in moved(t)],
                    problem,
                )
            else:
                pairs += each.part is Part.PAIR
                without = replace(problem, kitchen=problem.kitchen - {each.id, each.other})
                left = [tuple(tree) for tree in oracle.trees(without)]
            expected = oracle.best(left, without, [objective])
            assert (each.costs is None) == (expected is None)
            if each.costs is not None and expected is not None:
                sign = -1 if objective == Objective.SUCCESS else 1
                figure = Fraction(each.costs.measure(Objective(objective)))
                assert [sign * figure, each.costs.units] == list(expected)
                assert found.outcome.costs is not None
                loss = each.loss(found.outcome.costs, Objective(objective))
                assert loss is not None
                made = (
                    each.part in {Part.ITEM, Part.PAIR} and objective == Objective.KITCHEN
                )  # and so not taken
                assert loss >= -2 if made else loss >= 0
    assert pairs >= 3


def test_rates_of_single_units_stay_with_them_where_others_are_left_out() -> None:
    builder = NetworkBuilder()
    water, tea = ObjectNode.of("water"), ObjectNode.of("tea")
    for line, motion in enumerate(("pour", "brew", "steep"), 1):
        builder.add(motion, [water], [tea], Source("tea", line))
    ids = (builder.build().object_id(water), builder.build().object_id(tea))
    rates = dict.fromkeys(("pour", "brew", "steep"), Fraction(1, 2))
    assert ids[0] is not None
    assert ids[1] is not None
    problem = Problem(
        builder.build(), frozenset({ids[0]}), (ids[1],), rates, UTENSILS, own_rates={1: Fraction(3, 4)}
    )
    found = regret(problem, "success", units=[0], motions=["brew"])
    left = {(each.part, each.id): each.costs.success for each in found.regrets if each.costs is not None}
    assert left[Part.UNIT, 0] == Fraction(3, 4)
    assert left[Part.UNIT, 1] == left[Part.MOTION, 1] == Fraction(1, 2)
    with pytest.raises(UserError, match="no unit has the motion 'brw'; similar are 'brew'"):
        regret(problem, motions="brw")


def test_an_item_that_is_made_is_not_taken() -> None:
    """With dough at hand it is taken along with the water; without it, it is made of the water."""
    builder = NetworkBuilder()
    water, dough, bread = map(ObjectNode.of, ("water", "dough", "bread"))
    builder.add("knead", [water], [dough], Source("bread", 1))
    builder.add("bake", [dough, water], [bread], Source("bread", 2))
    network = builder.build()
    ids = [o for node in (water, dough, bread) if (o := network.object_id(node)) is not None]
    problem = Problem(network, frozenset(ids[:2]), (ids[2],), None, UTENSILS)
    found = regret(problem, "kitchen")
    assert found.outcome.costs is not None
    assert found.outcome.costs.kitchen == 2
    left = {each.id: each.costs for each in found.regrets if each.part is Part.ITEM}
    assert left[ids[0]] is None
    without_dough = left[ids[1]]
    assert without_dough is not None
    assert (without_dough.kitchen, without_dough.units) == (1, 2)
    assert "  -1 kitchen    dough\n" in found.text()


@pytest.mark.parametrize("rule", RULES)
def test_a_menu_is_the_joint_optimum_beside_the_single_ones(rule: ContainerRule) -> None:
    shared = 0
    for seed in range(7400, 7440):
        problem = random_problem(seed, rule)
        made = [o for o in range(len(problem.network.objects)) if o not in problem.kitchen]
        problem = replace(problem, goals=tuple(random.Random(seed).sample(made, min(2, len(made)))))
        if len(problem.goals) < 2:
            with pytest.raises(UserError, match="several goals"):
                menu(problem)
            continue
        found = menu(problem, "inputs")
        joint = oracle.best(list(oracle.trees(problem)), problem, ["inputs"])
        assert (found.together.costs is None) == (joint is None)
        if found.together.costs is None or joint is None:
            continue
        assert [found.together.costs.inputs, found.together.costs.units] == list(joint)
        total = found.sum_of_separate(Objective.INPUTS)
        ones = [replace(problem, goals=(goal,)) for goal in problem.goals]
        bests = [oracle.best(list(oracle.trees(one)), one, ["inputs"]) for one in ones]
        assert total == sum(best[0] for best in bests if best)
        assert total is not None
        assert found.together.costs.inputs <= total
        for goal in problem.goals:  # what serves a goal makes it
            serving = [u for u in found.together.units or () if goal in found.serves[u]]
            units = tuple(map(problem.network.unit, serving))
            assert oracle.makes(replace(problem, goals=(goal,)), units)
        assert all(found.serves[u] for u in found.together.units or ())
        shared += bool(found.shared)
    assert shared >= 2


def test_a_network_without_a_unit_is_a_part_of_it() -> None:
    network = random_problem(1, ContainerRule.STRICT).network
    less = network.without([1])
    assert [less.unit_number(u) for u in range(len(less))] == [u for u in range(len(network)) if u != 1]
    for u in range(len(less)):
        unit = less.unit(u)
        assert unit == network.unit(less.unit_number(u))
        assert less.unit_id(unit) == u
        assert less.unit_of_number(less.unit_number(u)) == u
    assert less.unit_id(network.unit(1)) is None
    assert less.without([0]).unit_number(0) == less.unit_number(1)


def test_different_trees_are_grouped_by_where_they_part(cli: Cli) -> None:
    words = ["alternatives", "--goal", "macaroni", "--different", "3", "--within", "20"]
    said = cli(*words).out.splitlines()
    assert said[2] == "they part at macaroni; cooked; in [pot]"
    assert [line.split(" [")[0] for line in said[3:5]] == ["  trees 1, 2: tilt", "  tree 3: pour"]
    assert said[5].startswith("trees 1, 2 part at water; ")
    found = cli(*words, "--format", "json").json
    first, second = found["partings"]
    assert [way["trees"] for way in first["ways"]] == [[0, 1], [2]]
    assert sorted(place for way in second["ways"] for place in way["trees"]) == [0, 1]
    for parting in found["partings"]:
        for way in parting["ways"]:
            for place in way["trees"]:
                ids = {unit["id"] for unit in found["trees"][place]["units"]}
                assert ids >= {unit["id"] for unit in way["made_by"]}


def test_one_tree_is_counted_as_one(cli: Cli) -> None:
    said = cli("alternatives", "--goal", "macaroni", "--different", "3").out
    assert "\nthere is 1 tree and no more (strict containers)\n" in said
