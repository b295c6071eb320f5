"""Progress at a terminal: how much of the networks has been read, and how far a search is."""

import io
import sys
import time
from pathlib import Path

import click
import pytest
from rich.console import Console

import foon_asp
from foon_asp.cli import progress_line
from foon_asp.deadline import Deadline
from foon_asp.problem import Objective
from foon_asp.text.reader import FoonReader

UNIT = "O\tcafé {0}\nM\tpour\nO\tcup {0}\n//\n"


@pytest.fixture
def network(tmp_path: Path) -> Path:
    file = tmp_path / "many.txt"
    file.write_text("//\n" + "".join(UNIT.format(number) for number in range(6_000)), encoding="utf-8")
    return file


def test_a_long_search_tells_what_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    tree = foon_asp.solve(foon_asp.load().problem("macaroni")).costs
    assert tree is not None
    monkeypatch.setattr(time, "monotonic", lambda: 100.0)
    shown = progress_line.Progress(Deadline(60))
    assert shown.line(102.0).startswith("nothing found yet  |  2 s, at most 60 s left")
    shown.tree(tree)
    shown.bound(Objective.UNITS, 3)
    assert (
        "9 units, 21 inputs, success ≈ 0.4988  |  proved: units at least 3  |  2 s, at most 60 s left"
        in shown.line(102.0)
    )
    shown.bound(Objective.UNITS, 7)  # four of six in two seconds
    assert "proved: units at least 7  |  2 s, about 1 s left at this pace" in shown.line(102.0)
    shown.bound(Objective.INPUTS, 18)  # another objective begins anew
    assert "proved: inputs at least 18  |  4 s, at most 60 s left" in shown.line(104.0)
    unlimited = progress_line.Progress()
    assert "|  5 s  |" in unlimited.line(105.0)
    unlimited.step("comparing", 10, 30)  # of which ten were there before
    assert unlimited.line(105.0) == "comparing: 10 of 30  |  5 s"
    unlimited.step("comparing", 15, 30)
    assert unlimited.line(105.0) == "comparing: 15 of 30  |  5 s, about 15 s left at this pace"


@pytest.mark.parametrize(
    ("terminal", "long", "shown"), [(True, 0.0, True), (True, 60.0, False), (False, 0.0, False)]
)
def test_only_a_terminal_sees_what_takes_long(
    network: Path, monkeypatch: pytest.MonkeyPatch, terminal: bool, long: float, shown: bool
) -> None:
    screen = io.StringIO()
    monkeypatch.setattr(progress_line, "_DELAY_SECONDS", long)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: terminal)
    monkeypatch.setattr(
        progress_line, "console", lambda err: Console(file=screen, force_terminal=True, width=100)
    )
    with click.Context(click.Command("solve")), progress_line.bytes_bar("reading", [network]):
        FoonReader().read_network([network])
    with progress_line.Progress() as told:
        told.step("answering", 3, 8)
        told.begin()
        end = time.monotonic() + 5
        while shown and "answering" not in screen.getvalue() and time.monotonic() < end:
            time.sleep(0.01)
    for text in ("reading", f"{network.stat().st_size / 1000:.1f} kB", "answering: 3 of 8"):
        assert (text in screen.getvalue()) is shown
