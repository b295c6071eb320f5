"""Bare clingo as a second engine: what is right, what is wrong, and what it leaves open."""

import math
import random
import shlex
import subprocess
import sys
import time
from fractions import Fraction
from itertools import combinations_with_replacement
from pathlib import Path

import pytest

from foon_asp.asp import Outcome, Settings, Status, solve
from foon_asp.asp.bare_program import bare_program
from foon_asp.asp.soft import SoftOutcome, solve_soft
from foon_asp.deadline import Deadline
from foon_asp.encoding.rate_scale import rate_scale
from foon_asp.engines import (
    Check,
    ClaimedAnswer,
    DisagreementError,
    Engine,
    NotCheckedError,
    bare_clingo,
    cross_check,
)
from foon_asp.engines.bare_clingo import check_with_bare_clingo, tree_weight_bound
from foon_asp.problem import Objective, Problem
from foon_asp.rules.passed_constraint import Constraint
from tests.conftest import ROOT, Cli
from tests.encoding.test_rate_scale import two_ways
from tests.support.gap_problem import gap_problem
from tests.support.reported import reported, words_to_ask_again
from tests.support.wrong_costs import with_measures

PATIENCE = 60.0


def agrees(outcome: Outcome, settings: Settings | None = None) -> None:
    check_with_bare_clingo(ClaimedAnswer(outcome, settings or Settings()), PATIENCE)


def with_tree(outcome: Outcome, units: tuple[int, ...]) -> Outcome:
    """Claim that another tree is the best one."""
    return outcome._replace(status=Status.OPTIMAL, units=units, costs=outcome.problem.costs(units))


def without_tree(outcome: Outcome) -> Outcome:
    """Claim that there is no tree."""
    return outcome._replace(status=Status.INFEASIBLE, units=None, costs=None)


# --- The bound on rounded weights.


def test_no_tree_as_good_as_ours_weighs_more_than_the_bound() -> None:
    """Whatever the weights are, and however they were rounded: right, coarsely, by chance, or to 0."""
    rng = random.Random(1)
    tight = 0
    for _ in range(150):
        rates = [Fraction(rng.randint(1, 99), 100) for _ in range(3)] + [
            1 - Fraction(1, 10 ** rng.randint(3, 60))
        ]
        scale = 10 ** rng.randint(0, 8)
        weights = rng.choice(
            [
                rate_scale(rates).weights,
                {rate: math.floor(-math.log(rate) * scale) for rate in rates},
                {rate: rng.randint(0, 50) for rate in rates},
            ]
        )
        own = rng.choices(rates, k=rng.randint(0, 4))
        most = tree_weight_bound([(rate, weights[rate]) for rate in rates], own)
        for size in range(5):
            for other in combinations_with_replacement(rates, size):
                if math.prod(other) >= math.prod(own):
                    weight = sum(weights[rate] for rate in other)
                    assert weight <= most
                    tight += weight == most
    assert tight > 100


def test_the_bound_is_no_wider_than_rounding_down_makes_it() -> None:
    rates = [Fraction(text) for text in ("0.3", "0.9", "0.85", "0.999999999999")]
    weights = rate_scale(rates).weights
    for size in range(5):
        for own in combinations_with_replacement(rates, size):
            slack = tree_weight_bound(weights.items(), own) - sum(map(weights.__getitem__, own))
            assert 0 <= slack <= max(0, size - 1)


def test_a_rate_without_a_logarithm_or_with_a_wrong_weight_is_not_checked() -> None:
    for rate, words in ((0, "no logarithm"), (1, "costs nothing has a weight")):
        with pytest.raises(NotCheckedError, match=words):
            tree_weight_bound([(Fraction(rate), 5)], [])
    for sure in (Fraction(1), 1 - Fraction(1, 10**5000)):
        assert tree_weight_bound([(sure, 0)], [sure]) == 0


# --- It agrees with what is right.


@pytest.mark.parametrize(
    ("better", "worse"),
    [
        (["0.5"] * 9, ["0.001953124999999999999"]),
        (["1"], ["0." + "9" * 20]),
        (["0." + "9" * 400], ["0." + "9" * 399 + "8"]),
    ],
)
def test_products_that_differ_late_are_told_apart(better: list[str], worse: list[str]) -> None:
    problem = two_ways(better, worse)
    outcome = solve(problem, (Objective.SUCCESS,))
    agrees(outcome)
    other = tuple(unit for unit in range(len(problem.network)) if unit not in (outcome.units or ()))
    with pytest.raises(DisagreementError, match=r"by success our tree has .* ours is not the best"):
        agrees(with_tree(outcome, other))


def test_what_comes_after_an_equal_product_is_checked() -> None:
    problem = two_ways(["0.09"], ["0.3", "0.3"])
    outcome = solve(problem, (Objective.SUCCESS,))
    agrees(outcome)
    with pytest.raises(
        DisagreementError, match="by units our tree has 2, the one of clingo 1; ours is not the best"
    ):
        agrees(with_tree(outcome, (1, 2)))


def test_costs_of_more_than_32_bits_are_read_whole() -> None:
    problem = two_ways(["0." + "0" * 8 + "1"] * 30, ["0." + "0" * 8 + "1"] * 31)
    outcome = solve(problem, (Objective.SUCCESS,))
    weight = rate_scale(set((problem.rates or {}).values())).weights[Fraction(1, 10**9)]
    assert 30 * weight > 2**32
    agrees(outcome)


def test_replaced_encodings_that_measure_something_else(tmp_path: Path) -> None:
    """Then the costs are what the encodings say."""
    folder = tmp_path / "mine"
    folder.mkdir()
    (folder / "objectives.lp").write_text("#minimize { 5@1,U : use(U) }.\n")
    settings = Settings(encodings=folder)
    outcome = solve(gap_problem(1, 4), (Objective.UNITS,), settings)
    agrees(outcome, settings)
    with pytest.raises(DisagreementError, match="as the encodings have it our tree costs"):
        agrees(with_tree(outcome, tuple(range(len(outcome.problem.network)))), settings)
    with pytest.raises(NotCheckedError, match="do not measure success"):
        agrees(solve(gap_problem(1, 4), (Objective.SUCCESS,), settings), settings)


# --- It finds what is wrong.


@pytest.mark.parametrize("objective", [Objective.UNITS, Objective.SUCCESS, Objective.KITCHEN])
def test_wrong_answers_are_found(objective: Objective, tmp_path: Path) -> None:
    mine = tmp_path / "mine.lp"
    mine.write_text(':- use(U), motion(U,"clear").\n')
    settings = Settings((mine,))
    problem = gap_problem(2, 4)
    outcome = solve(problem, (objective,), settings)
    agrees(outcome, settings)
    allowed = [unit for unit, motion in enumerate(problem.network.motions) if motion != "clear"]
    for units in (
        tuple(allowed),
        tuple(range(len(problem.network))),
    ):  # more than is needed, and forbidden ones
        with pytest.raises(DisagreementError):
            agrees(with_tree(outcome, units), settings)
    with pytest.raises(DisagreementError, match="we say no tree exists"):
        agrees(without_tree(outcome), settings)


@pytest.mark.slow
def test_wrong_answers_under_soft_rules_are_found(tmp_path: Path) -> None:
    mine = tmp_path / "mine.lp"
    mine.write_text(':- use(U), motion(U,"draw").\n:- use(U), motion(U,"clear").\n')
    problem = gap_problem(2, 4)
    weights: dict[Constraint, int] = {mine: 3}
    found = solve_soft(problem, (Objective.UNITS,), Settings(), weights)
    check_with_bare_clingo(ClaimedAnswer(found.outcome, Settings(), weights, found.penalty), PATIENCE)
    assert found.penalty
    everything = with_tree(found.outcome, tuple(range(len(problem.network))))
    ways = sum(motion in {"draw", "clear"} for motion in problem.network.motions)
    for outcome, penalty, message in (
        (found.outcome, found.penalty - 3, "we say our tree has the penalty"),
        (everything, found.penalty, "we say our tree has the penalty"),
        (everything, 3 * ways, r"by penalty our tree has .* ours is not the best"),
        (without_tree(found.outcome), None, "we say no tree exists"),
    ):
        with pytest.raises(DisagreementError, match=message):
            check_with_bare_clingo(ClaimedAnswer(outcome, Settings(), weights, penalty), PATIENCE)


def test_wrong_costs_and_trees_that_do_not_execute_are_found() -> None:
    outcome = solve(gap_problem(2, 4), (Objective.UNITS,))
    assert outcome.units is not None
    assert outcome.costs is not None
    with pytest.raises(DisagreementError, match="the costs of our tree are not those of its units"):
        agrees(outcome._replace(costs=with_measures(outcome.costs, kitchen=9)))
    with pytest.raises(DisagreementError, match="the tree of foon-asp does not execute"):
        agrees(with_tree(outcome, outcome.units[1:]))


def test_wrong_facts_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """What clingo adds up is held against the units: facts that say something else are no second opinion."""
    outcome = solve(gap_problem(2, 4), (Objective.INPUTS,))
    right = bare_program

    def wrong(*args: object) -> object:
        program = right(*args)  # type: ignore[arg-type]
        return program._replace(facts=program.facts.replace("inputs(0,", "inputs(0,1"))

    monkeypatch.setattr(bare_clingo, "bare_program", wrong)
    with pytest.raises(DisagreementError, match="clingo adds up the costs"):
        agrees(with_tree(outcome, tuple(range(len(outcome.problem.network)))))


# --- It says what it left open.


def test_too_many_trees_within_the_bound_are_not_checked(monkeypatch: pytest.MonkeyPatch) -> None:
    outcome = solve(gap_problem(2, 4), (Objective.SUCCESS,))
    agrees(outcome)
    monkeypatch.setattr(bare_clingo, "MAX_KINDS", 0)
    (check, *_) = cross_check(ClaimedAnswer(outcome), PATIENCE, ())
    assert check == Check("clingo", (), check.reason, check.seconds)
    assert check.reason
    assert "more than 0 kinds of trees are too close" in check.reason


def said_by(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError:  # the process has ended
        return b""


ENDLESS = "p(1..2000).  q(X,Y,Z) :- p(X), p(Y), p(Z).  :- q(1,1,1), not use(0), not use(1).\n"


def test_endless_grounding_is_ended(tmp_path: Path) -> None:
    mine = tmp_path / "mine.lp"
    mine.write_text(ENDLESS)
    outcome = solve(gap_problem(2, 4), (Objective.UNITS,))
    began = time.monotonic()
    (check,) = cross_check(ClaimedAnswer(outcome, Settings((mine,))), 0.5, ())
    assert time.monotonic() - began < 10
    assert check.reason == "clingo did not finish within 0.5 s"
    assert not [file for file in Path("/proc").glob("[0-9]*/cmdline") if str(mine).encode() in said_by(file)]


@pytest.mark.slow
def test_memory_that_runs_out_is_not_checked(tmp_path: Path) -> None:
    if not hasattr(__import__("resource"), "prlimit"):
        pytest.skip("only Linux limits the memory of another process")
    mine = tmp_path / "mine.lp"
    mine.write_text(ENDLESS)
    # less memory than these tests have by then, which is no matter
    settings = Settings((mine,), deadline=Deadline(memory=2**27))
    outcome = solve(gap_problem(2, 4), (Objective.UNITS,))
    (check,) = cross_check(ClaimedAnswer(outcome, settings), PATIENCE, ())
    assert check.reason is not None
    assert "memory" in check.reason


def test_rules_that_clingo_refuses_are_not_checked(tmp_path: Path) -> None:
    mine = tmp_path / "mine.lp"
    mine.write_text(":- use(U), X < 3.\n")
    (check,) = cross_check(ClaimedAnswer(solve(gap_problem(2, 4)), Settings((mine,))), PATIENCE, ())
    assert check.reason is not None
    assert f"{mine}:1:1-18: error: unsafe variables in" in check.reason


def test_what_is_not_proved_is_not_checked() -> None:
    outcome = solve(gap_problem(2, 4))._replace(status=Status.FEASIBLE)
    assert {check.reason for check in cross_check(ClaimedAnswer(outcome), PATIENCE)} == {
        "nothing is proved, so there is nothing to check"
    }


def test_from_an_interruption_on_nothing_is_checked(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(asked: ClaimedAnswer, seconds: float) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(bare_clingo, "check_with_bare_clingo", interrupted)
    checks = cross_check(ClaimedAnswer(solve(gap_problem(2, 4))), PATIENCE)
    assert {check.reason for check in checks} == {"interrupted"}


def test_nothing_of_the_working_folder_is_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("clingo.py", "json.py", "cffi.py"):
        (tmp_path / name).write_text("raise SystemExit('run')\n")
    monkeypatch.chdir(tmp_path)
    agrees(solve(gap_problem(2, 4)))


# --- On the command line.


@pytest.mark.slow
def test_a_worse_tree_is_our_bug_with_all_that_is_needed(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def worse(problem: Problem, *args: object) -> Outcome:
        outcome = solve(problem, *args)  # type: ignore[arg-type]
        files = Path("at_least.lp"), Path("mine.lp")
        more = solve(problem, (Objective.UNITS,), Settings(files, constants=("name=freezer bag",)))
        assert more.units is not None
        return with_tree(outcome, more.units)

    monkeypatch.chdir(tmp_path)
    Path("at_least.lp").write_text(":- #count { U : use(U) } < 4.\n")
    Path("part.lp").write_text("touched(L) :- use(U), input(U,O), label(O,L).\n")
    Path("mine.lp").write_text('#include "part.lp".\n#const name = "".\n:- touched(name).\n')
    monkeypatch.setattr("foon_asp.questions.answer.solve", worse)
    words = (
        "--goal",
        "ice",
        "--constraint",
        "mine.lp",
        "-c",
        "name=freezer bag",
        "--objective",
        "success,units",
    )
    ran = cli("solve", *words, "--cross-check", "--format", "json")
    assert (ran.code, ran.out) == (70, "")
    assert "ours is not the best" in ran.err
    monkeypatch.undo()
    report = reported(tmp_path)
    assert "clingo" in report["answers"]
    (tmp_path / "part.lp").unlink()
    bare, program = report["bare_clingo"], tmp_path / "program.lp"
    program.write_text(bare["program"])
    command = [sys.executable, "-m", "clingo", str(program), *bare["arguments"]]
    said = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    assert "OPTIMUM FOUND" in said
    again = cli(*words_to_ask_again(report, tmp_path / "again"), "--format", "json")
    assert again.json["cross_check"][0]["checked"]
    assert int(said.split("Optimization : ")[1].split()[1]) == again.json["costs"]["units"]


@pytest.mark.slow
def test_a_tree_that_is_denied_is_our_bug(cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def denied(*args: object) -> SoftOutcome:
        return SoftOutcome(without_tree(solve_soft(*args).outcome), None, ())  # type: ignore[arg-type]

    monkeypatch.setattr("foon_asp.questions.solve_soft.solve_soft", denied)
    monkeypatch.chdir(tmp_path)
    words = ("--goal", "ice", "--soft", "forbid_motion=3", "-c", "forbidden_motion=crush", "--cross-check")
    ran = cli("solve", *words)
    assert ran.code == 70
    assert "we say no tree exists, clingo says a tree exists" in ran.err
    monkeypatch.undo()
    again = cli(*words_to_ask_again(reported(tmp_path), tmp_path / "again"))
    assert "cross-check: clingo agrees by penalty, units (" in again.out


def test_what_is_found_is_said_where_no_file_can_be_written(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def wrong(asked: ClaimedAnswer, engines: tuple[Engine, ...]) -> list[Check]:
        check_with_bare_clingo(asked._replace(outcome=without_tree(asked.outcome)), PATIENCE)
        return []

    monkeypatch.setattr("foon_asp.questions.cross_check.ask_engines", wrong)
    monkeypatch.setattr("foon_asp.questions.disagreement.disagreement_name", lambda outcome: "file/report")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").write_text("")
    ran = cli("solve", "--goal", "ice", "--cross-check")
    assert ran.code == 70
    assert "we say no tree exists, clingo says a tree exists; the report could not be written" in ran.err


# --- Soft constraints in bare clingo.


def test_facts_of_soft_files_give_the_same_optimum_in_bare_clingo(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The command of the help and of docs/questions.md."""
    monkeypatch.chdir(ROOT)
    anna, ben, facts = (tmp_path / name for name in ("anna.lp", "ben.lp", "facts.lp"))
    anna.write_text(':- use(U), motion(U,"whip").\n:- use(U), motion(U,"beat").\n')
    ben.write_text(':- use(U), motion(U,"dispense").\n:- #count { U : use(U) } < 6.\n')
    soft = "--soft", f"{anna}=1", "--soft", f"{ben}=3"
    words = "--goal", "whipped cream", *soft, "--objective", "inputs,units"
    facts.write_text(cli("facts", *words).out)
    solved = cli("solve", *words, "--format", "json").json
    clingo = f"{shlex.quote(sys.executable)} -m clingo encodings/*.lp encodings/questions/soft.lp {facts}"
    said = subprocess.run(clingo, shell=True, capture_output=True, text=True, check=False).stdout
    assert "OPTIMUM FOUND" in said
    costs = said.split("Optimization : ")[1].split("\n")[0].split()
    assert list(map(int, costs)) == [solved["penalty"], solved["costs"]["inputs"], solved["costs"]["units"]]
    assert solved["penalty"]


def test_a_helper_that_is_free_to_break_more_is_no_penalty(tmp_path: Path) -> None:
    """What a tree pays is the least that its helpers can make of it."""
    mine = tmp_path / "mine.lp"
    mine.write_text("{ extra(1..5) }.\n:- extra(X).\n:- use(U), not extra(1).\n")
    found = solve_soft(gap_problem(2, 4), (Objective.UNITS,), Settings(), {mine: 2})
    assert found.penalty == 2
    check_with_bare_clingo(ClaimedAnswer(found.outcome, Settings(), {mine: 2}, found.penalty), PATIENCE)
