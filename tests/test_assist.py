"""With a person's help: held against brute force over all trees and all choices of who does what."""

import json
import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import combinations, pairwise
from math import prod
from pathlib import Path

import pytest

from foon_asp.asp import Outcome, Reporter, Settings, Status, solve
from foon_asp.asp.ranking import Ranked
from foon_asp.deadline import Deadline
from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.questions.assist import Assistance, assist
from foon_asp.questions.assist import assistant as module
from tests import oracle
from tests.conftest import STRUCK_WHILE_READING, Cli
from tests.random_problems import MOTIONS, RATES, SERIES, UTENSILS, random_problem
from tests.test_alternatives import choosing

pytestmark = pytest.mark.sampled(4)  # by default some cases of each test: there are many

RULES = list(ContainerRule)
Table = Mapping[str, Fraction] | None
Tree = tuple[FunctionalUnit, ...]
Shared = Callable[[Tree, frozenset[FunctionalUnit]], bool]  # who does what: the tree, and the person's units


def drawn(seed: int, rule: ContainerRule) -> Problem:
    return (choosing, random_problem, ways)[seed % 3](seed, rule)


def ways(seed: int, rule: ContainerRule) -> Problem:
    """Make two things out of dough, each in one step or in two or three that only help makes succeed."""
    rng = random.Random(seed)
    builder = NetworkBuilder()
    dough, parts = ObjectNode.of("dough"), [ObjectNode.of("roll"), ObjectNode.of("loaf")]
    for part in parts:
        builder.add(rng.choice(MOTIONS[:3]), [dough], [part], Source("ways", 1))
        steps = [dough, *(ObjectNode.of(part.label, [str(k)]) for k in range(rng.choice((1, 2)))), part]
        for before, after in pairwise(steps):
            builder.add(rng.choice(MOTIONS[3:]), [before], [after], Source("ways", 1))
    network = builder.build()
    names = [network.object_id(node) for node in (dough, *parts)]
    kitchen, *goals = [o for o in names if o is not None]
    rates = {motion: Fraction(rng.choice(("0.5", "0.7", "0.9"))) for motion in MOTIONS[:3]}
    rates |= {motion: Fraction(rng.choice(("0.1", "0.2", "0.3"))) for motion in MOTIONS[3:]}
    return Problem(network, frozenset({kitchen}), tuple(goals), rates, UTENSILS, rule)


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
    for tree in oracle.trees(problem):
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
            assert row.costs is None
            assert row.status is Status.INFEASIBLE
            continue
        assert row.status is Status.OPTIMAL
        assert (-row.success, row.costs.units) == figures
        assert row.bound == row.success
        tree = tuple(map(problem.network.unit, row.units))
        helped = frozenset(map(problem.network.unit, row.helped))
        assert len(set(tree)) == len(tree) == row.costs.units
        assert helped <= set(tree)
        assert len(helped) <= row.most
        at_hand = set(problem.kitchen)
        for unit in row.units:
            assert at_hand.issuperset(problem.needs[unit])
            at_hand.update(problem.gives[unit])
        assert succeeds(problem, person, tree, helped) == row.success
        assert allowed(tree, helped)
    successes = [row.success or Fraction(0) for row in found.rows]
    assert successes == sorted(successes)
    return expected


@pytest.mark.slow
@SERIES
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("trees", [None, 0], ids=["one by one", "counted"])
@pytest.mark.sampled(6)
def test_every_number_of_units(
    part: int, rule: ContainerRule, trees: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The greatest success for every number of units; what no price proves is found in either way."""
    monkeypatch.setattr(module, "_TREES", trees)
    looked_at: list[Problem] = []

    class Noted(Ranked):
        def __init__(self, problem: Problem, *others: object) -> None:
            looked_at.append(problem)
            super().__init__(problem, *others)  # type: ignore[arg-type]

    monkeypatch.setattr(module, "Ranked", Noted)
    helpful = several = infeasible = 0
    for seed in range(5000, 5000 + 60 // part):
        problem, person = drawn(seed, rule), table(seed)
        found = assist(problem, person=person)
        assert found.complete
        expected = check_rows(found, person)
        if expected[-1] is None:
            assert found.greatest is None
            assert not found.exhausted
            assert len(expected) == 1
            infeasible += 1
            continue
        everything = best(problem, person, len(problem.network))
        assert everything is not None
        assert found.greatest == -everything[0] == found.rows[-1].success
        assert found.exhausted
        assert all(row is None or row[0] > everything[0] for row in expected[:-1])
        helpful += len(expected) > 1
        several += len(problem.goals) > 1
    assert infeasible >= 3 // part
    assert helpful >= 15 // part
    assert several >= 2 // part
    assert len(looked_at) >= 5 // part


@pytest.mark.slow
@SERIES
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.sampled(2)
def test_rows_end_where_they_are_asked_to(part: int, rule: ContainerRule) -> None:
    reached = missed = short = 0
    for seed in range(5200, 5200 + 36 // part):
        problem, person = drawn(seed, rule), table(seed)
        everything = assist(problem, person=person)
        if everything.greatest is None:
            continue
        for most in (0, 2, 7):
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
        fewest = sorted(len(helped) for failure, _, helped in everyone if -failure >= wanted)
        assert found.smallest == (fewest[0] if fewest else None)
        if fewest:
            assert found.rows[-1].most == fewest[0]
            reached += fewest[0] > 0
        else:
            assert found.exhausted
            missed += 1
        both = assist(problem, 1, person=person, reach=wanted)
        assert both.smallest == (fewest[0] if fewest and fewest[0] <= 1 else None)
        short += both.smallest != found.smallest
    assert reached >= 3 // part
    assert missed >= 3 // part
    assert short >= 1 // part


@pytest.mark.slow
@SERIES
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.sampled(2)
def test_a_constraint_holds_whoever_does_a_unit(part: int, rule: ContainerRule, tmp_path: Path) -> None:
    by_number = tmp_path / "mine.lp"
    for seed in range(5300, 5300 + 40 // part):
        problem, person = drawn(seed, rule), table(seed)
        motion = random.Random(seed).choice(MOTIONS)
        gone = seed % len(problem.network)
        by_number.write_text(f":- use({gone}).\n", encoding="utf-8")
        rules = ("forbid_motion", by_number)
        constants = {"forbidden_motion": motion}

        unit = problem.network.unit(gone)

        def allowed(tree: Tree, _: object, word: str = motion, gone: FunctionalUnit = unit) -> bool:
            return gone not in tree and all(unit.motion != word for unit in tree)

        found = assist(problem, person=person, constraints=rules, constants=constants)
        assert found.complete
        check_rows(found, person, allowed)


@pytest.mark.slow
@SERIES
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.sampled(3)
def test_a_constraint_can_look_at_who_does_a_unit(part: int, rule: ContainerRule, tmp_path: Path) -> None:
    mine = tmp_path / "mine.lp"
    mine.write_text(':- use(U), _by_person(U), motion(U,"cut").\n', encoding="utf-8")
    late = 0
    for seed in range(5400, 5400 + 30 // part):
        problem, person = drawn(seed, rule), table(seed)
        assert problem.rates is not None
        rates = problem.rates

        def allowed(
            tree: Tree,
            helped: frozenset[FunctionalUnit],
            rates: Mapping[str, Fraction] = rates,
            person: Table = person,
        ) -> bool:
            who = [
                rates if unit not in helped else person or dict.fromkeys(MOTIONS, Fraction(1))
                for unit in tree
            ]
            least = all(table[unit.motion] >= Fraction("0.2") for unit, table in zip(tree, who, strict=True))
            return least and not any(unit.motion == "cut" for unit in helped)

        rules = (mine, "least_rate")
        found = assist(problem, person=person, constraints=rules, constants={"least_rate": 200000})
        assert found.complete
        expected = check_rows(found, person, allowed)
        late += expected[0] is None and expected[-1] is not None
    assert late >= 2 // part  # trees that there are with help alone


@pytest.mark.slow
@SERIES
@pytest.mark.parametrize("rule", RULES)
def test_no_tree_has_a_unit_twice(part: int, rule: ContainerRule, tmp_path: Path) -> None:
    """A constraint that asks for a motion twice is not met by a unit and the same unit again."""
    twice = tmp_path / "twice.lp"
    twice.write_text(
        ':- #count { U : use(U), motion(U,"cut") } < 2.\n:- use(U), rate(U,0).\n', encoding="utf-8"
    )

    def allowed(tree: Tree, _: object) -> bool:
        return sum(unit.motion == "cut" for unit in tree) >= 2

    possible = 0
    for seed in range(5500, 5500 + 30 // part):
        problem = drawn(seed, rule)
        found = assist(problem, constraints=twice)
        possible += check_rows(found, None, allowed)[-1] is not None
    assert possible >= 2 // part


@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.sampled(2)
def test_other_encodings(rule: ContainerRule) -> None:
    for seed in range(5600, 5620):
        problem, person = drawn(seed, rule), table(seed)
        found = assist(problem, person=person, encodings="by_need")
        assert [row.success for row in found.rows] == [
            row.success for row in assist(problem, person=person).rows
        ]


@pytest.mark.parametrize("constraint", [(), ("least_rate",)], ids=["priced", "counted"])
def test_a_stop_leaves_rows_with_their_bounds(
    constraint: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whichever search a limit ends, the rows before are proved, and the last one is between its bounds."""
    problem = ways(5002, ContainerRule.STRICT)
    constants = {"least_rate": 1} if constraint else None
    everything = assist(problem, constraints=constraint, constants=constants)
    assert len(everything.rows) > 2
    left = 0

    def limited(
        problem: Problem, objectives: Sequence[Objective], settings: Settings, reporter: Reporter
    ) -> Outcome:
        nonlocal left
        left -= 1
        outcome = solve(problem, objectives, settings, reporter)
        return outcome if left >= 0 else outcome._replace(status=Status.FEASIBLE, bounds={})

    monkeypatch.setattr(module, "solve", limited)
    lengths = set()
    for searches in range(100):
        left = searches
        found = assist(problem, constraints=constraint, constants=constants)
        lengths.add(len(found.rows))
        assert found.complete == (left >= 0)
        if found.complete:
            assert found == everything
            break
        check_stopped(found, everything)
    assert len(lengths) > 2


@pytest.mark.slow
def test_a_stop_while_trees_are_looked_at_one_by_one(monkeypatch: pytest.MonkeyPatch) -> None:
    class Late(Ranked):
        def __init__(
            self, problem: Problem, objectives: Sequence[Objective], settings: Settings, reporter: Reporter
        ) -> None:
            super().__init__(problem, objectives, settings._replace(deadline=Deadline(0)), reporter)

    seeds = range(5000, 5060, 3)
    asked = [(ways(seed, ContainerRule.STRICT), table(seed)) for seed in seeds]
    proved = [assist(problem, person=person) for problem, person in asked]
    monkeypatch.setattr(module, "Ranked", Late)
    stopped = 0
    for (problem, person), everything in zip(asked, proved, strict=True):
        found = assist(problem, person=person)
        if not found.complete:
            check_stopped(found, everything)
            stopped += 1
    assert stopped >= 2


def check_stopped(found: Assistance, everything: Assistance) -> None:
    *before, last = found.rows
    for row, best_row in zip(before, everything.rows, strict=False):
        assert (row.status, row.success) == (best_row.status, best_row.success)
    proved = everything.rows[last.most].success or Fraction(0)
    assert (last.success or 0) <= proved
    assert last.bound is None or proved <= last.bound
    if before:
        assert (last.success or 0) >= (before[-1].success or 0)


def test_an_interruption_leaves_the_rows_so_far(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = ways(5002, ContainerRule.STRICT)
    everything = assist(problem)
    calls = 0

    def interrupted(*words: object) -> object:
        nonlocal calls
        calls += 1
        if calls == 4:
            raise KeyboardInterrupt
        return solve(*words)  # type: ignore[arg-type]

    monkeypatch.setattr(module, "solve", interrupted)
    found = assist(problem)
    assert not found.complete
    assert 0 < len(found.rows) <= len(everything.rows)
    assert found.rows == everything.rows[: len(found.rows)]


def test_rates_are_needed_and_above_0() -> None:
    problem = random_problem(1, ContainerRule.STRICT)
    with pytest.raises(UserError, match=r"pour.*above 0"):
        assist(problem, person={"pour": 0})
    without = Problem(problem.network, problem.kitchen, problem.goals, None, problem.utensils)
    with pytest.raises(UserError, match="--rates"):
        assist(without)


@STRUCK_WHILE_READING
def test_the_command(cli: Cli, tmp_path: Path) -> None:
    ran = cli("assist", "--goal", "macaroni", "--reach", "0.8", "--format", "json")
    assert ran.code == 0
    found = ran.json
    assert found["complete"]
    assert found["smallest"] == 3
    assert found["reach"] == {"exact": "4/5", "approx": 0.8}
    assert [row["most"] for row in found["rows"]] == [0, 1, 2, 3]
    solved = cli("solve", "--goal", "macaroni", "--objective", "success", "--format", "json").json
    first, last = found["rows"][0], found["rows"][-1]
    assert first["costs"] == solved["costs"]
    assert first["by_person"] == []
    assert last["by_person"] == sorted(unit["id"] for unit in last["units"] if unit["by"] == "person")
    assert len(last["by_person"]) == 3
    product = Fraction(1)
    rates = {}
    for line in Path("data/kitchen/motion.txt").read_text(encoding="utf-8").splitlines():
        if "\t" in line:
            motion, rate = line.split("\t")
            rates[motion] = Fraction(rate)
    for unit in last["units"]:
        product *= 1 if unit["by"] == "person" else rates[unit["motion"]]
    assert Fraction(last["costs"]["success"]["exact"]) == product >= Fraction(4, 5)

    person = tmp_path / "person.txt"
    person.write_text("pour\t0.97\nstirr\t0.9\n", encoding="utf-8")
    ran = cli("assist", "--goal", "macaroni", "--person", person, "--reach", "0.9")
    assert ran.code == 1
    assert "0.9 is out of reach" in ran.out
    assert "'stirr'" in ran.err
    ran = cli("assist", "--goal", "apple pie")
    assert ran.code == 1
    assert "infeasible" in ran.out
    ran = cli("assist", "--goal", "macaroni", "--time-limit", "0", "--format", "json")
    assert ran.code == 3
    assert not ran.json["complete"]
    for wrong in ("0", "1.1", "often", "1/0", "1e999999999", "1e-999999999"):
        assert cli("assist", "--goal", "macaroni", "--reach", wrong).code == 2


def test_the_real_network(cli: Cli, universal: Path) -> None:
    ran = cli(
        "assist", "--data", universal, "--goal", "macaroni", "--containers", "implied", "--format", "json"
    )
    assert ran.code == 0
    rows = json.loads(ran.out)["rows"]
    assert rows[0]["costs"]["success"]["approx"] == 0.02187
    solved = cli(
        *("solve", "--data", universal, "--goal", "macaroni", "--containers", "implied"),
        *("--objective", "success", "--format", "json"),
    )
    assert rows[0]["costs"] == solved.json["costs"]
    successes = [Fraction(row["costs"]["success"]["exact"]) for row in rows]
    assert successes == sorted(successes)
    assert successes[-1] == 1
    assert all(row["status"] == "optimal" and len(row["by_person"]) <= row["most"] for row in rows)


def test_copies_of_units_have_numbers_of_their_own() -> None:
    network = random_problem(1, ContainerRule.STRICT).network
    for whole in (network, network.without([1])):
        copies = whole.with_copies([2, 0])
        assert len(copies) == len(whole) + 2
        assert [copies.unit(len(whole) + k) for k in range(2)] == [whole.unit(2), whole.unit(0)]
        assert copies.sources[len(whole) :] == (whole.sources[2], whole.sources[0])
        numbers = [copies.unit_number(unit) for unit in range(len(copies))]
        assert numbers[: len(whole)] == [whole.unit_number(unit) for unit in range(len(whole))]
        assert numbers == sorted(set(numbers))
        assert [copies.unit_of_number(number) for number in numbers] == list(range(len(copies)))
        assert copies.unit_id(whole.unit(2)) == 2


@pytest.mark.parametrize("rule", RULES)
def test_units_with_rates_of_their_own(rule: ContainerRule) -> None:
    """The ordinary search, reductions and order of trees go by the rate of the unit, not of its motion."""
    differing = 0
    for seed in range(5700, 5740):
        problem = drawn(seed, rule)
        rng = random.Random(seed)
        own = {u: Fraction(rng.choice(RATES)) for u in range(len(problem.network)) if rng.random() < 0.5}
        changed = replace(problem, own_rates=own)
        by_unit = {changed.network.unit(u): changed.rate(u) for u in range(len(changed.network))}
        expected = min(
            ((-prod(map(by_unit.__getitem__, tree)), len(tree)) for tree in oracle.trees(problem)),
            default=None,
        )
        outcome = solve(changed, [Objective.SUCCESS])
        ranked = next(iter(Ranked(changed, [Objective.SUCCESS], Settings())), None)
        if expected is None or outcome.costs is None or ranked is None:
            assert expected is None
            assert outcome.costs is None
            assert ranked is None
            continue
        for costs in (outcome.costs, ranked[1]):
            assert costs.success is not None
            assert (-costs.success, costs.units) == expected
        plain = solve(problem, [Objective.SUCCESS])
        differing += plain.costs is not None and plain.costs.success != outcome.costs.success
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
