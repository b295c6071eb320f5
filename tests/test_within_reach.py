"""What can be made at rests up to a limit, asked for by and by, held against what is derived at once."""

import math
import random

import pytest

from foon_asp.reduce import within_reach as module
from foon_asp.reduce.derivation import derive
from foon_asp.reduce.near import near
from foon_asp.reduce.within_reach import within_reach
from tests.plain_graphs import plain, random_graph


@pytest.mark.parametrize(
    ("least", "deep", "looks"), [(1, 100, 1000), (0, 100, 1000), (1, 1, 1000), (1, 100, 20)]
)
def test_what_is_asked_for_by_and_by_is_what_is_derived_at_once(
    least: int, deep: int, looks: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "_DEEP", deep)
    monkeypatch.setattr(module, "_LOOKS", looks)
    exact = (least, deep, looks) == (1, 100, 1000)  # else it may be too deep, as in circles that cost nothing
    told = untold = 0
    for seed in range(40):
        rng = random.Random(seed)
        graph = random_graph(seed, actions=14)
        allowed = set(rng.sample(range(14), 12))
        rest = {a: rng.randint(least, 4) for a in allowed}
        made = derive(graph, allowed, rest, added=False)
        reach = within_reach(graph, allowed, rest.__getitem__)
        asked = [(o, limit) for o in range(graph.size) for limit in range(9)]
        rng.shuffle(asked)
        for o, limit in asked:
            beyond = o not in graph.start and made.cost.get(o, math.inf) > limit
            said = not reach(o, limit)
            assert beyond or not said, (seed, o, limit)
            told += said
            untold += beyond and not said
        for limit in (0, 2, 5):
            close = near(graph, allowed, rest.__getitem__, limit, made.before)
            reach = within_reach(graph, allowed, rest.__getitem__)
            found = near(graph, allowed, rest.__getitem__, limit, within=reach)
            assert found == close if exact else found >= close, (seed, limit)
    assert told > 500
    assert (untold == 0) == exact


def test_what_a_limit_rules_out_is_not_asked_about() -> None:
    row = plain([([2], [1]), ([3], [2]), ([4], [3]), ([], [4])], [1])
    asked: list[int] = []

    def rest(action: int) -> int:
        asked.append(action)
        return 2

    reach = within_reach(row, range(4), rest)
    assert not reach(1, 3)
    assert asked == [0, 1]
    assert not reach(1, 3)  # as is known
    assert asked == [0, 1]
    assert not reach(1, 7)
    assert reach(1, 8)
    asked.clear()
    assert reach(1, 9)
    assert not reach(1, 7)
    assert asked == []


def test_in_a_circle_it_comes_to_an_end() -> None:
    """Of actions that cost nothing, each of which needs what the other gives."""
    circle = plain([([2], [1]), ([1], [2])], [1])
    assert within_reach(circle, range(2), lambda _: 0)(1, 5)  # too deep to tell
    assert not within_reach(circle, range(2), lambda _: 1)(1, 5)
    assert not within_reach(circle, {0}, lambda _: 0)(1, 5)


def test_costs_may_be_larger_than_any_float() -> None:
    """Of an object that nothing makes, nothing is said, however much the action costs that needs it."""
    reach = within_reach(plain([([], [2]), ([2, 3], [1])], [1]), range(2), lambda _: 10**400)
    assert not reach(1, 2 * 10**400)
    assert not reach(1, 10**500)
    assert reach(2, 10**400)


def test_circles_are_not_gone_round_for_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each of ten objects makes each other one, at a rest of its own: 67,869 looks, if nothing ends them."""
    actions = [([one], [other]) for one in range(1, 11) for other in range(1, 11) if one != other]
    rng = random.Random(2)
    rests = [1 << rng.randrange(20) for _ in actions]
    asked: list[int] = []

    def rest(action: int) -> int:
        asked.append(action)
        return rests[action]

    monkeypatch.setattr(module, "_LOOKS", 500)
    reach = within_reach(plain(actions, [1]), range(len(actions)), rest)
    assert reach(1, 10**7)
    assert reach(2, 10**7)
    assert 500 < len(asked) < 700
