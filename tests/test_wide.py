"""What trees up to a cost can have, for rules that decide which trees count: by hand, and by brute force."""

import random
from collections.abc import Collection
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from typing import Any

import pytest

from foon_asp.bounds.landmark_cuts import Cuts, landmark_cuts
from foon_asp.network import UnitPrices
from foon_asp.problem import ContainerRule, Objective, Problem, Restriction, levels
from foon_asp.reduce import Wide, reduce
from foon_asp.reduce import reduction as reduction_module
from foon_asp.reduce import wide as wide_module
from foon_asp.reduce.derivation import derive
from foon_asp.reduce.exact_costs import ExactCosts
from tests import oracle
from tests.gap_problem import gap_problem
from tests.plain_graphs import plain_problem
from tests.random_problems import MOTIONS, random_problem
from tests.test_constraint_meanings import small
from tests.test_reduction import two_rows

UNITS, KITCHEN, PRICE = Objective.UNITS, Objective.KITCHEN, Objective.PRICE


def wide_of(problem: Problem, *objectives: Objective, spare: bool = False) -> Wide:
    wide = reduce(problem, levels(objectives or (UNITS,)), spare=spare, rest=True).wide
    assert wide is not None
    return wide


def within(wide: Wide, units: Collection[int]) -> set[int]:
    """Give what trees can have that cost no more than these units."""
    return {*wide.within(wide.total(units), lambda: False)}


def without(problem: Problem, label: str) -> Problem:
    (gone,) = (o for o, node in enumerate(problem.network.objects) if node.label == label)
    return replace(problem, kitchen=problem.kitchen - {gone})


# --- By hand.

# 0 makes the goal, 1 to 3 and 4 lead to no goal, 5 and 7 wait for what nobody has, and so nothing needs 6
JUNK = without(
    small(
        *("boil: start > end", "peel: start > a, b", "cut: a > c", "mix: c > d", "stir: a, b > e"),
        *("wait: never > f", "fry: start > g", "bake: g, never > end"),
    ),
    "never",
)


def test_all_that_a_tree_can_have() -> None:
    assert wide_of(JUNK).everything() == {0}
    assert wide_of(JUNK, spare=True).everything() == {0, 1, 2, 3, 4, 6}
    removed = replace(JUNK, restriction=Restriction(lambda unit: unit in {1, 5}))
    assert wide_of(removed, spare=True).everything() == {0, 6}
    assert wide_of(removed).everything() == {0}


def test_what_a_tree_up_to_a_cost_can_have() -> None:
    plain, spare = wide_of(JUNK), wide_of(JUNK, spare=True)
    for units, expected in (
        ({0}, {0}),
        ({0, 1}, {0, 1, 6}),
        ({0, 1, 2}, {0, 1, 2, 4, 6}),  # 4 needs two things, which are made by one unit
        ({0, 1, 2, 3}, {0, 1, 2, 3, 4, 6}),
    ):
        assert within(plain, units) == {0}
        assert within(spare, units) == expected
    assert spare.within(0, lambda: False) == plain.within(0, lambda: False) == frozenset()
    removed = wide_of(replace(JUNK, restriction=Restriction(lambda unit: unit == 6)), spare=True)
    assert within(removed, {0, 1}) == {0, 1}


def test_cuts_are_looked_for_anew_while_anything_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    wide = wide_of(JUNK, spare=True)
    asked = 0

    def counted(*given: object) -> Cuts:
        nonlocal asked
        asked += 1
        return landmark_cuts(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(wide_module, "landmark_cuts", counted)
    assert within(wide, {0, 1}) == {0, 1, 6}
    assert asked == 1
    asked = 0
    assert wide.within(2, lambda: True) == {0, 1, 6}
    assert asked == 0
    for found, expected in (
        (Cuts(0, {}, [], hopeless=True), set()),
        (Cuts(9, {}, []), set()),
        (Cuts(2, {0: 0}, []), {0}),
    ):
        monkeypatch.setattr(wide_module, "landmark_cuts", lambda *_, found=found: found)
        assert within(wide, {0, 1}) == expected
    monkeypatch.setattr(wide_module, "landmark_cuts", lambda *_: Cuts(0, {}, [], interrupted=True))
    with pytest.raises(KeyboardInterrupt):
        within(wide, {0, 1})


# a has two makers, b a row of one each; start is grown, and at hand
MADE = small(
    *("boil: start > end", "mix: a, b > end", "cut: start > a", "chop: start > a", "fry: c > b"),
    *(
        "wash: d > c",
        "dry: start > d",
        "grow: seed > start",
        "wind: thread > spool",
        "unwind: spool > thread",
    ),
)
MADE = replace(
    MADE,
    kitchen=frozenset(o for o, node in enumerate(MADE.network.objects) if node.label in {"start", "seed"}),
)


def test_what_makes_what_units_need_and_what_makes_the_same() -> None:
    wide = wide_of(MADE)
    assert wide.makers([]) == wide.makers([0]) == {0, 1}
    assert wide.makers([1]) == {0, 1, 2, 3, 4}
    assert wide.makers([4, 5]) == {0, 1, 5, 6}
    assert wide.beside([2]) == {2, 3}
    assert wide.beside([0, 6]) == {0, 1, 6}
    assert wide.beside([7]) == set()


def test_what_units_build_upon_without_a_choice() -> None:
    wide = wide_of(MADE)
    assert wide.with_only_makers([0], 99) == {0}
    assert wide.with_only_makers([1], 99) == {1, 4, 5, 6}
    assert wide.with_only_makers([8], 99) == {8, 9}
    assert wide.with_only_makers([1, 0], 2) == {0, 1}
    assert [len(wide.with_only_makers([1], most)) for most in range(6)] == [1, 1, 2, 3, 4, 4]


def test_sets_of_units_of_which_each_tree_has_one() -> None:
    assert wide_of(MADE).landmarks() == [{0, 1}]
    required = replace(
        MADE, restriction=Restriction(lambda unit: unit == 3, (frozenset({2, 3}), frozenset({6, 4})))
    )
    assert [{*each} for each in wide_of(required).landmarks()][-2:] == [{2}, {4, 6}]
    # kitchen items are no units, though one of them is taken by all trees
    taken = wide_of(MADE, KITCHEN)
    assert any(max(cut.members) == len(MADE.network) for cut in taken.cuts.cuts) or len(MADE.kitchen) > 1
    assert all(max(each) < len(MADE.network) for each in taken.landmarks())


def test_items_count_in_what_a_tree_costs_where_they_are_counted() -> None:
    size = len(MADE.network)
    (start,) = (o for o, node in enumerate(MADE.network.objects) if node.label == "start")
    wide = wide_of(MADE, KITCHEN)
    assert wide.total({0}) == wide.costs(0) + wide.costs(size + start)
    row = {1, 2, 4, 5, 6}
    assert wide.total(row) == sum(map(wide.costs, row)) + wide.costs(size + start)
    assert wide_of(MADE).total(row) == 5


def test_all_items_together_count_less_than_one_unit() -> None:
    problem = small("mix: a, b, c > end", "cut: d > e", "fry: e > end")
    actions = range(len(problem.network) + len(problem.network.objects))
    exact = ExactCosts(problem, (UNITS, KITCHEN), actions)
    items = [len(problem.network) + o for o in problem.kitchen]
    assert exact(0) + sum(map(exact, items)) < exact(1) + exact(2)
    assert len(items) == 4


def test_units_that_lead_to_no_goal_are_dear_by_all_of_a_way_and_others_by_what_they_need() -> None:
    # 1 to 3 are one way to the goal, of which only 3 waits for nothing; 4 waits for what nobody has
    row = without(
        small("boil: start > end", "mix: a > end", "cut: b > a", "dry: start > b", "wait: never > a"), "never"
    )
    assert [within(wide_of(row), {*range(1, n)}) for n in (2, 3, 4)] == [{0}, {0}, {0, 1, 2, 3}]
    assert [within(wide_of(row, spare=True), {*range(1, n)}) for n in (2, 3, 4)] == [
        *({0}, {0, 3}, {0, 1, 2, 3}),
    ]
    # what cannot run has no costs where no unit is spare
    rates = {"boil": 9, "mix": 8, "cut": 7, "dry": 6, "wait": 5}
    rated = replace(row, rates={motion: Fraction(n, 10) for motion, n in rates.items()})
    assert within(wide_of(rated, Objective.SUCCESS), {1, 2, 3}) == {0, 1, 2, 3}


def test_what_rounding_makes_dearer_is_within_what_is_as_good() -> None:
    problem = two_rows(-57)  # the first 5 are worse
    wide = wide_of(problem, Objective.SUCCESS)
    assert wide.total(range(5)) < wide.total(range(5, 10))
    assert within(wide, range(5)) == {*range(10)}


def test_what_is_left_out_one_by_one_is_no_longer_looked_for_after_six_rounds(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    wide = wide_of(plain_problem([([0], [1])] * 20, [1]))
    looked = 0

    def one_less(_graph: object, left: Collection[int], *_: object) -> set[int]:
        nonlocal looked
        looked += 1
        return {*left} - {max(left)}

    monkeypatch.setattr(wide_module, "dear_left_out", one_less)
    assert within(wide, {0}) == {*range(14)}
    assert looked == 6
    # nor where time is up, or nothing is left out
    looked = 0
    assert wide.within(9, lambda: True) == {*range(19)}
    assert looked == 1
    monkeypatch.setattr(wide_module, "dear_left_out", lambda _graph, left, *_: one_less(0, [*left, 99]))
    assert within(wide, {0}) == {*range(20)}
    assert looked == 2


def test_cuts_of_what_is_left_are_guided_by_its_costs(monkeypatch: pytest.MonkeyPatch) -> None:
    # the goal comes of two things, each of the same one, or of a row of five
    fork = ("wash: start > s", "cut: s > p", "fry: s > q", "mix: p, q > end")
    row = ("dry: start > t", "fold: t > u", "wind: u > v", "coil: v > w", "bind: w > end")
    wide = wide_of(small(*fork, *row))
    asked = 0

    def cutting(*given: Any) -> Cuts:
        graph, _, among, costs, guide, *_, anew = given
        nonlocal asked
        asked += 1
        assert guide == anew(costs) == derive(graph, among, costs, added=False).cost
        assert guide != derive(graph, among, costs, added=True).cost
        return landmark_cuts(*given)

    monkeypatch.setattr(wide_module, "landmark_cuts", cutting)
    assert within(wide, {0, 1, 2, 3}) == {0, 1, 2, 3}
    assert asked


def test_kitchen_items_are_no_units(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = small("mix: a, b > end", "cut: a > end")
    wide = wide_of(problem, KITCHEN)
    assert min(problem.kitchen) == 0
    assert {*wide.actions_within(99, lambda: False)} > {2, 3}
    assert within(wide, {0}) == wide.everything() == wide.nearest(9) == {0, 1}
    assert (wide.total({0}), wide.total({1})) == (2 * wide.costs(2) + 1, wide.costs(2) + 1)


# --- In the course of the reductions.


@pytest.mark.parametrize("seed", range(3))
def test_what_is_wide_is_what_was_there_before_anything_was_left_out(seed: int) -> None:
    problem = gap_problem(seed)
    reduced = reduce(problem, levels((UNITS,)))
    assert reduced.wide is not None
    cone = reduced.wide.graph.cone()[0]
    assert {*reduced.wide.left} == cone
    assert reduced.wide.everything() == cone


def test_where_ctrl_c_ends_the_first_cuts_nothing_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    def struck(*given: object) -> Cuts:
        return landmark_cuts(*given)._replace(interrupted=True)  # type: ignore[arg-type]

    monkeypatch.setattr(reduction_module, "landmark_cuts", struck)
    reduced = reduce(MADE, levels((UNITS,)))
    assert (reduced.interrupted, reduced.settled, reduced.wide) == (True, False, None)
    assert reduced.tree == frozenset({0})


# --- By brute force.


@pytest.mark.parametrize("spare", [False, True])
def test_no_tree_up_to_a_cost_has_anything_else(spare: bool) -> None:
    left_out = 0
    for seed in range(40):
        rng = random.Random(seed)
        problem = random_problem(seed, list(ContainerRule)[seed % 2], units=6)
        prices = {motion: Fraction(rng.randint(0, 6), rng.choice((1, 2, 3))) for motion in MOTIONS}
        problem = replace(problem, unit_prices=UnitPrices(prices, {}))
        size, objective = len(problem.network), (UNITS, PRICE, KITCHEN, Objective.INPUTS)[seed % 4]
        gone, some = rng.randrange(size), frozenset(rng.sample(range(size), 2))
        problem = replace(problem, restriction=Restriction(frozenset({gone}).__contains__, (some,)))
        found = []
        for tree in oracle.trees(problem):
            ids = frozenset(u for u in range(size) if problem.network.unit(u) in tree)
            if gone not in ids and ids & some:
                found.append((oracle.key(problem, tree, [str(objective)]), ids))
        if not spare:
            found = [(key, ids) for key, ids in found if not any(other < ids for _, other in found)]
        wide = reduce(problem, levels((objective,)), spare=spare, rest=True).wide
        if wide is None:
            assert not found or min(found)[1] == frozenset()
            continue
        found.sort(key=lambda each: each[0])
        totals = [wide.total(ids) for _, ids in found]
        for (one, other), (low, high) in zip(
            pairwise(totals), pairwise(key for key, _ in found), strict=True
        ):
            assert one < other if low < high else one == other
        for ids in (ids for _, ids in found):
            assert ids <= wide.everything(), seed
            assert all(ids & each for each in wide.landmarks()), seed
        for total in {*totals[:1], *totals[len(totals) // 2 :][:1], *totals[-1:]}:
            left = wide.within(total, lambda: False)
            left_out += len(wide.everything() - left)
            for (_, ids), cost in zip(found, totals, strict=True):
                assert cost > total or ids <= left, (seed, total)
    assert left_out > 5
