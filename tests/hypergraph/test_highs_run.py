"""HiGHS ends when time is up, however long a step of it takes."""

import subprocess
import sys
import threading
from collections.abc import Callable
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import highspy
import pytest

from foon_asp.hypergraph import highs_run
from foon_asp.hypergraph.covering import Covering
from foon_asp.plans.whole_program import Solved, Stopped, WholeProgram

Look = Callable[[object, object, object, Any, object], None]


class Endless:
    """In place of HiGHS: runs until it is told not to, when it asks; where it is ``deaf``, until let go."""

    def __init__(self, columns: int, rows: int, deaf: bool = False) -> None:
        self.size = columns, rows
        self.asked_by: list[Look] = []
        self.asked: list[bool] = []
        self.let_go = threading.Event()
        self.deaf = deaf
        self.most_steps = 4000

    def getNumCol(self) -> int:  # noqa: N802
        return self.size[0]

    def getNumRow(self) -> int:  # noqa: N802
        return self.size[1]

    def setOptionValue(self, name: str, value: object) -> None:  # noqa: N802
        assert (name, value) == ("simplex_iteration_limit", highspy.kHighsIInf)
        self.most_steps = highspy.kHighsIInf

    def setCallback(self, look: Look, _: object) -> None:  # noqa: N802
        self.asked_by = [look]

    def startCallback(self, kind: object) -> None:  # noqa: N802
        assert str(kind).endswith("Interrupt")

    def getModelStatus(self) -> object:  # noqa: N802
        return highspy.HighsModelStatus.kInterrupt

    def run(self) -> None:
        assert threading.current_thread() is not threading.main_thread()
        answer = SimpleNamespace(user_interrupt=False)
        while not answer.user_interrupt and not self.let_go.wait(0.001):
            if not self.deaf:
                self.asked.append(True)
                self.asked_by[0](0, "", None, answer, None)
        self.let_go.set()


@pytest.mark.parametrize(("columns", "rows", "whole"), [(6001, 0, False), (3000, 3001, False), (1, 1, True)])
def test_it_ends_where_it_asks_when_time_is_up(columns: int, rows: int, whole: bool) -> None:
    highs, looks = Endless(columns, rows), iter([False, True])
    assert not highs_run.run(highs, lambda: next(looks), whole)
    assert highs.let_go.is_set()
    assert highs.asked
    assert highs.most_steps == highspy.kHighsIInf  # whatever it had when the program was small


def test_where_it_does_not_end_nobody_waits_for_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(highs_run, "RUN", highs_run.RUN._replace(end_seconds=0.01))
    highs = Endless(9000, 9000, deaf=True)
    with pytest.raises(KeyboardInterrupt):
        highs_run.run(highs, lambda: True)
    assert not highs.let_go.is_set()
    highs.let_go.set()


def test_ctrl_c_ends_it_at_once() -> None:
    def pressed() -> bool:
        raise KeyboardInterrupt

    highs = Endless(9000, 9000)
    with pytest.raises(KeyboardInterrupt):
        highs_run.run(highs, pressed)
    assert highs.let_go.is_set()


def test_a_small_program_is_asked_for_some_steps_at_a_time() -> None:
    class Small(Endless):
        def __init__(self) -> None:
            super().__init__(3000, 3000)
            self.runs = 0

        def setOptionValue(self, name: str, value: object) -> None:  # noqa: N802
            assert (name, value) == ("simplex_iteration_limit", 4000)

        def run(self) -> None:
            assert threading.current_thread() is threading.main_thread()
            self.runs += 1

        def getModelStatus(self) -> object:  # noqa: N802
            status = highspy.HighsModelStatus
            return status.kIterationLimit if self.runs < 3 else status.kOptimal

    small = Small()
    assert highs_run.run(small, lambda: False)
    assert small.runs == 3
    small = Small()
    assert not highs_run.run(small, lambda: True)
    assert small.runs == 1


def test_large_programs_have_the_same_solutions(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(highs_run, "RUN", highs_run.RUN._replace(small_size=-1))
    program = WholeProgram(2)
    program.add_row({0: 2, 1: 1}, 3)
    assert program.solve({0: 2, 1: 3}) == Solved([1.5, 0.0], Fraction(3))
    assert program.whole_optimum({0: 2, 1: 3}) == [2.0, 0.0]
    covering = Covering([1.0] * 3)
    for row in ([0, 1], [1, 2], [0, 2]):
        covering.add_row(row)
    amid = covering.interior_point()
    assert amid is not None
    assert amid.value == pytest.approx(1.5)
    assert covering.solve().value == pytest.approx(1.5)
    monkeypatch.setattr("foon_asp.plans.whole_program.run", lambda *_: False)
    with pytest.raises(Stopped):
        program.solve({0: 1})


def test_nothing_is_written_where_answers_are() -> None:
    made = "from foon_asp.hypergraph.covering import Covering\nCovering([1.0]).solve()\n"
    run = subprocess.run([sys.executable, "-c", made], capture_output=True, check=True)
    assert (run.stdout, run.stderr) == (b"", b"")
