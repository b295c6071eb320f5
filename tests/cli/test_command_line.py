"""``foon-asp`` as a user meets it: results on stdout, messages on stderr, documented exit codes."""

from pathlib import Path

import click
import pytest

from foon_asp.cli.main import cli as group
from tests.conftest import Cli

# A pancake by two ways: a risky flip, or a slow bake that is safe. The kitchen has no flour in the bowl.
NETWORK = """\
# Source:\thttps://example.org/pancake
//
O\tbowl
S\tempty
O\tflour
S\tin\t[bag]
O\tbag
S\tcontains\t{flour}
M\tpour
O\tbowl
S\tcontains\t{flour}
//
O\tbowl
S\tcontains\t{flour}
O\tmilk
M\tmix
O\tbatter
S\tin\t[bowl]
//
O\tbatter
S\tin\t[bowl]
O\tpan
S\thot
M\tfry
O\tpancake
S\traw on top
S\tin\t[pan]
//
O\tpancake
S\traw on top
S\tin\t[pan]
M\tflip
O\tpancake
S\tdone
//
O\tbatter
S\tin\t[bowl]
O\toven
S\thot
O\tpan
S\thot
O\ttray
M\tbake
O\tpancake
S\tdone
//
O\tpancake
S\tdone
O\tplate
M\tserve
O\tpancake
S\tdone
S\ton\t[plate]
//
O\tcake
S\tcold
M\twarm up
O\tcake
S\twarm
//
"""
KITCHEN = """[
  {"label": "bowl", "states": ["empty"], "ingredients": [], "container": null},
  {"label": "flour", "states": [], "ingredients": [], "container": "bag"},
  {"label": "bag", "states": [], "ingredients": ["flour"], "container": null},
  {"label": "milk"}, {"label": "pan", "states": ["hot"]}, {"label": "oven", "states": ["hot"]},
  {"label": "tray"}, {"label": "plate"}
]
"""
RATES = "pour\t0.9\nmix\t0.9\nfry\t0.8\nflip\t0.5\nbake\t0.3\nserve\t1\nwarm up\t0.9\n"
GOALS = '[{"label": "pancake", "states": ["done"], "ingredients": [], "container": "plate"}]'


@pytest.fixture
def data(tmp_path: Path) -> Path:
    folder = tmp_path / "pancake"
    folder.mkdir()
    (folder / "FOON.txt").write_text(NETWORK)
    (folder / "kitchen.json").write_text(KITCHEN)
    (folder / "motion.txt").write_text(RATES)
    (folder / "utensils.txt").write_text("bag\n")
    (folder / "goal_nodes.json").write_text(GOALS)
    return folder


def test_check_reads_answers_and_is_as_lenient_as_asked(cli: Cli, data: Path, tmp_path: Path) -> None:
    answer, tree = tmp_path / "answer.json", tmp_path / "tree.txt"
    answer.write_text(cli("solve", "--data", data, "--format", "json").out)
    as_text = cli("solve", "--data", data, "--format", "foon").out
    tree.write_text(as_text + "nonsense\n")
    executes = "executes as listed (strict containers)\n4 units, 11 inputs, success 0.243\n"
    assert cli("check", answer, "--data", data).out == executes
    assert cli("check", tree, "--data", data).code == 2
    lenient = cli("check", tree, "--data", data, "--lenient")
    assert lenient.out == executes
    assert f"{tree}:" in lenient.err


def test_check_finds_an_order_or_says_what_is_missing(cli: Cli, data: Path, tmp_path: Path) -> None:
    tree = tmp_path / "tree.txt"
    pour, mix, _fry, _flip, bake, serve, warm = [block for block in NETWORK.split("//\n")[1:] if block]
    for units, code, said in (
        ([serve, mix, pour, bake], 0, "as listed: unit 1, serve    [tree.txt:1], lacks pancake; done"),
        ([mix, bake, serve], 1, "bowl; contains {flour}"),
        ([pour, mix], 1, "every unit runs, but the goal is not made: pancake; done; on [plate]"),
        ([pour, mix, bake, serve, warm.replace("warm up", "heat")], 1, "unit 5 is not in the network: heat"),
    ):
        tree.write_text("//\n".join([*units, ""]))
        ran = cli("check", tree, "--data", data)
        assert (ran.code, said in ran.out) == (code, True)


def test_a_goal_in_the_kitchen_needs_nothing(cli: Cli, data: Path) -> None:
    ran = cli("solve", "--data", data, "--goal", "milk")
    assert ran.code == 0
    assert "0 units, 0 inputs, success 1" in ran.out
    assert "nothing to do" in ran.out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--goal", "panckae"], "no object node has the label 'panckae'; similar are"),
        (["--goal", "pancake; burnt"], "no object node is exactly 'pancake; burnt'"),
        (["--goal", "bowl"], "means 2 object nodes; paste the one you mean"),
        (["--data", "/no/such/folder"], "/no/such/folder: no such file or folder"),
        (["--constraint", "nothing.lp"], "nothing.lp: no such file"),
        (["-c", "nothing=1"], "no encoding in use has the constant 'nothing'"),
        (["pancake"], "no such file or folder: pancake (goals are named with --goal)"),
        (["--", "--opt-mode=ignore"], "would change what an answer means"),
        (["--", "--no-such-option"], "unknown option: 'no-such-option'"),
        (["--format", "xml"], "is not one of 'text', 'json', 'csv', 'markdown', 'foon'"),
        (["--objektive", "units"], "Did you mean"),
    ],
)
def test_bad_usage_exits_with_2(cli: Cli, data: Path, words: list[str], message: str) -> None:
    ran = cli("solve", "--data", data, *words)
    assert ran.code == 2
    assert message in ran.err
    assert ran.out == ""
    assert "Traceback" not in ran.err


@pytest.mark.parametrize(
    ("name", "old", "new", "message"),
    [
        ("FOON.txt", "M\tmix\n", "mix\n", "FOON.txt:16:1: error: found 'mix', expected"),
        ("motion.txt", "flip\t0.5", "flip\t1.5", "motion.txt:4:6: error: found the success rate 1.5"),
        ("kitchen.json", '"label": "tray"', '"lable": "tray"', "kitchen.json:6:3: error: found the key"),
        ("kitchen.json", "]\n", "", "kitchen.json"),
        ("goal_nodes.json", '"done"', '"eaten"', "goal_nodes.json:1:2: error: the goal 'pancake; eaten"),
    ],
)
def test_bad_input_names_its_place(cli: Cli, data: Path, name: str, old: str, new: str, message: str) -> None:
    file = data / name
    file.write_text(file.read_text().replace(old, new, 1))
    ran = cli("solve", "--data", data)
    assert ran.code == 2
    assert message in ran.err
    assert ran.out == ""


def test_lenient_leaves_lines_out_and_counts_them(cli: Cli, data: Path) -> None:
    file = data / "FOON.txt"
    file.write_text(NETWORK.replace("O\ttray\n", "tray\n"))
    assert cli("solve", "--data", data).code == 2
    ran = cli("solve", "--data", data, "--lenient")
    assert ran.code == 0
    assert "FOON.txt:42:1: warning: found 'tray', expected" in ran.err
    assert "warning: 1 line left out" in ran.err
    assert "4 units, 10 inputs" in ran.out


def test_a_network_of_its_own_has_no_bundled_kitchen(cli: Cli, data: Path) -> None:
    ran = cli("solve", "--network", data / "FOON.txt", "--goal", "pancake; done; on [plate]")
    assert "No kitchen given" in ran.err
    assert "success" not in ran.out
    pieces = ["--network", data / "FOON.txt", "--kitchen", data / "kitchen.json", "--goals"]
    ran = cli("solve", *pieces, data / "goal_nodes.json")
    assert ran.code == 0
    assert "4 units, 11 inputs\n" in ran.out
    ran = cli("solve", *pieces, data / "goal_nodes.json", "--objective", "success")
    assert ran.code == 2
    assert "give a rates file, with --rates" in ran.err


def test_help_and_version(cli: Cli) -> None:
    assert "--time-limit" in cli("solve", "-h").out
    assert cli("--version").out.startswith("foon-asp")


@pytest.mark.parametrize("verb", group.list_commands(click.Context(group)))
def test_examples_in_help_stand_on_lines_of_their_own(cli: Cli, verb: str) -> None:
    text = cli(verb, "--help").out
    assert "\\b" not in text
    assert all(line.count("foon-asp ") < 2 for line in text.splitlines())


def test_a_bug_of_ours_exits_with_70(cli: Cli, data: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise ZeroDivisionError("oops")

    monkeypatch.setattr("foon_asp.questions.answer.solve", fail)
    ran = cli("solve", "--data", data)
    assert ran.code == 70
    assert "foon-asp has a bug: ZeroDivisionError: oops" in ran.err
    assert "Traceback" not in ran.err
    assert "Traceback" in cli("solve", "--data", data, "--debug").err
