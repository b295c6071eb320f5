"""What rules remove and require is honoured by all that walks over a network, held against brute force."""

import random
from contextlib import nullcontext
from dataclasses import replace

import pytest

from foon_asp.problem import Objective, Problem, Restriction, executable_order, first_tree, levels, reach
from foon_asp.problem import relevant as relevant_units
from foon_asp.reduce import ALL, SAFE, Listener, Reduction, reduce, reduction
from tests.test_reductions import LISTS, Measured, best_left, dearest, posed, some


def restricted(problem: Problem, seed: int) -> Problem:
    """Remove units of a problem at random, and require one of some sets at random."""
    rng = random.Random(f"restricted {seed}")
    units = range(len(problem.network))
    removed = frozenset(u for u in units if rng.random() < rng.choice((0, 0.15, 0.3)))
    sets = rng.choice((0, 0, 1, 1, 2))
    required = tuple(
        frozenset(rng.sample(units, min(len(units), rng.choice((0, 1, 2, 3))))) for _ in range(sets)
    )
    return replace(problem, restriction=Restriction(removed.__contains__, required))


def kept(problem: Problem, found: list[Measured]) -> list[Measured]:
    """Give the trees that keep to what a problem is restricted to."""
    restriction = problem.restriction
    assert restriction is not None
    return [
        tree
        for tree in found
        if not any(map(restriction.removed, tree.units))
        and all(tree.units & one for one in restriction.required)
    ]


@pytest.mark.parametrize("seed", some(120))
def test_what_can_be_made_and_what_matters(seed: int) -> None:
    plain, _, found = posed(seed)
    problem = restricted(plain, seed)
    found = kept(problem, found)
    reached = reach(problem)
    assert problem.restriction is not None
    assert not any(map(problem.restriction.removed, reached.units))
    tree = first_tree(problem, reached)
    assert (tree is None) == (not found)
    if tree is not None:
        assert executable_order(problem, tree) is not None
        assert frozenset(tree) in {one.units for one in found}
    matters = frozenset(relevant_units(problem, reached))
    tight = [one for one in found if not any(other.units < one.units for other in found)]
    assert all(one.units <= matters for one in tight)


@pytest.fixture(params=["all at once", "nearest first"])
def _sizes(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Have small networks treated as large ones are."""
    if request.param != "all at once":
        monkeypatch.setattr(reduction, "_LARGE", 0)
        monkeypatch.setattr(reduction, "_FIRST", 1)


@pytest.mark.usefixtures("_sizes")
@pytest.mark.parametrize("reductions", [*(frozenset({one}) for one in Reduction), ALL])
@pytest.mark.parametrize("seeds", [range(30), pytest.param(range(30, 400), marks=pytest.mark.slow)])
def test_what_is_left_has_the_optimum(seeds: range, reductions: frozenset[Reduction]) -> None:
    fewer = 0
    for seed in seeds:
        plain, _, every = posed(seed)
        problem = restricted(plain, seed)
        found = kept(problem, every)
        fewer += 0 < len(found) < len(every)
        names = LISTS[seed % len(LISTS)]
        by = [*names, "units"]
        left = reduce(problem, levels(tuple(map(Objective, names))), reductions)
        if not found:
            assert left.tree is None
            continue
        expected = min(tree.key(by) for tree in found)
        [in_hand] = [tree.key(by) for tree in found if tree.units == left.tree]
        alone = [tree.key(by) for tree in found if tree.units <= set(left.units)]
        assert min(alone) == expected, (seed, names)
        assert not left.settled or in_hand == expected
        if reductions <= SAFE:
            optimal = [tree for tree in found if tree.key(by) == expected]
            assert all(tree.units <= set(left.units) for tree in optimal), (seed, names)
        if left.costs is not None:
            bound = left.costs.first(left.bound)
            assert (-bound if names[0] == "success" else bound) <= expected[0]
    assert fewer > len(seeds) / 8


@pytest.mark.usefixtures("_sizes")
@pytest.mark.parametrize("reductions", [*(frozenset({one}) for one in Reduction), ALL])
@pytest.mark.parametrize("seeds", [range(30), pytest.param(range(30, 400), marks=pytest.mark.slow)])
def test_what_is_left_has_the_optimum_without_the_tree_in_hand(
    seeds: range, reductions: frozenset[Reduction], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The tree in hand is the worst that keeps to the restriction, and no better one is looked for."""
    monkeypatch.setattr(reduction, "improved", lambda _graph, _actions, tree, *_: tree)
    bad = 0
    for seed in seeds:
        plain, _, every = posed(seed)
        problem = restricted(plain, seed)
        found = kept(problem, every)
        objectives = levels(tuple(map(Objective, LISTS[seed % len(LISTS)])))
        names = list(map(str, objectives))
        worst = dearest(problem, found, names)
        monkeypatch.setattr(reduction, "without_spare", lambda *_, tree=worst: set(tree))
        reducer = reduction._Reducer(
            problem, objectives, reductions, lambda: False, Listener(), spare=False, rest=False
        )
        reduced = reducer.reduce(nullcontext)
        if not found:
            assert reduced.tree is None
            continue
        expected = min(tree.key(names) for tree in found)
        [in_hand] = [tree.key(names) for tree in found if tree.units == reducer._units(reducer.tree)]
        if reduced.settled or (Reduction.BOUNDS in reductions and in_hand == expected):
            assert in_hand == expected
            continue
        bad += in_hand > expected
        left = reducer._units(reducer.left)
        alone = [tree.key(names) for tree in found if tree.units <= left]
        assert min(alone, default=None) == expected, (seed, names)
        if reductions <= SAFE:
            optimal = [tree for tree in found if tree.key(names) == expected]
            assert all(tree.units <= left for tree in optimal), (seed, names)
    assert bad > len(seeds) / 30


def test_a_unit_is_asked_about_once_and_only_if_it_is_looked_at() -> None:
    problem, _, found = posed(4)
    assert found
    asked: list[int] = []

    def removed(unit: int) -> bool:
        asked.append(unit)
        return False

    same = replace(problem, restriction=Restriction(removed))
    assert not asked
    goal = problem.goals[0]
    assert same.makers[goal] == problem.makers[goal]
    assert asked == list(problem.makers[goal])
    for _ in range(2):
        assert list(same.makers) == list(problem.makers)
    assert len(asked) == len(set(asked))


def test_a_required_set_is_one_more_node_to_make() -> None:
    problem, _, _ = posed(4)
    size = len(problem.network.objects)
    one = replace(problem, restriction=Restriction({2}.__contains__, (frozenset({2, 1}), frozenset({2}))))
    assert one.targets == (*problem.goals, size, size + 1)
    assert list(one.makers[size:]) == [(1,), ()]
    assert reduce(one, levels((Objective.UNITS,))).tree is None
    assert best_left(problem, tuple(range(len(problem.network))), ["units"]) is not None


@pytest.mark.sampled(4)
@pytest.mark.usefixtures("_sizes")
@pytest.mark.parametrize("spare", [False, True])
@pytest.mark.parametrize("seeds", [range(40), pytest.param(range(40, 400), marks=pytest.mark.slow)])
def test_all_that_trees_up_to_a_limit_have_is_within_it(seeds: range, spare: bool) -> None:
    """By the exact costs of every tree there is, and by figures between them."""
    asked = left_out = 0
    for seed in seeds:
        plain, _, every = posed(seed)
        problem = restricted(plain, seed)
        found = kept(problem, every)
        if not spare:  # then rules that leave a tree leave what is left of it without spare units
            found = [one for one in found if not any(other.units < one.units for other in found)]
        names = LISTS[seed % len(LISTS)]
        reduced = reduce(problem, levels(tuple(map(Objective, names))), spare=spare, rest=True)
        wide = reduced.wide
        if wide is None:
            continue
        everything = wide.everything()
        assert all(tree.units <= everything for tree in found)
        totals = sorted({wide.total(tree.units) for tree in found})
        for tree in found:  # measured as the objectives do
            [same] = {
                one.key([*names, "units"]) for one in found if wide.total(one.units) == wide.total(tree.units)
            }
            assert same == tree.key([*names, "units"])
        for total in totals:
            for limit in {total - 1, total, total + 1, total * 11 // 10}:
                within = wide.within(limit, lambda: False)
                asked, left_out = asked + 1, left_out + (within < everything)
                assert within <= everything
                for tree in found:
                    assert wide.total(tree.units) > limit or tree.units <= within, (seed, names)
    assert asked > len(seeds)
    assert left_out > asked / 8


@pytest.mark.parametrize(("seed", "objective"), [(4, Objective.UNITS), (2, Objective.SUCCESS)])
def test_the_units_nearest_to_the_goals_make_them_sooner_or_later(seed: int, objective: Objective) -> None:
    """Whatever they cost: exact costs by success have forty digits."""
    problem = restricted(posed(seed)[0], seed)
    wide = reduce(problem, levels((objective,))).wide
    assert wide is not None
    assert wide.nearest(1) <= wide.nearest(3) <= wide.nearest(1000) == wide.everything()
    assert len(wide.nearest(1)) >= 1
