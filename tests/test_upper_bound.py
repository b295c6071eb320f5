"""Trees found fast: nothing in them can be left out, and a better one is taken where one is found."""

import random
from collections.abc import Callable, Collection, Iterable, Iterator
from functools import partial

import pytest

from foon_asp.bounds.shared_costs import SharedCosts
from foon_asp.reduce.derivation import derive
from foon_asp.reduce.graph import Graph
from foon_asp.reduce.support import Support
from foon_asp.reduce.upper_bound import following, improved, varied, without_spare
from tests.plain_graphs import executes, plain, random_graph


def never() -> bool:
    return False


def solvable(seeds: range) -> Iterator[tuple[Graph, dict[int, int], list[int]]]:
    """Give graphs with a tree, prices of actions, and the actions that can run."""
    met = 0
    for seed in seeds:
        rng = random.Random(seed)
        graph = random_graph(seed, actions=14)
        price = {a: rng.randint(1, 6) for a in range(14)}
        made = derive(graph, range(14), price, added=False)
        if made.tree(graph, graph.goals):
            met += 1
            yield graph, price, list(made.before)
    assert met > len(seeds) // 3


def sharing(seeds: range) -> Iterator[tuple[Graph, dict[int, int], list[int]]]:
    """Give the same of graphs whose actions give much, so that cheap ways to make things have spare ones."""
    for seed in seeds:
        rng = random.Random(f"sharing {seed}")
        actions = [
            (rng.sample(range(12), rng.choice((0, 1, 2))), rng.sample(range(12), 3)) for _ in range(20)
        ]
        graph = plain(actions, rng.sample(range(1, 12), 6), [0])
        price = {a: rng.randint(0, 6) for a in range(20)}
        made = derive(graph, range(20), price, added=False)
        if made.tree(graph, graph.goals):
            yield graph, price, list(made.before)


def test_nothing_more_can_be_left_out_of_a_tree() -> None:
    for graph, price, able in (*solvable(range(60)), *sharing(range(60))):
        tree = without_spare(graph, able, price.__getitem__)
        assert executes(graph, tree)
        made = (derive(graph, tree - {a}, price, added=True) for a in tree)
        assert all(each.tree(graph, graph.goals) is None for each in made)


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
    support = Support(CHAIN, range(4), prices.__getitem__)
    assert support.left == ({0, 1, 2, 3} if prices[2] > 3 else {0, 2})
    assert [a for a in sorted(support.left) if support.replaceable(a)] == ([0, 1] if prices[2] > 3 else [])
    assert without_spare(CHAIN, range(4), prices.__getitem__) == expected


def test_what_is_of_no_use_goes_at_once_and_what_alone_gives_something_in_use_is_not_replaceable() -> None:
    # 1 gives what nobody needs, 2 the start, 3 alone gives 4, of which it gives 5 besides as 4 does
    graph = plain([([0], [1]), ([0], [2]), ([0], [0]), ([1], [4, 5]), ([0], [5]), ([4, 5], [6])], [6], [0])
    support = Support(graph, range(6), lambda _: 1)
    assert support.left == {0, 3, 4, 5}
    assert [a for a in range(6) if a in support.left and support.replaceable(a)] == [4]
    assert support.leave_out(3) is None
    assert support.leave_out(4) == set()  # 3 gives 5 as before
    assert support.left == without_spare(graph, range(6), lambda _: 1) == {0, 3, 5}


def test_what_makes_itself_in_a_circle_supports_nothing() -> None:
    # 1 and 2 come of each other and of 0; without that, they are still given, and of nothing
    graph = plain([([0], [1]), ([1], [2]), ([2], [1]), ([2], [3])], [3], [0])
    support = Support(graph, range(4), lambda _: 1)
    assert support.left == {0, 1, 3}  # 2 does nothing for the goal
    circle = plain([([0], [1, 4]), ([1], [2, 5]), ([2], [1, 6]), ([2], [3])], [3, 4, 5, 6], [0])
    support = Support(circle, range(4), lambda _: 1)
    assert support.left == {0, 1, 2, 3}
    assert [support.leave_out(a) for a in range(4)] == [None] * 4


def test_left_out_step_by_step_a_tree_stays_one_with_the_cheapest_ways() -> None:
    kept = gone = circular = 0
    for number, (graph, price, able) in enumerate((*solvable(range(80)), *sharing(range(80)))):
        support = Support(graph, able, price.__getitem__)
        order = sorted(support.left)
        random.Random(number).shuffle(order)
        for action in order:
            before = set(support.left)
            if action not in before:
                continue
            spare = [a for a in before if makes(graph, before - {a})]
            assert not spare or any(map(support.replaceable, spare))
            used = in_use(graph, before)
            others = {o for a in before - {action} for o in graph.gives[a]}
            replaceable = used.intersection(graph.gives[action]) <= others
            assert support.replaceable(action) == replaceable
            freed = support.leave_out(action)
            if action not in spare:
                assert freed is None
                assert support.left == before
                kept += 1
                circular += replaceable
            else:
                assert freed is not None
                assert support.left <= before - {action}
                # these alone may have become replaceable
                unused = used - in_use(graph, support.left)
                assert freed == {a for a in support.left if unused.intersection(graph.gives[a])}
                gone += 1
            assert executes(graph, support.left)
            ways = derive(graph, support.left, price, added=True)
            assert all(support.figure[o] == ways.cost[o] for o in in_use(graph, support.left))
        assert all(support.leave_out(a) is None for a in order if a in support.left)
    assert min(kept, gone, circular) > 10


def makes(graph: Graph, actions: Iterable[int]) -> bool:
    return derive(graph, [*actions], lambda _: 1, added=True).tree(graph, graph.goals) is not None


def in_use(graph: Graph, actions: Iterable[int]) -> set[int]:
    return {*graph.goals}.union(*(graph.needs[a] for a in actions)) - graph.start


def test_what_is_needed_after_all_stays() -> None:
    # either of 0 and 1 gives 1, but 1 needs 2, which comes of 1
    graph = plain([([0], [1]), ([2], [1, 3]), ([1], [2, 3])], [3], [0])
    assert without_spare(graph, range(3), [9, 5, 1].__getitem__) == {0, 2}


def test_with_one_out_the_others_are_followed_by_costs_that_add_up() -> None:
    # without 0, the goal comes of 2, 3 and 4, which cost 9, or of 5 and 6, which cost 8 and are dearer singly
    makers = [([0], [1]), ([2, 3, 4], [1]), ([0], [2]), ([0], [3]), ([0], [4]), ([5], [1]), ([0], [5])]
    graph = plain([*makers, ([1], [6])], [6], [0])
    prices = [20, 1, 3, 3, 3, 2, 6, 1]
    assert without_spare(graph, range(8), prices.__getitem__) == {5, 6, 7}


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
        # the same, but as much is left of both by either measure, and costs decide
        ([5, 1, 1, 1, 4, 4, 1], [0, 1, 1, 1, 1, 1, 1], APART),
    ],
)
def test_each_estimate_alone_leads_to_a_better_tree(
    prices: list[int], rests: list[int], expected: set[int]
) -> None:
    price, rest = [*prices, 20].__getitem__, [*rests, 20].__getitem__
    hand = set(ONCE)
    assert improved(ROUTES, range(8), hand, price, rest, never, thorough=False) == expected
    cheap = [*prices, min(sum(prices[a] for a in way) for way in (SHARING, APART))].__getitem__
    for thorough in (False, True):
        assert improved(ROUTES, range(8), hand, cheap, rest, never, thorough) is hand


@pytest.mark.parametrize(
    ("prices", "shares", "left", "hand", "expected"),
    [
        # only what the relaxed solution lacks, added up (3005 and 3003), leads to what is apart
        ([2, 3, 3, 4, 6, 3, 1], [2.0, 0.75, 0.25, 2.0, 0.5, 1.25, 1.25], [0, 1, 1, 0, 2, 2, 2], ONCE, APART),
        # only costs with what is left of them do, 48 and 38, or 32 and 28 the dearest ways
        ([4, 3, 4, 3, 1, 5, 5], [1.0, 2.0, 0, 0.75, 0.5, 0.0, 0.5], [9, 0, 9, 3, 9, 9, 9], ONCE, APART),
        # only what it lacks does
        ([1, 6, 1, 1, 1, 4, 1], [1.0, 0.75, 1.0, 0.25, 0.5, 1.0, 1.0], [0, 0, 0, 1, 3, 0, 5], ONCE, APART),
        # thousandths are told apart
        (
            [1, 1, 1, 1, 2, 3, 3],
            [0.9966] * 2 + [0.9974, 0.9991, 0.9966, 0.9982, 0.9991],
            [30, 0, 30, 0, 0, 0, 0],
            ONCE,
            SHARING,
        ),
        # nothing is cheaper than what is in hand
        (
            [3, 1, 2, 6, 2, 3, 6],
            [0.75, 0.25, 1.25, 1.0, 1.0, 0.75, 0.25],
            [0, 2, 1, 3, 1, 5, 9],
            SHARING,
            SHARING,
        ),
    ],
)
def test_a_relaxed_solution_leads_to_a_better_tree(
    prices: list[int], shares: list[float], left: list[int], hand: set[int], expected: set[int]
) -> None:
    relaxed = SharedCosts(0, dict(enumerate([*left, 9])), [], dict(enumerate([*shares, 0.0])))
    price = [*prices, 20].__getitem__
    found = [hand, *following(ROUTES, range(8), price, relaxed)]
    assert all(executes(ROUTES, tree) for tree in found)
    assert min(found, key=lambda tree: sum(map(price, tree))) == expected


# Twice: 1 of 2 (goals are 1 and 3), which costs 6 and 1; and 3 at once, or of 2 for 1.
TWICE = plain(
    [
        ([], [2]),
        ([2], [1]),
        ([], [3]),
        ([2], [3]),
        ([], [6]),
        ([6], [5]),
        ([], [7]),
        ([6], [7]),
    ],
    [1, 3, 5, 7],
)


@pytest.mark.parametrize(
    ("prices", "rests", "trials", "expected"),
    [
        # 0 and 4 are tried first, without which there is no tree, then 2, then 6
        ((5, 5), {}, 0, {2, 6}),
        ((5, 5), {}, 2, {2, 6}),
        ((5, 5), {}, 3, {3, 6}),
        ((5, 5), {}, 4, {3, 7}),
        # a dearer one comes before those
        ((5, 6), {}, 2, {2, 6}),
        ((5, 6), {}, 3, {2, 7}),
        ((5, 6), {}, 4, {3, 7}),
        # and first of all one of which more is left
        ((5, 5), {6: 9, 7: 10}, 1, {2, 7}),
        ((5, 5), {2: 9, 3: 10, 6: 8, 7: 10}, 1, {3, 6}),
        ((5, 5), {2: 9, 3: 10, 6: 8, 7: 10}, 2, {3, 6}),  # what came for 2 is tried next
        ((5, 5), {2: 9, 3: 10, 6: 8, 7: 10}, 3, {3, 7}),
    ],
)
def test_to_be_thorough_each_is_forbidden_in_turn(
    prices: tuple[int, int], rests: dict[int, int], trials: int, expected: set[int]
) -> None:
    price = [6, 1, prices[0], 1, 6, 1, prices[1], 1].__getitem__
    hand = {0, 1, 2, 4, 5, 6}
    for thorough in (False, True):
        asked = iter([False] * trials + [True] * 9)
        found = improved(TWICE, range(8), hand, price, lambda a: rests.get(a, 0), asked.__next__, thorough)
        assert found == ({0, 1, 4, 5} | expected if thorough else hand)
        assert (found is hand) == (found == hand)


def test_a_search_for_better_trees_ends_by_itself() -> None:
    price = [6, 1, 5, 1, 6, 1, 5, 1].__getitem__
    hand = {0, 1, 2, 4, 5, 6}
    assert improved(TWICE, range(8), hand, price, price, never, thorough=True) == {0, 1, 3, 4, 5, 7}
    # what may not be used is not
    assert improved(TWICE, range(7), hand, price, price, never, thorough=True) == {0, 1, 3, 4, 5, 6}


def test_what_the_tree_has_already_comes_for_nothing() -> None:
    # the goal 4 comes of 1, 2 and 3, which the goal 3 needs anyway, for 1 more, or at once for 3 or for 2
    chain = [([], [1]), ([1], [2]), ([2], [3]), ([3], [4]), ([], [4]), ([], [4])]
    graph = plain(chain, [3, 4])
    price, rest = [1, 1, 1, 1, 3, 2].__getitem__, [0, 0, 0, 1, 1, 0].__getitem__
    asked = iter([False, True])
    assert improved(graph, range(6), {0, 1, 2, 5}, price, rest, asked.__next__, thorough=True) == {0, 1, 2, 3}


def test_a_tree_counts_without_its_spare_units() -> None:
    # 0 is the cheapest that gives 1, and 1 the cheapest that gives 2, which gives 1 as well
    graph = plain([([], [1]), ([], [1, 2]), ([], [1, 2])], [1, 2])
    price = [1, 4, 5].__getitem__
    assert improved(graph, range(3), {2}, price, price, never, thorough=False) == {1}


def test_the_rest_of_a_tree_is_completed_by_costs_that_add_up() -> None:
    # the goal 2 comes at once for 6, of the goal 1 for 5, or of 3 and 4 for 1, which cost 3 each
    graph = plain([([], [1]), ([], [2]), ([1], [2]), ([3, 4], [2]), ([], [3]), ([], [4])], [1, 2])
    price, rest = [6, 6, 5, 1, 3, 3].__getitem__, [0, 0, 9, 9, 9, 9].__getitem__
    asked = iter([False, False, True])  # without 0 there is no tree
    assert improved(graph, range(6), {0, 1}, price, rest, asked.__next__, thorough=True) == {0, 2}


# three sets of three goals each for 2, of goals in rows, and for each goal an action of its own for 1
SETS = plain(
    [*[([0], [n]) for n in range(1, 10)], *[([0], [n, n + 1, n + 2]) for n in (1, 4, 7)]], range(1, 10), [0]
)
SET_COSTS = [1] * 9 + [2] * 3


def by_chance(
    graph: Graph,
    actions: Collection[int],
    tree: set[int],
    price: Callable[[int], int],
    enough: int,
    expired: Callable[[], bool] = never,
) -> set[int]:
    """Look for a cheaper tree where a relaxed solution says nothing."""
    nothing = dict.fromkeys(actions, 0.0)
    return varied(graph, actions, tree, price, enough, expired, nothing, random.Random(0).random, 40)


def test_chance_leads_where_no_estimate_does() -> None:
    price, single = SET_COSTS.__getitem__, set(range(9))
    for added in (True, False):
        assert derive(SETS, range(12), price, added).tree(SETS, SETS.goals) == single
    assert by_chance(SETS, range(12), single, price, 0) == {9, 10, 11}
    assert by_chance(SETS, range(12), single, price, 0, lambda: True) is single
    assert by_chance(SETS, range(9), single, price, 0) is single
    assert by_chance(SETS, range(12), single, price, 9) is single
    assert 6 < sum(map(price, by_chance(SETS, range(12), single, price, 8))) <= 8


def test_chance_goes_along_with_a_relaxed_solution() -> None:
    """The three sets are the best whatever chance says, where a solution takes most of them."""
    price, single = SET_COSTS.__getitem__, set(range(9))
    shares = dict.fromkeys(range(9), 0.1) | dict.fromkeys(range(9, 12), 0.9)
    for times, least in ((0.4, 6), (0.6, 9)):  # each other time
        chances = iter([times, *[0.5] * 12])
        chance = partial(next, chances, 0.999)
        found = varied(SETS, range(12), single, price, 8, never, shares, chance, 1)
        assert (sum(map(price, found)) == 6) == (least == 6)


def test_what_chance_leads_to_is_a_tree_and_no_dearer() -> None:
    cheaper = 0
    for graph, price, able in (*solvable(range(60)), *sharing(range(20))):
        tree = without_spare(graph, able, lambda _: 1)  # not by what they cost
        better = by_chance(graph, able, tree, price.__getitem__, 0)
        total, least = (sum(map(price.__getitem__, some)) for some in (tree, better))
        assert executes(graph, better)
        assert better <= set(able)
        assert better is tree or least < total
        assert better == without_spare(graph, better, price.__getitem__) or better is tree
        cheaper += least < total
    assert cheaper > 5
