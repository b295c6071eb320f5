"""Trees found fast: nothing in them can be left out, and a better one is taken where one is found."""

import random
from collections.abc import Callable, Collection
from functools import partial

import pytest

from foon_asp.hypergraph.cost_partition import CostPartition
from foon_asp.hypergraph.goal_graph import GoalGraph
from foon_asp.hypergraph.h_values import compute_h_values
from foon_asp.hypergraph.incumbent_trees import (
    improve_locally,
    irredundant_subset,
    perturbation_search,
    trees_by_lp_values,
    trees_by_partition,
)
from tests.hypergraph.test_reduce_parts import solvable, with_trees
from tests.support.plain_graphs import executes, plain


def never() -> bool:
    return False


def total(tree: Collection[int], price: dict[int, int]) -> int:
    return sum(map(price.__getitem__, tree))


def test_nothing_more_can_be_left_out_of_a_tree() -> None:
    costs = 0
    for graph, price, able in solvable(120):
        tree = irredundant_subset(graph, able, price.__getitem__)
        assert executes(graph, tree)
        made = (compute_h_values(graph, tree - {a}, price, h_add=True) for a in tree)
        assert all(each.tree(graph, graph.goals) is None for each in made)
        costs += total(tree, price)
    assert costs <= 660


def test_what_cannot_be_left_out_stays() -> None:
    only = 0
    for price, graph, slim in with_trees():
        able = compute_h_values(graph, graph.cone()[0], price.__getitem__, h_add=False).h_actions
        assert irredundant_subset(graph, able, price.__getitem__) in slim
        for tree in slim:
            assert irredundant_subset(graph, tree, price.__getitem__) == tree
            for larger in (tree | {more} for more in able):
                inside = [other for other in slim if other <= larger]
                runs = compute_h_values(graph, larger, lambda _: 1, h_add=False).h_actions
                if len(runs) == len(larger) and len(inside) == 1:
                    only += 1  # whatever the costs
                    assert irredundant_subset(graph, larger, price.__getitem__) == tree
    assert only > 100


# the goals 1, 2 and 3: 1 of 0 or 1, 2 of 1 or 2, and 3 of 2 alone; 1 needs what 3 gives
CHAIN = plain([([], [1]), ([4], [1, 2]), ([], [2, 3]), ([0], [4])], [1, 2, 3], [0])


@pytest.mark.parametrize(
    ("prices", "expected"),
    [
        ([1, 2, 9, 1], {0, 2}),  # the dear one of two goes, and what only it needs
        ([3, 2, 9, 1], {1, 2, 3}),
        ([2, 2, 9, 0], {1, 2, 3}),  # the first of those that cost the same
        ([2, 2, 3, 1], {0, 2}),  # which 1 gives as cheaply as 2 is not asked for of both
    ],
)
def test_dear_ones_go_first(prices: list[int], expected: set[int]) -> None:
    assert irredundant_subset(CHAIN, range(4), prices.__getitem__) == expected


def test_with_one_out_the_others_are_followed_by_costs_that_add_up() -> None:
    # without 0, the goal comes of 2, 3 and 4, which cost 9, or of 5 and 6, which cost 8 and are dearer singly
    makers = [([0], [1]), ([2, 3, 4], [1]), ([0], [2]), ([0], [3]), ([0], [4]), ([5], [1]), ([0], [5])]
    graph = plain([*makers, ([1], [6])], [6], [0])
    prices = [20, 1, 3, 3, 3, 2, 6, 1]
    assert irredundant_subset(graph, range(8), prices.__getitem__) == {5, 6, 7}


@pytest.mark.parametrize("thorough", [False, True])
def test_a_tree_is_exchanged_for_a_cheaper_one_only(thorough: bool) -> None:
    costs = better = 0
    for price, graph, slim in with_trees():
        able = compute_h_values(graph, graph.cone()[0], price.__getitem__, h_add=False).h_actions
        ordered = sorted((total(tree, price), sorted(tree)) for tree in slim)
        best, dearest = set(ordered[0][1]), set(ordered[-1][1])
        found = improve_locally(graph, able, dearest, price.__getitem__, lambda a: a % 3, never, thorough)
        assert found in slim
        assert total(found, price) < total(dearest, price) or found is dearest
        assert (
            improve_locally(graph, able, best, price.__getitem__, price.__getitem__, never, thorough) is best
        )
        costs += total(found, price)
        better += found is not dearest
    for graph, price, runs in solvable(120):
        tree = irredundant_subset(graph, runs, {a: 6 - price[a] for a in price}.__getitem__)
        found = improve_locally(graph, runs, tree, price.__getitem__, lambda a: a % 3, never, thorough)
        costs += total(found, price)
    assert better > 10
    assert costs <= (719 if thorough else 789)


# The goal 1 comes of 3 and 4, each of which comes of 2 (0 to 3), of 5 and 6 (4 to 6), or at once (7).
ROUTES = plain(
    [([], [2]), ([2], [3]), ([2], [4]), ([3, 4], [1]), ([], [5]), ([], [6]), ([5, 6], [1]), ([], [1])], [1]
)
SHARING, APART, ONCE = {0, 1, 2, 3}, {4, 5, 6}, {7}


@pytest.mark.parametrize(
    ("prices", "rests", "expected"),
    [
        # to add up: 9 and 7, the dearest ways: 5 and 6, of 8 and 7; by what is left it is the other one
        ([1, 3, 3, 1, 5, 1, 1], [0, 0, 0, 0, 1, 1, 1], APART),
        # to add up: 13 and 9, the dearest ways: 7 and 8, of 8 and 9; by what is left it is the other one
        ([5, 1, 1, 1, 7, 1, 1], [1, 1, 1, 1, 0, 0, 0], SHARING),
        # 13 and 9, 7 and 5, of 8 and 9; what is left adds up to 5 and 6, the dearest ways are 4 and 3
        ([5, 1, 1, 1, 4, 4, 1], [0, 1, 1, 3, 3, 3, 0], SHARING),
        # the same, but what is left adds up to 6 and 5, and the dearest ways are 3 and 4
        ([5, 1, 1, 1, 4, 4, 1], [0, 3, 3, 0, 1, 1, 3], SHARING),
    ],
)
def test_each_estimate_alone_leads_to_a_better_tree(
    prices: list[int], rests: list[int], expected: set[int]
) -> None:
    price, rest = [*prices, 20].__getitem__, [*rests, 20].__getitem__
    assert improve_locally(ROUTES, range(8), set(ONCE), price, rest, never, thorough=False) == expected


@pytest.mark.parametrize(
    ("prices", "lp_values", "left", "expected"),
    [
        # only what the relaxed solution lacks, added up (3005 and 3003), leads to what is apart
        ([2, 3, 3, 4, 6, 3, 1], [2.0, 0.75, 0.25, 2.0, 0.5, 1.25, 1.25], [0, 1, 1, 0, 2, 2, 2], APART),
        # only costs with what is left of them do, 48 and 38, or 32 and 28 the dearest ways
        ([4, 3, 4, 3, 1, 5, 5], [1.0, 2.0, 0, 0.75, 0.5, 0.0, 0.5], [9, 0, 9, 3, 9, 9, 9], APART),
        # thousandths are told apart
        (
            [1, 1, 1, 1, 2, 3, 3],
            [0.9966] * 2 + [0.9974, 0.9991, 0.9966, 0.9982, 0.9991],
            [30, 0, 30],
            SHARING,
        ),
    ],
)
def test_a_relaxed_solution_leads_to_a_better_tree(
    prices: list[int], lp_values: list[float], left: list[int], expected: set[int]
) -> None:
    rests = dict.fromkeys(range(7), 0) | dict(enumerate(left)) | {7: 9}
    relaxed = CostPartition(0, rests, [], dict(enumerate([*lp_values, 0.0])))
    price = [*prices, 20].__getitem__
    found = [ONCE, *trees_by_partition(ROUTES, range(8), price, relaxed)]
    assert all(executes(ROUTES, tree) for tree in found)
    assert min(found, key=lambda tree: sum(map(price, tree))) == expected
    guesses = [*trees_by_lp_values(ROUTES, range(8), price, dict(enumerate([*lp_values, 0.0])), expected)]
    assert all(executes(ROUTES, tree) and tree.isdisjoint(expected) for tree in guesses)


def test_to_be_thorough_each_is_forbidden_in_turn() -> None:
    # twice: 1 of 2 (goals are 1 and 3), which costs 6 and 1; and 3 at once, or of 2 for 1
    once = [([], [2]), ([2], [1]), ([], [3]), ([2], [3])]
    graph = plain(
        [*once, *(([n + 4 for n in need], [n + 4 for n in give]) for need, give in once)], [1, 3, 5, 7]
    )
    price = [6, 1, 5, 1, 6, 1, 5, 1].__getitem__
    hand = {0, 1, 2, 4, 5, 6}
    found = [
        improve_locally(graph, range(8), hand, price, price, never, thorough) for thorough in (False, True)
    ]
    assert found == [hand, {0, 1, 3, 4, 5, 7}]
    # what may not be used is not, and when time is up no more is tried
    assert improve_locally(graph, range(7), hand, price, price, never, thorough=True) == {0, 1, 3, 4, 5, 6}
    asked = iter([False] * 3 + [True] * 9)
    assert improve_locally(
        graph, range(8), hand, price, lambda _: 0, asked.__next__, thorough=True
    ) == hand - {2} | {3}


# three sets of three goals each for 2, of goals in rows, and for each goal an action of its own for 1
SETS = plain(
    [*[([0], [n]) for n in range(1, 10)], *[([0], [n, n + 1, n + 2]) for n in (1, 4, 7)]], range(1, 10), [0]
)
SET_COSTS = [1] * 9 + [2] * 3


def by_chance(
    graph: GoalGraph,
    actions: Collection[int],
    tree: set[int],
    price: Callable[[int], int],
    enough: int,
    expired: Callable[[], bool] = never,
) -> set[int]:
    """Look for a cheaper tree where a relaxed solution says nothing."""
    nothing = dict.fromkeys(actions, 0.0)
    return perturbation_search(
        graph, actions, tree, price, enough, expired, nothing, random.Random(0).random, 40
    )


def test_chance_leads_where_no_estimate_does() -> None:
    price, single = SET_COSTS.__getitem__, set(range(9))
    for added in (True, False):
        assert compute_h_values(SETS, range(12), price, added).tree(SETS, SETS.goals) == single
    assert by_chance(SETS, range(12), single, price, 0) == {9, 10, 11}
    assert by_chance(SETS, range(12), single, price, 0, lambda: True) is single
    assert by_chance(SETS, range(9), single, price, 0) is single
    assert by_chance(SETS, range(12), single, price, 9) is single
    assert 6 < sum(map(price, by_chance(SETS, range(12), single, price, 8))) <= 8


def test_chance_goes_along_with_a_relaxed_solution() -> None:
    """The three sets are the best whatever chance says, where a solution takes most of them."""
    price, single = SET_COSTS.__getitem__, set(range(9))
    lp_values = dict.fromkeys(range(9), 0.1) | dict.fromkeys(range(9, 12), 0.9)
    for times, least in ((0.4, 6), (0.6, 9)):  # each other time
        chances = iter([times, *[0.5] * 12])
        chance = partial(next, chances, 0.999)
        found = perturbation_search(SETS, range(12), single, price, 8, never, lp_values, chance, 1)
        assert (sum(map(price, found)) == 6) == (least == 6)


def test_what_chance_leads_to_is_a_tree_and_no_dearer() -> None:
    costs = 0
    for graph, price, able in solvable(80):
        tree = irredundant_subset(graph, able, lambda _: 1)  # not by what they cost
        better = by_chance(graph, able, tree, price.__getitem__, 0)
        assert executes(graph, better)
        assert better <= set(able)
        assert better is tree or total(better, price) < total(tree, price)
        assert better == irredundant_subset(graph, better, price.__getitem__) or better is tree
        costs += total(better, price)
    assert costs <= 333
