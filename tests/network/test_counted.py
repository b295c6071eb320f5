"""Numbers with their nouns: one of a thing is not called several."""

from pathlib import Path

import foon_asp
from tests.conftest import Cli

ONE = "O\ttea\nM\tboil\nO\ttea\nS\thot\n//\n"


def test_one_unit_is_one_everywhere(tmp_path: Path, cli: Cli) -> None:
    one = tmp_path / "one.txt"
    one.write_text(ONE)
    items = tmp_path / "kitchen.txt"
    items.write_text("O\ttea\n")
    foon = foon_asp.load(one, kitchen=items)
    assert repr(foon.network) == "<Network: 1 unit, 2 object nodes, level 3>"
    merged = cli("merge", one, "-o", tmp_path / "out.txt")
    assert merged.err.endswith("1 file: 1 unit of 1 read, 2 object nodes\n")
    stored = cli("merge", one, "--store", tmp_path / "one.foon")
    assert "1 unit of 1 read, 2 object nodes" in stored.out
    assert cli("stats", one).out.startswith("1 unit read from 1 file, 0 source videos")
