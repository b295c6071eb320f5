"""Numbers with their nouns: one of a thing is not called several."""

from pathlib import Path

import pytest

import foon_asp
from foon_asp.network import counted
from tests.conftest import Cli

ONE = "O\ttea\nM\tboil\nO\ttea\nS\thot\n//\n"


@pytest.mark.parametrize(("number", "said"), [(0, "0 units"), (1, "1 unit"), (1234, "1,234 units")])
def test_a_number_has_its_noun(number: int, said: str) -> None:
    assert counted(number, "unit", ",") == said


def test_one_unit_is_one_everywhere(tmp_path: Path, cli: Cli) -> None:
    one = tmp_path / "one.txt"
    one.write_text(ONE)
    items = tmp_path / "kitchen.txt"
    items.write_text("O\ttea\n")
    foon = foon_asp.load(one, kitchen=items)
    assert repr(foon.network) == "<Network: 1 unit, 2 object nodes, level 3>"
    merged = cli("merge", one, "-o", tmp_path / "out.txt")
    assert merged.err.split()[:10] == ["1", "file", "1", "unit", "read", "0", "of", "them", "duplicates", "1"]
    stored = cli("import", one, "--store", tmp_path / "one.foon")
    assert "1 unit of 1 read, 2 object nodes" in stored.out
    assert cli("stats", one).out.startswith("1 unit read from 1 file, 0 source videos")
    again = tmp_path / "twice"
    again.mkdir()
    (again / "FOON.txt").write_text(ONE + ONE)
    assert "1 of them is a copy of another" in cli("stats", "--network", again).out
