"""Thousands of questions in one run: every one gets exactly one row, whatever happens."""

import contextlib
import csv
import json
import os
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from msgspec import structs

import foon_asp
from foon_asp.batch.answer_row import ANSWERS, AnswerRow, answer_row
from foon_asp.batch.answer_table import write_table
from foon_asp.batch.batch_question import BatchQuestion
from foon_asp.batch.cluster import answer_on_cluster
from foon_asp.batch.question_file import read_questions
from foon_asp.batch.workers import answer_all
from foon_asp.comparison.rows_file import RowsFile
from foon_asp.errors import UserError
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.resources import bundled_kitchen
from foon_asp.text.data_folder import find_data, read_data
from foon_asp.text.diagnostics import InputError
from foon_asp.text.node_lookup import find_goal
from tests.conftest import ROOT, Cli, valid

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
    foon = foon_asp.load()
    for row in rows:
        names = [row["goal"]] if isinstance(row["goal"], str) else row["goal"]
        asked = foon.vary(kitchen=[]) if row["kitchen"] else foon
        problem = asked.problem(*names, containers=row["containers"])
        answer = foon_asp.solve(problem, row["objective"]).json()
        assert (row["status"], row["costs"]) == (answer["status"], answer["costs"])
        assert row["units"] is None or len(row["units"]) == row["costs"]["units"]


def test_rules_hold_for_all_questions(cli: Cli, questions: Path, tmp_path: Path) -> None:
    given = ["--constraint", "at_most_units", "-c", "max_units=9", "--rule", ':- use(U), motion(U,"crush").']
    batch = ["batch", questions, "--results", tmp_path / "a.jsonl"]
    assert cli(*batch, *given).code == 0
    rows = rows_of(tmp_path / "a.jsonl")
    assert {row["status"] for row in rows} == {"optimal", "infeasible"}
    for row in rows[:6]:
        goals = ["--goal", row["goal"], "--containers", row["containers"], "--objective", row["objective"]]
        answer = cli("solve", *goals, *given, "--format", "json").json
        assert (answer["status"], answer["costs"]) == (row["status"], row["costs"])
    assert "10 of them answered before" in cli(*batch, *given).out
    for others in (given[:4], [*given[:3], "max_units=8", *given[4:]], []):
        assert "was started for another question" in cli(*batch, *others).err


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


@pytest.mark.parametrize(
    ("line", "place", "message"),
    [
        ("{", "1:2", "not JSON"),
        ('{"goal": "ice",\t}', "1:15", "not JSON: found a comma before }, expected none"),
        ('{"objective": "units"}', "1:1", "expected an object such as"),
        ('{"goal": "ice", "goals": 1}', "1:1", "found the key 'goals', expected one of goal, objective"),
        ('{"goal": []}', "1:1", "found an empty list"),
        ('{"goal": "@all"}', "1:1", "found the goal '@all'"),
        ('{"goal": [["ice", "@goals"]]}', "1:1", "by itself"),
        ('{"goal": "ice", "containers": "loose"}', "1:1", "found the containers 'loose', expected strict or"),
        (
            '{"goal": "ice", "time_limit": "1 s"}',
            "1:1",
            "Expected `float | null`, got `str` - at",
        ),
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

    def goals_of_word(self, word: str, containers: ContainerRule, kitchen: str | None) -> Sequence[str]:
        return ()

    def items(self, asked: BatchQuestion) -> str:
        return "lasting"

    def problem(self, asked: BatchQuestion) -> Problem:
        (name,) = asked.goals
        if name == "die":
            os.kill(os.getpid(), signal.SIGKILL)
        if name == "leave":
            sys.exit(5)
        while name == "sleep":
            with contextlib.suppress(KeyboardInterrupt):
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
def test_one_question_never_ends_the_run(jobs: int) -> None:
    names = ["ice", "die", "macaroni", "sleep", "leave", "break", "greek salad"]
    questions = [BatchQuestion(name, time_limit=5.0 if name != "sleep" else 0.1) for name in names]
    answered = answer_all(OpenMisbehaving(), questions, jobs, grace=0.5 if jobs == 1 else 1.0)
    rows = {row.goals[0]: row for row in answered}
    assert set(rows) == set(names)
    statuses = {name: row.status for name, row in rows.items()}
    good = {"ice", "macaroni", "greek salad"}
    assert statuses == {name: "optimal" if name in good else "failed" for name in names}
    assert "was killed by SIGKILL" in str(rows["die"].error)
    assert "exit code 5" in str(rows["leave"].error)
    assert "no answer within the time limit" in str(rows["sleep"].error)
    assert "a bug of foon-asp: ZeroDivisionError" in str(rows["break"].error)


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


# --- one run at a time

NAMES = pytest.mark.parametrize("name", ["a.jsonl", "a.csv", "a.parquet"])


@NAMES
def test_results_are_written_by_one_run_and_a_row_that_stands_twice_is_reported(
    cli: Cli, questions: Path, tmp_path: Path, name: str
) -> None:
    if name.endswith(".parquet"):
        pytest.importorskip("pyarrow")
    rows = tmp_path / (name if name.endswith(".jsonl") else f"{name}.jsonl")
    words = ["batch", str(questions), "--results", str(tmp_path / name)]
    assert cli(*words).err.count("warning") == 0
    first, *lines = rows.read_text().splitlines(keepends=True)
    before = {file: file.read_bytes() for file in tmp_path.iterdir()}
    with RowsFile(rows, ANSWERS, json.loads(first)["question"]):
        ran = cli(*words)
        assert (ran.code, ran.out) == (2, "")
        assert "another run is writing it" in ran.err
    assert before == {file: file.read_bytes() for file in tmp_path.iterdir()}
    rows.write_text("".join([first, *lines, lines[1]]))
    again = cli(*words)
    assert again.code == 0
    assert f"{rows}:{len(lines) + 2}: warning: a row of the same question as line 3" in again.err


# --- tables


def test_tables_have_a_column_for_each_cost_and_each_part_of_a_question(tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    row = answer_row(Misbehaving(), BatchQuestion("ice", "attempts"))
    row = structs.replace(row, goal=("ice", "macaroni"))
    assert row.costs is not None
    row.costs.update(price=Fraction(1, 3), washing=2)
    failed = AnswerRow("=none", status="failed", error="unknown")
    objectives = (*Objective, Objective.of_measure("washing"))
    for name in ("a.csv", "a.parquet"):
        write_table(tmp_path / name, [row, failed], objectives)
    one, other = parquet.read_table(tmp_path / "a.parquet").to_pylist()
    assert (one["goal"], other["goal"]) == (["ice", "macaroni"], ["=none"])
    for cost, figure in row.costs.items():
        number, text = (float(figure), str(figure)) if isinstance(figure, Fraction) else (figure, None)
        assert (one[f"costs.{cost}"], one.get(f"costs.{cost}_exact")) == (number, text)
        assert other[f"costs.{cost}"] is None
    assert one["lower_bound.attempts_exact"] == one["costs.attempts_exact"]
    assert one["units"] == list(row.units or ())
    with (tmp_path / "a.csv").open(newline="") as file:
        first, second = csv.DictReader(file)
    assert list(first) == list(one)
    assert (first["goal"], second["goal"]) == ("ice + macaroni", "'=none")
    assert (first["costs.price_exact"], first["runs_used_up"]) == ("1/3", str(row.runs_used_up).lower())


@pytest.mark.parametrize("name", ["a.csv", "a.parquet"])
def test_a_table_has_all_rows_of_an_interrupted_run(
    cli: Cli, questions: Path, tmp_path: Path, name: str
) -> None:
    if name.endswith(".parquet"):
        pytest.importorskip("pyarrow")
    words = ["batch", str(questions), "--results", str(tmp_path / name)]
    assert cli(*words).code == 0
    table, rows = (tmp_path / name).read_bytes(), tmp_path / f"{name}.jsonl"
    rows.write_bytes(rows.read_bytes()[:-20])
    (tmp_path / name).unlink()
    assert "9 of them answered before" in cli(*words).out
    assert len((tmp_path / name).read_bytes()) == pytest.approx(len(table), abs=200)  # seconds differ
    rows.unlink()
    ran = cli(*words)
    assert (ran.code, "was not made from" in ran.err) == (2, True)


# --- a cluster


@pytest.fixture
def scheduler(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[str]:
    """Start a scheduler and two workers on this machine, and give its address."""
    pytest.importorskip("distributed")
    named = tmp_path / "scheduler.json"
    env = {**os.environ, "PYTHONPATH": str(ROOT), **getattr(request, "param", {})}
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


@dataclass(frozen=True)
class Deadly:
    """Data, to be opened, of which one goal kills the process that asks for it, and another one does so once.

    Without a problem for any other.
    """

    folder: Path

    def __call__(self) -> "Deadly":
        return self

    def goals_of_word(self, *_: object) -> Sequence[str]:
        return ()

    def items(self, _: BatchQuestion) -> str:
        return "lasting"

    def problem(self, asked: BatchQuestion) -> Problem:
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
    tmp_path: Path, scheduler: str
) -> None:
    goals = [*map(str, range(30)), "once", *map(str, range(30, 47)), "deadly", *map(str, range(47, 70))]
    rows = [*answer_on_cluster(Deadly(tmp_path), [BatchQuestion(goal) for goal in goals], scheduler)]
    assert (tmp_path / "once").exists()
    assert Counter(row.goal for row in rows) == Counter(goals)
    errors = {row.goal: str(row.error) for row in rows}
    assert errors.pop("deadly").startswith("on the cluster: ")
    assert errors == {goal: f"answered {goal}" for goal in goals if goal != "deadly"}


@pytest.mark.slow
def test_no_scheduler_is_said(
    cli: Cli, questions: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("foon_asp.batch.cluster._PATIENCE", "0.5s")
    ran = cli("batch", questions, "--results", tmp_path / "a.jsonl", "--scheduler", "tcp://127.0.0.1:9")
    assert ran.code == 2
    assert "no scheduler at tcp://127.0.0.1:9" in ran.err


def test_a_limit_is_a_row_that_says_so(cli: Cli, tmp_path: Path) -> None:
    """A question that takes more than there is costs its row."""
    file = tmp_path / "questions.jsonl"
    file.write_text('{"goal": ["ice", "macaroni"], "objective": "success"}\n')
    ran = cli("batch", file, "--results", tmp_path / "a.jsonl", "--memory-limit", "20M")
    assert ran.code == 3
    rows = rows_of(tmp_path / "a.jsonl")
    assert [row["status"] for row in rows] == ["unknown", "unknown"]
    assert all(row["error"].startswith("stopped at the memory limit of 20M while ") for row in rows)
