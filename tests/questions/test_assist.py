"""With a person's help: held against brute force over all trees and all choices of who does what."""

import random
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import partial
from itertools import combinations, pairwise
from math import prod
from pathlib import Path

import pytest

import foon_asp
from foon_asp.asp import Status, solve
from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.questions.assist import Assistance, assist
from tests.conftest import STRUCK_WHILE_READING, Cli
from tests.oracle import task_trees
from tests.questions.test_alternatives import choosing
from tests.support.random_problems import MOTIONS, RATES, SERIES, UTENSILS, random_problem

RULES = list(ContainerRule)
Table = Mapping[str, Fraction] | None
Tree = tuple[FunctionalUnit, ...]
Shared = Callable[[Tree, frozenset[FunctionalUnit]], bool]  # who does what: the tree, and the person's units


def drawn(seed: int, rule: ContainerRule) -> Problem:
    return (choosing, random_problem, ways)[seed % 3](seed, rule)


def ways(seed: int, rule: ContainerRule) -> Problem:
    """Make two things out of dough, each in one step or in two or three that only help makes succeed."""
    rng = random.Random(seed)
    units = []
    for part in ("roll", "loaf"):
        units.append((rng.choice(MOTIONS[:3]), "dough", part))
        steps = ["dough", *(f"{part}; {k}" for k in range(rng.choice((1, 2)))), part]
        units += [(rng.choice(MOTIONS[3:]), before, after) for before, after in pairwise(steps)]
    foon = foon_asp.build(units, kitchen="dough", utensils=UTENSILS)
    rates = {motion: Fraction(rng.choice(("0.5", "0.7", "0.9"))) for motion in MOTIONS[:3]}
    rates |= {motion: Fraction(rng.choice(("0.1", "0.2", "0.3"))) for motion in MOTIONS[3:]}
    return replace(foon.problem("roll;", "loaf;", containers=rule), rates=rates)


def table(seed: int) -> Table:
    """Give the rates of a person who never fails, or who cannot do everything and does some of it worse."""
    rng = random.Random(seed)
    if seed % 4 == 0:
        return None
    if seed % 3 == 2:
        return {motion: Fraction(rng.choice(("0.8", "0.95"))) for motion in MOTIONS[2:]}
    return {
        motion: Fraction(rng.choice(RATES)) for motion in rng.sample(MOTIONS, rng.randint(2, len(MOTIONS)))
    }


def anything(_tree: Tree, _helped: frozenset[FunctionalUnit]) -> bool:
    return True


def succeeds(problem: Problem, person: Table, tree: Tree, helped: frozenset[FunctionalUnit]) -> Fraction:
    """Multiply the rates of those who do the units."""
    assert problem.rates is not None
    success = Fraction(1)
    for unit in tree:
        theirs = Fraction(1) if person is None else person.get(unit.motion, Fraction(0))
        success *= theirs if unit in helped else problem.rates[unit.motion]
    return success


def shares(
    problem: Problem, person: Table, most: int, allowed: Shared
) -> Iterator[tuple[Fraction, int, frozenset[FunctionalUnit]]]:
    """Give every tree with every choice of at most so many units for the person: failure first."""
    for tree in task_trees.trees(problem):
        able = [unit for unit in tree if person is None or unit.motion in person]
        for count in range(min(most, len(able)) + 1):
            for helped in map(frozenset, combinations(able, count)):
                if allowed(tree, helped):
                    yield -succeeds(problem, person, tree, helped), len(tree), helped


def best(
    problem: Problem, person: Table, most: int, allowed: Shared = anything
) -> tuple[Fraction, int] | None:
    """Give the greatest success, negative, and the fewest units with it."""
    return min((share[:2] for share in shares(problem, person, most, allowed)), default=None)


def check_rows(
    found: Assistance, person: Table, allowed: Shared = anything
) -> list[tuple[Fraction, int] | None]:
    """Hold every row against brute force, and give what it should be."""
    problem = found.problem
    expected = [best(problem, person, row.most, allowed) for row in found.rows]
    assert [row.most for row in found.rows] == list(range(len(found.rows)))
    for row, figures in zip(found.rows, expected, strict=True):
        if figures is None or row.units is None or row.success is None or row.costs is None:
            assert figures is None
            assert row.units is None
            assert (row.costs, row.by_person) == (None, ())
            assert row.status is Status.INFEASIBLE
            continue
        assert row.status is Status.OPTIMAL
        assert (-row.success, row.costs.units) == figures
        assert row.bound == row.success
        network = problem.network
        ids = network.units_of_numbers(step.id for step in row.units if step.id is not None)
        tree = tuple(map(network.unit, ids))
        helped = frozenset(map(network.unit, network.units_of_numbers(row.by_person)))
        assert [step.by == "person" for step in row.units] == [unit in helped for unit in tree]
        assert len(set(tree)) == len(tree) == row.costs.units
        assert helped <= set(tree)
        assert len(helped) <= row.most
        at_hand = set(problem.kitchen)
        for unit in ids:
            assert at_hand.issuperset(problem.needs[unit])
            at_hand.update(problem.gives[unit])
        assert succeeds(problem, person, tree, helped) == row.success
        assert allowed(tree, helped)
    successes = [row.success or Fraction(0) for row in found.rows]
    assert successes == sorted(successes)
    return expected


@SERIES
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.default_cases("strict-3")
def test_every_number_of_units(part: int, rule: ContainerRule) -> None:
    helpful = several = infeasible = 0
    for seed in range(5000, 5000 + 60 // part):
        problem, person = drawn(seed, rule), table(seed)
        found = assist(problem, person=person, encodings="by_need" if seed % 5 == 0 else None)
        assert found.complete
        expected = check_rows(found, person)
        if expected[-1] is None:
            assert found.greatest_success is None
            assert not found.more_help_changes_nothing
            assert len(expected) == 1
            infeasible += 1
            continue
        everything = best(problem, person, len(problem.network))
        assert everything is not None
        assert found.greatest_success == -everything[0] == found.rows[-1].success
        assert found.more_help_changes_nothing
        assert all(row is None or row[0] > everything[0] for row in expected[:-1])
        helpful += len(expected) > 1
        several += len(problem.goals) > 1
    assert infeasible >= 3 // part
    assert helpful >= 15 // part
    assert several >= 2 // part


@SERIES
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.default_cases("implied-3")
def test_rows_end_where_they_are_asked_to(part: int, rule: ContainerRule) -> None:
    reached = missed = 0
    for seed in range(5200, 5200 + 36 // part):
        problem, person = drawn(seed, rule), table(seed)
        everything = assist(problem, person=person)
        if everything.greatest_success is None:
            continue
        for most in (0, 2):
            found = assist(problem, most, person=person)
            expected = check_rows(found, person)
            assert found.rows[-1].most <= most
            # what is left out is no better, and has no fewer units
            assert best(problem, person, most) == expected[-1]
        rng = random.Random(seed)
        wanted = rng.choice([row.success for row in everything.rows] + [Fraction(1), Fraction(1, 2)])
        assert wanted is not None
        found = assist(problem, person=person, reach=wanted)
        everyone = shares(problem, person, len(problem.network), anything)
        fewest = min((len(helped) for failure, _, helped in everyone if -failure >= wanted), default=None)
        assert found.smallest == fewest
        assert found.more_help_changes_nothing if fewest is None else found.rows[-1].most == fewest
        reached += bool(fewest)
        missed += fewest is None
        both = assist(problem, 1, person=person, reach=wanted)
        assert both.smallest == (fewest if fewest is not None and fewest <= 1 else None)
    assert reached >= 3 // part
    assert missed >= 3 // part


def by_rates(problem: Problem, person: Table, tree: Tree, helped: frozenset[FunctionalUnit]) -> bool:
    assert problem.rates is not None
    perfect = dict.fromkeys(MOTIONS, Fraction(1))
    rates = [(perfect if person is None else person) if unit in helped else problem.rates for unit in tree]
    least = all(table[unit.motion] >= Fraction("0.2") for unit, table in zip(tree, rates, strict=True))
    return least and not any(unit.motion == "cut" for unit in helped)


RULED: dict[str, tuple[list[str], Callable[[Problem, Table, Tree, frozenset[FunctionalUnit]], bool]]] = {
    "whoever does it": (
        ["forbid_motion:forbidden_motion=cut", ":- use(1)."],
        lambda p, _, tree, __: p.network.unit(1) not in tree and all(unit.motion != "cut" for unit in tree),
    ),
    "who does it": ([':- use(U), _by_person(U), motion(U,"cut").', "least_rate:least_rate=200000"], by_rates),
    # a unit and the same unit again are one
    "twice": (
        [':- #count { U : use(U), motion(U,"cut") } < 2.', ":- use(U), rate(U,0)."],
        lambda _, __, tree, ___: sum(unit.motion == "cut" for unit in tree) >= 2,
    ),
}


@SERIES
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("ruled", RULED)
@pytest.mark.default_cases("whoever does it-implied-3", "who does it-strict-3")
def test_a_constraint_can_look_at_who_does_a_unit(part: int, rule: ContainerRule, ruled: str) -> None:
    written, allowed = RULED[ruled]
    possible = late = 0
    for seed in range(5400, 5400 + 30 // part):
        problem, person = drawn(seed, rule), table(seed) if ruled != "twice" else None
        found = assist(problem, person=person, constraints=written)
        assert found.complete
        expected = check_rows(found, person, partial(allowed, problem, person))
        possible += expected[-1] is not None
        late += expected[0] is None and expected[-1] is not None
    assert possible >= 2 // part
    assert late >= 2 // part or ruled != "who does it"  # trees that there are with help alone


def test_rates_are_needed_and_above_0() -> None:
    problem = random_problem(1, ContainerRule.STRICT)
    with pytest.raises(UserError, match=r"pour.*above 0"):
        assist(problem, person={"pour": 0})
    without = Problem(problem.network, problem.kitchen, problem.goals, None, problem.utensils)
    with pytest.raises(UserError, match="--rates"):
        assist(without)


@STRUCK_WHILE_READING
def test_exit_codes(cli: Cli, tmp_path: Path) -> None:
    asked = ("assist", "--goal", "macaroni")
    found = cli(*asked, "--reach", "0.8", "--format", "json").json
    assert (found["smallest"], found["reach"]) == (3, {"exact": "4/5", "approx": 0.8})
    last = found["rows"][-1]
    by_person = sorted(unit["id"] for unit in last["units"] if unit["by"] == "person")
    assert (last["most"], last["by_person"]) == (3, by_person)
    person = tmp_path / "person.txt"
    person.write_text("pour\t0.97\nstirr\t0.9\n", encoding="utf-8")
    ran = cli(*asked, "--person", person, "--reach", "0.9")
    assert (ran.code, "0.9 is out of reach" in ran.out, "'stirr'" in ran.err) == (1, True, True)
    ran = cli("assist", "--goal", "apple pie")
    assert (ran.code, "infeasible" in ran.out) == (1, True)
    ran = cli(*asked, "--time-limit", "0", "--format", "json")
    assert (ran.code, ran.json["complete"]) == (3, False)
    for wrong in ("0", "1.1", "often", "1/0", "1e999999999", "1e-999999999"):
        assert cli(*asked, "--reach", wrong).code == 2


def test_the_real_network(cli: Cli, universal: Path) -> None:
    words = ("--data", universal, "--goal", "macaroni", "--containers", "implied", "--format", "json")
    rows = cli("assist", *words).json["rows"]
    assert rows[0]["costs"] == cli("solve", *words, "--objective", "success").json["costs"]
    assert rows[-1]["costs"]["success"]["exact"] == "1"
    assert all(row["status"] == "optimal" and len(row["by_person"]) <= row["most"] for row in rows)


@pytest.mark.parametrize("rule", RULES)
def test_units_with_rates_of_their_own(rule: ContainerRule) -> None:
    """The ordinary search and its reductions go by the rate of the unit, not of its motion."""
    differing = 0
    for seed in range(5700, 5740):
        problem = drawn(seed, rule)
        rng = random.Random(seed)
        own = {u: Fraction(rng.choice(RATES)) for u in range(len(problem.network)) if rng.random() < 0.5}
        changed = replace(problem, own_rates=own)
        by_unit = {changed.network.unit(u): changed.rate(u) for u in range(len(changed.network))}
        trees = [(-prod(map(by_unit.__getitem__, tree)), len(tree)) for tree in task_trees.trees(problem)]
        costs = solve(changed, [Objective.SUCCESS]).costs
        if costs is None or costs.success is None:
            assert not trees
            continue
        assert (-costs.success, costs.units) == min(trees)
        plain = solve(problem, [Objective.SUCCESS]).costs
        differing += plain is not None and plain.success != costs.success
    assert differing >= 5


@pytest.mark.slow
def test_a_rule_that_would_see_units_twice_is_refused(cli: Cli) -> None:
    """For rules about rates, a unit that the person does better is there twice: a count of all is off."""
    few = ":- use(U), motion(U,M), #count { V : motion(V,M) } < 2."
    slow, knife = ":- use(U), rate(U,N), N < 300000.", ":- use(U), not _by_person(U), motion(U,M), rate(U,1)."
    asked = ["assist", "--goal", "macaroni", "--assist", 1]
    assert cli(*asked, "--rule", few).code in {0, 1}
    assert cli(*asked, "--rule", slow, "--rule", knife).code == 0
    ran = cli(*asked, "--rule", slow, "--rule", few)
    assert ran.code == 2
    assert "error: rule 2:1: this rule looks at units that the tree need not have" in ran.err
    assert "it would see those twice that a person does better" in ran.err


@pytest.mark.parametrize(
    "numbered",
    [":- use(78).", ":- not use(78).", ":- use(U), U < 30.", ":- motion(78,M), use(U), motion(U,M)."],
)
def test_a_rule_that_names_a_unit_by_number_is_refused_beside_one_about_who_does_it(
    cli: Cli, numbered: str
) -> None:
    """What a person does has another number there, so the rule would not be kept to."""
    asked = ["assist", "--goal", "macaroni", "--assist", 1, "--rule", numbered]
    assert cli(*asked).code in {0, 1}
    ran = cli(*asked, "--rule", ":- use(U), rate(U,N), N < 300000.")
    assert (ran.code, "names a unit by its number" in ran.err) == (2, True)
