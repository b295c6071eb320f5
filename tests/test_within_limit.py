"""A limit on how many of some units a tree has, by prices, against all trees there are."""

import random

import pytest

from foon_asp.asp import Settings, Status, solve
from foon_asp.problem import Objective, levels
from foon_asp.reduce import reduce, reduction
from foon_asp.reduce.within_limit import limited
from foon_asp.rules.constraint import given_constraint
from tests.test_constraint_meanings import small
from tests.test_reductions import LISTS, posed


@pytest.mark.sampled(2)
@pytest.mark.parametrize("improving", [True, False])
@pytest.mark.parametrize("seeds", [range(40), pytest.param(range(40, 600), marks=pytest.mark.slow)])
def test_better_trees_within_a_limit_are_within_what_is_left(
    seeds: range, improving: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where trees are not improved, so that prices and bounds have to bear bad ones."""
    if not improving:
        monkeypatch.setattr(reduction, "improved", lambda _graph, _actions, tree, *_: tree)
    none = left_out = unknown = 0
    for seed in seeds:
        problem, _, found = posed(seed)
        rng = random.Random(f"limit {seed}")
        counting = frozenset(u for u in range(len(problem.network)) if rng.random() < 0.6)
        names = LISTS[seed % len(LISTS)]
        by = [*names, "units"]
        objectives = levels(tuple(map(Objective, names)))
        reduced = reduce(problem, objectives, rest=True)
        if reduced.tree is None or reduced.wide is None:
            continue
        most = len(reduced.tree & counting) - 1
        if most < 0:
            continue
        kept = [tree for tree in found if len(tree.units & counting) <= most]
        limit = limited(reduced.wide, objectives, reduced.tree, counting.__contains__, most, lambda: False)
        if limit is None:
            unknown += 1
            continue
        if limit.tree is None:
            none += 1
            assert not kept, (seed, names)
            continue
        [mine] = [tree for tree in kept if tree.units == limit.tree]
        within = limit.wide.within(limit.allowed, lambda: False)
        left_out += within < reduced.wide.everything()
        for tree in kept:
            if tree.key(by) < mine.key(by) and not any(other.units < tree.units for other in found):
                assert tree.units <= within, (seed, names)
    assert none > len(seeds) / 30
    assert left_out > len(seeds) / 60
    assert unknown < len(seeds) / 10


# --- By hand: p, q and r are cut by one unit each, or fried and boiled by two.

THREE = small(
    *("cut: start > p", "cut: start > q", "cut: start > r", "fry: start > a", "boil: a > p"),
    *("fry: start > b", "boil: b > q", "fry: start > c", "boil: c > r", "mix: p, q, r > end"),
)


@pytest.mark.parametrize(("most", "units"), [(0, 7), (1, 6), (2, 5), (3, 4)])
def test_the_best_tree_of_so_many_cuts(most: int, units: int) -> None:
    rule = given_constraint(f"at_most_motion:limited_motion=cut,max_uses={most}")
    outcome = solve(THREE, settings=Settings((rule,)))
    assert outcome.status is Status.OPTIMAL
    assert outcome.costs is not None
    assert outcome.costs.units == units


@pytest.mark.parametrize(("cuts", "boils", "units"), [(1, 1, None), (1, 2, 6), (2, 1, 5)])
def test_a_tree_within_one_limit_may_be_beyond_another(cuts: int, boils: int, units: int | None) -> None:
    limits = {"cut": cuts, "boil": boils}
    rules = [given_constraint(f"at_most_motion:limited_motion={m},max_uses={n}") for m, n in limits.items()]
    outcome = solve(THREE, settings=Settings(tuple(rules)))
    assert outcome.status is (Status.OPTIMAL if units else Status.INFEASIBLE)
    assert (outcome.costs.units if outcome.costs else None) == units


def test_what_a_price_allows_is_what_it_adds_to_a_tree_within_the_limit() -> None:
    by = levels((Objective.UNITS,))
    wide = reduce(THREE, by, rest=True).wide
    assert wide is not None
    for most in (1, 2):
        found = limited(wide, by, frozenset({0, 1, 2, 9}), {0, 1, 2}.__contains__, most, lambda: False)
        assert found is not None
        assert found.tree is not None
        assert len(found.tree & {0, 1, 2}) <= most
        # three units more for three cuts fewer: each cut is priced at 1
        assert found.allowed == len(found.tree) + most
        left = found.wide.within(found.allowed, lambda: False)
        assert {0, 4, 6, 8, 9} <= left
    problem = small("cut: start > p", "fry: start > q", "cut: start > q", "mix: p, q > end")
    wide = reduce(problem, by, rest=True).wide
    assert wide is not None
    none = limited(wide, by, frozenset({0, 2, 3}), {0, 2}.__contains__, 0, lambda: False)
    assert none is not None
    assert none.tree is None
