"""Thousands of questions in one run: every one gets exactly one row, whatever happens."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any, cast

import pytest

import foon_asp
from foon_asp.asp import solve
from foon_asp.batch import cluster
from foon_asp.batch.answer_row import answer_row
from foon_asp.batch.asked import Asked, Opener
from foon_asp.batch.cluster import answer_on_cluster
from foon_asp.batch.question_file import read_questions
from foon_asp.batch.results import open_results
from foon_asp.batch.workers import Work, answer_all
from foon_asp.cli.batch_data import Opening
from foon_asp.errors import UserError
from foon_asp.problem import ContainerRule, Objective, Problem, parse_objectives
from foon_asp.resources import bundled_kitchen
from foon_asp.text.data_folder import find_data, read_data
from foon_asp.text.diagnostics import InputError
from foon_asp.text.goal_name import find_goal
from tests.conftest import Cli, valid

pytestmark = pytest.mark.sampled(3)  # by default some cases of each test: there are many

LINES = """
{"goal": ["ice", "macaroni"], "objective": ["units", "success,units"], "containers": ["strict", "implied"]}
{"goal": [["ice", "macaroni"]], "objective": "inputs"}

{"goal": "ice", "kitchen": [null, "water.txt"]}
"""


@pytest.fixture
def questions(tmp_path: Path) -> Path:
    (tmp_path / "water.txt").write_text("O\twater\nS\tin\t[jug]\n")
    file = tmp_path / "questions.jsonl"
    file.write_text(LINES)
    return file


def rows_of(file: Path) -> list[dict[str, Any]]:
    head, *rows = (valid(json.loads(line)) for line in file.read_text().splitlines())
    assert "question" in head
    return rows


def asked_by(row: dict[str, Any]) -> tuple[str, str, str, str | None]:
    return str(row["goal"]), row["objective"], row["containers"], row["kitchen"]


def test_every_answer_is_that_of_solve(cli: Cli, questions: Path, tmp_path: Path) -> None:
    ran = cli("batch", questions, "--results", tmp_path / "a.jsonl", "--jobs", 2)
    assert ran.code == 0
    rows = rows_of(tmp_path / "a.jsonl")
    # "ice" by units and strict containers is asked twice, and answered once
    assert len(rows) == 10
    data = read_data(find_data(bundled_kitchen()))
    for row in rows:
        names = [row["goal"]] if isinstance(row["goal"], str) else row["goal"]
        goals = tuple(find_goal(name, data.network, data.goals) for name in names)
        kitchen = frozenset() if row["kitchen"] else data.kitchen
        rule = ContainerRule(row["containers"])
        problem = Problem(data.network, kitchen, goals, data.rates, data.utensils, rule)
        outcome = solve(problem, parse_objectives([row["objective"]]))
        assert row["status"] == outcome.status
        if outcome.costs is None:
            assert row["units"] is None
            continue
        costs = problem.costs(row["units"])
        assert costs.key((*outcome.objectives, Objective.UNITS)) == outcome.costs.key(
            (*outcome.objectives, Objective.UNITS)
        )
        assert row["costs"]["units"] == costs.units
        assert Fraction(row["costs"]["success"]["exact"]) == costs.success


def test_a_run_is_gone_on_with_and_not_repeated(cli: Cli, questions: Path, tmp_path: Path) -> None:
    file = tmp_path / "a.jsonl"
    assert cli("batch", questions, "--results", file).code == 0
    whole = file.read_bytes()
    lines = whole.splitlines(keepends=True)
    file.write_bytes(b"".join(lines[:4]) + lines[4][:20])  # killed while it wrote
    ran = cli("batch", questions, "--results", file, "--format", "json")
    assert (ran.json["answered_before"], ran.json["answered"]) == (3, 7)
    assert Counter(map(asked_by, rows_of(file))) == Counter(asked_by(json.loads(x)) for x in lines[1:])
    assert cli("batch", questions, "--results", file).out.startswith(
        "10 questions, 10 of them answered before"
    )


def test_results_of_other_data_are_refused(cli: Cli, questions: Path, tmp_path: Path) -> None:
    file = tmp_path / "a.jsonl"
    cli("batch", questions, "--results", file)
    (tmp_path / "water.txt").write_text("O\twater\n")
    ran = cli("batch", questions, "--results", file)
    assert ran.code == 2
    assert "was started for another question" in ran.err


@pytest.mark.slow
def test_rules_hold_for_all_questions(cli: Cli, questions: Path, tmp_path: Path) -> None:
    file = tmp_path / "a.jsonl"
    mine = tmp_path / "mine.lp"
    mine.write_text("#const most = 10.\n:- #count { U : use(U) } > most.\n")
    given = ["--constraint", mine, "-c", "most=9", "--rule", ':- use(U), motion(U,"crush").']
    batch = ["batch", questions, "--results", file, "--jobs", 2]
    assert cli(*batch, *given).code == 0
    rows = rows_of(file)
    assert {row["status"] for row in rows} == {"optimal", "infeasible"}
    for row in rows[:6]:
        goals = ["--goal", row["goal"], "--containers", row["containers"], "--objective", row["objective"]]
        answer = cli("solve", *goals, *given, "--format", "json").json
        assert (answer["status"], answer["costs"]) == (row["status"], row["costs"])
    assert "10 of them answered before" in cli(*batch, *given).out
    for others in (given[:4], [*given[:3], "most=8", *given[4:]], []):
        assert "was started for another question" in cli(*batch, *others).err
    ran = cli(*batch[:3], tmp_path / "b.jsonl", "--rule", ":- use(U), motoin(U,1).")
    assert ran.code == 0
    assert ran.err.count("did you mean motion/2") == 1


def test_a_question_that_fails_is_a_row(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "q.jsonl").write_text(
        '{"goal": ["icecream", "ice"]}\n{"goal": "ice", "kitchen": "no.json"}\n'
    )
    (tmp_path / "no.json").write_text("[7]")
    ran = cli("batch", tmp_path / "q.jsonl", "--results", tmp_path / "a.jsonl")
    assert ran.code == 1
    assert "failed: icecream: no object node has the label 'icecream'" in ran.out
    rows = rows_of(tmp_path / "a.jsonl")
    assert [row["status"] for row in rows] == ["failed", "optimal", "failed"]
    assert "no.json:1:2" in rows[2]["error"]
    # and it is one when the run is started again
    assert cli("batch", tmp_path / "q.jsonl", "--results", tmp_path / "a.jsonl").code == 1


@pytest.mark.slow
def test_what_stands_for_many_goals(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "q.jsonl").write_text('{"goal": "@goals"}\n{"goal": "@makeable", "containers": "implied"}\n')
    ran = cli(
        "batch", tmp_path / "q.jsonl", "--results", tmp_path / "a.jsonl", "--jobs", "2", "--format", "json"
    )
    stats = cli("stats", "--format", "json").json
    assert stats  # the bundled kitchen is read
    rows = rows_of(tmp_path / "a.jsonl")
    assert len(rows) == ran.json["questions"]
    strict = [row for row in rows if row["containers"] == "strict"]
    assert len(strict) == 15
    implied = [row for row in rows if row["containers"] == "implied"]
    assert len(implied) > 100
    assert {row["status"] for row in implied} == {"optimal"}
    assert all(row["proof"] and row["units"] for row in implied)


@pytest.mark.parametrize(
    ("line", "place", "message"),
    [
        ("{", "1:2", "not JSON"),
        ('{"goal": "ice",\t}', "1:15", "not JSON: found a comma before }, expected none"),
        ("7", "1:1", "expected an object such as"),
        ('{"objective": "units"}', "1:1", "expected an object such as"),
        ('{"goal": "ice", "goals": 1}', "1:1", "found the key 'goals', expected one of goal, objective"),
        ('{"goal": []}', "1:1", "found an empty list"),
        ('{"goal": 7}', "1:1", "found 7 as 'goal'"),
        ('{"goal": "@all"}', "1:1", "found the goal '@all'"),
        ('{"goal": [["ice", "@goals"]]}', "1:1", "by itself"),
        ('{"goal": "ice", "objective": "cheap"}', "1:1", "cheap"),
        ('{"goal": "ice", "containers": "loose"}', "1:1", "found the containers 'loose', expected strict or"),
        ('{"goal": "ice", "time_limit": "1 s"}', "1:1", "expected seconds"),
    ],
)
def test_lines_that_ask_nothing_are_located(tmp_path: Path, line: str, place: str, message: str) -> None:
    file = tmp_path / "q.jsonl"
    file.write_text(line + '\n{"goal": "ice"}\n')
    with pytest.raises(InputError) as caught:
        read_questions(file, None)
    assert str(caught.value).startswith(f"{file}:{place}: error: ")
    assert message in str(caught.value)


def test_a_file_without_questions_is_refused(tmp_path: Path) -> None:
    (tmp_path / "q.jsonl").write_text("\n")
    with pytest.raises(UserError, match="no questions"):
        read_questions(tmp_path / "q.jsonl", None)


# --- workers that misbehave


class Misbehaving:
    """Data that does what the name of the goal says."""

    def __init__(self) -> None:
        self._data = read_data(find_data(bundled_kitchen()))

    def named(self, word: str, containers: str, kitchen: Path | None) -> Sequence[str]:
        return ()

    def problem(self, asked: Asked) -> Problem:
        (name,) = asked.goals
        if name == "die":
            os.kill(os.getpid(), signal.SIGKILL)
        if name == "leave":
            sys.exit(5)
        if name == "sleep":
            time.sleep(60)
        if name == "break":
            raise ZeroDivisionError("by zero")
        goal = find_goal(name, self._data.network, self._data.goals)
        return Problem(self._data.network, self._data.kitchen, (goal,), self._data.rates, self._data.utensils)


@dataclass(frozen=True)
class OpenMisbehaving:
    def __call__(self) -> Misbehaving:
        return Misbehaving()


@pytest.mark.slow
@pytest.mark.parametrize("jobs", [1, 2])
@pytest.mark.sampled(2)
def test_one_question_never_ends_the_run(jobs: int) -> None:
    names = ["ice", "die", "macaroni", "sleep", "leave", "break", "greek salad"]
    questions = [Asked((name,), time_limit=5.0 if name != "sleep" else 0.1) for name in names]
    work = Work(OpenMisbehaving(), grace=0.5 if jobs == 1 else 1.0)
    rows = {asked.goals[0]: row for asked, row in answer_all(work, questions, jobs)}
    assert set(rows) == set(names)
    statuses = {name: row["status"] for name, row in rows.items()}
    good = {"ice", "macaroni", "greek salad"}
    assert statuses == {name: "optimal" if name in good else "failed" for name in names}
    assert "was killed by SIGKILL" in str(rows["die"]["error"])
    assert "exit code 5" in str(rows["leave"]["error"])
    assert "no answer within the time limit" in str(rows["sleep"]["error"])
    assert "a bug of foon-asp: ZeroDivisionError" in str(rows["break"]["error"])


@pytest.mark.slow
def test_a_killed_run_loses_and_repeats_nothing(tmp_path: Path) -> None:
    questions = tmp_path / "q.jsonl"
    questions.write_text('{"goal": "@goals", "objective": ["units", "success", "inputs", "kitchen"]}\n')
    file = tmp_path / "a.jsonl"
    command = [
        sys.executable,
        "-m",
        "foon_asp",
        "batch",
        str(questions),
        "--results",
        str(file),
        "--jobs",
        "2",
    ]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as running:
        deadline = time.monotonic() + 60
        while not (file.exists() and file.read_bytes().count(b"\n") > 10):
            assert time.monotonic() < deadline
            assert running.poll() is None
            time.sleep(0.01)
        running.kill()
    ran = subprocess.run([*command, "--format", "json"], capture_output=True, check=True)
    summary = json.loads(ran.stdout)
    assert summary["answered_before"] >= 10
    counts = Counter(map(asked_by, rows_of(file)))
    assert set(counts.values()) == {1}
    assert counts.total() == summary["questions"] == summary["answered_before"] + summary["answered"]


def test_ctrl_c_keeps_what_is_there(tmp_path: Path) -> None:
    questions = tmp_path / "q.jsonl"
    questions.write_text('{"goal": "@goals", "objective": ["units", "success", "inputs", "kitchen"]}\n')
    file = tmp_path / "a.jsonl"
    command = [sys.executable, "-m", "foon_asp", "batch", str(questions), "--results", str(file)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as running:
        while not (file.exists() and file.read_bytes().count(b"\n") > 3):
            assert running.poll() is None
            time.sleep(0.01)
        running.send_signal(signal.SIGINT)
        out, err = running.communicate(timeout=30)
    assert running.returncode == 3
    assert b"run the same command again to continue" in err
    assert b"in total: " in out
    assert len(rows_of(file)) >= 3


# --- Parquet


def some_rows(count: int) -> Iterator[tuple[Asked, dict[str, Any]]]:
    data = Misbehaving()
    one = answer_row(data, Asked(("ice",)))
    for number in range(count):
        asked = Asked((f"goal {number}",)) if number % 2 else Asked((f"goal {number}", "b"), time_limit=2.0)
        yield asked, {**one, **asked.shown()}


@pytest.mark.slow
def test_parquet_holds_the_same_rows(cli: Cli, questions: Path, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    cli("batch", questions, "--results", tmp_path / "a.jsonl")
    assert cli("batch", questions, "--results", tmp_path / "a.parquet").code == 0
    found = {
        (tuple(row["goal"]), row["objective"], row["containers"], row["kitchen"]): row
        for row in parquet.read_table(tmp_path / "a.parquet").to_pylist()
    }
    rows = rows_of(tmp_path / "a.jsonl")
    assert len(found) == len(rows)
    for row in rows:
        goals = (row["goal"],) if isinstance(row["goal"], str) else tuple(row["goal"])
        same = found[goals, row["objective"], row["containers"], row["kitchen"]]
        assert (same["status"], same["units"]) == (row["status"], row["units"])
        assert same["cost_success"] == (row["costs"] and row["costs"]["success"]["exact"])
    ran = cli("batch", questions, "--results", tmp_path / "a.parquet", "--format", "json")
    assert (ran.json["answered"], ran.json["answered_before"]) == (0, len(rows))


@pytest.mark.parametrize("killed_after", [0, 5, 9, 10, 11, 25])
def test_parts_and_what_waits_for_the_next_are_each_row_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, killed_after: int
) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    monkeypatch.setattr("foon_asp.batch.results._ROWS_IN_PART", 10)
    rows = list(some_rows(26))
    with open_results(tmp_path / "before.parquet", {"data": "x"}) as before:
        for asked, row in rows[:killed_after]:
            before.add(asked, row)
        shutil.copytree(tmp_path / "before.parquet", tmp_path / "a.parquet")  # as it is when it is killed
    with open_results(tmp_path / "a.parquet", {"data": "x"}) as again:
        assert set(again.done) == {asked.key for asked, _ in rows[:killed_after]}
        for asked, row in rows[killed_after:]:
            again.add(asked, row)
    found = parquet.read_table(tmp_path / "a.parquet").column("goal").to_pylist()
    assert Counter(map(tuple, found)) == Counter(asked.goals for asked, _ in rows)


def test_a_part_that_was_written_just_before_the_end_is_not_doubled(tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    rows = list(some_rows(10))
    with open_results(tmp_path / "a.parquet", {}) as results:
        for asked, row in rows:
            results.add(asked, row)
        waiting = (tmp_path / "a.parquet" / "_waiting.jsonl").read_bytes()
    (tmp_path / "a.parquet" / "_waiting.jsonl").write_bytes(waiting)  # killed before it was taken away
    with open_results(tmp_path / "a.parquet", {}) as results:
        assert len(results.done) == 10
    assert parquet.read_table(tmp_path / "a.parquet").num_rows == 10


def test_parquet_of_another_question_is_refused(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    with open_results(tmp_path / "a.parquet", {"data": "x"}):
        pass
    with pytest.raises(UserError, match="was started for another question"):
        open_results(tmp_path / "a.parquet", {"data": "y"})


# --- a cluster


@pytest.fixture
def scheduler(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[str]:
    """Start a scheduler and two workers on this machine, and give its address."""
    pytest.importorskip("distributed")
    named = tmp_path / "scheduler.json"
    env = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[1]), **getattr(request, "param", {})}
    quiet: dict[str, Any] = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    quiet |= {"cwd": tmp_path, "env": env}
    dask = [sys.executable, "-m", "distributed.cli.dask_scheduler"]
    options = ["--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", str(named)]
    worker = [sys.executable, "-m", "distributed.cli.dask_worker", "--scheduler-file", str(named)]
    started = [subprocess.Popen([*dask, *options], **quiet)]
    try:
        more = ["--nworkers", "2", "--nthreads", "1", "--no-dashboard", "--local-directory", str(tmp_path)]
        started.append(subprocess.Popen([*worker, *more], **quiet))
        deadline = time.monotonic() + 60
        while not (named.exists() and named.read_text()):
            assert time.monotonic() < deadline
            time.sleep(0.05)
        yield json.loads(named.read_text())["address"]
    finally:
        for process in reversed(started):
            process.terminate()
            process.wait(30)


@pytest.mark.slow
def test_a_cluster_gives_the_same_rows(cli: Cli, questions: Path, tmp_path: Path, scheduler: str) -> None:
    assert scheduler.startswith("tcp://")
    assert cli("batch", questions, "--results", tmp_path / "a.jsonl").code == 0
    ran = cli("batch", questions, "--results", tmp_path / "b.jsonl", "--scheduler", scheduler)
    assert ran.code == 0
    ours, theirs = (
        {asked_by(row): (row["status"], row["costs"], row["units"]) for row in rows_of(tmp_path / name)}
        for name in ("a.jsonl", "b.jsonl")
    )
    assert ours == theirs


@pytest.mark.slow
def test_nothing_is_lost_when_a_worker_dies_in_the_middle_of_a_task(
    tmp_path: Path, scheduler: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    distributed = pytest.importorskip("distributed")
    none = ("kitchen", "rates", "utensils", "goals", "unit_prices")
    named = {"folder": bundled_kitchen(), "network": (), **dict.fromkeys(none), "lenient": False, "level": 3}
    opening = Opening(tuple(named.items()), "d")
    goals = [str(node) for node in foon_asp.load().network.objects]
    asked = [Asked((goal,)) for goal in goals]
    monkeypatch.setattr("foon_asp.batch.cluster._MOST", 40)
    with distributed.Client(scheduler) as client:
        client.wait_for_workers(2, timeout=60)
        killed = 0
        found = []
        for one, row in answer_on_cluster(opening, asked, scheduler):
            found.append(one)
            assert row["error"] is None
            if len(found) in {100, 200}:
                (pid, *_) = client.run(os.getpid).values()
                os.kill(pid, signal.SIGKILL)
                killed += 1
    assert killed == 2
    assert sorted(found) == sorted(asked)


@dataclass(frozen=True)
class Deadly:
    """Data, to be opened, of which one goal kills the process that asks for it, and another one does so once.

    Without a problem for any other.
    """

    folder: Path

    def __call__(self) -> "Deadly":
        return self

    def named(self, *_: object) -> Sequence[str]:
        return ()

    def problem(self, asked: Asked) -> Problem:
        (goal,) = asked.goals
        time.sleep(0.05)  # so that others wait on the same worker
        once = self.folder / "once"
        if goal == "deadly" or (goal == "once" and not once.exists()):
            once.touch()
            os.kill(os.getpid(), signal.SIGKILL)
        raise UserError(f"answered {goal}")


@pytest.mark.slow
@pytest.mark.parametrize("scheduler", [{"DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "0"}], indirect=True)
def test_only_the_question_that_kills_workers_in_the_middle_of_a_task_fails(
    tmp_path: Path, scheduler: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("foon_asp.batch.cluster._MOST", 8)
    goals = [*map(str, range(30)), "once", *map(str, range(30, 47)), "deadly", *map(str, range(47, 70))]
    rows = [*answer_on_cluster(Deadly(tmp_path), [Asked((goal,)) for goal in goals], scheduler)]
    assert (tmp_path / "once").exists()
    assert Counter(one.goals[0] for one, _ in rows) == Counter(goals)
    errors = {one.goals[0]: str(row["error"]) for one, row in rows}
    assert errors.pop("deadly").startswith("on the cluster: ")
    assert errors == {goal: f"answered {goal}" for goal in goals if goal != "deadly"}


def test_a_task_ends_in_time_and_leaves_the_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    one, two, three, *more = [Asked((str(number),)) for number in range(40)]
    chunks = cluster._Chunks([one, two, three, *more])
    tasks = iter(chunks)
    assert next(tasks) == (one,)
    chunks.took((one,), 1, 0.001)
    assert next(tasks) == (two, three, *more[:2])
    monkeypatch.setattr(cluster, "_open", lambda opener: None)
    monkeypatch.setattr(cluster, "answer_row", lambda *given: {"goal": given[1].goals[0]})
    opener = cast(Opener, None)
    rows, seconds = cluster._answer_some(opener, (two, three), None, None)
    assert [row["goal"] for row in rows] == ["1", "2"]
    monkeypatch.setattr(cluster, "_SECONDS", 0.0)
    rows, seconds = cluster._answer_some(opener, (two, three), None, None)
    assert [row["goal"] for row in rows] == ["1"]
    chunks.took((two, three), 1, seconds)
    chunks.again.append((three,))
    assert [next(tasks), next(tasks), next(tasks)] == [(three,), (three,), (more[2],)]
    assert {asked for chunk in tasks for asked in chunk} == set(more[3:])


@pytest.mark.slow
def test_no_scheduler_is_said(
    cli: Cli, questions: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("foon_asp.batch.cluster._PATIENCE", "0.5s")
    ran = cli("batch", questions, "--results", tmp_path / "a.jsonl", "--scheduler", "tcp://127.0.0.1:9")
    assert ran.code == 2
    assert "no scheduler at tcp://127.0.0.1:9" in ran.err
    secure = cli("batch", questions, "--results", tmp_path / "c.jsonl", "--scheduler", "tls://127.0.0.1:9")
    assert secure.code == 2
    assert "no scheduler at tls://127.0.0.1:9: TLS expects" in secure.err


def test_a_worker_opens_equal_data_once() -> None:
    one, other = (Opening((("level", 3),), "d") for _ in range(2))
    assert one == other
    assert hash(one) == hash(other)


@pytest.mark.slow
def test_a_store_gives_the_same_rows(cli: Cli, questions: Path, tmp_path: Path) -> None:
    with questions.open("a") as more:
        more.write('{"goal": "@goals", "containers": "implied"}\n')
    store = tmp_path / "kitchen.foon"
    assert cli("import", "--data", bundled_kitchen(), "--store", store).code == 0
    assert cli("batch", questions, "--results", tmp_path / "a.jsonl").code == 0
    ran = cli("batch", questions, "--results", tmp_path / "b.jsonl", "--network", store, "--jobs", 2)
    assert ran.code == 0
    ours, theirs = (
        {asked_by(row): (row["status"], row["costs"]) for row in rows_of(tmp_path / name)}
        for name in ("a.jsonl", "b.jsonl")
    )
    assert ours == theirs


def test_a_limit_is_a_row_that_says_so(cli: Cli, tmp_path: Path) -> None:
    """A question that takes more than there is costs its row."""
    file = tmp_path / "questions.jsonl"
    file.write_text('{"goal": ["ice", "macaroni"], "objective": "success"}\n')
    ran = cli("batch", file, "--results", tmp_path / "a.jsonl", "--memory-limit", "20M")
    assert ran.code == 3
    rows = rows_of(tmp_path / "a.jsonl")
    assert [row["status"] for row in rows] == ["unknown", "unknown"]
    assert all(row["error"].startswith("stopped at the memory limit of 20M while ") for row in rows)
    ran = cli("batch", file, "--results", tmp_path / "b.jsonl", "--memory-limit", "2G")
    assert ran.code == 0
    assert {row["status"] for row in rows_of(tmp_path / "b.jsonl")} == {"optimal"}
