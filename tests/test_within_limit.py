"""A limit on how many of some units a tree has, by prices, against all trees there are."""

import random

import pytest

from foon_asp.problem import Objective, levels
from foon_asp.reduce import reduce, reduction
from foon_asp.reduce.within_limit import limited
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
