"""Amounts in files: neutral lines, JSON and tables, there and back, and what is wrong with them."""

import json
from pathlib import Path

import pytest

import foon_asp
from tests.conftest import Cli

pytestmark = pytest.mark.filterwarnings("ignore:No kitchen given:foon_asp.FoonWarning")

SAW = '{"id": "saw", "inputs": ["log"], "outputs": ["plank"]}\n'
CRAFT = '{"id": "craft", "inputs": {"plank": 2}, "outputs": {"stick": 4}}\n'
FOON = "O\tlog\nM\tsaw\nO\tplank\n//\nO\tplank\nM\tcraft\nO\tstick\n//\n"


def file(folder: Path, text: str, name: str = "wood.jsonl") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def sticks(path: Path, unit_amounts: Path | None = None) -> int:
    """Return how many units seven sticks take."""
    problem = foon_asp.load(path, unit_amounts=unit_amounts).problem("stick", amounts=7)
    costs = foon_asp.solve(problem).costs
    assert costs is not None
    return costs.units


def test_seven_sticks_four_to_a_craft_of_two_planks_are_six_units(tmp_path: Path) -> None:
    assert sticks(file(tmp_path, SAW + CRAFT)) == 6
    repeated = (
        '{"id": "craft", "inputs": ["plank", "plank"], "outputs": ["stick", "stick", "stick", "stick"]}\n'
    )
    assert sticks(file(tmp_path, SAW + repeated)) == 6
    table = file(tmp_path, "craft\tplank\t2\ncraft\t->\tstick\t4\n", "amounts.txt")
    text = file(tmp_path, FOON, "wood.txt")
    assert sticks(text, unit_amounts=table) == 6
    assert sticks(text) == 14


def test_a_table_in_the_folder_takes_precedence(tmp_path: Path) -> None:
    file(tmp_path, SAW + CRAFT)
    file(tmp_path, "# two to a craft\ncraft\t→\tstick\t2\n", "unit_amounts.txt")
    assert sticks(tmp_path) == 12


@pytest.mark.parametrize("dialect", ["neutral", "json", "json-list"])
def test_conversions_keep_amounts(tmp_path: Path, cli: Cli, dialect: str) -> None:
    there, back = tmp_path / "there.json", tmp_path / "back.jsonl"
    source = file(tmp_path, SAW + CRAFT)
    there = there.with_suffix(".jsonl") if dialect == "neutral" else there
    assert "nothing is lost" in cli("convert", str(source), "--to", dialect, "-o", str(there)).err
    cli("convert", str(there), "--to", "neutral", "-o", str(back))
    assert back.read_text(encoding="utf-8") == SAW + CRAFT
    assert sticks(there) == 6


def test_foon_text_cannot_hold_them_and_it_is_said(tmp_path: Path, cli: Cli) -> None:
    source = file(tmp_path, SAW + CRAFT)
    ran = cli("convert", str(source), "--to", "plain", "-o", str(tmp_path / "wood.txt"))
    assert "1  amounts of object nodes" in ran.err
    assert "FOON text has no amounts" in cli("merge", str(source), "-o", str(tmp_path / "merged.txt")).err


def test_a_store_keeps_them(tmp_path: Path, cli: Cli) -> None:
    source, store = file(tmp_path, SAW + CRAFT), tmp_path / "wood.foon"
    assert cli("merge", str(source), "--store", str(store)).code == 0
    assert sticks(store) == 6
    table = file(tmp_path, "craft\tplank\t2\n", "amounts.txt")
    assert (
        "beside text alone" in cli("solve", str(store), "--goal", "stick", "--unit-amounts", str(table)).err
    )


@pytest.mark.parametrize(
    ("inputs", "message"),
    [
        ('{"plank": 0}', "expected a whole number from 1 to 1000000"),
        ('{"plank": 1.5}', "expected a whole number from 1 to 1000000"),
        ('{"plank": "2"}', None),
        ('{"plank": 1000001}', "expected a whole number from 1 to 1000000"),
        ('"plank"', "expected a list of names, or amounts by name"),
    ],
)
def test_what_is_no_amount_is_refused(tmp_path: Path, cli: Cli, inputs: str, message: str | None) -> None:
    source = file(tmp_path, SAW + f'{{"id": "craft", "inputs": {inputs}, "outputs": ["stick"]}}\n')
    ran = cli("solve", str(source), "--goal", "stick")
    assert ran.code == (0 if message is None else 2)
    if message is not None:
        assert "wood.jsonl:2:" in ran.err
        assert message in ran.err


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ("craft\tplank\n", ":1:7: error: found 'plank', expected an amount, from 1 to 1000000"),
        ("craft\tplank\tmany\n", ":1:13: error: found 'many', expected an amount, from 1 to 1000000"),
        ("craft\tplank\t2\ncraft\tplank\t3\n", ":2:13: error: found a second amount"),
        ("craft\tstick\t2\n", "no unit 'craft' takes 'stick'"),
    ],
)
def test_a_wrong_row_is_named_in_place(tmp_path: Path, cli: Cli, row: str, message: str) -> None:
    source, table = file(tmp_path, FOON, "wood.txt"), file(tmp_path, row, "amounts.txt")
    assert message in cli("solve", str(source), "--goal", "stick", "--unit-amounts", str(table)).err


def test_copies_that_disagree_are_an_error_where_they_count(tmp_path: Path, cli: Cli) -> None:
    source = str(file(tmp_path, SAW + CRAFT + CRAFT.replace("4", "3")))
    assert cli("solve", source, "--goal", "stick").code == 0
    ran = cli("solve", source, "--goal", "stick", "--items", "used-up")
    assert ran.code == 2
    assert "wood.jsonl:3" in ran.err
    assert "wood.jsonl:2 with other amounts" in ran.err
    plain = str(file(tmp_path, SAW + CRAFT + '{"id": "craft", "inputs": ["plank"], "outputs": ["stick"]}\n'))
    assert cli("solve", plain, "--goal", "stick", "--items", "used-up").code == 2


def test_an_answer_in_json_has_amounts_and_is_read_back(tmp_path: Path, cli: Cli) -> None:
    source, plan = str(file(tmp_path, SAW + CRAFT)), tmp_path / "plan.json"
    plan.write_text(cli("solve", source, "--goal", "stick", "--amount", "7", "--format", "json").out)
    saw, craft = json.loads(plan.read_text(encoding="utf-8"))["units"]
    assert (saw["times"], craft["times"]) == (4, 2)
    assert (craft["inputs"][0]["amount"], craft["outputs"][0]["amount"]) == (2, 4)
    wanted = ("--network", source, "--goal", "stick", "--items", "used-up")
    assert "executes as listed" in cli("check", str(plan), *wanted, "--amount", "8").out
    short = cli("check", str(plan), *wanted, "--amount", "9")
    assert short.code == 1
    assert "9 x stick" in short.out


def test_lint_reports_repeats_in_foon_text_alone(tmp_path: Path, cli: Cli) -> None:
    assert "repeated-object" not in cli("lint", str(file(tmp_path, SAW + CRAFT))).out
    twice = file(tmp_path, FOON.replace("O\tplank\nM\tcraft", "O\tplank\nO\tplank\nM\tcraft"), "twice.txt")
    assert "repeated-object" in cli("lint", str(twice)).out
