"""Limits and ctrl-C hold while clingo grounds what has no end, and while a network is read or cut."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

import foon_asp
from foon_asp.asp import Settings, Status, solve
from foon_asp.asp.session import Session
from foon_asp.asp.soft import solve_soft
from foon_asp.dataset.reading import read_dataset
from foon_asp.deadline import Deadline, LimitError, memory_size, seconds, size_text
from foon_asp.errors import UserError
from foon_asp.grounding import worker_process
from foon_asp.grounding.run import Run
from foon_asp.problem import Objective
from foon_asp.proof.simulation import Verdict, simulate_for
from foon_asp.questions.alternatives import alternatives
from foon_asp.text.data_folder import find_data
from tests.conftest import Cli
from tests.hard_problem import hard_problem

pytestmark = pytest.mark.sampled(3)  # by default some cases of each test: there are many

ENDLESS = "p(0). p(f(X)) :- p(X). :- use(U), p(f(U)).\n"  # what nothing looks at is left out
HUGE = "q(A,B,C,D) :- unit(A), unit(B), unit(C), unit(D). :- use(U), q(U,A,B,-1).\n"
LATE = 2.5  # seconds on a busy machine
START = 4  # more, for a process of ours to start and to end
LINUX = pytest.mark.skipif(sys.platform != "linux", reason="memory limits are held on Linux only")


@pytest.fixture
def endless(tmp_path: Path) -> Path:
    file = tmp_path / "endless.lp"
    file.write_text(ENDLESS)
    return file


@pytest.fixture
def large(tmp_path: Path) -> Path:
    """Give a network that takes seconds to read."""
    generate = Path(__file__).parents[1] / "benchmarks" / "generate.py"
    folder = tmp_path / "large"
    words = ["--family", "adversarial", "--units", "100000", "--seed", "1", "--out", str(folder)]
    subprocess.run([sys.executable, generate, *words], check=True, capture_output=True)
    return folder


def workers(parent: int) -> list[int]:
    """Give the processes of clingo that a process has."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError, IndexError):
            words = (folder / "cmdline").read_bytes()
            if b"grounding.worker" in words:
                stat = (folder / "stat").read_text().rpartition(")")[2].split()
                if stat[0] != "Z" and int(stat[1]) in {parent, 1}:
                    found.append(int(folder.name))
    return found


def orphans(before: set[int]) -> set[int]:
    end = time.monotonic() + 5
    while (left := set(workers(1)) - before) and time.monotonic() < end:
        time.sleep(0.05)
    return left


@contextlib.contextmanager
def nothing_left() -> Iterator[None]:
    """Hold that no process without a parent is left behind."""
    before = set(workers(1))
    yield
    assert not orphans(before)


def command(*words: str | Path) -> list[str]:
    return [sys.executable, "-m", "foon_asp", *map(str, words)]


@contextlib.contextmanager
def within(least: float, most: float) -> Iterator[None]:
    began = time.monotonic()
    yield
    assert least <= time.monotonic() - began <= most


@pytest.mark.slow
@pytest.mark.parametrize("rules", [ENDLESS, HUGE])
def test_the_command_line_stops(rules: str, tmp_path: Path) -> None:
    file = tmp_path / "rules.lp"
    file.write_text(rules)
    with nothing_left(), within(2, 2 + LATE + START):
        ran = subprocess.run(
            command("solve", "--goal", "ice", "--constraint", file, "--time-limit", "2", "--format", "json"),
            capture_output=True,
            check=False,
            timeout=60,
        )
    assert ran.returncode == 3, ran.stderr
    answer = json.loads(ran.stdout)
    assert answer["status"] == "unknown"
    assert answer["stopped"] == "the time limit of 2 s while grounding"
    assert b"check them" in ran.stderr


SLOW = ("alternatives", "assist", "certify", "menu", "pareto", "regret", "sensitivity")  # like the others
VERBS = {
    "soft": ("solve", "--goal", "ice", "--soft", "{file}=2"),
    "alternatives": ("alternatives", "--goal", "ice", "--constraint", "{file}"),
    "different": ("alternatives", "--different", "2", "--goal", "ice", "--constraint", "{file}"),
    "pareto": ("pareto", "--goal", "ice", "--constraint", "{file}"),
    "menu": ("menu", "--goal", "ice", "--goal", "tea", "--constraint", "{file}"),
    "regret": ("regret", "--goal", "ice", "--constraint", "{file}"),
    "assist": ("assist", "--goal", "ice", "--constraint", "{file}"),
    "sensitivity": ("sensitivity", "--goal", "ice", "--constraint", "{file}"),
    "shopping-list": ("shopping-list", "--goal", "hot cocoa", "--constraint", "{file}"),
    "clash": ("clash", "--goal", "ice", "--constraint", "{file}"),
    "certify": ("certify", "--goal", "ice", "--constraint", "{file}"),
    "encodings": ("solve", "--goal", "ice", "--encodings", "{folder}"),
}


@pytest.mark.parametrize(
    "verb", [pytest.param(verb, marks=[pytest.mark.slow] * (verb in SLOW)) for verb in VERBS]
)
def test_every_question_stops(verb: str, endless: Path, tmp_path: Path, cli: Cli) -> None:
    folder = tmp_path / "mine"
    folder.mkdir()
    (folder / "show.lp").write_text(ENDLESS + "#show use/1.\n")
    words = [word.format(file=endless, folder=folder) for word in VERBS[verb]]
    with within(0.5, 0.5 + LATE):
        ran = cli(*words, "--time-limit", "0.5")
    assert ran.code == 3, ran
    assert "the time limit of 0.5 s while grounding" in ran.err


def test_python_stops(endless: Path) -> None:
    with within(0.5, 0.5 + LATE):
        answer = foon_asp.solve(foon_asp.load().problem("ice"), constraints=endless, time_limit=0.5)
    assert answer.status is Status.UNKNOWN
    assert answer.stopped == "the time limit of 0.5 s while grounding"
    assert foon_asp.solve(foon_asp.load().problem("ice")).status is Status.OPTIMAL


def test_ctrl_c_in_python_is_an_answer(endless: Path) -> None:
    problem = foon_asp.load().problem("ice")
    timer = threading.Timer(0.7, lambda: signal.pthread_kill(main, signal.SIGINT))
    main = threading.get_ident()
    timer.start()
    with within(0.5, 0.7 + LATE):
        answer = foon_asp.solve(problem, constraints=endless)
    assert answer.status is Status.UNKNOWN
    assert answer.stopped == "ctrl-C while grounding"


def interrupted(words: list[str], after: float) -> tuple[int, bytes, bytes]:
    """Press ctrl-C, which goes to all processes of a terminal."""
    with subprocess.Popen(
        words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True
    ) as process:
        time.sleep(after)
        assert process.poll() is None
        os.killpg(process.pid, signal.SIGINT)
        with within(0, LATE):
            out, err = process.communicate(timeout=30)
    return process.returncode, out, err


@pytest.mark.slow
def test_ctrl_c_while_grounding(endless: Path) -> None:
    words = command("solve", "--goal", "ice", "--constraint", endless)
    with nothing_left():
        code, out, _ = interrupted(words, 3)
    assert code == 3
    assert b"unknown: stopped at ctrl-C while grounding" in out


@pytest.mark.slow
def test_limits_and_ctrl_c_while_reading(large: Path) -> None:
    with within(0.3, 0.3 + LATE + START):
        ran = subprocess.run(
            command("solve", "--data", large, "--time-limit", "0.3"), capture_output=True, check=False
        )
    assert ran.returncode == 3
    assert b"unknown: stopped at the time limit of 0.3 s while reading" in ran.stderr
    code, _, err = interrupted(command("solve", "--data", large), 1)
    assert code == 3
    assert b"interrupted before there was an answer" in err


@pytest.mark.slow
def test_limits_and_ctrl_c_while_cutting(large: Path) -> None:
    question = read_dataset(find_data(large))
    goal = question.each_goal(())[-1]
    for objective in (Objective.UNITS, Objective.SUCCESS):
        for limit in (0.2, 1, 3):
            problem = question.problem((goal,), "strict")
            with within(0, limit + 1 + LATE):
                outcome = solve(problem, (objective,), Settings(deadline=Deadline(limit)))
            if outcome.units is not None:
                verdict = simulate_for(problem, problem.tree(outcome.units)).verdict
                assert verdict is Verdict.AS_LISTED
                assert outcome.costs is not None
                bound = outcome.bounds.get(objective, 0)
                have = outcome.costs.measure(objective)
                assert bound >= have if objective is Objective.SUCCESS else bound <= have


def test_a_session_goes_on_after_a_stop(endless: Path, tmp_path: Path, cli: Cli) -> None:
    script = tmp_path / "lines.txt"
    script.write_text(
        textwrap.dedent(f"""\
        goal ice
        constraint forbid_motion forbidden_motion=fry
        solve
        solve --constraint {endless} --time-limit 0.5
        time-limit 30
        memory-limit 4G
        solve
        show
        """)
    )
    ran = cli("shell", script)
    assert ran.code == 0, ran.err
    assert ran.out.count("optimal by units") == 2
    assert ran.out.count("unknown: stopped at the time limit of 0.5 s while grounding") == 1
    assert "constraint: forbid_motion forbidden_motion=fry" in ran.out
    assert "memory-limit: 4G" in ran.out


def test_what_is_kept_in_a_session_outlives_a_stop(endless: Path) -> None:
    session = Session()
    problem = foon_asp.load().problem("ice")
    mine = endless.with_name("mine.lp")
    mine.write_text(':- use(U), motion(U,"fry").\n')
    kept = Settings(constraints=(mine,), session=session)
    first = solve(problem, settings=kept)
    stopped = solve(problem, settings=kept._replace(constraints=(endless,), deadline=Deadline(0.5)))
    assert stopped.status is Status.UNKNOWN
    again = solve(problem, settings=kept)
    assert (again.status, again.costs) == (first.status, first.costs) == (Status.OPTIMAL, first.costs)


@pytest.mark.slow
@LINUX
def test_grounding_stops_at_the_memory_limit(endless: Path) -> None:
    with nothing_left():
        ran = subprocess.run(
            command("solve", "--goal", "ice", "--constraint", endless, "--memory-limit", "250M"),
            capture_output=True,
            check=False,
            timeout=60,
        )
    assert ran.returncode == 3, ran.stderr
    assert b"unknown: stopped at the memory limit of 250M while grounding" in ran.stdout


@LINUX
def test_a_worker_that_dies_is_no_bug(endless: Path) -> None:
    problem = foon_asp.load().problem("ice")

    def kill() -> None:
        end = time.monotonic() + 10
        while time.monotonic() < end:
            for worker in workers(os.getpid()):
                if float(Path(f"/proc/{worker}/stat").read_text().rpartition(")")[2].split()[11]) > 30:
                    os.kill(worker, signal.SIGKILL)
                    return
            time.sleep(0.05)

    thread = threading.Thread(target=kill)
    thread.start()
    answer = foon_asp.solve(problem, constraints=endless, time_limit=20)
    thread.join()
    assert answer.status is Status.UNKNOWN
    assert answer.stopped == "the end of memory while grounding"


@LINUX
@pytest.mark.slow
def test_reading_stops_at_the_memory_limit(large: Path) -> None:
    ran = subprocess.run(
        command("solve", "--data", large, "--memory-limit", "60M"), capture_output=True, check=False
    )
    assert ran.returncode == 3
    assert b"unknown: stopped at the memory limit of 60M while reading" in ran.stderr


@pytest.mark.slow
@LINUX
def test_the_process_of_clingo_ends_with_ours(endless: Path) -> None:
    with nothing_left():
        process = subprocess.Popen(
            command("solve", "--goal", "ice", "--constraint", endless), stdout=subprocess.PIPE
        )
        end = time.monotonic() + 20
        while not workers(process.pid) and time.monotonic() < end:
            time.sleep(0.1)
        time.sleep(2)  # it grounds by now
        process.kill()
        process.communicate()


def test_without_a_main_module_and_in_threads(endless: Path) -> None:
    script = f"""
import threading, foon_asp
problem = foon_asp.load().problem("ice")
answers = []
def ask(): answers.append(foon_asp.solve(problem, constraints={str(endless)!r}, time_limit=0.5).status)
threads = [threading.Thread(target=ask) for _ in range(2)]
for thread in threads: thread.start()
for thread in threads: thread.join()
print(*answers)
"""
    with nothing_left():
        ran = subprocess.run(
            [sys.executable, "-"], input=script, capture_output=True, text=True, check=False, timeout=60
        )
    assert ran.stdout == "unknown unknown\n", ran.stderr
    assert not ran.stderr


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork on this system")
def test_a_copy_of_this_process_has_workers_of_its_own(tmp_path: Path) -> None:
    mine = tmp_path / "mine.lp"
    mine.write_text(':- use(U), motion(U,"fry").\n')
    script = f"""
import os, foon_asp
problem = foon_asp.load().problem("ice")
def ask(): return foon_asp.solve(problem, constraints={str(mine)!r}).costs.units
first = ask()
child = os.fork()
assert ask() == first
if child:
    assert os.waitpid(child, 0)[1] == 0
"""
    with nothing_left():
        ran = subprocess.run(
            [sys.executable, "-W", "error", "-c", script],
            check=False,
            capture_output=True,
            text=True,
            timeout=60,
        )
    assert (ran.returncode, ran.stderr) == (0, "")


def test_faults_in_rules_are_said_as_before(tmp_path: Path, cli: Cli) -> None:
    mine = tmp_path / "mine.lp"
    mine.write_text(":- use(U), motion(U,V), W < 3.\n")
    ran = cli("solve", "--goal", "ice", "--constraint", mine)
    assert ran.code == 2
    assert "mine.lp:1:" in ran.err
    assert "unsafe" in ran.err


@pytest.mark.slow
def test_the_most_different_trees_known_by_the_limit() -> None:
    problem = hard_problem(6, 8, 3, 3)
    for limit in (0.5, 2):
        with within(0, limit + LATE):
            found = alternatives(problem, different=4, within=100, limit=400, time_limit=limit)
        assert not found.complete
        assert found.trees
        assert len(found.trees) <= 4
        for tree in found.trees:
            assert simulate_for(problem, problem.tree(tree.units)).verdict is Verdict.AS_LISTED


def test_a_choice_that_is_stopped_is_from_all_that_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = hard_problem(3, 4, 2, 2)
    everything = alternatives(problem, different=3, within=100, limit=40)
    monkeypatch.setattr("foon_asp.questions.alternatives.run", lambda *_, **__: Run())
    found = alternatives(problem, different=3, within=100, limit=40)
    assert len(found.trees) == len(everything.trees) == 3
    assert not found.complete


@pytest.mark.slow
def test_trees_that_are_not_settled_are_given_as_such() -> None:
    problem = hard_problem()
    found = alternatives(problem, best=5, time_limit=2)
    assert not found.complete
    assert found.trees
    assert found.unproved == len(found.trees)
    assert not found.optimal


@pytest.mark.slow
def test_soft_constraints_tell_what_the_tree_known_by_then_breaks(tmp_path: Path) -> None:
    file = tmp_path / "soft.lp"
    file.write_text(":- use(U), inputs(U,N), N > 1.\n")
    problem = hard_problem()
    with within(0, 3 + LATE):
        found = solve_soft(problem, (Objective.UNITS,), Settings(deadline=Deadline(3)), {file: 1})
    assert found.outcome.status is Status.FEASIBLE
    assert found.outcome.units is not None
    broken = sum(len(problem.network.inputs[unit]) > 1 for unit in found.outcome.units)
    assert found.penalty == broken


@pytest.mark.parametrize("words", ["nan", "inf", "-1", "1e999", "", "soon", "٣"])
def test_time_limits_that_are_none(words: str) -> None:
    if words == "٣":
        assert seconds(words) == 3  # a digit is a digit
        return
    with pytest.raises(UserError, match="time limit"):
        seconds(words)


@pytest.mark.parametrize(
    ("words", "size"),
    [("500M", 500 * 2**20), ("2G", 2**31), ("2GiB", 2**31), ("1.5g", 3 * 2**29), ("1000", 1000), (7, 7)],
)
def test_sizes(words: str | int, size: int) -> None:
    assert memory_size(words) == size
    assert memory_size(size_text(size).removesuffix(" bytes")) == size


@pytest.mark.parametrize("words", ["", "0", "-1M", "1X", "M", "nan", "1e9", 0, -5, True])
def test_sizes_that_are_none(words: str | int) -> None:
    with pytest.raises(UserError, match="memory limit"):
        memory_size(words)


def test_where_memory_is_not_told_its_limit_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("foon_asp.deadline._STATM", Path("/nowhere"))
    with pytest.raises(UserError, match="Linux"):
        Deadline(None, 2**30)


def work(until: float) -> int:
    count = 0
    while time.monotonic() < until:
        count += 1
    return count


@pytest.mark.slow
@pytest.mark.parametrize("in_thread", [False, True])
@pytest.mark.sampled(2)
def test_a_watch_strikes_in_its_block_and_never_after(in_thread: bool) -> None:
    failures: list[BaseException] = []

    def check() -> None:
        try:
            for lasting in (0.0, 0.05, 0.09, 0.1, 0.11, 0.3):
                for _ in range(4):
                    deadline = Deadline(0.1)
                    struck = ""
                    try:
                        with deadline.watched("working"):
                            work(time.monotonic() + lasting)
                    except LimitError as error:
                        struck = error.stopped
                    except KeyboardInterrupt:  # in the very moment in which the block ended
                        assert deadline.stopped is not None
                        struck = deadline.stopped
                    assert struck in {"", "the time limit of 0.1 s while working"}
                    assert struck or lasting < 0.3
                    assert not struck or lasting > 0.05
                    work(time.monotonic() + 0.02)  # nothing strikes here
        except BaseException as error:
            failures.append(error)

    if in_thread:
        thread = threading.Thread(target=check)
        thread.start()
        thread.join()
    else:
        check()
    assert not failures


def test_a_fault_under_a_watch_stays_that_fault() -> None:
    with pytest.raises(ZeroDivisionError), Deadline(5).watched("working"):
        raise ZeroDivisionError


def test_a_limit_within_a_limit() -> None:
    outer = Deadline(0.05)
    inner = Deadline(10, within=outer)
    time.sleep(0.06)
    assert inner.passed
    assert inner.stopped == "the time limit of 0.05 s while reading"
    outer = Deadline(10)
    inner = Deadline(0, within=outer)
    assert inner.passed
    inner.interrupt()
    assert not outer.passed
    inner = Deadline(None, within=outer)
    inner.interrupt()
    assert outer.interrupted


def test_an_idle_worker_is_taken_again(tmp_path: Path) -> None:
    mine = tmp_path / "mine.lp"
    mine.write_text(':- use(U), motion(U,"fry").\n')
    problem = foon_asp.load().problem("ice")
    foon_asp.solve(problem, constraints=mine)
    (idle,) = worker_process._idle
    foon_asp.solve(problem, constraints=mine)
    assert worker_process._idle == [idle]


def test_rules_of_a_user_give_what_they_give_here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same questions with the program in another process and in this one."""
    mine = tmp_path / "mine.lp"
    mine.write_text(":- use(U), inputs(U,N), N > 4.\n")
    foon = foon_asp.load()

    def answers() -> list[object]:
        problems = [foon.problem(goal) for goal in ("ice", "macaroni", "tea")]
        found = [foon_asp.solve(problem, "success", constraints=mine) for problem in problems]
        return [(each.status, each.costs, each.bounds) for each in found]

    there = answers()
    monkeypatch.setattr("foon_asp.asp.assembly.is_own", lambda _: True)  # as if the rules were ours
    monkeypatch.setattr(worker_process, "WorkerProgram", None)
    assert answers() == there
