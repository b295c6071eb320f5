"""Answers under rules that are applied before the search, and under others beside them, by brute force."""

import random
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

import pytest

from foon_asp.asp import Proof, Settings, Status, solve
from foon_asp.asp.ranking import Ranked
from foon_asp.asp.user_rule_check import UserRuleCheck
from foon_asp.hypergraph import NONE
from foon_asp.problem import Objective, Problem
from foon_asp.rules import rules as rules_of_questions
from foon_asp.rules.passed_constraint import given_constraint
from foon_asp.rules.tuning import RuleTuning
from tests.hypergraph.test_reductions import LISTS, Measured, posed
from tests.rules.test_constraint_meanings import small


class Rule(NamedTuple):
    """A rule about units by number, and whether a set of units keeps to it."""

    text: str
    keeps: Callable[[frozenset[int]], bool]


def deleting(rng: random.Random, units: int) -> Rule:
    unit = rng.randrange(units)
    return Rule(f":- use({unit}).", lambda tree: unit not in tree)


def requiring(rng: random.Random, units: int) -> Rule:
    some = rng.sample(range(units), min(units, rng.choice((1, 2, 2, 3))))
    return Rule(f":- {', '.join(f'not use({u})' for u in some)}.", lambda tree: not tree.isdisjoint(some))


def shrinking(rng: random.Random, units: int) -> Rule:
    if rng.random() < 0.5:
        one, other = rng.randrange(units), rng.randrange(units)
        return Rule(f":- use({one}), use({other}).", lambda tree: not {one, other} <= tree)
    some, most = frozenset(rng.sample(range(units), max(1, units // 2))), rng.choice((0, 1, 1, 2))
    listed = ";".join(f"{u} : use({u})" for u in some)
    return Rule(f":- #count {{ {listed} }} > {most}.", lambda tree: len(tree & some) <= most)


def other(rng: random.Random, units: int) -> Rule:
    one, two = rng.sample(range(units), 2) if units > 1 else (0, 1)
    if rng.random() < 0.3:  # both of two: one that requires, and no single set
        both = f"both_{one}_{two}"
        return Rule(f"{both} :- use({one}), use({two}). :- not {both}.", lambda tree: {one, two} <= tree)
    return Rule(f":- use({one}), not use({two}).", lambda tree: one not in tree or two in tree)


CLASSES = {"deleting": deleting, "requiring": requiring, "shrinking": shrinking, "other": other}


def rules(seed: int, units: int, kinds: list[str]) -> list[Rule]:
    rng = random.Random(f"rules {seed}")
    drawn = [rng.choice(kinds) for _ in range(rng.choice((1, 1, 2, 3)))]
    return [CLASSES[kind](rng, units) for kind in drawn]


MIXES = [["deleting"], ["requiring"], ["deleting", "requiring"], ["shrinking"], ["other"], sorted(CLASSES)]


def asked(seed: int, mix: list[str], folder: Path) -> tuple[Problem, list[Measured], Path]:
    """Give a random problem, the trees that keep to some random rules, and a file of these."""
    problem, _, every = posed(seed)
    some = rules(seed, len(problem.network), mix)
    file = folder / "mine.lp"
    file.write_text("\n".join(rule.text for rule in some) + "\n")
    found = [tree for tree in every if all(rule.keeps(tree.units) for rule in some)]
    return problem, found, file


@pytest.mark.parametrize("mix", MIXES, ids="+".join)
@pytest.mark.parametrize("seeds", [range(12), pytest.param(range(12, 90), marks=pytest.mark.slow)])
@pytest.mark.default_cases(
    "seeds0-deleting",
    "seeds0-deleting+other+requiring+shrinking",
    "seeds0-other",
    "seeds0-deleting+requiring",
    "seeds0-shrinking",
    "seeds0-requiring",
)
def test_the_best_tree_is_the_best_by_brute_force(mix: list[str], seeds: range, tmp_path: Path) -> None:
    cuts = 0
    for seed in seeds:
        problem, found, file = asked(seed, mix, tmp_path)
        names = LISTS[seed % len(LISTS)]
        objectives = tuple(map(Objective, names))
        expected = min((tree.key([*names, "units"]) for tree in found), default=None)
        outcome = solve(problem, objectives, Settings((file,)))
        assert outcome.problem is problem
        if expected is None:
            assert outcome.status is Status.INFEASIBLE, seed
            continue
        assert outcome.status is Status.OPTIMAL
        assert outcome.units is not None
        [key] = [tree.key([*names, "units"]) for tree in found if tree.units == frozenset(outcome.units)]
        assert key == expected, (seed, names, file.read_text())
        cuts += outcome.proof is Proof.CUTS
    assert cuts > len(seeds) / 6


@pytest.mark.parametrize("mix", MIXES, ids="+".join)
@pytest.mark.parametrize("seeds", [range(5), pytest.param(range(5, 40), marks=pytest.mark.slow)])
@pytest.mark.default_cases(
    "seeds0-other",
    "seeds0-shrinking",
    "seeds0-deleting",
    "seeds0-deleting+other+requiring+shrinking",
    "seeds0-requiring",
    "seeds0-deleting+requiring",
)
def test_trees_come_in_order_and_none_is_missing(mix: list[str], seeds: range, tmp_path: Path) -> None:
    for seed in seeds:
        problem, found, file = asked(seed, mix, tmp_path)
        names = ["units"] if seed % 2 else ["inputs", "units"]
        minimal = [tree for tree in found if not any(other.units < tree.units for other in found)]
        if len(minimal) > 12:
            continue
        ranked = Ranked(problem, tuple(map(Objective, names)), Settings((file,)))
        given = [frozenset(units) for units, _ in ranked]
        assert ranked.complete
        assert set(given) == {tree.units for tree in minimal}, (seed, file.read_text())
        keys = [tree.key(names) for units in given for tree in minimal if tree.units == units]
        assert keys == sorted(keys)


@pytest.mark.parametrize("mix", MIXES, ids="+".join)
def test_rules_that_are_left_to_the_search_mean_the_same(
    mix: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rules_of_questions, "TUNING", RuleTuning(evaluated_units=0))
    for seed in range(6):
        problem, found, file = asked(seed, mix, tmp_path)
        expected = min((tree.key(["units"]) for tree in found), default=None)
        outcome = solve(problem, settings=Settings((file,)))
        keys = {tree.units: tree.key(["units"]) for tree in found}
        best = None if outcome.units is None else keys[frozenset(outcome.units)]
        assert best == expected, (seed, file.read_text())


REQUIRING = (
    ':- not use(U) : motion(U,"MOTION").',
    ':- not use(U) : input(U,O), label(O,"LABEL"); not use(U) : motion(U,"MOTION").',
    'got(O) :- use(U), gives(U,O), label(O,"LABEL"). :- not got(O) : label(O,"LABEL").',
    'eaten :- use(U), needs(U,O), not kitchen(O), named(O). named(O) :- label(O,"LABEL"). :- not eaten.',
    ':- #count { U : use(U), output(U,O), label(O,"LABEL") } < 1.',
    ":- goal(O), not used(O). used(O) :- times(U,N), N > 0, gives(U,O).",
)


@pytest.mark.parametrize("text", REQUIRING)
def test_units_that_rules_require_by_name_are_found_by_their_names(
    text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a large network, only the units with a name of the rule are looked at."""
    trees = 0
    for seed in range(8):
        problem, _, _ = posed(seed)
        network, rng = problem.network, random.Random(seed)
        label, motion = rng.choice(network.objects).label, rng.choice(network.motions)
        rule = given_constraint(text.replace("LABEL", label).replace("MOTION", motion))
        plain = solve(problem, settings=Settings((rule,), reductions=NONE))
        with monkeypatch.context() as patched:
            patched.setattr(rules_of_questions, "TUNING", RuleTuning(evaluated_units=0))
            outcome = solve(problem, settings=Settings((rule,)))
        sizes = [
            None if found.costs is None else found.costs.key([Objective.UNITS]) for found in (outcome, plain)
        ]
        assert (outcome.status, sizes[0]) == (plain.status, sizes[1]), (seed, rule)
        trees += outcome.units is not None
    assert trees


def test_a_rate_of_a_unit_that_only_serves_what_cannot_be_made() -> None:
    """No limit leaves a tree, so all units are looked at, the one that grinds for nothing among them."""
    rates = {"pour": Fraction(1, 2), "grind": Fraction(1, 5), "mix": Fraction(1, 3)}
    whole = small("pour: start > end", "grind: start > powder", "mix: powder, rare > end")
    rare = next(o for o, node in enumerate(whole.network.objects) if node.label == "rare")
    problem = replace(whole, kitchen=whole.kitchen - {rare}, rates=rates)
    rule = given_constraint(":- #count { U : use(U) } > 0.")
    assert solve(problem, (Objective.SUCCESS,), Settings((rule,))).status is Status.INFEASIBLE


@pytest.mark.parametrize("seeds", [range(6), pytest.param(range(6, 40), marks=pytest.mark.slow)])
def test_the_rules_that_a_tree_breaks_are_named(seeds: range) -> None:
    broken = 0
    for seed in seeds:
        problem, _, every = posed(seed)
        some = list(dict.fromkeys(rules(seed, len(problem.network), sorted(CLASSES))))
        given = tuple(given_constraint(rule.text) for rule in some if rule.text.count(":-") == 1)
        if not given:
            continue
        breaking = UserRuleCheck(Settings(given))
        for tree in random.Random(seed).sample(every, min(len(every), 4)):
            expected = {rule.text for rule in some if not rule.keeps(tree.units)} & set(map(str, given))
            found = breaking.broken_rules(problem, tree.units)
            assert {each.text for each in found} == expected, (seed, tree)
            broken += len(found)
    assert broken > len(seeds) / 2
