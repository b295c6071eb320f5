"""What a file with a tree is about: its own units where no data are named, and the goal of an answer."""

from pathlib import Path

import pytest

from foon_asp.resources import bundled_kitchen
from tests.conftest import Cli

EGGS = """\
O\tegg
S\twhole
M\tcrack
O\tegg
S\tcracked
//
O\tegg
S\tcracked
O\tpan
M\tfry
O\tegg
S\tfried
//
"""
GOAL = "egg; fried"
TIMES = "".join(f"{motion}\t9\n" for motion in ("crack", "fry", "twist", "crush"))
NAMED_BY_NOBODY = "No --network: using "


@pytest.fixture
def eggs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("times.txt").write_text(TIMES)
    file = Path("eggs.txt")
    file.write_text(EGGS)
    return file


@pytest.mark.parametrize("words", [("check",), ("trace",), ("schedule", "--durations", "times.txt")])
def test_a_tree_without_data_is_its_own_network(cli: Cli, eggs: Path, words: tuple[str, ...]) -> None:
    verb, *options = words
    alone = cli(verb, eggs, *options, "--format", "json")
    assert (alone.code, [goal["node"] for goal in alone.json["goals"]]) == (0, [GOAL])
    assert f"{NAMED_BY_NOBODY}eggs.txt\nNo --goal: using what the last step makes: {GOAL}" in alone.err
    assert alone.out == cli(verb, eggs, eggs, *options, "--goal", GOAL, "--format", "json").out


def test_verbs_with_a_tree_among_their_options_take_it_too(cli: Cli, eggs: Path) -> None:
    alone = cli("view", "--tree", eggs, "--format", "dot")
    assert (alone.code, alone.out) == (0, cli("view", "--tree", eggs, eggs, "--format", "dot").out)
    assert f"{NAMED_BY_NOBODY}eggs.txt" in alone.err
    boiled = Path("boiled.txt")
    boiled.write_text(EGGS.replace("fried", "boiled"))
    two = cli("diff", eggs, boiled, "--goal", GOAL)
    assert (two.code, "in both: 1 unit" in two.out) == (0, True)
    assert f"{NAMED_BY_NOBODY}eggs.txt and boiled.txt" in two.err


def test_a_tree_of_the_bundled_kitchen_is_about_that(cli: Cli, eggs: Path) -> None:
    tree = Path("ice.txt")
    tree.write_text(cli("solve", "--goal", "ice", "--format", "foon").out)
    assert cli("check", tree).out == cli("check", tree, "--data", bundled_kitchen()).out
    ice = tree.read_text()
    tree.write_text(EGGS + ice)
    mixed = cli("check", tree, "--goal", "ice")
    assert mixed.code == 1
    said = "no --network: using the bundled kitchen, which has 2 of 4 units"
    assert said in mixed.err
    tree.write_text("".join(ice.partition("//\n")[:2]) + EGGS)  # one of three
    assert cli("check", tree, "--goal", GOAL).out == cli("check", tree, tree, "--goal", GOAL).out


@pytest.mark.parametrize("words", [("check",), ("trace",), ("schedule", "--durations", "times.txt")])
def test_an_answer_knows_its_goal(cli: Cli, eggs: Path, words: tuple[str, ...]) -> None:
    verb, *options = words
    answer = Path("i.json")
    answer.write_text(cli("solve", "--goal", "ice", "--containers", "implied", "--format", "json").out)
    found = cli(verb, answer, *options, "--format", "json")
    assert found.code == 0
    assert found.json["containers"] == "implied"
    assert [goal["label"] for goal in found.json["goals"]] == ["ice"]
    assert "No --goal" not in found.err


def test_an_answer_about_other_data_says_what_to_name(cli: Cli, eggs: Path) -> None:
    Path("e.json").write_text(cli("solve", eggs, "--format", "json").out)
    for words in (("check", "e.json"), ("trace", "e.json")):
        refused = cli(*words)
        assert (refused.code, refused.out) == (2, "")
        assert "e.json: not of the bundled kitchen; name the data with --network: eggs.txt" in refused.err
        assert cli(*words, "--network", eggs).code == 0
    assert cli("diff", "e.json", eggs).code == 0


def test_warnings_of_a_file_that_is_tree_and_data_are_printed_once(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "eggs.txt"
    file.write_text("O\tegg\nM\tcrack\nO\tegg\nS\tcracked\n//\nO\tmilk\nM\tspill\n//\n", encoding="utf-8")
    for words in (("check", str(file)), ("check", str(file), "--network", str(file)), ("trace", str(file))):
        ran = cli(*words)
        assert ran.err.count("the unit 'spill' has no output objects") == 1
        assert ran.err.count("No --goal") == 1
