"""Answers under ready-made constraints are the best of all trees that keep to them by their words."""

import subprocess
import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.asp import Settings, Status, solve
from foon_asp.asp.assembly import ready_made_program
from foon_asp.asp.ranking import Ranked
from foon_asp.asp.user_rule_check import UserRuleCheck
from foon_asp.errors import UserError
from foon_asp.hypergraph import ALL, NONE, Reduction
from foon_asp.network import UnitPrices
from foon_asp.problem import Objective, Problem
from foon_asp.rules.passed_constraint import given_constraint
from foon_asp.rules.ready_made import ReadyMade
from tests.conftest import ROOT, Cli
from tests.dataset.test_nearby import near_of, stored
from tests.oracle import task_trees
from tests.oracle.constraints import keeps, settings_of
from tests.rules.test_constraint_meanings import drawn, trees


def known(problem: Problem, settings: Settings) -> ReadyMade:
    """Understand ready-made constraints for a problem."""
    program = ready_made_program(problem, settings, lambda _: None)
    assert program is not None
    assert program.ready_made is not None
    return program.ready_made


def use_of(rule: dict[str, Any]) -> str:
    """Write a use of a constraint with constants of its own."""
    return f"{rule['rule']}:{','.join(settings_of([rule]).constants)}"


@pytest.mark.parametrize("seeds", [range(8), pytest.param(range(8, 20), marks=pytest.mark.slow)])
@pytest.mark.parametrize("objective", [Objective.UNITS, Objective.SUCCESS])
@pytest.mark.parametrize("reductions", [ALL, frozenset({Reduction.FORCED}), NONE], ids=["all", "few", "none"])
def test_the_best_tree_keeps_to_them(
    seeds: range, objective: Objective, reductions: frozenset[Reduction]
) -> None:
    """One of each, and some together; with constants for all, and with those of each use beside a rule."""
    for seed in seeds:
        problem, rules, rng = drawn(seed)
        rates = problem.rates or dict.fromkeys(problem.network.motions, Fraction(1, 2))
        problem = replace(problem, rates=rates)
        found = [tree for _, tree in trees(problem)]
        for some in (1, 1, 2, 3):
            chosen = rng.sample(rules, some)
            kept = [tree for tree in found if all(keeps(problem, tree, rule) for rule in chosen)]
            best = task_trees.best(kept, problem, [str(objective)])
            given = settings_of(chosen)._replace(reductions=reductions)
            uses = [use_of(rule) for rule in chosen]
            beside = Settings((*map(given_constraint, [*uses, ":- use(99)."]),), reductions=reductions)
            for settings in (given, beside):
                outcome = solve(problem, (objective,), settings)
                assert outcome.status is (Status.INFEASIBLE if best is None else Status.OPTIMAL), chosen
                if outcome.units is not None:
                    tree = tuple(map(problem.network.unit, outcome.units))
                    assert {*tree} in map(set, kept), chosen
                    assert task_trees.key(problem, tree, [str(objective)]) == best, chosen


@pytest.mark.parametrize("seed", range(12))
def test_uses_of_one_constraint_hold_each(seed: int) -> None:
    problem, _, rng = drawn(seed)
    motions = sorted(set(problem.network.motions))
    chosen = [
        {"rule": "at_most_motion", "limited_motion": rng.choice(motions), "max_uses": rng.randrange(2)}
        for _ in range(2)
    ]
    chosen += [{"rule": "forbid_motion", "forbidden_motion": rng.choice(motions)} for _ in range(seed % 3)]
    kept = [tree for _, tree in trees(problem) if all(keeps(problem, tree, rule) for rule in chosen)]
    outcome = solve(problem, (Objective.UNITS,), Settings((*map(given_constraint, map(use_of, chosen)),)))
    best = min(map(len, kept), default=None)
    assert (None if outcome.costs is None else outcome.costs.units) == best


@pytest.mark.parametrize("seeds", [range(6), pytest.param(range(6, 24), marks=pytest.mark.slow)])
def test_trees_in_order_keep_to_them_and_others_break_them(seeds: range) -> None:
    for seed in seeds:
        problem, rules, rng = drawn(seed)
        found = [*trees(problem)]
        for some in (1, 2):
            chosen = rng.sample(rules, some)
            kept = {units for units, tree in found if all(keeps(problem, tree, rule) for rule in chosen)}
            minimal = {tree for tree in kept if not any(other < tree for other in kept)}
            ranked = Ranked(problem, (Objective.UNITS,), settings_of(chosen))
            assert {frozenset(units) for units, _ in ranked} == minimal, chosen
            for units, tree in found[:3]:
                for rule in chosen:
                    broken = UserRuleCheck(settings_of([rule])).broken_rules(problem, units)
                    assert bool(broken) is not keeps(problem, tree, rule), rule


@pytest.mark.parametrize(
    "other", ["only_sources:allowed_source=FOON.txt", "require_ingredient:required_ingredient=salt"]
)
@pytest.mark.parametrize("reductions", ["all", "forced", "none"])
def test_clingo_is_told_what_the_others_look_at(cli: Cli, other: str, reductions: str) -> None:
    words = "--constraint", "before:earlier_motion=cook,later_motion=fry", "--constraint", other
    ran = cli("solve", "--goal", "macaroni", *words, "--reduce", reductions, "--format", "json")
    assert (ran.json["status"], ran.json["costs"]["units"]) == ("optimal", 9)


@pytest.mark.parametrize(
    ("written", "units"),
    [
        ("forbid_motion:forbidden_motion=crush", 3),
        ("forbid_motion:forbidden_motion=", 2),
        (r'forbid_motion:forbidden_motion="a\"b"', 2),
        ("at_most_units:max_units=1", None),
        ("at_most_price:max_price=3", 2),
        ("at_most_price:max_price=1", None),
    ],
)
def test_values_are_those_that_clingo_reads(written: str, units: int | None) -> None:
    problem = foon_asp.load().problem("ice")
    prices = UnitPrices(dict.fromkeys(problem.network.motions, Fraction(1, 100)), {})
    problem = replace(problem, unit_prices=prices)
    for reductions in (ALL, NONE):
        settings = Settings((given_constraint(written),), reductions=reductions)
        outcome = solve(problem, (Objective.UNITS,), settings)
        assert (outcome.costs and outcome.costs.units) == units


def test_prices_that_cannot_be_told_and_constants_that_nothing_has_are_refused() -> None:
    problem = drawn(0)[0]
    limit = Settings((given_constraint("at_most_price:max_price=3"),))
    thirds = UnitPrices(dict.fromkeys(problem.network.motions, Fraction(1, 3)), {})
    for asked, settings, message in (
        (replace(problem, unit_prices=thirds), limit, "is not a whole number of hundredths"),
        (replace(problem, unit_prices=None), limit, "no prices of units are known"),
        (problem, limit._replace(constants=("max_price=3",)), "has values of its own"),
    ):
        with pytest.raises(UserError, match=message):
            solve(asked, (Objective.UNITS,), settings)


def test_parts_of_stores_are_asked_about_without_clingo(tmp_path: Path) -> None:
    """But not where the rest of the rules does not see all that is taken to be at hand."""
    problem = drawn(5)[0]
    near = near_of(stored(problem, tmp_path).nearby((0,), "strict", units_at_first=1))
    assert near is not None
    prices = problem.unit_prices
    part, relaxed = (replace(each, unit_prices=prices) for each in (near.problem, near.relaxation))
    for text, rest in (
        ("forbid_motion:forbidden_motion=mix", False),
        ("at_most_units:max_units=3", True),
        ("before:earlier_motion=cut,later_motion=mix", True),
    ):
        settings = Settings((given_constraint(text),))
        assert ready_made_program(part, settings, lambda _: None)
        assert bool(ready_made_program(relaxed, settings, lambda _: None)) is not rest


def test_what_they_settle_needs_no_clingo() -> None:
    code = (
        "import sys\n"
        "from foon_asp.cli.main import main\n"
        "try:\n    main(sys.argv[1:])\n"
        "except SystemExit as end:\n    print(end.code, 'clingo' in sys.modules)"
    )
    words = ["solve", "--goal", "ice", "--constraint", "forbid_motion:forbidden_motion=crush"]
    words += ["--constraint", "at_most_units", "-c", "max_units=3"]
    ran = subprocess.run(
        [sys.executable, "-c", code, *words], capture_output=True, text=True, check=True, cwd=ROOT
    )
    assert "optimal by units (strict containers): 3 units, 9 inputs" in ran.stdout
    assert ran.stdout.endswith("0 False\n")
