"""Landmark cuts on small graphs: which are found, what they weigh and what they leave."""

import random
import sys
from collections.abc import Callable, Mapping

import pytest

from foon_asp.bounds.hypergraph import Hypergraph
from foon_asp.bounds.landmark_cuts import Cuts, WeightedCut, landmark_cuts

# 0 is at hand; 3 is made of 1 and 2 or of 2 and 0, 2 of 0 in two ways, 1 of nothing, or with 4 of 3
KITCHEN = Hypergraph(
    5, needs=[[1, 2], [2, 0], [], [0], [0, 0], [3]], gives=[[3], [3, 0], [1], [2], [2], [4, 1]], start=[0]
)


def ask(costs: list[int], targets: list[int], dear: Mapping[int, int] | None = None) -> Cuts:
    return landmark_cuts(KITCHEN, targets, range(6), costs.__getitem__, dear or {}, lambda: False)


def cut(objects: set[int], members: tuple[int, ...], cheapest: int, weight: int) -> WeightedCut:
    return WeightedCut(frozenset(objects), members, cheapest, weight)


@pytest.mark.parametrize(
    ("costs", "targets", "dear", "bound", "left", "cuts"),
    [
        (
            [2, 3, 1, 5, 4, 1],
            [3],
            {},
            7,
            {0: 0, 1: 0, 3: 1, 4: 0, 2: 0},
            [cut({3}, (0, 1), 0, 2), cut({2, 3}, (3, 4), 4, 4), cut({1, 3}, (1, 2), 1, 1)],
        ),
        (
            [3, 2, 1, 5, 4, 1],
            [3],
            {},
            6,
            {0: 1, 1: 0, 3: 1, 4: 0},
            [cut({3}, (0, 1), 1, 2), cut({2, 3}, (3, 4), 4, 4)],
        ),
        (  # 1 is thought to be dearer than 2
            [2, 9, 1, 5, 4, 1],
            [3],
            {1: 3, 2: 2, 3: 9},
            7,
            {0: 0, 1: 6, 2: 0, 3: 1, 4: 0},
            [cut({3}, (0, 1), 0, 2), cut({1, 3}, (1, 2), 2, 1), cut({2, 3}, (3, 4), 4, 4)],
        ),
        (  # what nothing is known about is thought to be dearest of all, and tried first
            [2, 2, 1, 5, 5, 1],
            [2, 3, 4],
            {3: 9, 2: 1000},
            8,
            {5: 0, 3: 0, 4: 0, 0: 0, 1: 0},
            [cut({4}, (5,), 5, 1), cut({2}, (3, 4), 3, 5), cut({3}, (0, 1), 0, 2)],
        ),
        (  # each target in turn has a cut, the one thought to be dearest before the others
            [2, 2, 1, 5, 5, 1],
            [3, 4],
            {3: 9, 2: 1000},
            8,
            {5: 0, 0: 0, 1: 0, 3: 0, 4: 0, 2: 0},
            [
                cut({4}, (5,), 5, 1),
                cut({3}, (0, 1), 0, 2),
                cut({1, 2, 3, 4}, (3, 4, 2), 2, 1),  # action 0 lacks 1 rather than 2, action 1 lacks 2
                cut({2, 3}, (3, 4), 3, 4),
            ],
        ),
        (  # the target that is thought to be dearest is tried first
            [2, 2, 1, 5, 5, 1],
            [1, 2],
            {1: 1, 2: 2},
            6,
            {3: 0, 4: 0, 2: 0, 5: 0},
            [cut({2}, (3, 4), 3, 5), cut({1}, (2, 5), 2, 1)],
        ),
        ([2, 3, 1, 5, 4, 1], [], {}, 0, {}, []),
    ],
)
def test_cuts_are_weighed_until_the_targets_come_for_nothing(
    costs: list[int],
    targets: list[int],
    dear: dict[int, int],
    bound: int,
    left: dict[int, int],
    cuts: list[WeightedCut],
) -> None:
    assert ask(costs, targets, dear) == Cuts(bound, left, cuts)


def test_only_what_is_allowed_counts() -> None:
    price = [2, 3, 1, 5, 4, 1].__getitem__
    found = landmark_cuts(KITCHEN, [3], {1, 3}, price, {}, lambda: False)
    assert found == (8, {1: 0, 3: 0}, [cut({3}, (1,), 1, 3), cut({2, 3}, (3,), 3, 5)], False, False)
    lost = landmark_cuts(KITCHEN, [3], {0, 1, 2}, price, {}, lambda: False)
    assert lost == (2, {0: 0, 1: 1}, [cut({3}, (0, 1), 0, 2)], True, False)
    assert landmark_cuts(KITCHEN, [3], (), price, {}, lambda: False) == (0, {}, [], True, False)


def test_an_action_that_lacks_an_object_of_the_cut_asks_for_no_other() -> None:
    # both actions that give 0 need 1, one of them 2 as well
    graph = Hypergraph(3, needs=[[1], [1, 2], [], []], gives=[[0], [0], [1], [2]], start=[])
    found = landmark_cuts(graph, [0], range(4), [1, 1, 5, 7].__getitem__, {}, lambda: False)
    assert found.cuts == [cut({0}, (0, 1), 0, 1), cut({0, 1}, (2,), 2, 5)]


def test_what_was_found_stands_when_time_is_up_or_ctrl_c_comes() -> None:
    price = [2, 3, 1, 5, 4, 1]
    answers = iter([False, False, True])
    late = landmark_cuts(KITCHEN, [3], range(6), price.__getitem__, {}, answers.__next__)
    assert late == (6, {0: 0, 1: 1, 3: 1, 4: 0}, ask(price, [3]).cuts[:2], False, False)

    def interrupted(action: int) -> int:
        if action == 2:
            raise KeyboardInterrupt
        return price[action]

    found = landmark_cuts(KITCHEN, [3], range(6), interrupted, {}, lambda: False)
    assert found._replace(left={}) == (6, {}, ask(price, [3]).cuts[:2], False, True)


def test_landmarks_of_many_members_end_the_search_for_more() -> None:
    price = [2, 3, 1, 5, 4, 1]
    cuts = ask(price, [3]).cuts
    assert [len(each.members) for each in cuts[:2]] == [2, 2]
    for most, found in ((0, 0), (1, 1), (2, 1), (3, 2), (4, 2), (5, 3)):
        some = landmark_cuts(KITCHEN, [3], range(6), price.__getitem__, {}, lambda: False, None, most)
        assert some.cuts == cuts[:found]
        assert some.bound == sum(each.weight for each in some.cuts)
        assert not some.interrupted


def test_a_guide_is_asked_by_what_is_left_after_64_cuts_and_one_for_each_target() -> None:
    # targets that take three actions each, one after the other, and more targets that take one
    asked: list[list[int]] = []
    costs = [1 + number % 3 for number in range(120)]

    def guide(rest: Callable[[int], int]) -> dict[int, int]:
        asked.append([action for action in range(120) if not rest(action)])
        return {}

    needs: list[list[int]] = [[number + 40] if number < 80 else [] for number in range(120)]
    graph = Hypergraph(120, needs, [[number] for number in range(120)], [])
    found = landmark_cuts(graph, range(40), range(120), costs.__getitem__, {}, lambda: False, guide)
    assert found.bound == sum(costs)
    assert asked == [[*range(40), *range(56, 80)]]
    asked.clear()
    found = landmark_cuts(graph, range(120), range(120), costs.__getitem__, {}, lambda: False, guide)
    assert (found.bound, asked) == (sum(costs), [])


def test_a_cut_goes_through_what_the_guide_says_to_be_dearest(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.modules["foon_asp.bounds.landmark_cuts"], "_FRESH", 1)
    price = [2, 3, 1, 5, 4, 1]
    found = landmark_cuts(
        KITCHEN, [3], range(6), price.__getitem__, {}, lambda: False, lambda rest: {1: 3 - rest(0), 2: 1}
    )
    assert found.cuts[1] == cut({1, 3}, (1, 2), 1, 1)
    assert found.bound == 7


@pytest.mark.parametrize("seed", range(100))
def test_random_cuts_hold_and_leave_the_targets_for_nothing(seed: int) -> None:
    rng = random.Random(seed)
    size, actions = rng.randint(3, 9), rng.randint(3, 14)
    needs = [rng.sample(range(size), rng.randint(0, min(3, size))) for _ in range(actions)]
    gives = [rng.sample(range(size), rng.randint(1, 2)) for _ in range(actions)]
    graph = Hypergraph(size, needs, gives, [0])
    costs = [rng.randint(1, 5) for _ in range(actions)]
    allowed = set(rng.sample(range(actions), actions - 1))
    targets = rng.sample(range(1, size), 2)
    found = landmark_cuts(graph, targets, allowed, costs.__getitem__, {}, lambda: False)
    left = list(costs)
    for objects, members, cheapest, weight in found.cuts:
        assert objects & set(targets)
        assert 0 not in objects
        given = [
            a for a in sorted(allowed) if objects.intersection(gives[a]) and objects.isdisjoint(needs[a])
        ]
        assert sorted(members) == sorted(given)
        assert weight == left[cheapest] == min(left[a] for a in members) > 0
        for a in members:
            left[a] -= weight
    assert found.bound == sum(each.weight for each in found.cuts)
    assert {a: left[a] for a in found.left} == found.left
    assert [costs[a] for a in range(actions) if a not in found.left] == [
        left[a] for a in range(actions) if a not in found.left
    ]
    dear = frozenset(a for a in range(actions) if a not in allowed or left[a])
    assert found.hopeless != all(graph.reach(dear)[target] for target in targets)
    lost = not all(graph.reach(frozenset(range(actions)) - allowed)[target] for target in targets)
    assert found.hopeless == lost


def test_targets_far_away_leave_those_on_the_way_their_own_cuts() -> None:
    # places of a grid, each reached from its neighbours; that each is visited is a target of its own
    side, places = 5, range(25)
    moves = [
        (here, there)
        for here in places
        for there in places
        if abs(here // side - there // side) + abs(here % side - there % side) == 1
    ]
    needs, gives = [[here] for here, _ in moves], [[there, 25 + there] for _, there in moves]
    graph = Hypergraph(50, needs, gives, [0, 25])
    dear = {25 + place: place // side + place % side for place in places}
    found = landmark_cuts(graph, range(26, 50), range(len(moves)), lambda _: 1, dear, lambda: False)
    assert found.bound == len(found.cuts) == 24
