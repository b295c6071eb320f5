"""Amounts in files: neutral lines, JSON and tables, there and back, and what is wrong with them."""

import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import foon_asp
from foon_asp.network import DataAmounts, FunctionalUnit
from foon_asp.text.conversion import Converter
from foon_asp.text.format import Dialect
from foon_asp.text.line_parser import parse_node
from foon_asp.text.merged_network import merged_text
from foon_asp.text.reader import FoonReader
from foon_asp.text.stated_amounts import counted_amounts
from foon_asp.text.writer import write_units
from tests.conftest import Cli
from tests.text.foon_strategies import steady

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


def test_foon_text_holds_them_in_comments(tmp_path: Path, cli: Cli) -> None:
    source, text = file(tmp_path, SAW + CRAFT), tmp_path / "wood.txt"
    assert "nothing is lost" in cli("convert", str(source), "--to", "plain", "-o", str(text)).err
    assert text.read_text(encoding="utf-8").endswith(
        "O\tplank\n# Amount:\t2\nM\tcraft\nO\tstick\n# Amount:\t4\n//\n"
    )
    back = cli("convert", str(text), "--to", "neutral")
    assert (back.out, "nothing is lost" in back.err) == (SAW + CRAFT, True)
    merged = tmp_path / "merged.txt"
    assert cli("merge", str(text), "-o", str(merged)).code == 0
    again = cli("merge", str(merged))
    assert (again.out, sticks(merged)) == (merged.read_text(encoding="utf-8"), 6)


def test_merging_takes_amounts_from_a_table_and_refuses_copies_that_disagree(
    tmp_path: Path, cli: Cli
) -> None:
    source = str(file(tmp_path, SAW + CRAFT))
    table = file(tmp_path, "craft\tplank\t3\n", "amounts.txt")
    assert "O\tplank\n# Amount:\t3\nM\tcraft" in cli("merge", source, "--unit-amounts", str(table)).out
    other = str(file(tmp_path, CRAFT.replace("4", "3"), "other.jsonl"))
    ran = cli("merge", source, other)
    assert (ran.code, "with other amounts" in ran.err) == (2, True)


@pytest.mark.parametrize(
    ("mark", "message"),
    [
        (
            "# Amount:\tmany",
            ":2:11: error: found the amount 'many', expected a whole number from 1 to 1000000",
        ),
        ("# Amount: 0", ":2:11: error: found the amount '0'"),
        ("# Amount:\t1000001", ":2:11: error: found the amount '1000001'"),
        ("# Amount:\t-2", ":2:11: error: found the amount '-2'"),
        ("# Amount:\t2\n# Amount:\t3", ":3:1: error: found a second amount"),
        ("M\tdry\n# Amount:\t2", ":3:1: error: found an amount, expected one under an object line"),
    ],
)
def test_a_wrong_mark_is_named_in_place(tmp_path: Path, cli: Cli, mark: str, message: str) -> None:
    source = file(tmp_path, f"O\tlog\n{mark}\nM\tsaw\nO\tplank\n//\n", "wood.txt")
    ran = cli("solve", str(source), "--goal", "plank")
    assert (ran.code, message in ran.err) == (2, True)
    assert message.partition("error: ")[2] in cli("lint", str(source)).out


NODES = [*map(parse_node, ("a", "b; hot", "c; in [d]", "e; contains {f,g}", "b"))]


@settings(steady, max_examples=60)
@given(st.data())
def test_every_dialect_keeps_amounts(tmp_path_factory: pytest.TempPathFactory, data: st.DataObject) -> None:
    side = st.lists(st.sampled_from(NODES), min_size=1, max_size=3)
    unit = st.builds(FunctionalUnit.of, st.sampled_from(["mix", "chop"]), side, side)
    drawn = data.draw(st.lists(unit, min_size=1, max_size=3))
    amounts = {
        one: counted_amounts(
            *([(node, data.draw(st.integers(1, 3))) for node in nodes] for nodes in (one.inputs, one.outputs))
        )
        for one in drawn
    }
    expected = {one: counted for one, counted in amounts.items() if counted}
    text, folder = write_units(drawn, (), amounts), tmp_path_factory.getbasetemp()
    for target in data.draw(st.permutations([d for d in Dialect if d is not Dialect.NEUTRAL])):
        text = Converter(target).convert(text, "a").text
        path = folder / f"{target}.any"
        path.write_text(text, encoding="utf-8", newline="")
        reader = FoonReader()
        merged = reader.read_network([path])
        assert reader.amounts.amounts_by_unit(merged) == DataAmounts(expected)
        path.write_text("".join(merged_text(merged, "a", expected)), encoding="utf-8", newline="")
        again = FoonReader()
        assert again.amounts.amounts_by_unit(again.read_network([path])) == DataAmounts(expected)


@pytest.mark.filterwarnings("ignore:note. 1 unit lists:foon_asp.FoonWarning")
def test_a_node_that_text_repeats_counts_once_in_every_dialect(tmp_path: Path, cli: Cli) -> None:
    twice = file(tmp_path, FOON.replace("O\tplank\nM\tcraft", "O\tplank\nO\tplank\nM\tcraft"), "twice.txt")
    for dialect in ("neutral", "json", "json-list"):
        converted = tmp_path / ("one.jsonl" if dialect == "neutral" else "one.json")
        cli("convert", str(twice), "--to", dialect, "-o", str(converted))
        assert sticks(converted) == sticks(twice) == 14


def test_diff_shows_amounts_that_differ(tmp_path: Path, cli: Cli) -> None:
    a, b = file(tmp_path, SAW + CRAFT, "a.jsonl"), file(tmp_path, SAW + CRAFT.replace("4", "3"), "b.jsonl")
    ran = cli("diff", str(a), str(b))
    assert ran.out.endswith(
        "other amounts: 1 object node\n  craft    [a.jsonl:2]  makes 4 x stick in A, 3 x in B\n"
    )
    (difference,) = cli("diff", str(a), str(b), "--format", "json").json["other_amounts"]
    assert (difference["side"], difference["a"], difference["b"]) == ("outputs", 4, 3)
    assert "other amounts" not in cli("diff", str(a), str(a)).out


@pytest.mark.filterwarnings("ignore:.*takes 'log':foon_asp.FoonWarning")
def test_a_store_keeps_them_and_a_table_beside_it_takes_precedence(tmp_path: Path, cli: Cli) -> None:
    source, store = file(tmp_path, SAW + CRAFT), tmp_path / "wood.foon"
    assert cli("merge", str(source), "--store", str(store)).code == 0
    assert sticks(store) == 6
    table = file(tmp_path, "craft\t->\tstick\t7\ncraft\tlog\t2\n", "amounts.txt")
    assert sticks(store, unit_amounts=table) == 3
    words = ("--goal", "stick", "--unit-amounts", str(table))
    assert "no unit 'craft' takes 'log'" in cli("solve", str(store), *words).err
    other = tmp_path / "other.foon"
    ran = cli("merge", str(source), "--store", str(other), "--unit-amounts", str(table))
    assert (ran.code, "no unit 'craft' takes 'log'" in ran.err) == (0, True)
    assert sticks(other) == 3


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
