"""Reductions: each alone and all together leave the optimum as it is, whatever rules remove and require."""

import random
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
from foon_asp.hypergraph import (
    ALL,
    NONE,
    SAFE,
    Listener,
    Reduction,
    greedy_stages,
    reduce,
    reduce_under_rules,
    reduction,
    tuning,
)
from foon_asp.hypergraph.exact_costs import ExactCosts
from foon_asp.hypergraph.tuning import PresolveTuning
from foon_asp.network import FunctionalUnit
from foon_asp.problem import (
    ContainerRule,
    Objective,
    Problem,
    Restriction,
    executable_order,
    first_tree,
    levels,
    reach,
    relevant_units,
)
from tests.hypergraph.test_reduction import after, interrupt_at
from tests.oracle.task_trees import key, measure, trees
from tests.oracle.test_optimum import assert_agrees
from tests.support.gap_problem import gap_problem
from tests.support.random_problems import USUAL, random_problem, random_steps

LISTS: list[list[str]] = [
    *([str(objective)] for objective in USUAL),
    ["success", "inputs"],
    ["inputs", "success"],
    ["units", "success"],
    ["kitchen", "success", "inputs"],
    ["units", "inputs", "kitchen"],
    ["inputs+ingredients", "kitchen"],
]
ALONE = [frozenset({one}) for one in Reduction]
CHOICES = [ALL, SAFE, *ALONE, *(frozenset(two) for two in combinations(Reduction, 2))]


class Measured(NamedTuple):
    """A tree by unit ids, and its measure by each objective, the smaller the better."""

    units: frozenset[int]
    figures: dict[str, Fraction]

    def key(self, names: list[str]) -> tuple[Fraction, ...]:
        return tuple(self.figures[name] for name in names)


@cache
def posed(seed: int) -> tuple[Problem, list[tuple[FunctionalUnit, ...]], list[Measured]]:
    """Return a random problem and all its trees, measured once for all that is asked of it."""
    make = random_steps if seed % 4 else random_problem
    problem = make(seed, list(ContainerRule)[seed % 2])
    found = list(trees(problem))
    measured = []
    for tree in found:
        units = frozenset(u for unit in tree if (u := problem.network.unit_id(unit)) is not None)
        measured.append(Measured(units, {str(o): measure(problem, tree, str(o)) for o in Objective}))
    return problem, found, measured


def restricted(seed: int) -> tuple[Problem, list[Measured]]:
    """Remove units of a problem and require one of some sets, and give it with the trees that keep to that.

    In every third problem nothing is removed or required.
    """
    problem, _, found = posed(seed)
    if seed % 3 == 0:
        return problem, found
    rng = random.Random(f"restricted {seed}")
    units = range(len(problem.network))
    removed = frozenset(u for u in units if rng.random() < rng.choice((0, 0.15, 0.3)))
    sets = rng.choice((0, 0, 1, 1, 2))
    required = tuple(
        frozenset(rng.sample(units, min(len(units), rng.choice((0, 1, 2, 3))))) for _ in range(sets)
    )
    kept = [
        tree for tree in found if tree.units.isdisjoint(removed) and all(tree.units & one for one in required)
    ]
    return replace(problem, restriction=Restriction(removed.__contains__, required)), kept


def without_redundant(found: list[Measured]) -> list[Measured]:
    """Return the trees none of whose units can be left out."""
    return [tree for tree in found if not any(other.units < tree.units for other in found)]


# How small networks are treated, as larger ones are.
SIZES = {
    "all at once": PresolveTuning(),
    "nearest first": PresolveTuning(lazy_actions=0, first_actions=1),
    "no searches left out": PresolveTuning(lazy_actions=0, first_actions=1, easy_actions=0),
    "costs shared out": PresolveTuning(relaxed_actions=0, easy_actions=0),
    "branching": PresolveTuning(relaxed_actions=0, branching_bound=Fraction(0), sparse_share=1),
}


@pytest.fixture(params=SIZES)
def _sizes(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tuning, "PRESOLVE", SIZES[request.param])
    if request.param == "no searches left out":
        monkeypatch.setattr(tuning, "CUTS", tuning.CutTuning(guided_cuts=1))


def assert_left(
    left: Collection[int], found: list[Measured], names: list[str], reductions: Collection[Reduction]
) -> None:
    """Require that units have a tree as good as the best, and all such trees after safe reductions."""
    expected = min(tree.key(names) for tree in found)
    optimal = [tree for tree in found if tree.key(names) == expected]
    kept = [tree for tree in optimal if tree.units <= set(left)]
    assert kept == optimal if frozenset(reductions) <= SAFE else kept


@pytest.mark.usefixtures("_sizes")
@pytest.mark.parametrize("seeds", [range(30), pytest.param(range(30, 150), marks=pytest.mark.slow)])
def test_what_is_left_has_the_optimum(seeds: range) -> None:
    fewer = 0
    for seed in seeds:
        problem, found = restricted(seed)
        fewer += 0 < len(found) < len(posed(seed)[2])
        for turn, names in enumerate(LISTS):
            by = [*names, "units"]
            for reductions in (ALL, CHOICES[(seed + turn) % len(CHOICES)]):
                left = reduce(problem, levels(tuple(map(Objective, names))), reductions)
                if not found:
                    assert (left.tree, left.units, left.settled) == (None, (), False)
                    continue
                expected = min(tree.key(by) for tree in found)
                [in_hand] = [tree.key(by) for tree in found if tree.units == left.tree]
                assert in_hand == expected or not left.settled, (seed, names)
                if left.settled:
                    assert frozenset(left.units) == left.tree
                else:
                    assert_left(left.units, found, by, reductions)
                if left.costs is not None:
                    bound = left.costs.first_objective_bound(left.bound)
                    assert (-bound if names[0] == "success" else bound) <= expected[0]
    assert fewer > len(seeds) / 12


def dearest(problem: Problem, found: list[Measured], names: list[str]) -> set[int]:
    """Return the worst tree without spare units, as the actions of the reductions' graph."""
    tight = without_redundant(found)
    units = set(max(tight, key=lambda tree: tree.key(names)).units) if tight else set()
    taken = {o for unit in units for o in problem.needs[unit] if o in problem.kitchen}
    return units | ({len(problem.network) + o for o in taken} if "kitchen" in names else set())


@pytest.mark.usefixtures("_sizes")
@pytest.mark.parametrize("reductions", [*ALONE, ALL])
@pytest.mark.parametrize("seeds", [range(24), pytest.param(range(24, 150), marks=pytest.mark.slow)])
def test_what_a_reduction_leaves_has_the_optimum_without_the_tree_in_hand(
    seeds: range, reductions: frozenset[Reduction], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The tree in hand is the worst there is, it gets no better, and it is not among what is left.

    Where only what is better than it is searched for, something better has to be left, unless it is optimal;
    else an optimal tree always has to be.
    """
    monkeypatch.setattr(greedy_stages, "improve_locally", lambda _graph, _actions, tree, *_: tree)
    bad = 0
    for seed in seeds:
        problem, found = restricted(seed)
        for some_names in (LISTS[seed % len(LISTS)], ["inputs", str(USUAL[seed % len(USUAL)])]):
            objectives = levels(tuple(dict.fromkeys(map(Objective, some_names))))
            names = list(map(str, objectives))
            worst = dearest(problem, found, names)
            monkeypatch.setattr(reduction, "irredundant_subset", lambda *_, tree=worst: set(tree))
            task = reduction._task_of(problem, objectives, reductions, lambda: False)
            presolve = reduction._Presolve(task, None, nullcontext)
            presolve.extend_or_run()
            reduced, gap = presolve.result(), presolve.gap
            if not found:
                assert reduced.tree is None
                continue
            assert gap is not None
            expected = min(tree.key(names) for tree in found)
            [in_hand] = [tree.key(names) for tree in found if tree.units == reduced.tree]
            if reduced.settled or (Reduction.BOUNDS in reductions and in_hand == expected):
                assert in_hand == expected
                continue
            bad += in_hand > expected
            units = {action for action in gap.candidates if action < len(problem.network)}
            assert_left(units, found, names, reductions)
    assert bad > len(seeds) / 30


@pytest.mark.usefixtures("_sizes")
@pytest.mark.parametrize("redundant", [False, True])
@pytest.mark.parametrize("seeds", [range(40), pytest.param(range(40, 200), marks=pytest.mark.slow)])
@pytest.mark.default_cases(
    "all at once-seeds0-False", "nearest first-seeds0-False", "all at once-seeds0-True"
)
def test_all_that_trees_up_to_a_limit_have_is_within_it(seeds: range, redundant: bool) -> None:
    """By the exact costs of every tree there is, and by figures between them."""
    asked = left_out = 0
    for seed in seeds:
        problem, found = restricted(seed)
        if not redundant:  # then rules that leave a tree leave what is left of it without such units
            found = without_redundant(found)
        names = LISTS[seed % len(LISTS)]
        by = [*names, "units"]
        wide = reduce_under_rules(
            problem, levels(tuple(map(Objective, names))), redundant=redundant
        ).subproblem
        if wide is None:
            continue
        everything = wide.all_units()
        assert all(tree.units <= everything for tree in found)
        assert all(tree.units & each for tree in found for each in wide.landmarks())
        keys = {wide.tree_cost(tree.units): tree.key(by) for tree in found}
        assert all(keys[wide.tree_cost(tree.units)] == tree.key(by) for tree in found)
        assert [keys[total] for total in sorted(keys)] == sorted(keys.values())
        for total in keys:
            for limit in {total - 1, total, total + 1, total * 11 // 10}:
                within = wide.units_within(limit, lambda: False)
                asked, left_out = asked + 1, left_out + (within < everything)
                assert within <= everything
                for tree in found:
                    assert wide.tree_cost(tree.units) > limit or tree.units <= within, (seed, names)
    assert asked > len(seeds)
    assert left_out > asked / 8


class Heard(Listener):
    """Keeps what it hears."""

    def __init__(self) -> None:
        self.trees: list[frozenset[int]] = []
        self.bounds: list[int] = []

    def tree(self, units: frozenset[int]) -> None:
        self.trees.append(units)

    def bound(self, costs: ExactCosts, bound: int) -> None:
        self.bounds.append(bound)


@pytest.mark.usefixtures("_sizes")
@pytest.mark.parametrize("interrupts", [False, True])
def test_whenever_it_is_stopped_the_bound_holds_and_nothing_better_is_lost(interrupts: bool) -> None:
    """What is left then has the optimum, or it is said that nothing was left out."""
    stopped = 0
    for seed in range(16):
        problem, found = restricted(seed)
        names = LISTS[seed % len(LISTS)]
        by, objectives = [*names, "units"], levels(tuple(map(Objective, names)))
        for calls in (0, 1, 2, 3, 5, 8) if found else ():
            reductions = CHOICES[(seed + calls) % len(CHOICES)]
            heard = Heard()
            expired = interrupt_at(calls) if interrupts else after(calls)
            left = reduce(problem, objectives, reductions, expired, heard)
            best = min(tree.key(by) for tree in found)
            [in_hand] = [tree.key(by) for tree in found if tree.units == left.tree]
            stopped += left.interrupted
            assert heard.trees[-1:] in ([], [left.tree])
            if left.costs is not None:
                bound = left.costs.first_objective_bound(left.bound)
                assert (-bound if names[0] == "success" else bound) <= best[0]
            if left.settled:
                assert in_hand == best
            elif not left.interrupted:
                assert_left(left.units, found, by, reductions)
    assert stopped > 10 or not interrupts


@cache
def many_asked() -> list[tuple[Problem, tuple[Objective, ...]]]:
    lists = [names for names in LISTS if names != ["attempts"]]
    asked = [(restricted(seed)[0], names) for seed in range(0, 40, 2) for names in lists]
    gaps = [gap_problem(seed, 5 + seed % 2) for seed in range(6)] + [
        gap_problem(seed, 9) for seed in range(3)
    ]
    asked += [(problem, ["units"]) for problem in gaps]
    return [(problem, levels(tuple(map(Objective, names)))) for problem, names in asked]


def left_of_many(reductions: Collection[Reduction]) -> tuple[int, int]:
    """Return how many questions are not settled, and how many units these have left together."""
    left = [reduce(problem, objectives, reductions) for problem, objectives in many_asked()]
    return sum(not each.settled for each in left), sum(len(each.units) for each in left if not each.settled)


@pytest.mark.parametrize(
    ("reductions", "units"), [(SAFE, 702), *zip(ALONE, (933, 702, 813, 440), strict=True)]
)
def test_each_reduction_leaves_no_more_than_it_did(reductions: frozenset[Reduction], units: int) -> None:
    unsettled, left = left_of_many(reductions)
    assert unsettled <= (122 if Reduction.BOUNDS in reductions else 249)
    assert left <= units


@pytest.mark.parametrize(
    ("_sizes", "most"),
    [*zip(SIZES, ((122, 428), (122, 428), (122, 423), (113, 35), (113, 35)), strict=True)],
    indirect=["_sizes"],
)
@pytest.mark.usefixtures("_sizes")
def test_all_together_leave_no_more_than_they_did(most: tuple[int, int]) -> None:
    unsettled, left = left_of_many(ALL)
    assert (unsettled <= most[0], left <= most[1]) == (True, True)


@pytest.mark.parametrize("encodings", [None, Path("by_need")])
@pytest.mark.parametrize("reductions", ALONE)
@pytest.mark.parametrize("seeds", [range(16), pytest.param(range(16, 60), marks=pytest.mark.slow)])
@pytest.mark.default_cases("seeds0-reductions3-None")
def test_every_objective_by_every_reduction_alone(
    seeds: range, reductions: frozenset[Reduction], encodings: Path | None
) -> None:
    for seed in seeds:
        problem, found, _ = posed(seed)
        for objective in Objective:
            settings = Settings(encodings=encodings, reductions=reductions)
            assert_agrees(problem, [str(objective)], found, settings)


@pytest.mark.usefixtures("_sizes")
@pytest.mark.parametrize("seeds", [range(6), pytest.param(range(6, 60), marks=pytest.mark.slow)])
def test_answers_are_the_same_and_their_cuts_make_certificates(seeds: range) -> None:
    for seed in seeds:
        problem = random_problem(seed, list(ContainerRule)[seed % 2], units=14)
        objectives = tuple(map(Objective, LISTS[seed % len(LISTS)]))
        order = levels(objectives)
        plain = solve(problem, objectives, Settings(reductions=NONE))
        for reductions in (ALL, CHOICES[2 + seed % (len(CHOICES) - 2)]):
            outcome = solve(problem, objectives, Settings(reductions=reductions))
            assert outcome.status is plain.status
            if plain.costs is None or outcome.costs is None or outcome.units is None:
                assert outcome.cuts == ()
                continue
            assert outcome.costs.key(order) == plain.costs.key(order), reductions
            assert outcome.bounds == plain.bounds
            certificate = certify(problem, order, outcome.units, cuts=outcome.cuts)
            assert certificate is not None
            assert (certificate.claim, certificate.certified) == ("optimal", order)
            assert outcome.proof is not Proof.CUTS or outcome.cuts or not outcome.units


@pytest.mark.parametrize("looked_for", [True, False])
def test_trees_get_better_and_bounds_rise_and_the_optimum_is_between(
    looked_for: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """So it is, too, where better trees are not looked for, and the one in hand is no good."""
    if not looked_for:
        monkeypatch.setattr(greedy_stages, "improve_locally", lambda graph, actions, tree, *_: tree)
        monkeypatch.setattr(tuning, "PRESOLVE", PresolveTuning(easy_actions=0))
    for seed in (*range(12), 48, 54, 69, 72, 84):
        problem = gap_problem(seed, corners=4 + seed % 4)
        names = LISTS[seed % len(LISTS)] if seed % 3 else ["units"]
        objectives = tuple(map(Objective, names))
        heard = Heard()
        found = reduce(problem, levels(objectives), ALL, listener=heard)
        best_tree = solve(problem, objectives, Settings(reductions=NONE)).units
        assert best_tree is not None

        def measured(units: Collection[int], problem: Problem = problem, names: list[str] = names) -> Any:
            return key(problem, tuple(problem.network.unit(u) for u in units), names)

        optimum = measured(best_tree)
        measures = [*map(measured, heard.trees)]
        assert all(later < earlier for earlier, later in pairwise(measures))
        assert measures[-1] >= optimum
        assert found.tree == heard.trees[-1]
        assert all(earlier < later for earlier, later in pairwise([0, *heard.bounds]))
        assert heard.bounds[-1:] == ([found.bound] if found.bound else [])
        assert found.costs is not None
        first = found.costs.first_objective_bound(found.bound)
        assert (-first if names[0] == "success" else first) <= optimum[0]
        assert not found.settled or measures[-1] == optimum
        answer = solve(problem, objectives, Settings(reductions=ALL)).units
        assert answer is not None
        assert measured(answer) == optimum


def test_goals_at_hand_take_no_unit() -> None:
    problem = random_problem(0, ContainerRule.STRICT)
    problem = replace(problem, goals=tuple(sorted(problem.kitchen))[:1])
    for names in LISTS:
        heard = Heard()
        found = reduce(problem, levels(tuple(map(Objective, names))), ALL, listener=heard)
        assert (found.tree, found.units, found.settled, found.bound) == (frozenset(), (), True, 0), names
        assert heard.bounds == []


# --- What rules remove and require is honoured by all that walks over a network.


@pytest.mark.parametrize("seeds", [range(40), pytest.param(range(40, 120), marks=pytest.mark.slow)])
def test_what_can_be_made_and_what_matters(seeds: range) -> None:
    for seed in seeds:
        problem, found = restricted(seed)
        reached = reach(problem)
        assert problem.restriction is None or not any(map(problem.restriction.removed, reached.units))
        tree = first_tree(problem, reached)
        assert (tree is None) == (not found)
        if tree is not None:
            assert executable_order(problem, tree) is not None
            assert frozenset(tree) in {one.units for one in found}
        matters = frozenset(relevant_units(problem, reached))
        assert all(one.units <= matters for one in without_redundant(found))


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
