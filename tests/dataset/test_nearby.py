"""Large stores: no more is read than an answer takes, and it is the answer that the whole network has."""

import json
import random
from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from msgspec import structs

import foon_asp
from foon_asp.asp import Proof, Settings, Status, solve
from foon_asp.asp.assembly import hold_for_subtrees
from foon_asp.asp.outcome import Outcome
from foon_asp.batch.answer_row import answer_row
from foon_asp.batch.batch_question import BatchQuestion
from foon_asp.certificate.certificate import subject_of
from foon_asp.cli.batch_data import BatchData
from foon_asp.dataset import Dataset, nearby_optimum
from foon_asp.dataset.nearby import Nearby, NearbyProblem
from foon_asp.dataset.nearby_optimum import RefinementTuning, near_goals
from foon_asp.dataset.reading_store import read_store
from foon_asp.deadline import Deadline, LimitError
from foon_asp.foon import Foon
from foon_asp.problem import ContainerRule, Objective, Problem, levels, reach
from foon_asp.proof import verifier
from foon_asp.questions.answer import answer_from_store, answer_under_rules
from foon_asp.questions.certifying import solve_with_certificate
from foon_asp.questions.ending import Ending
from foon_asp.rules.passed_constraint import RuleText
from foon_asp.store.import_files import import_files
from foon_asp.text.data_folder import DataFiles
from tests.conftest import Cli
from tests.oracle.constraints import random_rule, settings_of
from tests.store.test_store import import_problem
from tests.support.random_problems import MOTIONS, SERIES, random_problem

LISTS = (
    (Objective.UNITS,),
    (Objective.SUCCESS,),
    (Objective.INPUTS, Objective.SUCCESS),
    (Objective.ATTEMPTS,),
)


def stored(problem: Problem, folder: Path) -> Dataset:
    """Import a problem, and give the data that its store has, with the rates and utensils of the problem."""
    dataset = read_store(DataFiles((import_problem(problem, folder),)), 3)
    return replace(dataset, rates=problem.rates, utensils=problem.utensils)


def near_of(problem: Problem) -> Nearby | None:
    return problem.nearby() if isinstance(problem, NearbyProblem) else None


def asked(problem: Problem) -> Nearby:
    near = near_of(problem)
    assert near is not None
    return near


def assert_same(found: Outcome, expected: Outcome, objectives: Sequence[Objective], *drawn: object) -> None:
    """Require the status and the costs that are expected; what was drawn is told where they differ."""
    assert found.status is expected.status, (*drawn, objectives)
    if found.costs is not None and expected.costs is not None:
        order = levels(tuple(objectives))
        assert found.costs.key(order) == expected.costs.key(order), (*drawn, objectives)


# Two ways to a stew, of 3 and of 12 units; the last unit of either makes it of what takes the others.
SHORT = [("boil", "water", "boiled"), ("plate", "boiled", "plated"), ("serve", "plated", "stew")]
LONG = [
    (f"cook {n}", f"stock {n}" if n else "bones", f"stock {n + 1}" if n < 11 else "stew") for n in range(12)
]


def two_ways(folder: Path) -> Dataset:
    """Make a store of them, with water and bones at hand."""
    units = "".join(f"O\t{need}\nM\t{motion}\nO\t{give}\n//\n" for motion, need, give in (*SHORT, *LONG))
    file, kitchen = folder / "stew.txt", folder / "kitchen.txt"
    file.write_text(units, encoding="utf-8")
    kitchen.write_text("O\twater\nO\tbones\n", encoding="utf-8")
    import_files(DataFiles((file,), kitchen), folder / "stew.foon")
    return read_store(DataFiles((folder / "stew.foon",)), 3)


def test_what_is_taken_to_be_at_hand_is_in_no_answer(tmp_path: Path) -> None:
    dataset = two_ways(tmp_path)
    near = asked(dataset.nearby(dataset.command_goal_ids(["stew"]), "strict", units_at_first=1))
    assert len(near.problem.network) == 2  # both ways, one unit each
    free = solve(near.relaxation)
    assert free.units is not None
    assert len(free.units) == 1
    assert near.open_nodes_used(free.units) != []
    assert solve(near.problem).status is Status.INFEASIBLE
    found = answer_from_store(near, [Objective.UNITS], Settings())
    assert found.status is Status.OPTIMAL
    assert found.tree is not None
    assert [unit.motion for unit in found.tree.units] == ["boil", "plate", "serve"]
    assert found.problem.kitchen < near.relaxation.kitchen, "the other way was read to its end"
    assert not any(map(found.problem.at_hand, found.problem.goal_nodes))


def test_a_limit_gives_no_tree_that_may_not_be_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def stopped(*asked: object) -> Outcome:
        found = solve(*asked)  # type: ignore[arg-type]
        return found._replace(status=Status.FEASIBLE, proof=None, stopped="the time limit of 1 s")

    monkeypatch.setattr(nearby_optimum, "solve", stopped)
    dataset = two_ways(tmp_path)
    near = asked(dataset.nearby(dataset.command_goal_ids(["stew"]), "strict", units_at_first=1))
    found = answer_from_store(near, [Objective.UNITS], Settings(deadline=Deadline(1)))
    assert (found.status, found.units, found.costs) == (Status.UNKNOWN, None, None)
    assert found.outcome.bounds[Objective.UNITS] == 1


def test_a_limit_gives_a_tree_of_what_was_read_and_the_bound(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stopped(*asked: object) -> None:
        raise LimitError(Deadline(0))

    dataset = two_ways(tmp_path)
    near = asked(dataset.nearby(dataset.command_goal_ids(["stew"]), "strict", units_at_first=5))
    monkeypatch.setattr(Nearby, "grow", stopped)
    monkeypatch.setattr(Deadline, "watched", lambda *given, **late: nullcontext())
    found = answer_from_store(near, [Objective.UNITS], Settings())
    assert found.costs is not None
    assert (found.status, found.proof, found.costs.units) == (Status.FEASIBLE, None, 3)
    assert found.outcome.bounds[Objective.UNITS] == 2  # the last two units of the longer way
    assert found.stopped is not None
    near = asked(dataset.nearby(dataset.command_goal_ids(["stew"]), "strict", units_at_first=1))
    found = answer_from_store(near, [Objective.UNITS], Settings())
    assert (found.status, found.proof, found.units) == (Status.UNKNOWN, None, None)
    assert found.outcome.bounds[Objective.UNITS] == 1


@pytest.mark.parametrize("at_limit", [1, 2])
def test_at_a_limit_the_tree_of_the_fewest_units_is_one_that_keeps_to_the_rules(
    at_limit: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    looks: list[Objective] = []

    def stopped(
        problem: Problem, by: Sequence[Objective], how: Settings, *more: Any, **known: Any
    ) -> Outcome:
        found = solve(problem, by, how, *more, **known)
        looks.extend(by if how.constraints else ())
        if looks.count(Objective.INPUTS) < 3 - at_limit or looks[-1] is Objective.UNITS:
            return found
        at_once = found._replace(status=Status.UNKNOWN, units=None, costs=None, proof=None)
        return at_once._replace(stopped="a limit", bounds={})

    monkeypatch.setattr(nearby_optimum, "solve", stopped)
    dataset = two_ways(tmp_path)
    near = asked(dataset.nearby(dataset.command_goal_ids(["stew"]), "strict", units_at_first=1))
    how = Settings((Path("before"),), constants=("earlier_motion=serve", "later_motion=plate"))
    found = answer_from_store(near, [Objective.INPUTS], how)
    assert (found.stopped, found.proof) == ("a limit", None)
    if at_limit == 2:  # before the fewest units were asked about
        assert (found.status, found.units) == (Status.UNKNOWN, None)
        return
    assert Objective.UNITS in looks
    assert (found.status, found.costs and found.costs.units) == (Status.FEASIBLE, 12)
    assert found.tree is not None
    assert len(found.tree.units) == 12
    assert found.costs is not None
    assert found.outcome.bounds[Objective.INPUTS] <= found.costs.inputs


@pytest.mark.parametrize("rules", [(), (RuleText(":- #count { U : use(U) } > 20."),)])
@pytest.mark.parametrize("weak", [{}, {Objective.UNITS: 0}])
def test_a_limit_keeps_the_bound_of_what_was_asked_before(
    rules: tuple[RuleText, ...],
    weak: dict[Objective, int],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    looks = 0

    def stopped(problem: Problem, by: Sequence[Objective], how: Settings, *more: Any) -> Outcome:
        nonlocal looks
        found, looks = solve(problem, by, how, *more), looks + 1
        if looks < 4 and not (rules and how.constraints):
            return found
        return found._replace(status=Status.FEASIBLE, proof=None, stopped="a limit", bounds=dict(weak))

    monkeypatch.setattr(nearby_optimum, "solve", stopped)
    dataset = two_ways(tmp_path)
    near = asked(dataset.nearby(dataset.command_goal_ids(["stew"]), "strict", units_at_first=1))
    found = answer_from_store(near, [Objective.UNITS], Settings(rules))
    assert looks >= 4
    assert found.stopped == "a limit"
    assert found.outcome.bounds == {Objective.UNITS: 2}  # of the last two units of either way


def test_a_limit_while_all_is_read_gives_the_tree_in_hand(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stopped(*asked: object) -> None:
        raise LimitError(Deadline(0))

    monkeypatch.setattr("foon_asp.questions.answer.problem_for_rules", stopped)
    dataset, order = two_ways(tmp_path), (Objective.UNITS,)
    how = Settings((RuleText(':- not 1 <= #count { U : use(U), motion(U,"cook 3") }.'),))
    problem = dataset.problem(dataset.command_goal_ids(["stew"]), "strict")
    found = answer_under_rules(problem, order, how)
    assert found.costs is not None
    assert (found.status, found.proof, found.costs.units) == (Status.FEASIBLE, None, 7)
    assert found.outcome.bounds == {Objective.UNITS: 3}  # without the rule
    assert found.ending is Ending.LIMIT


@pytest.mark.parametrize("limited", [True, False])
def test_where_rules_leave_no_tree_that_is_said_even_at_a_limit(
    limited: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stopped(*asked: object, **named: object) -> None:
        raise LimitError(Deadline(0))

    dataset = two_ways(tmp_path)
    near = asked(dataset.nearby(dataset.command_goal_ids(["stew"]), "strict", units_at_first=1))
    if limited:
        monkeypatch.setattr(Nearby, "grow", stopped)
    forbidden = Settings(
        tuple(RuleText(f':- use(U), motion(U,"{each}").') for each in (SHORT[-1][0], LONG[-1][0]))
    )
    found = answer_from_store(near, [Objective.UNITS], forbidden)
    assert (found.status, found.units) == (Status.INFEASIBLE, None)
    assert len(found.problem.network) < len(SHORT + LONG)


@pytest.fixture
def from_one_unit(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have questions begin with one unit near the goals, and nobody read all that these need."""
    monkeypatch.setattr(Dataset.nearby, "__defaults__", (None, 1))
    monkeypatch.setattr(Nearby, "full_problem", None)


@pytest.mark.usefixtures("from_one_unit")
def test_rows_of_a_batch_are_those_of_the_text(tmp_path: Path) -> None:
    store = BatchData(two_ways(tmp_path))
    text = BatchData(foon_asp.load(tmp_path / "stew.txt", kitchen=tmp_path / "kitchen.txt")._dataset)
    statuses = set()
    for forbidden in ((), ("serve", "cook 3")):
        for goals, objective in product((("stew",), ("stew", "stock 9")), ("units", "success")):
            one = BatchQuestion(goals, objective)
            settings = Settings(tuple(RuleText(f':- use(U), motion(U,"{each}").') for each in forbidden))
            ours, theirs = (answer_row(asker, one, settings=settings) for asker in (text, store))
            assert structs.replace(theirs, seconds=0) == structs.replace(ours, seconds=0)
            statuses.add(ours.status)
    assert statuses == {"optimal", "infeasible", "failed"}  # there are no rates


@SERIES
@pytest.mark.parametrize("rule", list(ContainerRule))
def test_random_problems(
    rule: ContainerRule, part: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    compared = read_again = impossible = 0
    for seed in range(36 // part):
        # every other time, trees without a proof say what is read from the first round on
        refinement = RefinementTuning(proved_units=0) if seed % 2 else RefinementTuning()
        monkeypatch.setattr(nearby_optimum, "REFINEMENT", refinement)
        problem = replace(random_problem(seed, rule, units=14, readable=True), unit_prices=None)
        dataset = stored(problem, tmp_path)
        for goals in {
            problem.goals,
            *((o,) for o in random.Random(seed).sample(range(len(problem.network.objects)), 3)),
        }:
            for objectives in LISTS:
                near = near_of(dataset.nearby(goals, rule.value, units_at_first=1))
                if near is None:
                    continue
                before = len(near.problem.network)
                found = answer_from_store(near, objectives, Settings())
                expected = solve(replace(problem, goals=goals), objectives)
                assert_same(found.outcome, expected, objectives, seed, goals)
                compared += 1
                read_again += len(found.problem.network) > before
                impossible += found.status is Status.INFEASIBLE
    assert compared > 180 // part
    assert read_again > compared // 4
    assert impossible > 2


@pytest.mark.usefixtures("from_one_unit")
@pytest.mark.parametrize("form", ["text", "json"])
@pytest.mark.parametrize("motions", [(), ("boil", "cook 11")])
def test_the_command_says_the_same_from_what_it_reads_near_the_goal(
    motions: tuple[str, ...], form: str, tmp_path: Path, cli: Cli
) -> None:
    """Of two ways to a stew, one breaks the rule far from the goal, and the other one where it begins."""
    two_ways(tmp_path).close()
    words = ("solve", "--goal", "stew", "--format", form)
    rules = [word for each in motions for word in ("--rule", f':- use(U), motion(U,"{each}").')]
    text = cli(*words, *rules, "--network", tmp_path / "stew.txt", "--kitchen", tmp_path / "kitchen.txt")
    near = cli(*words, *rules, "--network", tmp_path / "stew.foon")
    assert near.code == text.code == bool(motions)
    if form == "text":
        assert near.out == text.out
        assert ("without the constraints there is one" in near.out) is bool(motions)
    else:
        ours, theirs = (json.loads(said.out) for said in (near, text))
        assert {**ours, "seconds": 0, "network": 0} == {**theirs, "seconds": 0, "network": 0}


@pytest.mark.parametrize(
    "words",
    [
        ("--objective", "kitchen"),
        ("--reduce", "none"),
        ("--rule", ":- not 1 <= #count { U : use(U) }."),
        ("--rule", ":- #count { O : available(O) } > 7."),
        ("--items", "used-up"),
        ("--cross-check",),
        ("--", "--opt-strategy=bb"),
    ],
)
def test_other_questions_read_all_that_the_goal_needs(
    words: tuple[str, ...], tmp_path: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch
) -> None:
    two_ways(tmp_path).close()
    monkeypatch.setattr(Dataset.nearby, "__defaults__", (None, 1))
    monkeypatch.setattr("foon_asp.questions.answer.answer_from_store", None)
    said = cli("solve", "--network", tmp_path / "stew.foon", "--goal", "stew", *words)
    assert said.code == 0, said.err
    assert "3 units" in said.out or "3 executions" in said.out


@SERIES
@pytest.mark.parametrize("rule", list(ContainerRule))
def test_random_problems_under_rules(rule: ContainerRule, part: int, tmp_path: Path) -> None:
    compared = mattered = 0
    for seed in range(45 // part):
        rng = random.Random(seed)
        problem = replace(random_problem(seed, rule, units=14, readable=True), unit_prices=None)
        drawn = random_rule(rng, problem)
        how = settings_of([drawn])
        if not hold_for_subtrees(how):
            continue
        dataset = stored(problem, tmp_path)
        near = near_of(dataset.nearby(problem.goals, rule.value, units_at_first=1))
        if near is None:
            continue
        objectives = rng.choice(LISTS)
        found = answer_from_store(near, objectives, how)
        whole = near.full_problem()
        expected, free = solve(whole, objectives, how), solve(whole, objectives)
        assert_same(found.outcome, expected, objectives, seed, drawn)
        compared += 1
        mattered += (free.status, free.costs) != (expected.status, expected.costs)
    assert compared > 15 // part
    assert mattered > compared // 10


def random_look(rng: random.Random, one: str) -> Settings:
    """Draw rules about a motion that look at the kitchen; each is asked of clingo, or not, in its own way."""
    texts = (
        f':- use(U), motion(U,"{one}"), needs(U,O), not kitchen(O).',
        f':- use(U), motion(U,"{one}"), needs(U,O), kitchen(O).',
        f':- use(U), motion(U,"{one}"), #sum {{ 1,O : needs(U,O), kitchen(O) }} > 1.',  # not flat
        f":- #count {{ O : use(U), needs(U,O), kitchen(O) }} > {rng.randrange(1, 4)}.",
        f":- #count {{ O : use(U), needs(U,O), not kitchen(O) }} > {rng.randrange(1, 4)}.",
        f":- #count {{ U : use(U), needs(U,O), kitchen(O) }} > {rng.randrange(1, 3)}.",
        f':- use(U), motion(U,"{one}"), gives(U,O), use(V), needs(V,O), needs(V,P), kitchen(P).',
    )
    before = f'earlier_motion="{rng.choice(MOTIONS)}"', f'later_motion="{one}"'
    if rng.random() < 0.6:
        return Settings((Path("before"),), constants=before)
    return Settings((RuleText(rng.choice(texts)),))


@pytest.mark.slow
@SERIES
def test_random_problems_under_rules_that_see_the_kitchen(part: int, tmp_path: Path) -> None:
    compared = mattered = little = 0
    for seed in range(45 // part):
        rng = random.Random(seed)
        rule = rng.choice(list(ContainerRule))
        problem = replace(random_problem(seed, rule, units=14, readable=True), unit_prices=None)
        made = sorted(set(reach(problem).makers) - problem.kitchen)
        goals = (rng.choice(made or problem.goals),)
        posed = stored(problem, tmp_path).nearby(goals, rule.value, units_at_first=1)
        objectives, whole = rng.choice(LISTS), replace(problem, goals=goals)
        free = solve(whole, objectives)
        motions = [problem.network.motions[unit] for unit in free.units or ()]
        how = random_look(rng, rng.choice(motions or MOTIONS))
        near = near_goals(posed, objectives, how)
        assert (near is not None) is isinstance(posed, NearbyProblem)
        if near is None:
            continue
        found = answer_from_store(near, objectives, how)
        expected = solve(whole, objectives, how)
        assert_same(found.outcome, expected, objectives, seed, how)
        compared += 1
        mattered += (free.status, free.costs) != (expected.status, expected.costs)
        little += len(found.problem.network) < len(near.full_problem().network)
    assert compared > 22 // part
    assert mattered > compared // 4
    assert little > compared // 4


ONE_AT_HAND = 'motion(U,"serve"), needs(U,O), kitchen(O)'


@pytest.mark.parametrize(
    ("rule", "constants", "best"),
    [
        (Path("before"), ("earlier_motion=boil", "later_motion=serve"), 3),
        (Path("before"), ("earlier_motion=serve", "later_motion=plate"), 12),
        (RuleText(f":- use(U), {ONE_AT_HAND}."), (), 3),
        (RuleText(':- use(U), motion(U,"serve"), #sum { 1,O : needs(U,O), kitchen(O) } > 0.'), (), 3),
        (RuleText(f":- #count {{ U : use(U), {ONE_AT_HAND} }} > 0."), (), 3),
        (RuleText(':- use(U), use(V), motion(U,"plate"), needs(U,O), kitchen(O), motion(V,"serve").'), (), 3),
        # on whole trees: asked about where the best one without them was read
        (RuleText(":- #count { U : use(U) } > 20."), (), 3),
        (RuleText(':- #count { U : use(U), motion(U,"boil") } > 0.'), (), 12),
    ],
)
def test_rules_see_the_kitchen_as_it_is(
    rule: Path | RuleText,
    constants: tuple[str, ...],
    best: int,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What units that were not read may make is no item of the kitchen, nor is it there too early."""
    dataset = two_ways(tmp_path)
    problem = dataset.nearby(dataset.command_goal_ids(["stew"]), "strict", units_at_first=1)
    monkeypatch.setattr(Nearby, "full_problem", None)
    found = answer_under_rules(problem, [Objective.UNITS], Settings((rule,), constants=constants))
    assert found.status is Status.OPTIMAL
    assert found.units is not None
    assert len(found.units) == best
    assert best == 12 or len(found.problem.network) < len(SHORT + LONG)
    assert found.problem.kitchen == found.problem.kitchen_seen


@pytest.mark.parametrize(
    ("text", "holds"),
    [
        (':- use(U), motion(U,"fry").', True),
        (":- #count { U : use(U) } > 3.", True),
        (':- not 1 <= #count { U : use(U), motion(U,"fry") }.', False),  # a part may lack it
        (':- use(U), needs(U,O), not kitchen(O), motion(U,"fry").', True),
        (":- #count { O : use(U), needs(U,O), kitchen(O) } > 7.", True),
        (":- #count { O : available(O) } > 7.", False),  # more is available than in the kitchen
        (':- use(U), needs(U,O), fresh(O). fresh(O) :- label(O,"ice"), available(O).', False),
        (":- use(U), motion(U,M), #count { V : motion(V,M) } < 2.", False),  # others are not there
    ],
)
def test_rules_that_hold_for_parts(text: str, holds: bool) -> None:
    assert hold_for_subtrees(Settings((RuleText(text),))) is holds


@SERIES
@pytest.mark.parametrize("rule", list(ContainerRule))
def test_a_certificate_of_a_store_is_one_of_the_text(rule: ContainerRule, part: int, tmp_path: Path) -> None:
    claims, little = set(), 0
    for seed in range(30 // part):
        problem = replace(random_problem(seed, rule, units=14, readable=True), unit_prices=None)
        dataset = stored(problem, tmp_path)
        rng = random.Random(seed)
        objectives = rng.choice((*LISTS, (Objective.KITCHEN,)))
        goals = (rng.randrange(len(problem.network.objects)),) if seed % 2 else problem.goals
        first = rng.choice((1, 1, 1000))
        found = solve_with_certificate(dataset.nearby(goals, rule.value, None, first), objectives, Settings())
        expected = solve(replace(problem, goals=goals), objectives)
        assert found.status is expected.status, seed
        assert found.certificate is not None, seed
        assert found.proof is Proof.CERTIFICATE
        whole = subject_of(problem)._replace(prices=dataset.unit_prices)
        there = verifier.verify(found.certificate.content, whole)
        here = foon_asp.verify(Foon(dataset, "a store"), found.certificate)
        computed = foon_asp.verify(Foon(dataset, "a store"), found.certificate, full=True)
        assert (here.claim, here.tree) == (there.claim, there.tree)
        assert structs.replace(computed, trusted=here.trusted) == here
        assert "the digests of kitchen, network and prices" in here.trusted[0]
        assert computed.trusted == ()
        if expected.costs is not None:
            order = levels(objectives)
            assert there.claim == "optimal"
            assert there.costs == tuple(expected.costs.measure(each) for each in order)
        claims.add(there.claim)
        little += len(found.problem.network) < len(problem.network)
    assert claims == {"optimal", "infeasible"}
    assert little > 20 // part


@SERIES
def test_the_optima_of_a_store_are_those_of_the_text(part: int, tmp_path: Path) -> None:
    near = 0
    for seed in range(12 // part):
        problem = replace(random_problem(seed, ContainerRule.STRICT, 14, readable=True), unit_prices=None)
        dataset = stored(problem, tmp_path)
        goals = tuple(random.Random(seed).sample(range(len(problem.network.objects)), 4))
        asked = dataset.nearby(goals, "strict", None, 1)
        found = foon_asp.solve_all_goals(asked, ["units", "kitchen"])
        expected = foon_asp.solve_all_goals(replace(problem, goals=goals), ["units", "kitchen"])
        assert [(each.status, each.problem.goal_nodes) for each in found.answers] == [
            (each.status, each.problem.goal_nodes) for each in expected.answers
        ]
        for one, other in zip(found.answers, expected.answers, strict=True):
            assert (one.costs is None) == (other.costs is None)
            if one.costs is not None and other.costs is not None:
                assert one.costs.key(levels(one.objectives)) == other.costs.key(levels(one.objectives))
        table, there = ([line.split()[:2] for line in each.text().splitlines()] for each in (found, expected))
        assert table == there
        assert [each["goals"] for each in (found.json(), expected.json())].count(found.json()["goals"]) == 2
        near += isinstance(asked, NearbyProblem)
    assert near > 6 // part


def test_a_problem_of_a_store_reads_no_more_than_is_looked_at(tmp_path: Path) -> None:
    dataset = two_ways(tmp_path)
    goals = dataset.command_goal_ids(["stew"])
    problem = dataset.nearby(goals, "strict", None, 1)
    assert isinstance(problem, NearbyProblem)
    assert repr(problem) == "<Problem: stew (strict containers)>"
    for _ in range(2):  # what the first read is no part of the second
        found = foon_asp.solve(problem)
        assert (found.status, len(found.problem.network) < len(SHORT + LONG)) == (Status.OPTIMAL, True)
    for drawn in (foon_asp.view(problem, beside=()), foon_asp.view(problem, units=[0])):
        assert "boiled" in drawn.dot()
    assert "network" not in vars(problem)
    varied = problem.vary(without="water")
    assert foon_asp.solve(varied).costs == solve(replace(problem, kitchen=varied.kitchen)).costs
    assert len(problem.network) == len(SHORT + LONG)
    assert problem.nearby() is None
    assert problem == dataset.problem(goals, "strict")
