"""Limits and ctrl-C hold while clingo grounds what has no end, and while a network is read."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

import foon_asp
from foon_asp.asp import Settings, Status
from foon_asp.asp.soft import solve_soft
from foon_asp.deadline import Deadline, LimitError, parse_memory_size, parse_seconds, size_text
from foon_asp.encoding.program_client import start_in_advance
from foon_asp.errors import UserError
from foon_asp.problem import Objective
from foon_asp.proof.simulation import Verdict, simulate_for
from foon_asp.questions.alternatives import alternatives
from tests.conftest import ROOT, Cli
from tests.support.hard_problem import hard_problem

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
    generate = ROOT / "benchmarks" / "generate.py"
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
            if b"encoding.program_worker" in words:
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


VERBS = {
    "soft": ("solve", "--soft", "{file}=2"),
    "different": ("alternatives", "--different", "2", "--constraint", "{file}"),
    "pareto": ("pareto", "--constraint", "{file}"),
    "assist": ("assist", "--constraint", "{file}"),
    "shopping-list": ("shopping-list", "--constraint", "{file}"),
    "certificate": ("solve", "--certificate", "{folder}/proof.json", "--constraint", "{file}"),
    "encodings": ("solve", "--encodings", "{folder}"),
}


@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.default_cases("shopping-list", "different")
def test_every_question_stops(verb: str, endless: Path, tmp_path: Path, cli: Cli) -> None:
    folder = tmp_path / "mine"
    folder.mkdir()
    (folder / "show.lp").write_text(ENDLESS + "#show use/1.\n")
    words = [word.format(file=endless, folder=folder) for word in VERBS[verb]]
    with within(0.5, 0.5 + LATE):
        ran = cli(*words, "--goal", "ice", "--time-limit", "0.5")
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
@pytest.mark.parametrize(
    ("limit", "said"),
    [
        (("--time-limit", "0.3"), "the time limit of 0.3 s"),
        pytest.param(("--memory-limit", "60M"), "the memory limit of 60M", marks=LINUX),
    ],
)
def test_reading_stops(large: Path, limit: tuple[str, str], said: str) -> None:
    with within(0.3, 0.3 + LATE + START):
        ran = subprocess.run(command("solve", "--data", large, *limit), capture_output=True, check=False)
    assert ran.returncode == 3
    assert f"unknown: stopped at {said} while reading" in ran.stderr.decode()


@pytest.mark.slow
def test_ctrl_c_while_reading(large: Path) -> None:
    code, _, err = interrupted(command("solve", "--data", large), 1)
    assert code == 3
    assert b"interrupted before there was an answer" in err


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


@pytest.mark.slow
def test_trees_known_by_the_limit() -> None:
    with within(1, 1 + LATE):
        found = alternatives(hard_problem(), best=5, time_limit=1)
    assert found.trees
    assert (found.complete, found.optimal) == (False, 0)
    assert found.unproved == len(found.trees)
    problem = hard_problem(6, 8, 3, 3)
    with within(1, 1 + LATE):
        found = alternatives(problem, different=4, within=100, limit=400, time_limit=1)
    assert not found.complete
    assert 0 < len(found.trees) <= 4
    for tree in found.trees:
        assert simulate_for(problem, problem.tree(tree.ids)).verdict is Verdict.AS_LISTED


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


@pytest.mark.parametrize("words", ["nan", "inf", "-1", "1e999", "", "soon"])
def test_time_limits_that_are_none(words: str) -> None:
    with pytest.raises(UserError, match="time limit"):
        parse_seconds(words)


@pytest.mark.parametrize(
    ("words", "size"),
    [("500M", 500 * 2**20), ("2G", 2**31), ("2GiB", 2**31), ("1.5g", 3 * 2**29), ("1000", 1000), (7, 7)],
)
def test_sizes(words: str | int, size: int) -> None:
    assert parse_memory_size(words) == size
    assert parse_memory_size(size_text(size).removesuffix(" bytes")) == size


@pytest.mark.parametrize("words", ["", "0", "-1M", "1X", "M", "nan", "1e9", 0, -5, True])
def test_sizes_that_are_none(words: str | int) -> None:
    with pytest.raises(UserError, match="memory limit"):
        parse_memory_size(words)


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
def test_a_watch_strikes_in_its_block_and_never_after() -> None:
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


@LINUX
def test_one_idle_worker_is_kept_and_taken_again(tmp_path: Path) -> None:
    mine = tmp_path / "mine.lp"
    mine.write_text(':- use(U), motion(U,"fry").\n')
    problem = foon_asp.load().problem("ice")

    def ask() -> None:
        foon_asp.solve(problem, constraints=mine)

    threads = [threading.Thread(target=ask) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    idle = workers(os.getpid())
    assert len(idle) == 1
    ask()
    start_in_advance()
    assert workers(os.getpid()) == idle
