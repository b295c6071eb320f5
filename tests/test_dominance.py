"""Which actions others stand in for, and what is beside those that every tree has: small cases."""

import random
from dataclasses import replace

import pytest

from foon_asp.reduce import dominance
from foon_asp.reduce.dominance import undominated
from foon_asp.reduce.forced import beside_forced
from tests.plain_graphs import Action, plain

# Of 0, which is there, the goals 1 and 2 are made, and 3, which the last action needs for 1.
LAST: Action = ([3], [1])


@pytest.mark.parametrize(
    ("actions", "prices", "expected"),
    [
        # one that needs less, gives more, or costs less, and is no worse in the rest
        ([([3], [1]), ([0], [1])], [5, 5], {1}),
        ([([0, 4], [1, 3]), ([4], [1])], [5, 5], {0}),
        ([([0], [1]), ([0], [1])], [5, 4], {1}),
        ([([0], [1]), ([0], [1])], [4, 5], {0}),
        # of two that are as good, the last
        ([([0], [1]), ([0], [1])], [5, 5], {1}),
        ([([0, 4], [1]), ([4], [1])], [5, 5], {1}),  # to need what is there is to need nothing
        ([([0], [1, 0, 9]), ([0], [1])], [5, 5], {1}),  # to give what nobody needs is to give nothing
        ([([0], [1]), ([0], [1, 9])], [5, 5], {1}),
        # better in one thing and worse in another
        ([([3], [1]), ([0], [1])], [4, 5], {0, 1}),
        ([([0], [1, 2]), ([0], [1])], [5, 4], {0, 1}),
        ([([3], [1, 2]), ([0], [1])], [5, 5], {0, 1}),
        ([([3], [1]), ([4], [1])], [5, 5], {0, 1}),
        ([([0], [1]), ([0], [2])], [5, 5], {0, 1}),
        # what gives nothing that is needed is of no use, however cheap
        ([([0], [9]), ([0], [1]), ([0], [])], [1, 5, 9], {1}),
        # neither of two cheap ones gives all that the dear one does
        ([([0], [1, 2]), ([0], [1]), ([0], [2])], [9, 1, 1], {0, 1, 2}),
        # one after the other: the dearest goes by the second, which goes by the third
        ([([3, 4], [1]), ([3], [1]), ([0], [1])], [5, 4, 3], {2}),
        ([([0], [1]), ([3], [1]), ([3, 4], [1])], [3, 4, 5], {0}),
    ],
)
def test_what_another_stands_in_for_goes(
    actions: list[Action], prices: list[int], expected: set[int]
) -> None:
    # 3 and 4 are made, each by one action, and needed, each by one that makes 8
    others: list[Action] = [([0], [3]), ([0], [4]), ([3, 5], [8]), ([4, 5], [8]), ([0], [5])]
    graph = plain([*actions, *others], [1, 2, 8], [0])
    count = len(actions)
    price = [*prices, *([3] * 5)].__getitem__
    left = undominated(graph, range(len(graph.needs)), price)
    assert {a for a in left if a < count} == expected
    assert {a for a in left if a >= count} == set(range(count, count + 5))
    assert undominated(graph, left, price) == left


@pytest.mark.parametrize("few", [0, 3, 99])
def test_those_that_stand_in_are_found_as_by_looking_at_all(
    few: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(dominance, "_FEW", few)
    gone = 0
    for seed in range(60):
        chance = random.Random(seed)
        objects = range(2, chance.randint(5, 9))
        some: list[Action] = [
            (chance.sample(objects, chance.randint(0, 3)), chance.sample(objects, chance.randint(1, 3)))
            for _ in range(40)
        ]
        prices = [chance.randint(1, 3) for _ in some]
        graph = plain(some, chance.sample(objects, 2), [0])
        wanted = set(graph.goals).union(*graph.needs)
        left = set(range(40))
        for action in sorted(left, key=lambda a: (-prices[a], a)):
            needs, gives = set(graph.needs[action]), wanted.intersection(graph.gives[action])
            if not gives or any(
                needs.issuperset(graph.needs[other])
                and gives.issubset(graph.gives[other])
                and prices[other] <= prices[action]
                for other in left - {action}
            ):
                left.discard(action)
        assert undominated(graph, range(40), prices.__getitem__) == left
        gone += 40 - len(left)
    assert gone > 400


def test_only_what_is_left_stands_in_and_only_its_needs_count() -> None:
    graph = plain([([0], [1, 2]), ([0], [1]), ([2], [3])], [1], [0])
    assert undominated(graph, range(3), [5, 4, 1].__getitem__) == {0, 1}  # 2 needs what 0 gives
    assert undominated(graph, {0, 1}, [5, 4, 1].__getitem__) == {1}
    assert undominated(graph, [0, 2], [5, 4, 1].__getitem__) == {0}
    assert undominated(graph, [], [5, 4, 1].__getitem__) == set()


@pytest.mark.parametrize(
    ("actions", "goals", "expected"),
    [
        # a chain of single makers, and what else gives something that they give
        ([([0], [2]), ([2], [1]), ([0], [3])], [1], {0, 1}),
        ([([0], [2, 3]), ([2, 3], [1]), ([0], [3])], [1], {0, 1}),
        ([([0], [2, 3]), ([3, 2], [1]), ([0], [3])], [1], {0, 1}),
        # two makers: neither is forced, and both stay, with what they need
        ([([2], [1]), ([3], [1]), ([0], [2]), ([0], [3]), ([0], [4])], [1], {0, 1, 2, 3}),
        # what a forced one gives is not made on the way of others
        (
            [([0], [2, 3]), ([2], [1]), ([3], [4]), ([5], [4]), ([0], [5]), ([0], [3])],
            [1, 4],
            {0, 1, 2, 3, 4},
        ),
        # a forced one that may build upon what it gives itself: 2 of 3, of which it gives some, too
        ([([2], [1, 3]), ([3], [2]), ([0], [2]), ([0], [3])], [1], {0, 1, 2, 3}),
        ([([2], [1, 3]), ([3], [2]), ([0], [2]), ([0], [3])], [3, 1], {0, 1, 2, 3}),
        # it gives the start, too, which it builds upon: that does not matter
        ([([2], [1, 0]), ([0], [2]), ([4], [2]), ([0], [4]), ([0], [1])], [1], {0, 1, 2, 3, 4}),
        ([([2], [1, 0, 3]), ([0], [2]), ([4], [2]), ([0], [4]), ([0], [3])], [1, 3], {0, 1, 2, 3}),
        ([([2], [1, 3]), ([3], [2]), ([0], [2]), ([0], [5])], [5, 3, 1], {0, 1, 2, 3}),
        # of two makers of a goal that is there by then, both go; so they do where it is met first
        ([([0], [2, 3]), ([2], [1]), ([0], [3]), ([0], [3])], [3, 1], {0, 1}),
        ([([0], [2, 3]), ([2], [1]), ([0], [3]), ([0], [3])], [1, 3], {0, 1}),
        # what cannot run at all
        ([([2], [1]), ([3], [2]), ([2], [3]), ([0], [4])], [1], {0, 1, 2}),
        ([([2], [1]), ([0], [4])], [1], {0}),
        ([([0], [2])], [1], set()),
        # goals that are there, and none
        ([([0], [1])], [0], set()),
        ([([0], [1])], [], set()),
    ],
)
def test_beside_what_is_forced_nothing_else_stays(
    actions: list[Action], goals: list[int], expected: set[int]
) -> None:
    graph = plain(actions, goals, [0])
    assert beside_forced(graph, range(len(actions))) == expected


def test_what_makes_things_that_are_there_is_not_looked_at() -> None:
    # 0 and 2 are there, and the network knows what makes them all the same, the latter of what the goal gives
    graph = plain([([2], [1, 3]), ([3], [2]), ([0], [3]), ([0], [0])], [1, 3, 0], [0, 2])
    known = replace(graph, known_makers=[(3,), (0,), (1,), (0, 2)])
    assert beside_forced(known, range(4)) == {0}


def test_only_what_is_allowed_forces_and_stays() -> None:
    graph = plain([([2], [1]), ([3], [1]), ([0], [2, 4]), ([0], [3]), ([0], [4])], [1, 4], [0])
    assert beside_forced(graph, range(5)) == {0, 1, 2, 3, 4}
    assert beside_forced(graph, {0, 2, 3, 4}) == {0, 2}
    assert beside_forced(graph, {0, 1, 3, 4}) == {0, 1, 3, 4}
    assert beside_forced(graph, {1, 3, 4}) == {1, 3, 4}
