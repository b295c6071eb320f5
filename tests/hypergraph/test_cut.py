"""What can be reached, and which cuts are found: by hand, and by the definition."""

import random

import pytest

from foon_asp.hypergraph.cut import Cut, Cutter
from foon_asp.hypergraph.hypergraph import Hypergraph
from tests.hypergraph.small_graphs import crossing, random_graph, reaches

# 0 and 1 are at hand; 4 is made of 2 and 3, 2 from 0 or from 3, 3 from 1 or from 2; 5 from 4 is of no concern
KITCHEN = Hypergraph(
    6, needs=[[2, 3], [0], [3], [1], [2], [4]], gives=[[4], [2], [2], [3], [3], [5, 0]], start=[0, 1]
)


def test_the_start_is_closed_under_the_actions_that_are_not_forbidden() -> None:
    assert list(KITCHEN.reach()) == [1] * 6
    assert list(KITCHEN.reach(frozenset({0}))) == [1, 1, 1, 1, 0, 0]
    assert list(KITCHEN.reach(frozenset({1, 3}))) == [1, 1, 0, 0, 0, 0]
    # what is needed or given twice counts once
    graph = Hypergraph(4, needs=[[0, 1, 1], [2, 2]], gives=[[2, 2, 0], [3]], start=[0])
    assert list(graph.reach()) == [1, 0, 0, 0]
    assert list(Hypergraph(4, graph.needs, graph.gives, start=[0, 1]).reach()) == [1] * 4


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
        ([], [0, 3, 1, 2, 4], Cut((2, 4), (1, 2))),
        ([], [0, 4, 2, 1, 3], Cut((2, 3, 4), (1, 3))),  # 2 and 4 wait for each other
        ([2, 4], [0, 3, 1], Cut((2, 3, 4), (1, 3))),
        ([0, 1], [0, 1, 2, 3, 4], Cut((3, 4), (3, 4))),
        ([0, 1, 4], [0, 1, 2, 3, 4], None),
    ],
)
def test_what_comes_late_is_cut(keep: list[int], order: list[int], cut: Cut | None) -> None:
    assert Cutter(KITCHEN, [4]).cut(keep, order) == cut


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
    assert cutter.widen([0]) == Cut((0, 2, 3, 4), (0, 6))
    assert cutter.widen([5, 0]) == Cut((0, 2, 3, 4), (0, 6))
    assert cutter.widen([0, 1]) == Cut((0, 1, 2, 3, 4), (4, 6))
    assert Cutter(graph, [0], frozenset({6})).widen([0]) == Cut((0, 2, 3, 4), (0,))
    assert Cutter(graph, [0], frozenset({1, 3, 6})).widen([0, 1]) == Cut((0, 1, 4), (4,))
    assert cutter.widen([0, 3]) == Cut((0, 3, 4), (0, 6))  # 2 is not needed for it
    assert cutter.widen([5]) == Cut((), ())


@pytest.mark.parametrize("seed", range(100))
def test_actions_are_refused_one_by_one_as_the_definition_says(seed: int) -> None:
    chance = random.Random(seed)
    graph = random_graph(chance, most=24, idle=True)
    every = range(len(graph.needs))
    forbidden = frozenset(a for a in every if chance.random() < 0.1)
    cutter = Cutter(graph, chance.sample(range(graph.size), chance.choice((1, 2, 3))), forbidden)

    def landmark(objects: tuple[int, ...]) -> list[int]:
        assert set(objects) & set(cutter.targets)
        assert set(objects).isdisjoint(graph.start)
        return sorted(crossing(graph, objects) - forbidden)

    assert (cutter.hopeless is None) == reaches(graph, {*every} - forbidden, cutter.targets)
    if cutter.hopeless is not None:
        assert landmark(cutter.hopeless.objects) == []
        return
    keep = [a for a in every if chance.random() < 0.1]
    order = chance.sample(cutter.actions, len(cutter.actions))
    admitted, refused = {*keep} - forbidden, set[int]()
    found = cutter.cut(keep, order)
    assert cutter.reached_by(keep) == reaches(graph, admitted, cutter.targets) == (found is None)
    if found is None:
        return
    for action in order:
        (refused if reaches(graph, {*admitted, action}, cutter.targets) else admitted).add(action)
    assert set(found.members) <= refused
    assert list(found.members) == landmark(found.objects)
    assert not any(reaches(graph, admitted, [o]) for o in found.objects)
    for member in found.members:  # none of them is there for nothing
        assert reaches(graph, {*every} - forbidden.union(found.members) | {member}, cutter.targets)
    assert cutter.without_forbidden(found.members) == found.members
    assert cutter.widen(found.objects).members == found.members
