"""Landmark cuts on small graphs: which are found, what they weigh and what they leave."""

import random
from collections.abc import Callable, Mapping

import pytest

from foon_asp.hypergraph.hypergraph import Hypergraph
from foon_asp.hypergraph.landmark_cuts import Cuts, WeightedCut, landmark_cuts
from tests.hypergraph.small_graphs import crossing, random_graph

# 0 is at hand; 3 is made of 1 and 2 or of 2 and 0, 2 of 0 in two ways, 1 of nothing, or with 4 of 3
KITCHEN = Hypergraph(
    5, needs=[[1, 2], [2, 0], [], [0], [0, 0], [3]], gives=[[3], [3, 0], [1], [2], [2], [4, 1]], start=[0]
)


def ask(costs: list[int], targets: list[int], dear: Mapping[int, int] | None = None) -> Cuts:
    return landmark_cuts(KITCHEN, targets, range(6), costs.__getitem__, dear or {}, lambda: False)


Plain = tuple[set[int], list[int], int, int]


def cut(objects: set[int], members: tuple[int, ...], cheapest: int, weight: int) -> Plain:
    return objects, sorted(members), cheapest, weight


def plain(cuts: list[WeightedCut]) -> list[Plain]:
    return [(set(each.objects), sorted(each.members), each.cheapest, each.weight) for each in cuts]


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
        (  # both members of the first need 2, only one needs 1
            [2, 9, 1, 5, 4, 1],
            [3],
            {1: 3, 2: 2, 3: 9},
            7,
            {0: 0, 1: 6, 2: 0, 3: 1, 4: 0},
            [cut({3}, (0, 1), 0, 2), cut({2, 3}, (3, 4), 4, 4), cut({1, 3}, (1, 2), 2, 1)],
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
        ([2, 3, 1, 5, 4, 1], [], {}, 0, {}, []),
    ],
)
def test_cuts_are_weighed_until_the_targets_come_for_nothing(
    costs: list[int],
    targets: list[int],
    dear: dict[int, int],
    bound: int,
    left: dict[int, int],
    cuts: list[Plain],
) -> None:
    found = ask(costs, targets, dear)
    assert (found.bound, found.reduced_costs, plain(found.cuts)) == (bound, left, cuts)
    assert not found.hopeless


def test_only_what_is_allowed_counts() -> None:
    price = [2, 3, 1, 5, 4, 1].__getitem__
    found = landmark_cuts(KITCHEN, [3], {1, 3}, price, {}, lambda: False)
    assert (found.bound, found.reduced_costs, found.hopeless) == (8, {1: 0, 3: 0}, False)
    assert plain(found.cuts) == [cut({3}, (1,), 1, 3), cut({2, 3}, (3,), 3, 5)]
    lost = landmark_cuts(KITCHEN, [3], {0, 1, 2}, price, {}, lambda: False)
    assert (lost.bound, lost.reduced_costs, lost.hopeless) == (2, {0: 0, 1: 1}, True)
    assert plain(lost.cuts) == [cut({3}, (0, 1), 0, 2)]
    assert landmark_cuts(KITCHEN, [3], (), price, {}, lambda: False) == (0, {}, [], True, False)


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
    assert found._replace(reduced_costs={}) == (6, {}, ask(price, [3]).cuts[:2], False, True)


def test_landmarks_of_many_members_end_the_search_for_more() -> None:
    price = [2, 3, 1, 5, 4, 1]
    cuts = ask(price, [3]).cuts
    assert [len(each.members) for each in cuts[:2]] == [2, 2]
    for most, found in ((0, 0), (1, 1), (2, 1), (3, 2), (4, 2), (5, 3)):
        some = landmark_cuts(KITCHEN, [3], range(6), price.__getitem__, {}, lambda: False, None, most)
        assert some.cuts == cuts[:found]
        assert some.bound == sum(each.weight for each in some.cuts)
        assert not some.interrupted


def test_a_guide_is_asked_by_what_is_left_after_many_cuts_and_says_what_is_dearest() -> None:
    # targets that take three actions each, one after the other; the last of them is made in two ways
    costs = [1 + number % 3 for number in range(120)] + [9, 9]
    asked: list[list[int]] = []

    def guide(rest: Callable[[int], int]) -> dict[int, int]:
        asked.append([action for action in range(120) if not rest(action)])
        return {}

    needs: list[list[int]] = [[number + 40] if number < 80 else [] for number in range(120)]
    graph = Hypergraph(120, needs, [[number] for number in range(120)], [])
    found = landmark_cuts(graph, range(40), range(120), costs.__getitem__, {}, lambda: False, guide)
    assert found.bound == sum(costs[:120])
    assert len(asked) == 1
    assert set(range(40)) < {*asked[0]}


@pytest.mark.parametrize("seed", range(100))
def test_random_cuts_hold_and_leave_the_targets_for_nothing(seed: int) -> None:
    rng = random.Random(seed)
    graph = random_graph(rng, 14, idle=True)
    size, actions, start = graph.size, len(graph.needs), {*graph.start}
    costs = [rng.randint(1, 5) for _ in range(actions)]
    allowed = set(rng.sample(range(actions), actions - 1))
    targets = rng.sample(sorted({*range(size)} - start), 2)
    found = landmark_cuts(graph, targets, allowed, costs.__getitem__, {}, lambda: False)
    left = list(costs)
    for each in found.cuts:
        objects, members, cheapest, weight = each.objects, each.members, each.cheapest, each.weight
        assert objects & set(targets)
        assert objects.isdisjoint(start)
        assert set(members) == crossing(graph, objects) & allowed
        assert weight == left[cheapest] == min(left[a] for a in members) > 0
        for a in members:
            left[a] -= weight
    assert found.bound == sum(each.weight for each in found.cuts)
    assert [found.reduced_costs.get(a, costs[a]) for a in range(actions)] == left
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


def test_cuts_of_a_long_chain_have_few_objects_of_their_own() -> None:
    size = 20_000
    graph = Hypergraph(size + 1, [[o] for o in range(size)], [[o + 1] for o in range(size)], [0])
    found = landmark_cuts(graph, [size], range(size), lambda _: 1, {}, lambda: False)
    assert found.bound == size
    assert max(len(each.added_objects) for each in found.cuts) == 1
    assert found.cuts[2].objects == {size, size - 1, size - 2}
