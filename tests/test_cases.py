"""The best tree that keeps to ready-made constraints, case by case, against all trees there are."""

import random
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any
from unittest.mock import ANY

import pytest

from foon_asp.asp import Settings, Status, solve
from foon_asp.asp.solver import _Solver
from foon_asp.deadline import Deadline
from foon_asp.network import UnitPrices
from foon_asp.problem import ContainerRule, Objective, Problem, Restriction, levels
from foon_asp.reduce import Reduced, Reduction, Wide, reduce
from foon_asp.reduce import cases as module
from foon_asp.reduce.cases import Kept, best_kept
from foon_asp.reduce.within_limit import Limited
from foon_asp.rules.constraint import given_constraint
from foon_asp.rules.ready_made import ReadyMade
from tests.constraint_oracle import keeps, random_rule, settings_of
from tests.random_problems import MOTIONS, random_problem, random_steps
from tests.test_constraint_meanings import small, trees
from tests.test_ready_made import known

UNITS = levels((Objective.UNITS,))
LISTS: Sequence[list[str]] = [["units"], ["success"], ["kitchen"], ["price", "inputs"], ["units", "success"]]
SEEDS = [range(30, 36), pytest.param(range(120), marks=pytest.mark.slow)]
Tree = tuple[frozenset[int], tuple[Any, ...]]


def never() -> bool:
    return False


def asked(seeds: range) -> Iterator[tuple[Problem, list[dict[str, Any]], ReadyMade, list[Tree]]]:
    """Draw problems, and constraints of which some do more than to remove and to require units."""
    for seed in seeds:
        rng = random.Random(f"cases {seed}")
        problem = (random_steps if seed % 3 else random_problem)(seed, list(ContainerRule)[seed % 2])
        prices = {motion: Fraction(place * place, 10) for place, motion in enumerate(MOTIONS)}
        rates = problem.rates or dict.fromkeys(problem.network.motions, Fraction(1, 2))
        problem = replace(problem, rates=rates, unit_prices=UnitPrices(prices, {}))
        found = [*trees(problem)]
        for _ in range(6 if found else 0):
            drawn = {rule["rule"]: rule for rule in (random_rule(rng, problem) for _ in range(3))}
            ready = known(problem, settings_of([*drawn.values()]))
            if ready.rest:
                yield problem, [*drawn.values()], ready, found


def by_cases(
    problem: Problem, by: Sequence[Objective], ready: ReadyMade, expired: Callable[[], bool] = never
) -> tuple[Reduced, Kept | None] | None:
    """Look for the best tree where there is one for what is applied before."""
    applied = ready.applied(problem)
    if not isinstance(applied, Restriction):
        return None
    reduced = reduce(replace(problem, restriction=applied), by, rest=True)
    if reduced.tree is None or reduced.wide is None:
        return None
    return reduced, best_kept(problem, by, reduced.wide, reduced, ready, expired)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("seeds", SEEDS)
def test_it_is_the_best_of_all_trees_that_keep_to_them(seeds: range) -> None:
    told = none = dearer = 0
    for place, (problem, rules, ready, found) in enumerate(asked(seeds)):
        names = LISTS[place % len(LISTS)]
        by = levels(tuple(map(Objective, names)))
        ended = by_cases(problem, by, ready)
        if ended is None or ended[1] is None:
            continue
        kept = [tree for tree in found if all(keeps(problem, tree[1], rule) for rule in rules)]
        best = min((problem.costs(units).key(by) for units, _ in kept), default=None)
        tree = ended[1].tree
        assert (None if tree is None else problem.costs(tree).key(by)) == best, (rules, names)
        assert tree is None or tree in [units for units, _ in kept]
        told += 1
        none += tree is None
        dearer += tree is not None and ended[0].tree is not None and tree != ended[0].tree
    assert told > len(seeds) / 2
    assert none > len(seeds) / 8
    assert dearer > len(seeds) / 10


@pytest.mark.sampled(2)
@pytest.mark.parametrize("seeds", SEEDS)
def test_no_tree_that_keeps_to_them_has_all_of_a_conflict(seeds: range) -> None:
    conflicts = 0
    for problem, rules, ready, found in asked(seeds):
        others = [rule for rule in rules if rule["rule"] not in ready_rest(rules)]
        kept = [units for units, tree in found if all(keeps(problem, tree, rule) for rule in rules)]
        for units, tree in found:
            if not all(keeps(problem, tree, rule) for rule in others):
                continue
            conflict = ready.conflict(problem, units)
            assert (conflict is None) == (units in kept), (rules, units)
            if conflict is None:
                continue
            conflicts += 1
            assert not any(units.isdisjoint(each) for each in conflict)
            for tree_kept in kept:
                assert any(tree_kept.isdisjoint(each) for each in conflict), (rules, units, tree_kept)
            for without in (frozenset[int](), *kept[:2]):
                others_kept = [each for each in kept if each.isdisjoint(without)]
                assert all(ready.barred(problem, without).isdisjoint(each) for each in others_kept)
    assert conflicts > len(seeds)


def ready_rest(rules: list[dict[str, Any]]) -> set[str]:
    """Give the names of those that do more than to remove and to require."""
    names = {rule["rule"] for rule in rules}
    return {name for name in names if name in {"before", "not_both_motions"} or name.startswith("at_most")}


# --- By hand: p, q and r are cut by one unit each, or fried and boiled by two.

THREE = small(
    *("cut: start > p", "cut: start > q", "cut: start > r", "fry: start > a", "boil: a > p"),
    *("fry: start > b", "boil: b > q", "fry: start > c", "boil: c > r", "mix: p, q, r > end"),
)
CUTS = ({0}, {1}, {2})


def within(**limits: int) -> Settings:
    rules = (f"at_most_motion:limited_motion={name},max_uses={most}" for name, most in limits.items())
    return Settings(tuple(map(given_constraint, rules)))


class Cases:
    """Notes which units are left out in each case; of some it says what it is told to."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, **told: Any) -> None:
        self.without: list[set[int]] = []
        self.expired: list[bool] = []
        self._told = told
        monkeypatch.setattr(module, "reduce", self)

    def __call__(
        self, problem: Problem, objectives: Sequence[Objective], *, expired: Callable[[], bool]
    ) -> Reduced:
        assert problem.restriction is not None
        self.without.append({*filter(problem.restriction.removed, range(len(problem.network)))})
        self.expired.append(expired())
        return reduce(problem, objectives)._replace(**self._told)


@pytest.mark.parametrize("cuts", range(4))
def test_the_best_tree_of_so_many_cuts_is_found_without_clingo(
    cuts: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_Solver, "_run", None)
    outcome = solve(THREE, settings=within(cut=cuts))
    assert outcome.costs is not None
    assert (outcome.status, outcome.costs.units) == (Status.OPTIMAL, 7 - cuts)
    if cuts < 3:
        assert solve(THREE, settings=within(cut=cuts, boil=2 - cuts)).status is Status.INFEASIBLE


def test_there_is_a_case_without_each_part_of_a_conflict(monkeypatch: pytest.MonkeyPatch) -> None:
    cases = Cases(monkeypatch)
    monkeypatch.setattr(module, "least", lambda *_: None)
    found = by_cases(THREE, UNITS, known(THREE, within(cut=1)))
    assert found is not None
    assert found[1] is not None
    assert found[1].tree is not None
    assert len(found[1].tree & {0, 1, 2}) == 1
    assert cases.without[:2] == [{0}, {1}]  # two of three are one too many
    assert all(len(each) == 2 for each in cases.without[2:])
    assert len({frozenset(each) for each in cases.without}) == len(cases.without)
    assert cases.expired == [False] * len(cases.expired)


def test_of_a_limit_that_no_tree_keeps_to_there_are_no_cases(monkeypatch: pytest.MonkeyPatch) -> None:
    cases = Cases(monkeypatch)
    assert by_cases(THREE, UNITS, known(THREE, within(mix=0))) == (ANY, Kept(None))
    assert by_cases(THREE, UNITS, known(THREE, within(mix=-1))) == (ANY, Kept(None))
    assert cases.without == []
    monkeypatch.setattr(module, "least", lambda *_: None)
    assert by_cases(THREE, UNITS, known(THREE, within(mix=-1))) == (ANY, Kept(None))
    assert cases.without == []  # there is nothing to leave out
    assert by_cases(THREE, UNITS, known(THREE, within(mix=0))) == (ANY, Kept(None))
    assert cases.without == [{9}]


def test_a_tree_within_a_limit_is_the_answer_where_no_case_promises_better(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    cases = Cases(monkeypatch)
    problem = small("cut: start > p", "fry: start > p", "mix: p > end")
    found = by_cases(problem, UNITS, known(problem, within(cut=0)))
    assert found == (ANY, Kept(frozenset({1, 2})))
    assert cases.without == []
    # one beyond another limit is not
    both = known(problem, within(cut=0)).rules
    limits = ReadyMade([*both, {"rule": "at_most_units", "max_units": 1}], {}, [])
    assert by_cases(problem, UNITS, limits) == (ANY, Kept(None))


def test_too_many_cases_are_left_to_clingo(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "least", lambda *_: None)
    cases = Cases(monkeypatch)
    ready = known(THREE, within(cut=1))
    assert by_cases(THREE, UNITS, ready) != (ANY, None)
    first = module._CASE + len(THREE.network)
    count = len(cases.without)
    spent = first + sum(module._CASE + len(THREE.network) - len(each) for each in cases.without)
    monkeypatch.setattr(module, "_EFFORT", spent)
    assert by_cases(THREE, UNITS, ready) != (ANY, None)
    monkeypatch.setattr(module, "_EFFORT", spent - 1)
    assert by_cases(THREE, UNITS, ready) == (ANY, None)
    assert len(cases.without) == 3 * count - 1
    outcome = solve(THREE, settings=within(cut=1))
    assert outcome.costs is not None
    assert (outcome.status, outcome.costs.units) == (Status.OPTIMAL, 6)


def test_a_case_that_bounds_do_not_settle_is_left_to_clingo(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "least", lambda *_: None)
    Cases(monkeypatch, settled=False)
    ready = known(THREE, within(cut=2))
    assert by_cases(THREE, UNITS, ready) == (ANY, None)
    outcome = solve(THREE, settings=within(cut=2))
    assert outcome.costs is not None
    assert (outcome.status, outcome.costs.units) == (Status.OPTIMAL, 5)


def test_what_is_not_settled_and_breaks_rules_has_cases_as_well(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "least", lambda *_: None)
    ready = known(THREE, within(cut=2))
    applied = ready.applied(THREE)
    assert isinstance(applied, Restriction)
    reduced = reduce(replace(THREE, restriction=applied), UNITS, rest=True)._replace(settled=False)
    assert reduced.wide is not None
    cases = Cases(monkeypatch)
    found = best_kept(THREE, UNITS, reduced.wide, reduced, ready, never)
    assert found is not None
    assert found.tree is not None
    assert len(found.tree) == 5
    assert cases.without[0] == set()  # it is settled without the rules first


def test_only_where_bounds_count_are_there_cases(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "best_kept", None)
    settings = within(cut=2)._replace(reductions=frozenset({Reduction.DEAR}))
    assert solve(THREE, settings=settings).status is Status.OPTIMAL


@pytest.mark.parametrize("known_before", [False, True])
def test_ctrl_c_in_a_case(known_before: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    def pressed(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(module, "best_kept", pressed)
    monkeypatch.setattr(_Solver, "_beside", None)  # nothing else is looked at
    if known_before:
        keep = _Solver._by_cases

        def unsettled(solver: _Solver, reduced: Reduced, wide: Wide) -> Any:
            assert reduced.tree is not None
            solver.heard.tree(frozenset({0, 1, 5, 6, 7, 8, 9}))
            return keep(solver, reduced, wide)

        monkeypatch.setattr(_Solver, "_by_cases", unsettled)
    deadline = Deadline()
    outcome = solve(THREE, settings=within(cut=2)._replace(deadline=deadline))
    assert outcome.status is (Status.FEASIBLE if known_before else Status.UNKNOWN)
    assert (outcome.units is not None) == known_before
    assert deadline.interrupted


def test_an_interrupted_case_ends_the_search(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "least", lambda *_: None)
    Cases(monkeypatch, interrupted=True)
    with pytest.raises(KeyboardInterrupt):
        by_cases(THREE, UNITS, known(THREE, within(cut=2)))


def test_what_runs_too_early_is_told_by_what_it_builds_upon() -> None:
    problem = small(
        *("cut: start > a", "wash: start > b", "peel: b > c", "wash: start > d"),
        *("fry: c > e", "mix: a, d, e > end"),
    )
    ready = known(problem, Settings((given_constraint("before:earlier_motion=cut,later_motion=fry"),)))
    every = frozenset(range(6))
    assert ready.conflict(problem, every) == [frozenset({unit}) for unit in (1, 2, 4)]
    later = known(problem, Settings((given_constraint("before:earlier_motion=wash,later_motion=fry"),)))
    assert later.conflict(problem, every) is None
    assert ready.barred(problem, frozenset()) == {4}  # nothing that is cut leads to it
    assert later.barred(problem, frozenset()) == frozenset()
    assert later.barred(problem, frozenset({1})) == {4}


def test_what_counts_most_is_in_a_conflict() -> None:
    problem = small("cut: start > a", "wash: start > b", "fry: a, b > end")
    priced = replace(
        problem,
        unit_prices=UnitPrices({"cut": Fraction(3), "wash": Fraction(1), "fry": Fraction(5)}, {}),
    )
    for most, units in ((799, (2, 0)), (800, (2, 0, 1)), (900, None), (499, (2,)), (-1, ())):
        ready = known(priced, Settings((given_constraint(f"at_most_price:max_price={most}"),)))
        expected = None if units is None else [frozenset({unit}) for unit in units]
        assert ready.conflict(priced, frozenset({0, 1, 2})) == expected
        [(counts, limit)] = ready.counted(priced)
        assert ([*map(counts, range(3))], limit) == ([300, 100, 500], most)


# --- Step by step, with cases and rules put in the place of real ones.

SIX = small(*(f"{motion}: start > end" for motion in ("cut", "fry", "boil", "mix", "wash", "peel")))


class Scripted:
    """Cases whose best trees are told, by what is left out, and rules that some of these trees break."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, **told: tuple[str, bool]) -> None:
        self.told = {digits(name): (digits(tree), settled) for name, (tree, settled) in told.items()}
        self.conflicts: dict[frozenset[int], list[str]] = {}
        self.asked: list[str] = []
        self.bars: dict[str, str] = {}
        self.beyond, self.limit = frozenset[int](), Limited(frozenset())
        self.within_limits: list[int] = []
        self.problem = replace(SIX, restriction=Restriction(never_removed))
        monkeypatch.setattr(module, "reduce", self.reduce)
        monkeypatch.setattr(module, "least", self.least)

    def reduce(self, problem: Problem, *_: object, **__: object) -> Reduced:
        assert problem.restriction is not None
        gone = frozenset(filter(problem.restriction.removed, range(6)))
        self.asked.append("".join(map(str, sorted(gone))))
        return self.found(gone)

    def found(self, gone: frozenset[int]) -> Reduced:
        tree, settled = self.told.get(gone, (frozenset(), True))
        return Reduced(tree or None, (), settled, None, 0, None)

    def least(self, wide: Any, counts: Callable[[int], int], most: int, expired: object) -> Limited | None:
        assert (wide, counts(0), most) == (self, 7, 3)
        return self.limit

    # the rules

    def conflict(self, problem: Problem, units: frozenset[int]) -> list[frozenset[int]] | None:
        found = self.conflicts.get(units)
        return None if found is None else [*map(digits, found)]

    def barred(self, problem: Problem, without: frozenset[int]) -> frozenset[int]:
        return digits(self.bars.get("".join(map(str, sorted(without))), ""))

    def counted(self, problem: Problem) -> Iterator[tuple[Callable[[int], int], int]]:
        yield lambda unit: 7, 3

    # what is known of all of the question

    def everything(self) -> frozenset[int]:
        return frozenset(range(6)) - self.beyond

    def total(self, units: frozenset[int]) -> int:
        return 10 * len(units)

    def within(self, limit: int, expired: object) -> frozenset[int]:
        self.within_limits.append(limit)
        return frozenset({0, 1, 2, 3})

    def best(self) -> str | None:
        """Give the best tree, and ``no`` where there is none."""
        wide: Any = self
        found = best_kept(SIX, UNITS, wide, self.found(frozenset()), self, never)
        if found is None:
            return None
        return "no" if found.tree is None else "".join(map(str, sorted(found.tree)))


def never_removed(_: int) -> bool:
    return False


def digits(text: str) -> frozenset[int]:
    return frozenset(map(int, text.removeprefix("_")))


def test_the_case_that_promises_most_is_next_until_none_does_better(monkeypatch: pytest.MonkeyPatch) -> None:
    cases = Scripted(
        monkeypatch, _=("0", True), _0=("123", True), _1=("", True), _2=("34", True), _02=("345", True)
    )
    cases.conflicts = {digits("0"): ["1", "0", "2"], digits("34"): ["0", "3"]}
    cases.told[digits("23")] = digits("45"), True
    assert cases.best() == "45"
    assert cases.asked == ["1", "0", "2", "02", "23"]
    # what is as good as the tree in hand is not looked at
    cases.told[digits("02")] = digits("15"), True
    assert cases.best() == "15"
    assert cases.asked[5:] == ["1", "0", "2", "02"]


def test_what_is_not_settled_promises_no_more_than_the_case_before(monkeypatch: pytest.MonkeyPatch) -> None:
    cases = Scripted(monkeypatch, _=("0", True), _0=("12345", False), _1=("234", True), _03=("45", True))
    cases.conflicts = {digits("0"): ["0", "1"], digits("12345"): ["3"]}
    assert cases.best() == "45"
    assert cases.asked == ["0", "1", "03"]
    cases.told[digits("0")] = digits("12345"), True
    assert cases.best() == "234"


def test_each_case_is_looked_at_once_and_its_barred_units_are_left_out(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    cases = Scripted(monkeypatch, _=("0", True), _0=("1", True), _1=("2", True), _015=("24", True))
    cases.conflicts = {digits("0"): ["0", "1"], digits("1"): ["1"], digits("2"): ["0"]}
    cases.bars = {"01": "5"}
    assert cases.best() == "24"
    assert cases.asked == ["0", "1", "015"]
    cases.beyond = digits("3")
    cases.told = {digits("3" + "".join(map(str, each))): told for each, told in cases.told.items()}
    cases.told[frozenset()] = digits("0"), True
    cases.bars = {"013": "5"}
    assert cases.best() == "24"
    assert cases.asked[3:] == ["03", "13", "0135"]


def test_a_tree_within_a_limit_bounds_the_cases(monkeypatch: pytest.MonkeyPatch) -> None:
    cases = Scripted(monkeypatch, _=("0", True), _045=("12", True), _145=("1", True))
    cases.conflicts = {digits("0"): ["0", "1"], digits("1"): ["2"]}
    cases.limit = Limited(digits("235"))
    assert cases.best() == "12"
    assert (cases.asked, cases.within_limits) == (["045", "145", "1245"], [29])
    del cases.told[digits("045")]
    assert cases.best() == "235"
    cases.limit = Limited(digits("5"))
    assert cases.best() == "5"  # none promises less
    assert len(cases.asked) == 6
    cases.conflicts[digits("5")] = ["5"]
    assert cases.best() == "no"
    assert cases.asked[6:] == ["0", "1"]
    cases.limit = Limited(None)
    assert cases.best() == "no"
    assert len(cases.asked) == 8
    monkeypatch.setattr(module, "least", lambda *_: None)
    cases.told[digits("0")] = digits("34"), True
    assert cases.best() == "34"
