"""Estimates of what things cost, held against their definition, and trees that follow them."""

import math
import random
from collections.abc import Collection, Mapping
from typing import Any

import pytest

from foon_asp.reduce.derivation import Derivations, derive
from foon_asp.reduce.graph import Graph
from tests.plain_graphs import executes, plain, random_graph

# 1 is made for 3; of it 2 for 2 more and 3 for 4 more, and of both the goal 4 for 1 more; or 3 at once for 9
SHARED = plain([([0], [1]), ([1], [2]), ([1, 0], [3]), ([2, 3], [4]), ([], [3])], [4], [0])
PRICES = {0: 3, 1: 2, 2: 4, 3: 1, 4: 9}


def test_what_is_used_twice_is_counted_twice_where_needs_are_added() -> None:
    added = derive(SHARED, range(5), PRICES, added=True)
    assert added.cost == {1: 3, 2: 5, 3: 7, 4: 13}
    assert added.before == {0: 3, 1: 5, 2: 7, 3: 13, 4: 9}
    assert added.maker == {1: 0, 2: 1, 3: 2, 4: 3}


def test_where_the_dearest_need_counts_the_others_come_for_nothing() -> None:
    dearest = derive(SHARED, range(5), PRICES.__getitem__, added=False)
    assert dearest.cost == {1: 3, 2: 5, 3: 7, 4: 8}
    assert dearest.before == {0: 3, 1: 5, 2: 7, 3: 8, 4: 9}
    assert dearest.maker == {1: 0, 2: 1, 3: 2, 4: 3}


def test_what_comes_cheaper_later_in_the_list_is_taken_first() -> None:
    graph = plain([([], [1]), ([], [1]), ([], [2]), ([2], [1])], [1])
    assert derive(graph, range(4), {0: 7, 1: 6, 2: 1, 3: 1}, added=True).maker == {1: 3, 2: 2}
    assert derive(graph, range(4), {0: 7, 1: 2, 2: 1, 3: 9}, added=True).maker == {1: 1, 2: 2}
    assert derive(graph, [0, 2], {0: 7, 2: 1}, added=True).maker == {1: 0, 2: 2}


def by_definition(
    graph: Graph, actions: Collection[int], price: Mapping[int, int], added: bool
) -> tuple[dict[int, int], dict[int, int]]:
    """Work estimates out by going over all actions until nothing changes."""
    cost: dict[int, float] = dict.fromkeys(range(graph.size), math.inf) | dict.fromkeys(graph.start, 0)
    before: dict[int, float] = {}
    for _ in range(graph.size + 1):
        for a in actions:
            needed = [cost[o] for o in graph.needs[a] if o not in graph.start]
            before[a] = price[a] + (sum(needed) if added else max(needed, default=0))
            for o in graph.gives[a]:
                cost[o] = min(cost[o], before[a])
    return (
        {o: int(c) for o, c in cost.items() if o not in graph.start and c < math.inf},
        {a: int(c) for a, c in before.items() if c < math.inf},
    )


@pytest.mark.parametrize("least", [0, 1])
@pytest.mark.parametrize("added", [True, False])
def test_estimates_are_what_they_are_defined_to_be(added: bool, least: int) -> None:
    made = missed = 0
    for seed in range(150):
        rng = random.Random(seed)
        graph = random_graph(seed)
        price = {a: rng.randint(least, 5) for a in range(9)}
        actions = rng.sample(range(9), 8)
        found = derive(graph, actions, price, added)
        assert (found.cost, found.before) == by_definition(graph, actions, price, added)
        assert list(found.before.values()) == sorted(found.before.values())
        for o, action in found.maker.items():
            assert o in graph.gives[action]
            assert found.before[action] == found.cost[o]
        assert found.maker.keys() == found.cost.keys()
        tree = found.tree(graph, graph.goals)
        if graph.start.union(found.cost).issuperset(graph.goals):
            assert tree is not None
            assert executes(graph, tree)
            used = {*graph.goals}.union(*(graph.needs[a] for a in tree)) - graph.start
            assert tree == {found.maker[o] for o in used}
            made += 1
        else:
            assert tree is None
            missed += 1
    assert min(made, missed) > 10


def test_what_is_there_from_the_start_is_made_by_nothing() -> None:
    graph = plain([([], [0, 1]), ([0], [2])], [0, 2], [0])
    found = derive(graph, range(2), {0: 1, 1: 1}, added=True)
    assert found == Derivations({1: 1, 2: 1}, {1: 0, 2: 1}, {0: 1, 1: 1})
    assert found.tree(graph, [0]) == set()
    assert found.tree(graph, [0, 2]) == {1}
    assert found.tree(graph, [2, 3]) is None


def test_of_actions_each_is_asked_for_its_price_once() -> None:
    asked: list[int] = []

    def price(action: int) -> int:
        asked.append(action)
        return PRICES[action]

    for added in (True, False):
        asked.clear()
        derive(SHARED, range(5), price, added)
        assert sorted(asked) == [0, 1, 2, 3, 4]


def test_of_a_tree_each_action_is_followed_once() -> None:
    # two of each of 60 steps, each of which needs both of the step before: 2 ** 60 ways back
    steps = [([2 * step, 2 * step + 1], [2 * step + 2 + side]) for step in range(60) for side in range(2)]
    graph = plain(steps, [120, 121], [0, 1])
    found = derive(graph, range(120), dict.fromkeys(range(120), 1), added=False)
    assert found.tree(graph, graph.goals) == set(range(120))


def test_nothing_is_made_of_nothing() -> None:
    circle: Any = plain([([1], [2]), ([2], [1])], [1])
    assert derive(circle, range(2), {0: 0, 1: 0}, added=True) == Derivations({}, {}, {})
    assert derive(circle, (), {}, added=False).tree(circle, [1]) is None
