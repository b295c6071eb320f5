"""Who can be the first to make an object, held against what can be reached without it."""

import random
from collections.abc import Iterator

import pytest

from foon_asp.hypergraph import first_achievers, tuning
from foon_asp.hypergraph.first_achievers import FirstAchievers
from foon_asp.hypergraph.hypergraph import Hypergraph
from tests.hypergraph.small_graphs import crossing, random_graph


def drawn(seeds: range) -> Iterator[tuple[random.Random, Hypergraph]]:
    for seed in seeds:
        rng = random.Random(seed)
        yield rng, random_graph(rng, 20)


def reached_without(graph: Hypergraph, out: int) -> bytearray:
    """Close the start under all actions, with an object that nothing gives."""
    gives = [[o for o in given if o != out] for given in graph.gives]
    return Hypergraph(graph.size, graph.needs, gives, graph.start).reach()


def cuts(rng: random.Random, graph: Hypergraph) -> Iterator[frozenset[int]]:
    """Return sets of objects that are not there from the start."""
    others = [o for o in range(graph.size) if not graph.at_start[o]]
    for _ in range(6):
        yield frozenset(rng.sample(others, rng.randint(1, min(3, len(others)))))


def test_what_takes_something_back_gives_it_to_no_effect() -> None:
    # 1 of nothing, 2 of 1, 3 of 2, and back: 1 of 3, and 2 of 3 with 4 beside it
    graph = Hypergraph(5, [[0], [1], [2], [3], [3]], [[1], [2], [3], [1], [2, 4]], [0])
    achievers = FirstAchievers(graph)
    assert achievers.graph.gives == [[1], [2], [3], [], [4]]
    assert achievers.graph.needs == graph.needs
    assert achievers.landmark_of(frozenset({2})) == [1]
    assert achievers.widen(frozenset({2})) == {2, 3}  # which the last one needs
    assert achievers.widen(frozenset({4})) == {4}


def test_what_is_given_to_no_effect_is_what_no_need_is_reached_without() -> None:
    dropped = 0
    for _, graph in drawn(range(300)):
        achievers = FirstAchievers(graph)
        for needed, given, left in zip(graph.needs, graph.gives, achievers.graph.gives, strict=True):
            for o in given:
                without = reached_without(graph, o)
                late = not graph.at_start[o] and not all(without[n] for n in needed)
                assert (o not in left) == late
                dropped += late
    assert dropped > 200


@pytest.mark.parametrize("bits", [None, 60, 20, 0])
def test_every_set_of_actions_makes_the_same_and_cuts_have_the_members_they_say(
    bits: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where landmarks are known among a few objects only."""
    if bits is not None:
        monkeypatch.setattr(tuning, "RELAXATION", tuning.RelaxationTuning(landmark_bits=bits))
    fewer = wider = 0
    for rng, graph in drawn(range(200)):
        achievers = FirstAchievers(graph)
        everything = frozenset(range(len(graph.needs)))
        for _ in range(8):
            without = frozenset(a for a in everything if rng.random() < 0.4)
            assert achievers.graph.reach(without) == graph.reach(without)
        for cut in cuts(rng, graph):
            wide = achievers.widen(cut)
            assert wide >= cut
            assert wide.isdisjoint(graph.start)
            assert set(achievers.landmark_of(cut)) == crossing(graph, wide)
            fewer += len(achievers.landmark_of(cut)) < len(crossing(graph, cut))
            wider += wide > cut
    assert (fewer > 9) == (bits != 0)
    assert (wider > 9) == (bits != 0)


def test_nothing_is_known_where_time_is_up(monkeypatch: pytest.MonkeyPatch) -> None:
    for rng, graph in drawn(range(30)):
        known = FirstAchievers(graph).graph.gives
        monkeypatch.setattr(first_achievers, "_STEPS", 10**6)  # so there is no time to ask
        assert FirstAchievers(graph, lambda: True).graph.gives == known
        monkeypatch.setattr(first_achievers, "_STEPS", 1)
        assert FirstAchievers(graph).graph.gives == known
        late = FirstAchievers(graph, lambda: True)
        assert late.graph.gives == graph.gives
        for cut in cuts(rng, graph):
            assert set(late.landmark_of(cut)) == crossing(graph, cut)
            assert late.widen(cut) == cut
