"""A limit gives the best tree so far with its bound, and never a wrong claim."""

import itertools
import json
import os
import pty
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.asp import Outcome, Reporter, Settings, Status, optimum, solve
from foon_asp.cli.main import cli as commands
from foon_asp.cli.main import main
from foon_asp.cli.shared_options import start_deadline
from foon_asp.deadline import Deadline, LimitError, resend_lost_interrupts, uninterrupted
from foon_asp.encoding import program_client
from foon_asp.problem import Costs, Objective, Problem
from foon_asp.processes import worker
from foon_asp.proof.simulation import Verdict, simulate_for
from foon_asp.questions.caller import Caller, asked_by, caller
from foon_asp.questions.python_arguments import chosen_objectives
from foon_asp.rules.passed_constraint import RuleText
from foon_asp.text.writer import write_units
from tests.support.hard_problem import hard_problem


class Recorder(Reporter):
    def __init__(self) -> None:
        self.trees: list[Costs] = []
        self.bounds: list[int | Fraction] = []

    def tree(self, costs: Costs) -> None:
        self.trees.append(costs)

    def bound(self, objective: Objective, bound: int | Fraction) -> None:
        self.bounds.append(bound)


@pytest.mark.parametrize("objective", [Objective.UNITS, Objective.SUCCESS])
@pytest.mark.parametrize("seconds", [0, 1])
@pytest.mark.default_cases("0-units", "0-success")
def test_time_limit(objective: Objective, seconds: float) -> None:
    problem, recorder = hard_problem(), Recorder()
    began = time.monotonic()
    outcome = solve(problem, (objective,), Settings(deadline=Deadline(seconds)), recorder)
    assert time.monotonic() - began < seconds + 3
    assert outcome.status is Status.FEASIBLE
    assert outcome.units is not None
    assert outcome.costs == recorder.trees[-1]
    simulation = simulate_for(problem, problem.tree(outcome.units))
    assert simulation.verdict is Verdict.AS_LISTED
    keys = [costs.key((objective, Objective.UNITS)) for costs in recorder.trees]
    assert keys == sorted(keys, reverse=True)
    bound, value = outcome.bounds[objective], outcome.costs.measure(objective)
    assert bound >= value if objective is Objective.SUCCESS else bound <= value


def test_a_limit_before_any_tree_is_unknown() -> None:
    settings = Settings(
        constraints=(Path("at_most_units"),), constants=("max_units=100",), deadline=Deadline(0)
    )
    outcome = solve(hard_problem(), (Objective.UNITS,), settings)
    assert outcome.status is Status.UNKNOWN
    assert outcome.units is None


@pytest.fixture(scope="module")
def hard_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write the hard problem as a data folder."""
    folder = tmp_path_factory.mktemp("hard")
    problem = hard_problem()
    network = problem.network
    (folder / "FOON.txt").write_text(write_units(map(network.unit, range(len(network)))))
    assert problem.rates is not None
    rates = "".join(f"{motion}\t{float(rate):.3f}\n" for motion, rate in problem.rates.items())
    (folder / "motion.txt").write_text(rates)
    kitchen = [{"label": network.objects[o].label} for o in sorted(problem.kitchen)]
    (folder / "kitchen.json").write_text(json.dumps(kitchen))
    return folder


def command(folder: Path, *more: str) -> list[str]:
    goal = ["--goal", "part 11 0", "--data", str(folder)]
    return [sys.executable, "-m", "foon_asp", "solve", *goal, *more]


def read_terminal(terminal: int, until: bytes) -> bytes:
    """Read what a program writes on a terminal, until these words are on it or the program ends."""
    seen = b""
    while until not in seen:
        try:
            chunk = os.read(terminal, 4096)
        except OSError:  # the terminal is closed when the program ends
            break
        if not chunk:
            break
        seen += chunk
    return seen


def test_ctrl_c_gives_the_best_tree_and_exits_with_3(hard_folder: Path, tmp_path: Path) -> None:
    terminal, its_end = pty.openpty()
    wide = {**os.environ, "COLUMNS": "200"}  # so that no words are on two lines
    answer = tmp_path / "answer.json"  # a pipe that nobody reads meanwhile would be full
    arguments = command(hard_folder, "--format", "json")
    with (
        answer.open("wb") as output,
        subprocess.Popen(arguments, stdout=output, stderr=its_end, env=wide) as process,
    ):
        os.close(its_end)
        seen = read_terminal(terminal, b"units at least")
        assert b"best tree" in seen
        process.send_signal(signal.SIGINT)
        errors = read_terminal(terminal, b"there are no such words")
    os.close(terminal)
    assert process.returncode == 3, errors
    result = json.loads(answer.read_bytes())
    assert result["status"] == "feasible"
    assert 0 < result["lower_bound"]["units"] <= result["costs"]["units"] == len(result["units"])


@pytest.mark.slow
def test_progress_is_shown_on_a_terminal_only(hard_folder: Path) -> None:
    piped = subprocess.run(command(hard_folder, "--time-limit", "2"), capture_output=True, check=False)
    assert piped.returncode == 3
    assert b"best tree" not in piped.stderr


ENDLESS = "p(0). p(f(X)) :- p(X). :- use(U), p(U), not p(f(U)).\n"


@pytest.mark.slow
def test_grounding_without_an_end_is_stopped(tmp_path: Path) -> None:
    rules = tmp_path / "endless.lp"
    rules.write_text(ENDLESS)
    began = time.monotonic()
    outcome = solve(hard_problem(3, 3, 2, 2), settings=Settings(constraints=(rules,), deadline=Deadline(1)))
    assert time.monotonic() - began < 2.5
    assert outcome.status is Status.UNKNOWN


def test_rules_are_found_in_the_folder_of_the_moment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The process that grounds was begun in one folder and is asked again in another."""
    for name, rule in (("one", ""), ("other", ":- not use(U) : unit(U)."), ("third", ":-.")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "mine.lp").write_text(rule)
    statuses: list[Status] = []
    for name in ("one", "other", "third", "one"):
        monkeypatch.chdir(tmp_path / name)
        statuses.append(solve(hard_problem(3, 3, 2, 2), settings=Settings((Path("mine.lp"),))).status)
    assert statuses == [Status.OPTIMAL, Status.OPTIMAL, Status.INFEASIBLE, Status.OPTIMAL]


def test_prices_of_a_large_network_are_not_looked_up_beyond_the_limit() -> None:
    problem = hard_problem(4, 2, 1, 2)
    with asked_by(Caller(Reporter(), deadline=Deadline(-1.0))), pytest.raises(LimitError):
        chosen_objectives(problem, "units")


def test_limits_count_from_the_beginning_of_a_process_that_is_there_for_one_command() -> None:
    long_ago = time.monotonic() - 100
    for obj, passed in ((long_ago, True), (None, False), ("a session", False)):
        with commands.make_context("foon-asp", ["stats"], obj=obj):
            assert start_deadline(50, None).passed is passed


def test_a_process_ends_as_usual_though_at_once() -> None:
    code = (
        "import atexit; from foon_asp.cli.whole_process import exit_process; atexit.register(print, 'last')"
    )
    ran = subprocess.run(
        [sys.executable, "-c", f"{code}; print('first', end=' '); exit_process(3)"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (ran.returncode, ran.stdout, ran.stderr) == (3, "first last\n", "")


APART = RuleText(':- use(U), use(V), motion(U,"move 4"), motion(V,("move 0";"move 2")).')
RARE = RuleText(':- use(U), motion(U,"move 3"), not use(V) : motion(V,"move 7").')


@pytest.mark.parametrize("objective", [Objective.UNITS, Objective.SUCCESS])
@pytest.mark.parametrize(
    ("items", "settings"),
    [
        ("lasting", Settings()),
        ("lasting", Settings(reductions=frozenset())),
        ("lasting", Settings((RARE,))),
        ("lasting", Settings((APART,))),
        ("lasting", Settings((Path("at_most_units"),), constants=("max_units=9",))),
        ("used-up", Settings()),
    ],
    ids=["cuts", "search", "rule", "rest", "ready-made", "used up"],
)
def test_ctrl_c_anywhere_leaves_what_is_known(
    items: str, settings: Settings, objective: Objective, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where nobody looks at the clock somebody else does, and a stop there is one like any other."""
    problem = foon_asp.load().problem("tea", items=items) if items == "used-up" else hard_problem(3, 3, 2, 2)
    best = optimum.solve(problem, (objective,), settings).costs
    assert best is not None
    watched = Deadline.watched
    for moment in itertools.count():
        left = iter(range(moment))

        def struck(deadline: Deadline, doing: str, *how: bool, **named: bool) -> Any:
            if next(left, None) is None:  # noqa: B023
                deadline.doing = doing
                raise KeyboardInterrupt
            return watched(deadline, doing, *how, **named)

        recorder, asked = Recorder(), settings._replace(deadline=Deadline())
        with monkeypatch.context() as patch:
            patch.setattr(Deadline, "watched", struck)
            outcome = optimum.solve(problem, (objective,), asked, recorder)
        if outcome.status is Status.OPTIMAL:
            assert (outcome.costs, outcome.stopped) == (best, None)
            if next(left, None) is not None:
                break
            continue
        assert outcome.proof is None
        assert str(outcome.stopped).startswith("ctrl-C while ")
        assert outcome.status is (Status.FEASIBLE if recorder.trees else Status.UNKNOWN)
        assert outcome.costs == (recorder.trees[-1] if recorder.trees else None)
        bound, value = outcome.bounds.get(objective), best.measure(objective)
        assert bound is None or (bound >= value if objective is Objective.SUCCESS else bound <= value)
    assert moment > 2


def test_what_is_left_out_at_a_limit_is_unknown(monkeypatch: pytest.MonkeyPatch) -> None:
    def struck(
        problem: Problem, objectives: Sequence[Objective], how: Settings, reporter: Reporter
    ) -> Outcome:
        outcome = solve(problem, objectives, how, reporter)
        how.effective_deadline.interrupt()
        return outcome

    monkeypatch.setattr("foon_asp.questions.regret.solve", struck)
    found = foon_asp.regret(foon_asp.load().problem("ice"))
    assert found.answer.status is Status.OPTIMAL
    assert {(each.part.value, each.status) for each in found.regrets} == {
        ("unit", Status.UNKNOWN),
        ("item", Status.UNKNOWN),
    }
    assert "unknown" in found.text()


def test_what_was_enough_or_interrupted_comes_to_an_end_by_itself() -> None:
    """The search sees that it is over and says what it knows; it is interrupted only if it does not."""
    proved, pressed, full = Deadline(60), Deadline(), Deadline(memory=1)
    proved.stop_at_proof()
    pressed.interrupt()
    for deadline in (proved, pressed, full):
        assert deadline.passed
        assert not deadline.overdue


def test_without_memory_nothing_is_begun() -> None:
    """But what knows something already, and tells it."""
    with pytest.raises(LimitError), Deadline(memory=1).watched("reading", late=True):
        pytest.fail("it was begun")
    with Deadline(memory=1).watched("searching", late=True, grace=True):
        pass


def test_what_is_known_already_is_given_a_moment() -> None:
    long_over = Deadline(-9)
    with pytest.raises(LimitError), long_over.watched("counting", late=True):
        pytest.fail("it is late enough")
    with long_over.watched("counting", late=True, grace=True):
        pass
    with pytest.raises(LimitError), long_over.watched("counting", late=True, grace=True):
        time.sleep(60)


def test_why_there_is_no_tree_is_not_looked_for_beyond_the_limit(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def stopped(_: Problem) -> None:
        deadline = caller().deadline
        assert deadline is not None
        raise LimitError(deadline)

    monkeypatch.setattr("foon_asp.questions.why_infeasible.reach", stopped)
    words = ["solve", "--goal", "tea", "--rule", ':- use(U), motion(U,"steep").', "--time-limit", "600"]
    with pytest.raises(SystemExit) as ended:
        main(words)
    assert ended.value.code == 1
    assert "why-not explains why; there was no time left" in capsys.readouterr().out


def test_an_interrupt_in_a_destructor_comes_again(capfd: pytest.CaptureFixture[str]) -> None:
    class Struck:
        def __init__(self, error: type[BaseException]) -> None:
            self.error = error

        def __del__(self) -> None:
            raise self.error

    def wait() -> None:
        Struck(KeyboardInterrupt)
        time.sleep(60)

    with resend_lost_interrupts(), pytest.raises(KeyboardInterrupt):
        wait()
    assert capfd.readouterr().err == ""
    heard: list[object] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "unraisablehook", heard.append)
        with resend_lost_interrupts():
            Struck(ValueError)
    assert len(heard) == 1


def test_a_search_without_memory_for_a_thread_is_stopped_by_the_memory_limit(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(worker, "_idle", {})  # one that has had a thread has a stack to spare
    rules, deadline = "{use(1..3)}.", Deadline(memory=2**40)
    program = program_client.WorkerProgram([], rules, [], 0, deadline)
    status = Path(f"/proc/{program._worker._process.pid}/status").read_text()
    program.close()
    in_use = int(status.partition("VmData:")[2].split()[0]) * 1024
    monkeypatch.setattr(program_client, "_memory_left", lambda _: in_use + 2**21)
    program = program_client.WorkerProgram([], rules, [], 0, deadline)
    with pytest.raises(LimitError):
        program.search("opt", [("use", 1)], lambda _: None, lambda _: None)
    assert str(deadline.stopped).startswith("the memory limit of 1T")


_PRESSED = """
import signal, sys
from importlib.abc import MetaPathFinder

class Pressed(MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name == "foon_asp.{module}":
            signal.raise_signal(signal.SIGINT)

sys.meta_path.insert(0, Pressed())
sys.argv[1:] = ["solve", "--goal", "ice"]
from foon_asp.cli.start import main
main()
"""


@pytest.mark.parametrize("module", ["cli.main", "questions.solve", "asp.solver"])
def test_ctrl_c_while_the_program_is_imported_ends_it_quietly(module: str) -> None:
    code = _PRESSED.replace("{module}", module)
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stdout) == (3, "")
    assert ran.stderr == "interrupted before there was an answer\n"


@pytest.mark.slow
def test_nothing_strikes_while_a_library_is_imported_but_right_after() -> None:
    whole: list[str] = []

    def interrupted() -> None:
        with uninterrupted():
            signal.raise_signal(signal.SIGINT)
            whole.append("ctrl-C")
        whole.append("went on")

    def late() -> None:
        with Deadline(0.01).watched("importing"):
            with uninterrupted():
                time.sleep(0.1)
                whole.append("watch")
            time.sleep(5)
            whole.append("went on")

    def elsewhere() -> None:
        with pytest.raises(LimitError):
            late()

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    thread = threading.Thread(target=elsewhere)
    thread.start()
    thread.join()
    elsewhere()
    assert whole == ["ctrl-C", "watch", "watch"]
