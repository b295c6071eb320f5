"""What is near the goals, held against its definition, and a few actions among which there is a tree."""

import math
import random
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import pytest

from foon_asp.reduce.derivation import derive
from foon_asp.reduce.graph import Graph
from foon_asp.reduce.narrow import narrow
from foon_asp.reduce.near import near
from tests.plain_graphs import plain, random_graph


def by_definition(
    graph: Graph, allowed: set[int], rest: Mapping[int, int], limit: int, before: Mapping[int, int] | None
) -> set[int]:
    """Work out what is near by going over all actions until nothing changes."""
    distance: dict[int, float] = dict.fromkeys(range(graph.size), math.inf) | dict.fromkeys(graph.goals, 0)
    kept: set[int] = set()
    for _ in range(2 * graph.size):
        for a in allowed:
            closest = min((distance[o] for o in graph.gives[a] if o not in graph.start), default=math.inf)
            least = rest[a] if before is None else max(rest[a], before.get(a, math.inf))
            if closest + least <= limit:
                kept.add(a)
                for o in graph.needs[a]:
                    distance[o] = min(distance[o], closest + rest[a])
    return kept


@pytest.mark.parametrize("least", [0, 1])
def test_what_is_near_is_what_it_is_defined_to_be(least: int) -> None:
    some = 0
    for seed in range(40):
        rng = random.Random(seed)
        graph = random_graph(seed, actions=12)
        rest = {a: rng.randint(least, 5) for a in range(12)}
        allowed = set(rng.sample(range(12), 11))
        before = derive(graph, allowed, rest, added=False).before
        for limit in (0, 1, 2, 4, 7, 11):
            for known in (None, before):
                found = near(graph, allowed, rest.__getitem__, limit, known)
                assert found == by_definition(graph, allowed, rest, limit, known)
                some += 0 < len(found) < 9
    assert some > 50


@pytest.mark.parametrize(("least", "asked"), [(0, [0, 1, 2]), (1, [0, 1])])
def test_what_cannot_be_within_the_limit_is_not_asked_about(least: int, asked: list[int]) -> None:
    row = plain([([2], [1]), ([3], [2]), ([4], [3]), ([], [4])], [1])
    prices: list[int] = []

    def rest(action: int) -> int:
        prices.append(action)
        return 1

    assert near(row, range(4), rest, 2, least=least) == {0, 1}
    assert prices == asked


def test_one_that_is_too_dear_keeps_no_other_one_away() -> None:
    graph = plain([([], [1]), ([], [1]), ([], [1])], [1])
    assert near(graph, {0, 2}, [9, 1, 2].__getitem__, 5) == {2}
    assert near(graph, range(3), [9, 1, 2].__getitem__, 5) == {1, 2}


# 0, 1 and 2 give the goal; 3 and 4 what 0 needs, 5 what 1 needs, 6 what 5 needs
ROW = plain([([2], [1]), ([3], [1]), ([], [1]), ([], [2]), ([], [2]), ([4], [3]), ([], [4])], [1])
RESTS = {0: 1, 1: 2, 2: 5, 3: 1, 4: 0, 5: 1, 6: 1}


@pytest.mark.parametrize(
    ("most", "expected"),
    [
        (1, {0, 1, 2}),
        (3, {0, 1, 2}),
        (4, {0, 1, 2, 3, 4}),
        (5, {0, 1, 2, 3, 4}),
        (6, {0, 1, 2, 3, 4, 5}),
        (7, {0, 1, 2, 3, 4, 5, 6}),
        (8, {0, 1, 2, 3, 4, 5, 6}),
    ],
)
def test_the_nearest_come_first_until_there_are_enough(most: int, expected: set[int]) -> None:
    assert near(ROW, range(7), RESTS.__getitem__, 100, most=most) == expected


def test_a_limit_is_kept_to_by_the_way_there_and_by_the_way_to_the_start() -> None:
    graph = plain([([2], [1]), ([3], [2]), ([0], [3])], [1], [0])
    rest = {0: 2, 1: 0, 2: 3}.__getitem__
    found = [near(graph, range(3), rest, limit) for limit in range(1, 6)]
    assert found == [set(), {0, 1}, {0, 1}, {0, 1}, {0, 1, 2}]
    before = {0: 5, 1: 3, 2: 3}
    assert [near(graph, range(3), rest, limit, before) for limit in (4, 5)] == [set(), {0, 1, 2}]
    assert near(graph, range(3), rest, 5, {0: 5, 1: 3}) == {0, 1}  # 2 cannot run
    assert near(graph, range(3), rest, 5, {0: 5, 1: 4, 2: 3}) == {0}  # 1 is dearer than thought


def test_no_action_is_asked_for_what_is_left_of_its_cost_more_than_once() -> None:
    asked = []

    def rest(action: int) -> int:
        asked.append(action)
        return 0

    graph = plain([([2, 3], [1]), ([4], [2]), ([4], [3]), ([], [4]), ([], [4])], [1])
    assert near(graph, range(5), rest, 0) == {0, 1, 2, 3, 4}
    assert sorted(asked) == [0, 1, 2, 3, 4]


class Counted(list[tuple[int, ...]]):
    """A list that notes what is asked of it."""

    def __init__(self, items: Iterable[Sequence[int]]) -> None:
        super().__init__(map(tuple, items))
        self.asked: list[int] = []

    def __getitem__(self, place: Any) -> Any:
        self.asked.append(place)
        return super().__getitem__(place)


def test_no_object_is_looked_at_twice_or_is_there_from_the_start() -> None:
    graph = plain([([2, 3, 0], [1]), ([4], [2]), ([4], [3]), ([0], [4]), ([3], [2])], [1], [0])
    makers = Counted(graph.makers)
    assert near(with_makers(graph, makers), range(5), lambda a: 5 - a, 100) == {0, 1, 2, 3, 4}
    assert sorted(makers.asked) == [1, 2, 3, 4]


def with_makers(graph: Graph, makers: Sequence[Sequence[int]]) -> Graph:
    return replace(graph, known_makers=makers)


# the goal 1 is given by 0, of what nothing gives, and by 1, of 2 and 3, which are given by two each
FEW = plain([([5, 0], [1]), ([2, 3], [1]), ([2], [2]), ([0], [2]), ([6], [3]), ([0], [3])], [1], [0])
FEW_PRICES = {0: 1, 1: 1, 2: 1, 3: 4, 4: 1, 5: 2}


def test_actions_are_added_until_there_is_a_tree() -> None:
    found = narrow(FEW, set(), FEW_PRICES.__getitem__, 100)
    assert found is not None
    made, tree = found
    assert tree == {1, 3, 5}
    assert made == derive(FEW, [1, 3, 5], FEW_PRICES, added=False)
    assert made.before == {3: 4, 5: 2, 1: 5}
    assert narrow(FEW, {2}, FEW_PRICES.__getitem__, 100) == (
        derive(FEW, [1, 2, 3, 5], FEW_PRICES, added=False),
        {1, 3, 5},
    )


@pytest.mark.parametrize(("actions", "most", "enough"), [([], 0, False), ([], 1, True), ([2, 4], 2, False)])
def test_more_are_added_as_long_as_there_are_not_too_many(
    actions: list[int], most: int, enough: bool
) -> None:
    # 0 in the first round, 1 and what it needs in the second
    assert (narrow(FEW, set(actions), FEW_PRICES.__getitem__, most) is not None) is enough


@pytest.mark.parametrize(
    ("makers", "prices", "first"),
    [
        # 2 is given by the last action
        ([([2], [1]), ([0], [1])], [1, 9], {1}),  # that lacks least
        ([([2, 3], [1]), ([2, 0], [1])], [1, 9], {1, 2}),
        ([([0], [1]), ([0], [1])], [9, 1], {1}),  # that costs least
        ([([0], [1]), ([0], [1])], [1, 9], {0}),
        ([([0], [1]), ([0], [1])], [5, 5], {0}),  # the first
        ([([2, 0], [1]), ([9], [1])], [1, 1], {0, 2}),
    ],
)
def test_of_the_makers_one_comes_first(
    makers: list[tuple[list[int], list[int]]], prices: list[int], first: set[int]
) -> None:
    graph = plain([*makers, ([0], [2])], [1], [0])
    found = narrow(graph, set(), [*prices, 1].__getitem__, 100)
    assert found is not None
    assert set(found[0].before) == first == found[1]


@pytest.mark.parametrize("needed", range(1, 7))
def test_what_is_there_from_the_start_keeps_nothing_from_being_made(needed: int) -> None:
    graph = plain([(range(7), [7]), ([], [needed])], [7], {*range(7)} - {needed})
    assert narrow(graph, set(), lambda _: 1, 100) == (
        derive(graph, [0, 1], [1, 1].__getitem__, False),
        {0, 1},
    )


def test_no_more_makers_are_added_than_are_asked_for() -> None:
    # what the goal 1 needs (2 and 3) is needed by what gives 3, too; there are two makers of 2
    actions = [([2, 3], [1]), ([0], [2]), ([0], [2]), ([2], [3]), ([0], [9])]
    found = narrow(plain(actions, [1], [0]), set(), lambda _: 1, 100)
    assert found is not None
    assert set(found[0].before) == {0, 1, 3}
    # a second round adds a maker of 3, which lacks one, and none of 2, which is made, or of 0
    actions[3] = ([8], [3])
    graph = plain([*actions, ([4], [3]), ([0], [4])], [1], [0])
    found = narrow(with_makers(graph, [(4,), *graph.makers[1:]]), set(), lambda _: 1, 100)
    assert found is not None
    assert set(found[0].before) == {0, 1, 5, 6}


def test_where_no_more_can_be_added_there_is_no_tree() -> None:
    assert narrow(plain([([2], [1]), ([1], [2])], [1]), set(), lambda _: 1, 100) is None
    assert narrow(plain([([2], [1])], [1]), set(), lambda _: 1, 100) is None
    assert narrow(plain([], []), set(), lambda _: 1, 0) == (derive(FEW, (), {}, added=False), set())
