"""Cuts, exact comparisons, exact optima and proofs on plain arrays."""

import math
import random
from fractions import Fraction

import pytest

from foon_asp.bounds.cut import Cutter
from foon_asp.bounds.exact_optimum import exact_optimum
from foon_asp.bounds.hypergraph import Hypergraph
from foon_asp.bounds.lexicographic import Lexicographic

COUNT = Lexicographic([None])

# 0 and 1 are at hand; 4 is made of 2 and 3, 2 from 0 or from 3, 3 from 1 or from 2: there is a circle.
KITCHEN = Hypergraph(5, needs=[[2, 3], [0], [3], [1], [2]], gives=[[4], [2], [2], [3], [3]], start=[0, 1])


def ones(graph: Hypergraph) -> list[tuple[Fraction]]:
    return [(Fraction(1),)] * len(graph.needs)


def is_landmark(graph: Hypergraph, members: tuple[int, ...], target: int) -> bool:
    """Whether the target is out of reach without these actions, by the definition."""
    return not graph.reach(frozenset(members))[target]


def test_the_start_is_closed_under_the_actions_that_are_not_forbidden() -> None:
    assert list(KITCHEN.reach()) == [1] * 5
    assert list(KITCHEN.reach(frozenset({1}))) == [1] * 5
    assert list(KITCHEN.reach(frozenset({0}))) == [1, 1, 1, 1, 0]
    assert list(KITCHEN.reach(frozenset({1, 3}))) == [1, 1, 0, 0, 0]


def test_what_is_needed_or_given_twice_counts_once() -> None:
    graph = Hypergraph(4, needs=[[0, 1, 1], [2, 2]], gives=[[2, 2, 0], [3]], start=[0])
    assert list(graph.at_start) == [1, 0, 0, 0]
    assert graph.makers == [[0], [], [0], [1]]
    assert graph.takers == [[0], [0], [1], []]
    assert graph.missing == [1, 1]
    assert list(graph.reach()) == [1, 0, 0, 0]
    both = Hypergraph(4, graph.needs, graph.gives, start=[0, 1])
    assert list(both.reach()) == [1] * 4


def test_makers_that_are_known_are_taken_as_they_are() -> None:
    known = [(), (1, 2), (3, 4), (0,), ()]
    assert Hypergraph(5, KITCHEN.needs, KITCHEN.gives, KITCHEN.start, known).makers is known


def test_cuts_are_landmarks() -> None:
    cutter = Cutter(KITCHEN, [4])
    assert cutter.actions == [0, 1, 2, 3, 4]
    cut = cutter.cut([], [1, 2, 3, 4, 0])
    assert cut is not None
    assert cut.members == (0,)
    assert cut.objects == (4,)
    both = cutter.cut([], [0, 2, 4, 1, 3])
    assert both is not None
    assert both.members in {(3,), (1, 3)}
    assert cutter.cut([0, 1, 3], []) is None
    assert cutter.reached_by([0, 1, 3])
    assert not cutter.reached_by([0, 2, 4])


def test_random_cuts_are_landmarks_on_the_whole_graph() -> None:
    found = 0
    for seed in range(300):
        rng = random.Random(seed)
        size = rng.randint(4, 9)
        actions = rng.randint(3, 12)
        needs = [rng.sample(range(size), rng.randint(0, 2)) for _ in range(actions)]
        gives = [rng.sample(range(size), rng.randint(1, 2)) for _ in range(actions)]
        graph = Hypergraph(size, needs, gives, [0])
        forbidden = frozenset(rng.sample(range(actions), rng.randint(0, 2)))
        target = rng.randrange(1, size)
        cutter = Cutter(graph, [target], forbidden)
        cut = cutter.hopeless or cutter.cut([], rng.sample(cutter.actions, len(cutter.actions)))
        assert cut is not None
        found += not cutter.hopeless
        assert (cutter.hopeless is not None) == (not graph.reach(forbidden)[target])
        assert target in cut.objects
        assert 0 not in cut.objects
        inside = set(cut.objects)
        members = [
            a
            for a in range(actions)
            if a not in forbidden and inside & {*gives[a]} and not inside & {*needs[a]}
        ]
        assert list(cut.members) == members
        assert is_landmark(graph, (*cut.members, *forbidden), target)
        for member in cut.members:  # none of them is there for nothing
            assert not is_landmark(graph, (*(set(cut.members) - {member}), *forbidden), target)
    assert found > 100


def test_products_are_compared_exactly() -> None:
    rates = [Fraction("0.3"), Fraction("0.09"), Fraction("0.300000001")]
    order = Lexicographic([rates, None])
    half, one = Fraction(1, 2), Fraction(1)
    assert order.sign((one * 2, -one, Fraction(0), Fraction(0))) == 0
    assert order.sign((one, -half, Fraction(0), -one)) == -1
    assert order.sign((one, Fraction(0), -one, -one)) == 1
    assert order.sign((-half, Fraction(0), half, one)) == -1
    assert order.sign(order.zero) == 0
    tiny = Fraction(1, 10**30)  # 1 - 2 * 10**-30 against (1 - 10**-30) ** 2: their floats are equal
    close = Lexicographic([[1 - 2 * tiny, 1 - tiny]])
    assert close.sign((one, -2 * one)) == 1
    assert close.sign((-one, 2 * one)) == -1


def test_the_first_level_that_differs_decides() -> None:
    order = Lexicographic([None, None])
    assert order.sign((Fraction(0), Fraction(-1))) == -1
    assert order.sign((Fraction(1, 9), Fraction(-1))) == 1


def test_the_exact_optimum_of_a_triangle_is_a_half_of_each() -> None:
    rows = [[0, 1], [0, 2], [1, 2]]
    costs = [(Fraction(1), Fraction(c)) for c in (1, 2, 3)]
    order = Lexicographic([None, None])
    for columns, tight in (([0, 1, 2], [0, 1, 2]), ([0, 1], [1, 2])):
        found = exact_optimum(rows, costs, order, columns, tight)
        assert found is not None
        assert found.x == dict.fromkeys(range(3), Fraction(1, 2))
        assert found.value == (Fraction(3, 2), Fraction(3))
    assert exact_optimum(rows, costs, order, [0], [2]) is None  # singular
    assert exact_optimum(rows, costs, order, [0], [0]) is None  # the last row is not covered


@pytest.mark.parametrize("seed", range(200))
def test_costs_are_ordered_as_products_of_fractions_are(seed: int) -> None:
    """Among rates whose products collide, and for powers that are fractions."""
    rng = random.Random(seed)
    pool = ["0.5", "0.25", "0.7", "0.49", "0.9", "0.81", "0.3", "0.999999999", "0.000000001"]
    rates = list(map(Fraction, rng.sample(pool, 3)))
    first = rng.random() < 0.5
    order = Lexicographic([rates, None] if first else [None, rates])
    assert order.width == 4
    share = Fraction(1, rng.choice([1, 2, 3]))
    for _ in range(20):
        powers = [rng.randint(-3, 3) for _ in rates]
        count = rng.choice([-1, 0, 0, 1])
        product = math.prod(rate**power for rate, power in zip(rates, powers, strict=True))
        by_rates = (product < 1) - (product > 1)
        parts = [share * power for power in powers]
        vector = (*parts, share * count) if first else (share * count, *parts)
        expected = by_rates or count if first else count or by_rates
        assert order.sign(vector) == expected
        assert order.sign([-part for part in vector]) == -expected
        one, other = order.approximate(vector)
        logarithm, figure = (one, other) if first else (other, one)
        assert figure == float(share * count)
        assert logarithm == pytest.approx(-float(share) * math.log(product), abs=1e-12)
        assert order.total([vector, vector]) == tuple(2 * part for part in vector)
    assert order.total([]) == order.zero == (Fraction(0),) * 4
