"""The best tree that keeps to ready-made constraints, by prices or by clingo, against all trees there are."""

import random
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest

from foon_asp.asp import Settings, Status, solve
from foon_asp.deadline import Deadline
from foon_asp.hypergraph import ALL, NONE, priced_limit, tuning
from foon_asp.hypergraph.priced_limit import WithinLimit
from foon_asp.network import UnitPrices
from foon_asp.problem import ContainerRule, Objective, Problem, levels
from foon_asp.rules.passed_constraint import given_constraint
from tests.oracle.constraints import keeps, random_rule, settings_of
from tests.rules.test_constraint_meanings import small, trees
from tests.rules.test_ready_made import known
from tests.support.gap_problem import gap_problem
from tests.support.random_problems import MOTIONS, random_problem, random_steps

LISTS = [["units"], ["success"], ["kitchen"], ["price", "inputs"], ["units", "success"]]
SEEDS = [range(30, 40), pytest.param(range(100), marks=pytest.mark.slow)]
Tree = tuple[frozenset[int], tuple[Any, ...]]
# How an answer is looked for: small problems are treated as large ones are.
WAYS = {
    "by one price": tuning.PriceTuning(),
    "by prices": tuning.PriceTuning(easy_units=0),
    "by rising prices": tuning.PriceTuning(rising_units=0),
}


@pytest.fixture
def way(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Have an answer looked for in one way."""
    monkeypatch.setattr(tuning, "PRICES", WAYS[request.param])


ways = pytest.mark.parametrize("way", WAYS, indirect=True)


def asked(seeds: range) -> Iterator[tuple[Problem, list[dict[str, Any]], list[Tree]]]:
    """Draw problems, and constraints of which some do more than to remove and to require units."""
    for seed in seeds:
        rng = random.Random(f"limits {seed}")
        problem = (random_steps if seed % 3 else random_problem)(seed, list(ContainerRule)[seed % 2])
        prices = {motion: Fraction(place * place, 10) for place, motion in enumerate(MOTIONS)}
        rates = problem.rates or dict.fromkeys(problem.network.motions, Fraction(1, 2))
        problem = replace(problem, rates=rates, unit_prices=UnitPrices(prices, {}))
        found = [*trees(problem)]
        for _ in range(6 if found else 0):
            drawn = {rule["rule"]: rule for rule in (random_rule(rng, problem) for _ in range(3))}
            motions = [unit.motion for unit in min(found, key=lambda tree: len(tree[0]))[1]]
            if motions and rng.random() < 0.5:  # the smallest tree has one more than may be
                most = max(motions, key=motions.count)
                limit = {"limited_motion": most, "max_uses": motions.count(most) - 1}
                drawn["at_most_motion"] = {"rule": "at_most_motion", **limit}
            if known(problem, settings_of([*drawn.values()])).unsettled:
                yield problem, [*drawn.values()], found


@ways
@pytest.mark.usefixtures("way")
@pytest.mark.parametrize("seeds", SEEDS)
def test_the_answer_is_the_best_of_all_trees_that_keep_to_them(seeds: range) -> None:
    none = 0
    for place, (problem, rules, found) in enumerate(asked(seeds)):
        names = LISTS[place % len(LISTS)]
        objectives = tuple(map(Objective, names))
        order = levels(objectives)
        kept = [units for units, tree in found if all(keeps(problem, tree, rule) for rule in rules)]
        best = min((problem.costs(units).key(order) for units in kept), default=None)
        outcome = solve(problem, objectives, settings_of(rules))
        assert outcome.status is (Status.OPTIMAL if kept else Status.INFEASIBLE), (rules, names)
        assert (None if outcome.costs is None else outcome.costs.key(order)) == best, (rules, names)
        assert outcome.units is None or frozenset(outcome.units) in kept
        none += not kept
    assert none > len(seeds) / 8


# --- By hand: p, q and r are cut by one unit each, or fried and boiled by two.

THREE = small(
    *("cut: start > p", "cut: start > q", "cut: start > r", "fry: start > a", "boil: a > p"),
    *("fry: start > b", "boil: b > q", "fry: start > c", "boil: c > r", "mix: p, q, r > end"),
)


def within(**limits: int) -> Settings:
    rules = (f"at_most_motion:limited_motion={name},max_uses={most}" for name, most in limits.items())
    return Settings(tuple(map(given_constraint, rules)))


@ways
@pytest.mark.usefixtures("way")
def test_the_best_tree_of_so_many_cuts() -> None:
    for cuts in range(4):
        outcome = solve(THREE, settings=within(cut=cuts))
        assert outcome.costs is not None
        assert (outcome.status, outcome.costs.units) == (Status.OPTIMAL, 7 - cuts)
        for boils in (2 - cuts, 3 - cuts):
            both = solve(THREE, settings=within(cut=cuts, boil=boils))
            assert both.status is (Status.OPTIMAL if cuts + boils >= 3 else Status.INFEASIBLE)
    assert solve(THREE, settings=within(mix=0)).status is Status.INFEASIBLE


@pytest.mark.parametrize(("way", "units"), [*zip(WAYS, (380, 380, 361), strict=True)], indirect=["way"])
@pytest.mark.usefixtures("way")
def test_the_best_is_found_and_no_more_is_left_to_be_searched_than_was(units: int) -> None:
    """Of many questions together, each under a limit that the best tree breaks."""
    left, by = 0, (Objective.PRICE,)
    for problem in map(gap_problem, range(8)):
        free = solve(problem, by).units
        assert free is not None
        motions = [problem.network.motions[unit] for unit in free]
        for motion in ("wipe", "clear", "draw"):
            for most in range(max(0, motions.count(motion) - 2), motions.count(motion)):
                found, expected = (
                    solve(problem, by, within(**{motion: most})._replace(reductions=reductions))
                    for reductions in (ALL, NONE)
                )
                assert (found.status, found.costs and found.costs.key(by)) == (
                    *(expected.status, expected.costs and expected.costs.key(by)),
                )
                left += found.left
    assert left <= units


def test_ctrl_c_while_limits_are_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    def pressed(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(priced_limit, "search_within_limit", pressed)
    deadline = Deadline()
    outcome = solve(THREE, settings=within(cut=2)._replace(deadline=deadline))
    assert (outcome.status, outcome.units, deadline.interrupted) == (Status.UNKNOWN, None, True)
    assert outcome.stopped == "ctrl-C while cutting the network"


@pytest.mark.parametrize("units", [None, frozenset(range(10))])
def test_a_tree_within_a_limit_that_is_found_as_time_is_up_is_not_lost(
    units: frozenset[int] | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    deadline = Deadline()

    def late(*_: object) -> WithinLimit:
        deadline.interrupt()
        return WithinLimit(frozenset({0, 1, 7, 8, 9}), units)

    monkeypatch.setattr(priced_limit, "search_within_limit", late)
    outcome = solve(THREE, settings=within(cut=2)._replace(deadline=deadline))
    assert (outcome.status, outcome.units) == (Status.FEASIBLE, (0, 1, 7, 8, 9))


def test_what_leads_nowhere_has_no_costs() -> None:
    """It can run, but what takes its output cannot; where rates count, nothing knows what it costs."""
    nowhere = small(
        *("cut: start > a", "mix: a > end", "fry: start > b", "boil: b > c", "mix: c > end"),
        *("peel: start > x", "grow: never > never", "blend: x, never > end"),
    )
    figures = ("98/100", "97/100", "6/10", "7/10", "97/100", "1/5", "1/7", "1/9")
    rates = dict(zip(nowhere.network.motions, map(Fraction, figures), strict=True))
    outcome = solve(replace(nowhere, rates=rates), (Objective.SUCCESS,), within(cut=0))
    assert (outcome.status, outcome.units) == (Status.OPTIMAL, (2, 3, 4))


def test_a_limit_counts_what_a_unit_costs_in_hundredths() -> None:
    problem = small("cut: start > a", "wash: start > b", "fry: a, b > end")
    prices = UnitPrices({"cut": Fraction(3), "wash": Fraction(1), "fry": Fraction(5)}, {})
    priced = replace(problem, unit_prices=prices)
    for most in (-1, 799, 900):
        ready = known(priced, Settings((given_constraint(f"at_most_price:max_price={most}"),)))
        [row] = ready.upper_limits(priced, Deadline())
        assert ([*map(row.weight, range(3))], row.bound) == ([300, 100, 500], most)
