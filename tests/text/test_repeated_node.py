"""A node that a unit of FOON text lists twice counts once, with a note; in other formats two are meant."""

from pathlib import Path

import pytest

from tests.conftest import Cli

FOON = "O\tlog\nM\tsaw\nO\tplank\n//\nO\tplank\nO\tplank\nM\tnail\nO\tstick\n//\n"
SAW = '{"id": "saw", "inputs": ["log"], "outputs": ["plank"]}\n'
TWO_IN = SAW + '{"id": "nail", "inputs": ["plank", "plank"], "outputs": ["stick"]}\n'
TWO_OUT = SAW + '{"id": "split", "inputs": ["plank"], "outputs": ["stick", "stick"]}\n'


def written(folder: Path, name: str, text: str, stored: bool, cli: Cli) -> str:
    file = folder / name
    file.write_text(text, encoding="utf-8")
    if not stored:
        return str(file)
    store = folder / "stored.foon"
    ran = cli("merge", str(file), "--store", str(store))
    assert ran.err.count("twice") == name.endswith(".txt"), ran.err
    return str(store)


@pytest.mark.parametrize("stored", [False, True])
@pytest.mark.parametrize("items", ["lasting", "used-up"])
def test_in_foon_text_it_is_one_note(cli: Cli, tmp_path: Path, items: str, stored: bool) -> None:
    more = FOON + FOON.replace("nail", "glue").replace("stick", "frame")
    file = written(tmp_path, "wood.txt", more, stored, cli)
    ran = cli("solve", file, "--goal", "stick", "--items", items)
    assert ran.code == 0
    assert ran.err.count("twice") == 1
    assert "2 units list" in ran.err
    assert "wood.txt:5" in ran.err
    assert "twice" not in cli("solve", file, "--goal", "stick", "--items", items, "--quiet").err


@pytest.mark.parametrize("stored", [False, True])
@pytest.mark.parametrize(("text", "units"), [(TWO_IN, 3), (TWO_OUT, 2)])
def test_in_neutral_lines_two_are_meant(
    cli: Cli, tmp_path: Path, text: str, units: int, stored: bool
) -> None:
    file = written(tmp_path, "wood.jsonl", text, stored, cli)
    lasting = cli("solve", file, "--goal", "stick")
    assert lasting.code == 0
    assert lasting.out.count("note: amounts") == 1
    ran = cli("solve", file, "--goal", "stick", "--items", "used-up")
    assert f"{units} units" in ran.out
    assert "2 x " in ran.out
    assert "twice" not in lasting.err + ran.err


def test_what_is_on_both_sides_is_not_twice(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "wood.jsonl"
    file.write_text(
        '{"id": "saw", "inputs": ["log", "saw"], "outputs": ["saw", "plank"]}\n', encoding="utf-8"
    )
    ran = cli("solve", str(file), "--goal", "plank", "--items", "used-up")
    assert ran.code == 0
    assert "twice" not in ran.err
