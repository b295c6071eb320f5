"""Which cuts are found: their objects and members, worked out by hand."""

import random

import pytest

from foon_asp.bounds.cut import Cut, Cutter
from foon_asp.bounds.hypergraph import Hypergraph

# 0 and 1 are at hand; 4 is made of 2 and 3, 2 from 0 or from 3, 3 from 1 or from 2; 5 from 4 is of no concern
KITCHEN = Hypergraph(
    6, needs=[[2, 3], [0], [3], [1], [2], [4]], gives=[[4], [2], [2], [3], [3], [5, 0]], start=[0, 1]
)


def test_targets_at_hand_are_left_out_and_so_is_what_no_target_needs() -> None:
    cutter = Cutter(KITCHEN, [4, 0, 4])
    assert cutter.targets == [4]
    assert cutter.actions == [0, 1, 2, 3, 4]
    assert cutter.hopeless is None
    assert Cutter(KITCHEN, [3]).actions == [1, 2, 3, 4]
    assert Cutter(KITCHEN, [3], frozenset({1, 5})).actions == [2, 3, 4]
    assert Cutter(KITCHEN, [4], frozenset({1, 4})).actions == [0, 2, 3]


def test_actions_that_cannot_run_are_not_asked_for() -> None:
    graph = Hypergraph(4, needs=[[1], [2, 3], [0], []], gives=[[0], [0], [1], [1]], start=[])
    assert Cutter(graph, [0]).actions == [0, 2, 3]
    assert Cutter(graph, [0]).cut([], [2, 0, 3]) == Cut((0, 1, 2), (3,))


def test_where_all_is_at_hand_there_is_nothing_to_cut() -> None:
    cutter = Cutter(KITCHEN, [0, 1])
    assert cutter.actions == []
    assert cutter.reached_by([])
    assert cutter.cut([], []) is None


def test_actions_that_are_of_no_concern_may_be_kept() -> None:
    cutter = Cutter(KITCHEN, [4])
    assert cutter.reached_by([5, 0, 1, 5, 3])
    assert not cutter.reached_by([5, 0, 1])
    assert cutter.cut([5, 0, 1, 3], cutter.actions) is None
    assert cutter.cut([5, 1, 3], cutter.actions) == Cut((4,), (0,))


@pytest.mark.parametrize(
    ("keep", "order", "cut"),
    [
        ([], [1, 2, 3, 4, 0], Cut((4,), (0,))),
        ([], [4, 3, 2, 1, 0], Cut((4,), (0,))),
        ([], [0, 1, 2, 3, 4], Cut((3, 4), (3, 4))),  # 3 would reach the target, and so would 4
        ([], [0, 3, 1, 2, 4], Cut((2, 4), (1, 2))),
        ([], [0, 4, 2, 1, 3], Cut((2, 3, 4), (1, 3))),  # 2 and 4 wait for each other
        ([2, 4], [0, 3, 1], Cut((2, 3, 4), (1, 3))),
        ([4, 2], [1, 0, 3], Cut((4,), (0,))),
        ([0], [2, 4, 3, 1], Cut((2, 3, 4), (1, 3))),
        ([0, 3], [0, 1, 2, 3, 4], Cut((2, 4), (1, 2))),
        ([0, 1], [0, 1, 2, 3, 4], Cut((3, 4), (3, 4))),
        ([0, 1, 4], [0, 1, 2, 3, 4], None),
        ([2, 4, 0, 3], [0, 1, 2, 3, 4], None),
    ],
)
def test_what_comes_late_is_cut(keep: list[int], order: list[int], cut: Cut | None) -> None:
    assert Cutter(KITCHEN, [4]).cut(keep, order) == cut


def test_what_an_action_that_is_refused_would_have_made_is_taken_back() -> None:
    # 0 gives both targets and 4; each can be had by itself, 3 only by way of 4
    graph = Hypergraph(5, needs=[[], [], [4], []], gives=[[2, 4, 3], [2], [3], [4]], start=[])
    cutter = Cutter(graph, [2, 3])
    assert cutter.cut([], [0, 1, 2, 3]) == Cut((3, 4), (0, 3))
    assert cutter.cut([], [2, 0, 3, 1]) == Cut((2,), (0, 1))
    assert cutter.cut([], [1, 3, 0, 2]) == Cut((3,), (0, 2))
    assert not cutter.reached_by([1, 2])
    assert cutter.reached_by([1, 2, 3])
    assert cutter.reached_by([0])


def test_of_several_that_lack_the_one_with_most_takers_is_cut_then_the_first() -> None:
    # 0 needs 1 and 2, which 1 makes at once; 3 is a target of its own, made of 2 in the second graph
    one = Hypergraph(4, needs=[[2, 1], []], gives=[[0], [1, 2]], start=[])
    assert Cutter(one, [0]).cut([], [0, 1]) == Cut((0, 1), (1,))
    two = Hypergraph(4, needs=[[1, 2], [], [2], []], gives=[[0], [1, 2], [3], [3]], start=[])
    assert Cutter(two, [0, 3]).cut([], [0, 2, 3, 1]) == Cut((0, 2), (1,))


def test_what_cannot_be_made_is_cut_before_all_else() -> None:
    # 0 is made of 1, which action 2 makes; action 0 lacks 3 as well, which only comes of itself
    graph = Hypergraph(4, needs=[[1, 3], [1], [], [3]], gives=[[0], [0], [1], [3]], start=[])
    for forbidden in (frozenset[int](), frozenset({3})):
        cutter = Cutter(graph, [0], forbidden)
        assert cutter.actions == [1, 2]
        assert cutter.cut([], [2, 1]) == Cut((0, 3), (1,))
        assert cutter.cut([], [1, 2]) == Cut((0, 1, 3), (2,))


def test_where_targets_are_lost_the_cut_of_the_first_has_no_members() -> None:
    graph = Hypergraph(6, needs=[[5, 1], [3, 2], [0], []], gives=[[4], [4, 1], [2], [0, 5]], start=[])
    cutter = Cutter(graph, [5, 4, 1])
    assert cutter.hopeless == Cut((1, 3), ())
    assert (cutter.targets, cutter.actions) == ([1, 4, 5], [])
    assert Cutter(graph, [4]).hopeless == Cut((1, 3, 4), ())
    assert Cutter(graph, [2]).hopeless is None
    assert Cutter(graph, [2], frozenset({2})).hopeless == Cut((2,), ())
    assert Cutter(graph, [2], frozenset({3})).hopeless == Cut((0, 2), ())


def test_a_cut_is_widened_by_what_cannot_be_made() -> None:
    # 0 comes of 1, of nothing, and by actions that can never run; nothing makes 3 and 4
    graph = Hypergraph(
        6,
        needs=[[1], [5, 2, 3], [4, 5], [2, 3], [5], [3], []],
        gives=[[0], [0], [0], [2], [1], [2], [5, 0]],
        start=[5],
    )
    cutter = Cutter(graph, [0])
    assert cutter.widened([0]) == Cut((0, 2, 3, 4), (0, 6))
    assert cutter.widened([5, 0]) == Cut((0, 2, 3, 4), (0, 6))
    assert cutter.widened([0, 1]) == Cut((0, 1, 2, 3, 4), (4, 6))
    assert Cutter(graph, [0], frozenset({6})).widened([0]) == Cut((0, 2, 3, 4), (0,))
    assert Cutter(graph, [0], frozenset({1, 3, 6})).widened([0, 1]) == Cut((0, 1, 4), (4,))
    assert cutter.widened([0, 3]) == Cut((0, 3, 4), (0, 6))  # 2 is not needed for it
    assert cutter.widened([5]) == Cut((), ())


def test_actions_are_admitted_until_the_targets_are_reached() -> None:
    cutter = Cutter(Hypergraph(3, [[], [], []], [[1], [2], [2]], [0]), [2])
    waiting = iter([0, 1, 2, 1])
    assert cutter.reached_by(waiting)  # type: ignore[arg-type]
    assert [*waiting] == [2, 1]


def test_what_is_known_to_be_reachable_is_not_asked_again() -> None:
    graph = Hypergraph(3, [[1]], [[2]], [0])
    assert Cutter(graph, [2]).hopeless is not None
    known = Cutter(graph, [2], reachable=bytearray([1, 1, 1]))
    assert (known.hopeless, known.actions) == (None, [0])


def test_targets_that_are_kept_within_reach_are_not_cut_again() -> None:
    cutter = Cutter(Hypergraph(3, [[], []], [[1], [2]], [0]), [1, 2])
    assert cutter.cut([0], [1]) == Cut((2,), (1,))
    assert cutter.cut([0], [0, 1]) == Cut((2,), (1,))


@pytest.mark.parametrize("seed", range(30))
def test_actions_are_refused_one_by_one_as_the_definition_says(seed: int) -> None:
    chance = random.Random(seed)
    size, count = 9, 24
    graph = Hypergraph(
        size,
        [sorted(chance.sample(range(size), chance.choice((0, 1, 1, 2, 3)))) for _ in range(count)],
        [sorted(chance.sample(range(1, size), chance.choice((1, 1, 2, 3)))) for _ in range(count)],
        [0],
    )
    cutter = Cutter(graph, chance.sample(range(1, size), chance.choice((1, 2, 3))))
    keep = chance.sample(range(count), chance.choice((0, 2)))
    order = chance.sample(cutter.actions, len(cutter.actions))
    admitted, refused = {*keep}, set[int]()

    def reached(actions: set[int]) -> bytearray:
        return graph.reach(frozenset(range(count)) - actions)

    def all_reached(actions: set[int]) -> bool:
        return all(reached(actions)[o] for o in cutter.targets)

    found = cutter.cut(keep, order)
    if all_reached(admitted):
        assert found is None
        return
    for action in order:
        if all_reached({*admitted, action}):
            refused.add(action)
        else:
            admitted.add(action)
    assert found is not None
    assert set(found.members) <= refused
    inside = set(found.objects)
    assert not inside.intersection(o for o in range(size) if reached(admitted)[o])
    for action in range(count):
        crosses = not inside.isdisjoint(graph.gives[action]) and inside.isdisjoint(graph.needs[action])
        assert crosses == (action in found.members)
