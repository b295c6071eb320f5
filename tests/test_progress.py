"""Progress at a terminal: how much of the networks has been read."""

import io
import sys
from pathlib import Path

import click
import pytest
from rich.console import Console

from foon_asp.cli import progress
from foon_asp.text.bytes_read import telling
from foon_asp.text.reader import FoonReader

UNIT = "O\tcafé {0}\nM\tpour\nO\tcup {0}\n//\n"


@pytest.fixture
def network(tmp_path: Path) -> Path:
    file = tmp_path / "many.txt"
    file.write_text("//\n" + "".join(UNIT.format(number) for number in range(6_000)), encoding="utf-8")
    return file


def test_all_bytes_of_a_network_are_told_piece_by_piece(network: Path) -> None:
    told: list[int] = []
    with telling(told.append):
        FoonReader().read_network([network])
    assert len(told) > 2
    assert max(told) < 100_000
    assert sum(told) == network.stat().st_size
    FoonReader().read_network([network])
    assert sum(told) == network.stat().st_size


@pytest.mark.parametrize(
    ("terminal", "long", "shown"), [(True, 0.0, True), (True, 60.0, False), (False, 0.0, False)]
)
def test_only_a_terminal_sees_long_reading(
    network: Path, monkeypatch: pytest.MonkeyPatch, terminal: bool, long: float, shown: bool
) -> None:
    screen = io.StringIO()
    monkeypatch.setattr(progress, "_LONG", long)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: terminal)
    monkeypatch.setattr(progress, "console", lambda err: Console(file=screen, force_terminal=True, width=100))
    with click.Context(click.Command("solve")), progress.bytes_bar("reading", [network]):
        FoonReader().read_network([network])
    assert ("reading" in screen.getvalue()) is shown
    size = f"{network.stat().st_size / 1000:.1f} kB"
    assert (size in screen.getvalue()) is shown
