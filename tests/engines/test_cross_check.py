"""Second engines: one question, one answer; and what is said where they differ."""

import random
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import pytest

from foon_asp.asp import Outcome, Settings, Status, solve
from foon_asp.engines import (
    ENGINES,
    Check,
    ClaimedAnswer,
    DisagreementError,
    Engine,
    EngineAnswer,
    NotCheckedError,
    agreed_objectives,
    cross_check,
    fast_downward,
)
from foon_asp.engines.fast_downward import is_installed, solve_with_fast_downward
from foon_asp.engines.highs import solve_with_highs
from foon_asp.network import FunctionalUnit
from foon_asp.problem import ContainerRule, Costs, Objective, Problem, levels
from foon_asp.proof.certificate_subject import Subject
from foon_asp.text.data_folder import find_data, read_data
from tests.conftest import Cli
from tests.encoding.test_rate_scale import two_ways
from tests.oracle import task_trees
from tests.support.gap_problem import gap_problem
from tests.support.hard_problem import hard_problem
from tests.support.random_problems import random_objectives, random_problem
from tests.support.reported import reported, words_to_ask_again

RULES = list(ContainerRule)
Solve = Callable[[Problem, tuple[Objective, ...], frozenset[int], float], EngineAnswer]

needs_fast_downward = pytest.mark.skipif(
    not is_installed(), reason="Fast Downward is not installed: pip install 'foon-asp[cross-check]'"
)
SOLVERS = [
    pytest.param(solve_with_highs, id="HiGHS"),
    pytest.param(solve_with_fast_downward, id="Fast Downward", marks=[needs_fast_downward, pytest.mark.slow]),
]


def units(problem: Problem, answer: EngineAnswer) -> tuple[FunctionalUnit, ...]:
    assert answer.units is not None
    return tuple(map(problem.network.unit, answer.units))


@pytest.mark.parametrize("engine", SOLVERS)
@pytest.mark.parametrize("rule", RULES)
def test_every_engine_agrees_with_brute_force(engine: Solve, rule: ContainerRule) -> None:
    trees = 0
    for seed in range(12):
        problem = random_problem(seed, rule)
        found = list(task_trees.trees(problem))
        for objective in Objective:
            try:
                answer = engine(problem, levels((objective,)), frozenset(), 60.0)
            except NotCheckedError:  # and only then
                assert max(problem.figure(objective, unit) for unit in range(len(problem.network))) > 10**9
                continue
            assert answer.finished
            judged = [str(looked_at) for looked_at in answer.objectives]
            keys = [tuple(task_trees.measure(problem, tree, o) for o in judged) for tree in found]
            if not keys:
                assert answer.units is None
                continue
            tree = units(problem, answer)
            assert task_trees.makes(problem, tree)
            mine = tuple(task_trees.measure(problem, tree, o) for o in judged)
            if not objective.row.whole:  # in floats: rates that differ in the ninth digit are one
                assert float(mine[0]) == pytest.approx(float(min(keys)[0]), rel=1e-4, abs=1e-6)
            else:
                assert mine == min(keys)
            trees += bool(tree)
    assert trees > 10


def test_lists_are_checked_level_by_level() -> None:
    for seed in range(12):
        problem = random_problem(seed, RULES[seed % 2])
        objectives = random_objectives(random.Random(seed), 3)
        outcome = solve(problem, objectives)
        wanted = levels(objectives) if outcome.units is not None else ()
        clingo, highs = cross_check(ClaimedAnswer(outcome), 60.0, ENGINES[:1])
        assert (clingo.objectives, clingo.reason) == (wanted, None)
        if highs.objectives != wanted:  # floats may be unable to tell
            assert not wanted[len(highs.objectives)].row.whole


def test_forbidden_units_are_left_out() -> None:
    problem = gap_problem(1, 4)
    settings = Settings((Path("forbid_motion"),), constants=("forbidden_motion=scrub",))
    forbidden = frozenset(u for u, motion in enumerate(problem.network.motions) if motion == "scrub")
    outcome = solve(problem, (Objective.SUCCESS,), settings)
    for check in cross_check(ClaimedAnswer(outcome, settings), 60.0):
        assert check.reason is None or "not installed" in check.reason
    answer = solve_with_highs(problem, levels((Objective.SUCCESS,)), forbidden, 60.0)
    assert answer.units
    assert not forbidden & {*answer.units}


def test_an_engine_that_finds_nothing_in_time_says_so() -> None:
    answer = solve_with_highs(hard_problem(), (Objective.UNITS,), frozenset(), 0.05)
    assert not answer.finished
    with pytest.raises(NotCheckedError, match="no answer in time"):
        agreed_objectives(solve(gap_problem(0, 3)), answer)


# --- disagreements


def optimum() -> Outcome:
    return solve(gap_problem(2, 4), (Objective.UNITS,))


def answer(outcome: Outcome, units: tuple[int, ...] | None) -> EngineAnswer:
    return EngineAnswer("Oracle", levels(outcome.objectives), units, True)


def test_disagreements_are_found() -> None:
    outcome = optimum()
    assert outcome.units is not None
    assert agreed_objectives(outcome, answer(outcome, outcome.units)) == (Objective.UNITS,)
    with pytest.raises(DisagreementError, match="we say a tree exists, Oracle says no tree exists"):
        agreed_objectives(outcome, answer(outcome, None))
    none = outcome._replace(status=Status.INFEASIBLE, units=None, costs=None)
    with pytest.raises(DisagreementError, match="we say no tree exists, Oracle says a tree exists"):
        agreed_objectives(none, answer(outcome, outcome.units))
    with pytest.raises(DisagreementError, match="does not execute"):
        agreed_objectives(outcome, answer(outcome, outcome.units[1:]))
    everything = tuple(range(len(outcome.problem.network)))
    with pytest.raises(DisagreementError, match="Oracle calls a worse one the best"):
        agreed_objectives(outcome, answer(outcome, everything))
    costs = outcome.problem.costs(everything)
    with pytest.raises(DisagreementError, match="ours is not the best"):
        agreed_objectives(outcome._replace(units=everything, costs=costs), answer(outcome, outcome.units))


@pytest.mark.parametrize(("objective", "power"), [(Objective.SUCCESS, 1), (Objective.ATTEMPTS, -1)])
def test_fractions_are_compared_as_far_as_engines_can_tell(objective: Objective, power: int) -> None:
    outcome = solve(gap_problem(2, 4), (objective,))
    assert outcome.units is not None
    assert outcome.costs is not None
    theirs, measures = answer(outcome, outcome.units), outcome.costs.measures
    assert agreed_objectives(outcome, theirs) == (objective, Objective.UNITS)
    error: type[Exception]
    for factor, error, words in (
        ("1.00001", NotCheckedError, "floats"),
        ("1.001", DisagreementError, "Oracle calls a worse one the best"),
        ("0.9999999", DisagreementError, "ours is not the best"),
    ):
        better = outcome.costs.measure(objective) * Fraction(factor) ** power
        with pytest.raises(error, match=words):
            agreed_objectives(outcome._replace(costs=Costs({**measures, objective: better})), theirs)


@pytest.mark.slow
def test_the_command_line_says_who_agrees(cli: Cli) -> None:
    ran = cli("solve", "--goal", "macaroni", "--objective", "success", "--cross-check")
    assert ran.code == 0
    assert "cross-check: HiGHS agrees by success, units (" in ran.out
    assert "cross-check: clingo agrees by success, units (" in ran.out
    if is_installed():
        assert "cross-check: Fast Downward agrees by success (" in ran.out
    none = cli("solve", "--goal", "apple pie", "--cross-check", "--format", "json")
    assert none.code == 1
    assert "cross-check: clingo agrees that no tree exists (" in none.err
    narrower = ("--constraint", "at_most_units", "-c", "max_units=9")
    ran = cli("solve", "--goal", "ice", "--cross-check", *narrower, "--format", "json")
    unknown = "it knows no rules such as at_most_units"
    assert [(row["checked"], row["agrees_by"], row["reason"]) for row in ran.json["cross_check"]] == [
        (True, ["units"], None),
        (False, [], unknown),
        (False, [], unknown),
    ]


def test_an_engine_that_is_not_installed_is_named(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("foon_asp.engines.fast_downward.driver_script", lambda: None)
    ran = cli("solve", "--goal", "ice", "--cross-check")
    assert ran.code == 0
    assert ran.out.endswith(
        "cross-check: Fast Downward: not checked: it is not installed (pip install 'foon-asp[cross-check]')\n"
    )
    assert "HiGHS agrees" in ran.out


def test_a_disagreement_is_our_bug_with_all_that_is_needed(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def with_liar(asked: ClaimedAnswer, engines: tuple[Engine, ...]) -> list[Check]:
        none = EngineAnswer("Liar", asked.outcome.objectives, None, True)
        return cross_check(asked, 60.0, (Engine("Liar", lambda: True, lambda *_: none),))

    monkeypatch.setattr("foon_asp.questions.cross_check.ask_engines", with_liar)
    monkeypatch.chdir(tmp_path)
    words = ("--goal", "ice", "--constraint", "forbid_motion", "-c", "forbidden_motion=crush")
    ran = cli("solve", *words, "--cross-check")
    assert ran.code == 70
    assert "we say a tree exists, Liar says no tree exists" in ran.err
    report = reported(tmp_path)
    assert "foon-asp-disagreement-" in ran.err
    assert report["answers"]["Liar"] == {"objectives": ["units"], "units": None, "costs": None}
    assert report["answers"]["foon-asp"]["costs"]["units"] == 3
    assert set(report["versions"]) == {"foon-asp", "clingo", "highspy"}
    monkeypatch.undo()
    again = cli(*words_to_ask_again(report, tmp_path / "again"))
    assert again.code == 0
    assert "3 units" in again.out
    data = read_data(find_data(tmp_path / "again"))
    assert Subject(data.network, data.kitchen, data.rates, data.utensils).digests() == report["digests"]


def test_what_no_whole_number_of_an_engine_or_float_holds_is_not_asked_of_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    seldom, asked = Fraction(1, 10**9), ((Objective.ATTEMPTS,), frozenset[int](), 60.0)
    monkeypatch.setattr(fast_downward, "driver_script", lambda: Path("never-run"))
    with pytest.raises(NotCheckedError, match="more than its whole numbers hold"):
        solve_with_fast_downward(two_ways([str(seldom), "0.5"], ["0.2"]), *asked)
    assert solve_with_highs(two_ways([str(seldom), "0.5"], ["0.2"]), *asked).units == (2,)
    with pytest.raises(NotCheckedError, match="a unit costs more than its floats hold beside others"):
        solve_with_highs(two_ways([str(seldom / 10), "0.5"], ["0.2"]), *asked)
