"""What a tree takes more to have a unit of each required set: by hand, and by brute force."""

import random
from dataclasses import replace
from fractions import Fraction

import pytest

from foon_asp.hypergraph import ALL, SAFE, Reduction, reduce
from foon_asp.hypergraph.extension import actions_of_extensions, extend_tree
from foon_asp.hypergraph.goal_graph import GoalGraph, graph_of
from foon_asp.problem import Objective, Problem, Restriction, levels
from tests.hypergraph.test_reduction import Heard, interrupt_at
from tests.hypergraph.test_reductions import assert_left, posed
from tests.rules.test_constraint_meanings import small

UNITS, SUCCESS = levels((Objective.UNITS,)), levels((Objective.SUCCESS,))
# 3 needs what 1 makes, 6 what 4 and 5 make, and 7 what nobody has
WAYS = (
    *("boil: start > end", "cut: start > a", "mix: a > end", "fry: a > p", "wash: start > s", "dry: s > t"),
    *("fold: t > q", "wait: never > r"),
)


def without_never(*units: str) -> Problem:
    problem = small(*units)
    (never,) = (o for o, node in enumerate(problem.network.objects) if node.label == "never")
    return replace(problem, kitchen=problem.kitchen - {never})


MADE = without_never(*WAYS)


def requiring(*sets: set[int], problem: Problem = MADE) -> GoalGraph:
    required = tuple(map(frozenset, sets))
    return graph_of(replace(problem, restriction=Restriction(lambda _: False, required)), UNITS)


def test_a_tree_is_extended_as_cheaply_as_it_can_be() -> None:
    graph = requiring({3, 6})
    assert extend_tree(graph, {1, 2}, lambda _: 1, 99) == {1, 2, 3}
    assert extend_tree(graph, {0}, lambda _: 1, 99) == {0, 1, 3}
    assert extend_tree(graph, {0, 4, 5}, lambda _: 1, 99) == {0, 4, 5, 6}
    assert extend_tree(graph, {0}, lambda unit: 5 if unit == 3 else 1, 99) == {0, 4, 5, 6}
    assert extend_tree(requiring({3}, {6}), {0}, lambda _: 1, 99) == {0, 1, 3, 4, 5, 6}
    assert extend_tree(requiring({0}), {0}, lambda _: 1, 99) == {0}
    assert extend_tree(requiring({7}), {0}, lambda _: 1, 99) is None


def test_what_an_extension_up_to_a_cost_can_have() -> None:
    graph = requiring({3, 6})

    def up_to(limit: int, *free: int) -> set[int]:
        return actions_of_extensions(graph, set(free), lambda _: 1, limit, lambda: False)

    assert [up_to(limit) for limit in range(4)] == [set(), set(), {1, 3}, {1, 3, 4, 5, 6}]
    assert up_to(1, 1) == {3}  # what is free is there anyway
    assert up_to(1, 4, 5) == {6}
    assert up_to(0, 3) == set()


def test_what_an_extension_uses_twice_costs_it_once() -> None:
    # 4 needs two things that come of what 1 makes: 4 units, on ways of 3
    fork = small(
        *("boil: start > end", "wash: start > s", "cut: s > p", "fry: s > q", "mix: p, q > z"),
        *("chop: start > t", "dry: t > z"),
    )
    graph = requiring({4}, problem=fork)
    found = [actions_of_extensions(graph, set(), lambda _: 1, limit, lambda: False) for limit in (2, 3, 4)]
    assert found == [set(), {1, 2, 3, 4}, {1, 2, 3, 4}]
    # but where a tree is looked for, it counts twice: 5 rather than 3 by estimates, which 6 is between
    prices = [9, 1, 1, 1, 1, 2, 2].__getitem__
    assert extend_tree(requiring({4, 6}, problem=fork), {0}, prices, 99) == {0, 5, 6}


def test_of_a_large_required_set_the_units_stay_that_lack_least() -> None:
    graph = requiring({0, 1, 3, 5, 6}, {2, 4})
    one, other = graph.required
    costs = {0: 2, 1: 1, 2: 1, 3: 1, 4: 9, 5: 1, 6: 0}
    assert [{*graph.thin(most, costs.__getitem__).makers[one]} for most in (1, 2, 3, 4, 9)] == [
        *({1}, {0, 1}, {0, 1, 6}, {0, 1, 3, 6}, {0, 1, 3, 5, 6}),
    ]
    assert {*graph.thin(1, costs.__getitem__).makers[other]} == {4}
    assert {*graph.makers[one]} == {0, 1, 3, 5, 6}


@pytest.mark.parametrize("reductions", [ALL, ALL - {Reduction.BOUNDS}, frozenset({Reduction.DEAR})], ids=len)
def test_what_is_left_has_the_best_tree_with_a_unit_of_each_required_set(
    reductions: frozenset[Reduction],
) -> None:
    left_out = 0
    for seed in range(60):
        rng = random.Random(seed)
        problem, _, every = posed(seed)
        size = len(problem.network)
        objective = (Objective.UNITS, Objective.INPUTS, Objective.KITCHEN)[seed % 3]
        sets = tuple(
            frozenset(rng.sample(range(size), rng.choice((1, 2)))) for _ in range(rng.choice((1, 2)))
        )
        found = [tree for tree in every if all(tree.units & each for each in sets)]
        restricted = replace(problem, restriction=Restriction(lambda _: False, sets))
        reduced = reduce(restricted, levels((objective,)), reductions)
        if not found:
            assert reduced.tree is None, seed
            continue
        by = [str(objective), "units"]
        [in_hand] = [tree for tree in found if tree.units == reduced.tree]
        assert not reduced.settled or in_hand.key(by) == min(tree.key(by) for tree in found), seed
        assert_left(reduced.units, found, by, reductions)
        left_out += size - len(reduced.units)
    assert left_out > 20


BEST = frozenset({0, 1, 3})  # 1 to 3 are as good, and found later
# in a larger network more may be looked at for a tree
EITHER = replace(
    without_never(*WAYS, *(f"wait: never > x{n}" for n in range(19))),
    restriction=Restriction(lambda _: False, (frozenset({3, 6}),)),
)
MOTIONS = ("boil", "cut", "mix", "fry", "wash", "dry", "fold", "wait")
RATED = replace(EITHER, rates={motion: Fraction(9, 10 + n) for n, motion in enumerate(MOTIONS)})


def test_what_is_found_for_the_goals_alone_is_no_tree_but_its_bound_holds() -> None:
    heard = Heard()
    assert reduce(EITHER, UNITS, listener=heard).tree == BEST
    assert (heard.trees, heard.bounds) == ([{0, 1, 3}], [1, 3])


@pytest.mark.parametrize(("objectives", "posed"), [(UNITS, EITHER), (SUCCESS, RATED)], ids=str)
def test_a_tree_as_cheap_as_the_best_for_the_goals_alone_is_the_best(
    objectives: tuple[Objective, ...], posed: Problem
) -> None:
    best = reduce(replace(posed, restriction=None), objectives)
    assert best.settled
    assert best.tree is not None
    asked = replace(posed, restriction=Restriction(lambda _: False, (best.tree,)))
    found = reduce(asked, objectives)
    assert (found.tree, found.settled, found.units) == (best.tree, True, tuple(best.tree))
    assert found.costs is not None
    assert found.cuts is not None
    assert found.costs.first_objective_bound(found.bound) == found.costs.first_objective_bound(
        sum(map(found.costs, best.tree))
    )
    # not where what is as good counts, or what is left out may be in such a tree
    assert not reduce(asked, objectives, ALL - {Reduction.BOUNDS}).settled


def test_ctrl_c_leaves_a_tree_with_a_unit_of_each_required_set() -> None:
    interrupted = 0
    for calls in range(20):
        reduced = reduce(EITHER, UNITS, SAFE, interrupt_at(calls))
        assert (reduced.tree, reduced.settled) == (BEST, False)
        assert reduced.interrupted or {1, 2, 3} <= {*reduced.units}  # as good as the one in hand
        interrupted += reduced.interrupted
    assert interrupted > 2
