"""Reductions: each alone and all together leave the optimum as it is."""

import sys
from collections.abc import Collection
from contextlib import nullcontext
from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import combinations, pairwise
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from foon_asp.asp import Proof, Settings, solve
from foon_asp.certificate import certify
from foon_asp.network import FunctionalUnit
from foon_asp.problem import ContainerRule, Objective, Problem, levels
from foon_asp.reduce import ALL, NONE, SAFE, Listener, Reduction, reduce, reduction
from foon_asp.reduce.exact_costs import ExactCosts
from tests.gap_problem import gap_problem
from tests.oracle import best, key, measure, trees
from tests.plain_graphs import plain_problem
from tests.random_problems import random_problem, random_steps
from tests.test_optimum import assert_agrees

LISTS: list[list[str]] = [
    *([str(objective)] for objective in Objective),
    ["success", "inputs"],
    ["inputs", "success"],
    ["units", "success"],
    ["kitchen", "success", "inputs"],
    ["units", "inputs", "kitchen"],
    ["inputs+ingredients", "kitchen"],
]
CHOICES = [
    ALL,
    SAFE,
    *(frozenset({one}) for one in Reduction),
    *(frozenset(two) for two in combinations(Reduction, 2)),
]


def best_left(problem: Problem, units: tuple[int, ...], names: list[str]) -> object:
    """Give the best measure among the trees made of the units left, by brute force."""
    left = {problem.network.unit(u) for u in units}
    found = list(trees(problem, left.issuperset))
    return best(found, problem, names)


@pytest.fixture(params=["all at once", "nearest first", "no searches left out"])
def _sizes(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Have small networks treated as large ones are."""
    if request.param != "all at once":
        monkeypatch.setattr(reduction, "_LARGE", 0)
        monkeypatch.setattr(reduction, "_FIRST", 1)
    if request.param == "no searches left out":
        monkeypatch.setattr(reduction, "_EASY", 0)
        monkeypatch.setattr(sys.modules["foon_asp.bounds.landmark_cuts"], "_FRESH", 1)


def some(count: int) -> list[Any]:
    """Give seeds, the last two thirds of them for slow tests."""
    return [*range(count // 3), *(pytest.param(n, marks=pytest.mark.slow) for n in range(count // 3, count))]


@pytest.mark.usefixtures("_sizes")
@pytest.mark.parametrize("rule", ContainerRule)
@pytest.mark.parametrize("seed", some(60))
@pytest.mark.sampled(20)
def test_what_is_left_has_an_optimum(seed: int, rule: ContainerRule) -> None:
    problem = random_problem(seed, rule)
    found = list(trees(problem))
    for place, names in enumerate(LISTS):
        objectives = levels(tuple(map(Objective, names)))
        for number, reductions in enumerate(CHOICES):
            if number and (seed + place + number) % 4:
                continue
            expected = best(found, problem, names)
            left = reduce(problem, objectives, reductions)
            if expected is None:
                assert left.tree is None
                continue
            assert left.tree is not None
            units = tuple(problem.network.unit(u) for u in sorted(left.tree))
            in_hand = key(problem, units, names)
            assert in_hand >= expected
            assert best_left(problem, left.units, names) == expected, (names, reductions)
            if left.settled:
                assert in_hand == expected, (names, reductions)
            if reductions <= SAFE:  # every optimal tree is left
                kept = {problem.network.unit(u) for u in left.units}
                for tree in found:
                    if key(problem, tree, names) == expected:
                        assert kept.issuperset(tree), (names, reductions)
            if left.costs is not None:
                total = sum(map(left.costs, left.tree)) if "kitchen" not in names else None
                assert total is None or left.bound <= total
                bound, first = left.costs.first(left.bound), expected[0]
                assert (-bound if names[0] == "success" else bound) <= first


class Measured(NamedTuple):
    """A tree by unit ids, and its measure by each objective, the smaller the better."""

    units: frozenset[int]
    figures: dict[str, Fraction]

    def key(self, names: list[str]) -> tuple[Fraction, ...]:
        return tuple(self.figures[name] for name in names)


@cache
def posed(seed: int) -> tuple[Problem, list[tuple[FunctionalUnit, ...]], list[Measured]]:
    """Give a random problem and all its trees, measured once for all that is asked of it."""
    make = random_steps if seed % 4 else random_problem
    problem = make(seed, list(ContainerRule)[seed % 2])
    found = list(trees(problem))
    measured = []
    for tree in found:
        units = frozenset(u for unit in tree if (u := problem.network.unit_id(unit)) is not None)
        measured.append(Measured(units, {str(o): measure(problem, tree, str(o)) for o in Objective}))
    return problem, found, measured


def dearest(problem: Problem, found: list[Measured], names: list[str]) -> set[int]:
    """Give the worst tree without spare units, as the actions of the reductions' graph."""
    tight = [tree for tree in found if not any(other.units < tree.units for other in found)]
    units = set(max(tight, key=lambda tree: tree.key(names)).units) if tight else set()
    taken = {o for unit in units for o in problem.needs[unit] if o in problem.kitchen}
    return units | ({len(problem.network) + o for o in taken} if "kitchen" in names else set())


@pytest.mark.usefixtures("_sizes")
@pytest.mark.parametrize("reductions", [*(frozenset({one}) for one in Reduction), ALL])
@pytest.mark.parametrize("objective", Objective)
@pytest.mark.parametrize("seeds", [range(24), pytest.param(range(24, 240), marks=pytest.mark.slow)])
@pytest.mark.sampled(5)
def test_what_a_reduction_leaves_has_the_optimum_without_the_tree_in_hand(
    seeds: range,
    objective: Objective,
    reductions: frozenset[Reduction],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The tree in hand is the worst there is, it gets no better, and it is not among what is left.

    Where only what is better than it is searched for, something better has to be left, unless it is optimal;
    else an optimal tree always has to be.
    """
    monkeypatch.setattr(reduction, "improved", lambda _graph, _actions, tree, *_: tree)
    bad = 0
    for seed in seeds:
        problem, _, found = posed(seed)
        for some_names in ([str(objective)], [str(objective), "success"], ["inputs", str(objective)]):
            objectives = levels(tuple(dict.fromkeys(map(Objective, some_names))))
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
            if reduced.settled:
                assert in_hand == expected
                continue
            if Reduction.BOUNDS in reductions and in_hand == expected:
                continue
            bad += in_hand > expected
            left = reducer._units(reducer.left)
            alone = [tree.key(names) for tree in found if tree.units <= left]
            assert min(alone, default=None) == expected, (seed, names)
            if reductions <= SAFE:
                optimal = [tree for tree in found if tree.key(names) == expected]
                assert all(tree.units <= left for tree in optimal), (seed, names)
    assert bad > 5


@pytest.mark.parametrize(
    ("effort", "stop", "turns"),
    [
        (10**6, 9, 3),  # twice a better tree, and once none
        (12, 9, 3),  # each time, 4 units are looked at for one of the tree
        (11, 9, 2),
        (3, 9, 0),
        (10**6, 1, 1),
    ],
)
def test_better_trees_are_looked_for_from_each_that_is_found(
    effort: int, stop: int, turns: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = plain_problem([([0], [1])] * 4, [1])
    reducer = reduction._Reducer(
        problem, (Objective.UNITS,), ALL, lambda: len(asked) >= stop, Listener(), spare=False, rest=False
    )
    asked: list[bool] = []

    def improve(costs: Any, cuts: Any, thorough: bool) -> None:
        asked.append(thorough)
        if len(asked) < 3:
            reducer.tree = {len(asked)}

    monkeypatch.setattr(reduction, "_EFFORT", effort)
    monkeypatch.setattr(reducer, "_improve", improve)
    reducer.left, reducer.tree = range(4), {0}
    reducer._improve_on(ExactCosts(problem, (Objective.UNITS,), range(4)))
    assert asked == [True] * turns


@pytest.mark.parametrize("encodings", [None, Path("by_need")])
@pytest.mark.parametrize("reductions", [frozenset({one}) for one in Reduction])
@pytest.mark.parametrize("objective", Objective)
@pytest.mark.parametrize("seeds", [range(16), pytest.param(range(16, 200), marks=pytest.mark.slow)])
@pytest.mark.sampled(5)
def test_every_objective_by_every_reduction_alone(
    seeds: range, objective: Objective, reductions: frozenset[Reduction], encodings: Path | None
) -> None:
    for seed in seeds:
        problem, found, _ = posed(seed)
        settings = Settings(encodings=encodings, reductions=reductions)
        assert_agrees(problem, [str(objective)], found, settings)


@pytest.mark.usefixtures("_sizes")
@pytest.mark.parametrize("rule", ContainerRule)
@pytest.mark.parametrize("seed", some(100))
@pytest.mark.sampled(5)
def test_answers_are_the_same(seed: int, rule: ContainerRule) -> None:
    problem = random_problem(seed, rule, units=14)
    names = LISTS[seed % len(LISTS)]
    objectives = tuple(map(Objective, names))
    plain = solve(problem, objectives, Settings(reductions=NONE))
    for reductions in (ALL, CHOICES[2 + seed % (len(CHOICES) - 2)]):
        outcome = solve(problem, objectives, Settings(reductions=reductions))
        assert outcome.status is plain.status
        if plain.costs is not None and outcome.costs is not None:
            assert outcome.costs.key(levels(objectives)) == plain.costs.key(levels(objectives)), reductions
            assert outcome.bounds == plain.bounds


@pytest.mark.parametrize("seed", some(60))
def test_cuts_of_the_reductions_make_certificates(seed: int) -> None:
    problem = random_problem(seed, list(ContainerRule)[seed % 2], units=14)
    names = LISTS[seed % len(LISTS)]
    outcome = solve(problem, tuple(map(Objective, names)), Settings())
    if outcome.units is None:
        assert outcome.cuts == ()
        return
    wanted = levels(outcome.objectives)
    certificate = certify(problem, wanted, outcome.units, cuts=outcome.cuts)
    assert certificate is not None
    assert (certificate.claim, certificate.certified) == ("optimal", wanted)


def test_where_bounds_meet_the_cuts_are_the_certificate(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise AssertionError("searched again")

    monkeypatch.setattr("foon_asp.bounds.lower_bound.Covering", fail)
    met = 0
    for seed in range(40):
        problem = random_problem(seed, ContainerRule.STRICT)
        outcome = solve(problem, (Objective.SUCCESS,), Settings())
        if outcome.proof is Proof.CUTS and outcome.units:
            assert certify(problem, levels(outcome.objectives), outcome.units, cuts=outcome.cuts)
            met += 1
    assert met > 10


@pytest.mark.slow
def test_an_interrupted_search_for_cuts_leaves_a_bound_that_holds() -> None:
    met = 0
    for seed in range(40):
        problem = random_problem(seed, ContainerRule.STRICT, units=14)
        expected = best(list(trees(problem)), problem, ["units"])
        asked = 0

        def interrupt() -> bool:
            nonlocal asked
            asked += 1
            if asked == 3:
                raise KeyboardInterrupt
            return False

        if expected is None:
            continue
        found = reduce(problem, levels((Objective.UNITS,)), ALL, interrupt)
        assert found.tree is not None
        assert found.costs is not None
        if found.interrupted:
            assert 0 < found.costs.first(found.bound) <= expected[0]
            met += 1
    assert met > 5


class Heard(Listener):
    """Keeps what it hears."""

    def __init__(self) -> None:
        self.trees: list[frozenset[int]] = []
        self.bounds: list[int] = []

    def tree(self, units: frozenset[int]) -> None:
        self.trees.append(units)

    def bound(self, costs: ExactCosts, bound: int) -> None:
        self.bounds.append(bound)


@pytest.mark.parametrize("looked_for", [True, False])
@pytest.mark.parametrize("seed", [*some(45), 48, 54, 69, 72, 84])
def test_trees_get_better_and_bounds_rise_and_the_optimum_is_between(
    seed: int, looked_for: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """So it is, too, where better trees are not looked for, and the one in hand is no good."""
    if not looked_for:
        monkeypatch.setattr(reduction, "improved", lambda graph, actions, tree, *_: tree)
        monkeypatch.setattr(reduction, "_EASY", 0)
    problem = gap_problem(seed, corners=4 + seed % 4)
    names = LISTS[seed % len(LISTS)] if seed % 3 else ["units"]
    objectives = tuple(map(Objective, names))
    heard = Heard()
    found = reduce(problem, levels(objectives), ALL, listener=heard)
    best_tree = solve(problem, objectives, Settings(reductions=NONE)).units
    assert best_tree is not None

    def measure(units: Collection[int]) -> Any:
        return key(problem, tuple(problem.network.unit(u) for u in units), names)

    optimum = measure(best_tree)
    measures = [measure(tree) for tree in heard.trees]
    assert all(later < earlier for earlier, later in pairwise(measures))
    assert measures[-1] >= optimum
    assert found.tree == heard.trees[-1]
    assert all(earlier < later for earlier, later in pairwise([0, *heard.bounds]))
    assert heard.bounds[-1:] == ([found.bound] if found.bound else [])
    assert found.costs is not None
    first = found.costs.first(found.bound)
    assert (-first if names[0] == "success" else first) <= optimum[0]
    assert not found.settled or measures[-1] == optimum
    answer = solve(problem, objectives, Settings(reductions=ALL)).units
    assert answer is not None
    assert measure(answer) == optimum


def test_goals_at_hand_take_no_unit() -> None:
    problem = random_problem(0, ContainerRule.STRICT)
    problem = replace(problem, goals=tuple(sorted(problem.kitchen))[:1])
    for names in LISTS:
        heard = Heard()
        found = reduce(problem, levels(tuple(map(Objective, names))), ALL, listener=heard)
        assert (found.tree, found.units, found.settled, found.bound) == (frozenset(), (), True, 0), names
        assert heard.bounds == []


def test_what_is_only_as_good_as_the_tree_in_hand_is_left_out_too() -> None:
    left = {}
    for reductions in (frozenset({Reduction.DEAR}), frozenset({Reduction.DEAR, Reduction.BOUNDS})):
        found = [reduce(gap_problem(seed), (Objective.UNITS,), reductions) for seed in range(12)]
        left[reductions] = [len(each.units) for each in found if not each.settled]
        # what is left is never less than the tree in hand, which may be the only one
        assert all(each.tree is not None and each.tree <= set(each.units) for each in found)
    fewer, more = left[frozenset({Reduction.DEAR, Reduction.BOUNDS})], left[frozenset({Reduction.DEAR})]
    assert sum(fewer) < sum(more)
