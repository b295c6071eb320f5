"""``foon-asp`` as a user meets it: results on stdout, messages on stderr, documented exit codes."""

import os
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


def test_solve_prints_steps_for_people(cli: Cli, data: Path) -> None:
    ran = cli("solve", "--data", data)
    assert ran.code == 0
    assert ran.err == ""
    foon = data / "FOON.txt"
    assert (
        ran.out
        == f"""\
goal: pancake; done; on [plate]
optimal by units (strict containers): 4 units, 11 inputs, success 0.243

  1  pour    [{foon}:3]
       bowl; empty  (kitchen)
       flour; in [bag]  (kitchen)
       bag; contains {{flour}}  (kitchen)
     → bowl; contains {{flour}}
  2  mix    [{foon}:13]
       bowl; contains {{flour}}  (step 1)
       milk  (kitchen)
     → batter; in [bowl]
  3  bake    [{foon}:36]
       batter; in [bowl]  (step 2)
       oven; hot  (kitchen)
       pan; hot  (kitchen)
       tray  (kitchen)
     → pancake; done
  4  serve    [{foon}:47]
       pancake; done  (step 3)
       plate  (kitchen)
     → pancake; done; on [plate]
"""
    )


def test_solve_json(cli: Cli, data: Path) -> None:
    ran = cli("solve", "--data", data, "--objective", "success", "--format", "json")
    result = ran.json
    assert ran.code == 0
    assert result["schema"] == "foon-asp/answer/1"
    assert [goal["node"] for goal in result["goals"]] == ["pancake; done; on [plate]"]
    assert result["containers"] == "strict"
    assert result["objectives"] == ["success"]
    assert result["status"] == "optimal"
    costs = {"units": 5, "inputs": 10, "ingredients": 2, "kitchen": 6, "inputs+ingredients": 12}
    assert result["costs"].items() >= {**costs, "success": {"exact": "81/250", "approx": 0.324}}.items()
    assert result["lower_bound"] == {"success": {"exact": "81/250", "approx": 0.324}, "units": 5}
    assert [unit["motion"] for unit in result["units"]] == ["pour", "mix", "fry", "flip", "serve"]
    first, second, *_ = result["units"]
    place = {"file": str(data / "FOON.txt"), "line": 3, "videos": ["https://example.org/pancake"]}
    assert (first["step"], first["id"], first["motion"], first["source"]) == (1, 0, "pour", [place])
    assert [node["node"] for node in first["inputs"]] == [
        "bowl; empty",
        "flour; in [bag]",
        "bag; contains {flour}",
    ]
    bowl = {
        "id": 3,
        "node": "bowl; contains {flour}",
        "label": "bowl",
        "states": [],
        "relations": [],
        "contents": [{"word": "contains", "ingredients": ["flour"]}],
    }
    assert first["outputs"] == [{**bowl, "made": True}]
    assert second["inputs"][0] == {**bowl, "from": {"step": 1}}
    assert [node["from"] for node in first["inputs"]] == [{"kitchen": True}] * 3
    assert set(result["seconds"]) == {"read", "cut", "check"}  # nothing is left to search
    plain = cli(
        "solve", "--data", data, "--objective", "success", "--reduce", "none", "--format", "json"
    ).json
    assert set(plain["seconds"]) == {"read", "cut", "facts", "ground", "solve", "check"}
    differing = {"proof", "proof_by_objective", "seconds"}
    assert {k: v for k, v in plain.items() if k not in differing} == {
        k: v for k, v in result.items() if k not in differing
    }


@pytest.mark.parametrize(
    ("objective", "motions"),
    [
        ("units", ["pour", "mix", "bake", "serve"]),
        ("inputs", ["pour", "mix", "fry", "flip", "serve"]),
        ("success", ["pour", "mix", "fry", "flip", "serve"]),
        ("kitchen", ["pour", "mix", "fry", "flip", "serve"]),
        ("inputs+ingredients,units", ["pour", "mix", "fry", "flip", "serve"]),
        ("units,success", ["pour", "mix", "bake", "serve"]),
    ],
)
def test_objectives_disagree(cli: Cli, data: Path, objective: str, motions: list[str]) -> None:
    result = cli("solve", "--data", data, "--objective", objective, "--format", "json").json
    assert [unit["motion"] for unit in result["units"]] == motions


def test_the_container_rule_spares_the_bag(cli: Cli, data: Path) -> None:
    kitchen = data / "kitchen.json"
    kitchen.write_text(KITCHEN.replace('"ingredients": ["flour"]', '"ingredients": ["sugar"]'))
    strict = cli("solve", "--data", data)
    implied = cli("solve", "--data", data, "--containers", "implied")
    assert strict.code == 1
    assert "no unit that makes pancake; done; on [plate] can run" in strict.out
    assert "matches no object node" in strict.err
    assert implied.code == 0
    assert "4 units, 11 inputs" in implied.out
    assert "bag; contains {flour}  (implied)" in implied.out


def test_foon_output_checks(cli: Cli, data: Path, tmp_path: Path) -> None:
    tree = tmp_path / "tree.txt"
    tree.write_text(cli("solve", "--data", data, "--format", "foon").out)
    ran = cli("check", tree, "--data", data)
    assert ran.code == 0
    assert ran.out == "executes as listed (strict containers)\n4 units, 11 inputs, success 0.243\n"


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


def test_check_reads_a_tree_from_a_pipe(cli: Cli, data: Path) -> None:
    reading, writing = os.pipe()
    os.write(writing, cli("solve", "--data", data, "--format", "foon").out.encode())
    os.close(writing)
    assert cli("check", f"/dev/fd/{reading}", "--data", data).code == 0
    os.close(reading)


def test_check_finds_an_order_or_says_what_is_missing(cli: Cli, data: Path, tmp_path: Path) -> None:
    tree = tmp_path / "tree.txt"
    units = [block for block in NETWORK.split("//\n")[1:] if block]
    pour, mix, _fry, _flip, bake, serve, warm = units
    tree.write_text("//\n".join([serve, mix, pour, bake, ""]))
    ran = cli("check", tree, "--data", data)
    assert ran.code == 0
    assert "executes in another order" in ran.out
    assert f"as listed: unit 1, serve    [{tree}:1], lacks pancake; done" in ran.out
    assert cli("check", tree, "--data", data, "--format", "json").json["order"] == [3, 2, 4, 1]
    tree.write_text("//\n".join([mix, bake, serve, ""]))
    ran = cli("check", tree, "--data", data, "--format", "json")
    assert ran.code == 1
    assert ran.json["verdict"] == "does not execute"
    obstacle = ran.json["in_any_order"]
    assert (obstacle["position"], obstacle["cycle"]) == (1, [])
    assert obstacle["missing"]["node"] == "bowl; contains {flour}"
    assert (obstacle["unit"]["id"], obstacle["unit"]["motion"]) == (1, "mix")
    assert obstacle["unit"]["source"] == [{"file": str(tree), "line": 1, "videos": []}]
    tree.write_text("//\n".join([pour, mix, ""]))
    ran = cli("check", tree, "--data", data)
    assert ran.code == 1
    assert "every unit runs, but the goal is not made: pancake; done; on [plate]" in ran.out
    tree.write_text("//\n".join([pour, mix, bake, serve, warm.replace("warm up", "heat"), ""]))
    ran = cli("check", tree, "--data", data)
    assert ran.code == 1
    assert f"unit 5 is not in the network: heat    [{tree}:37]" in ran.out


def test_several_goals_make_one_tree(cli: Cli, data: Path) -> None:
    both = ["--goal", "pancake; done; on [plate]", "--goal", "pancake; raw on top; in [pan]"]
    result = cli("solve", "--data", data, *both, "--format", "json").json
    assert result["costs"]["units"] == 5
    assert [goal["node"] for goal in result["goals"]] == both[1::2]


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
        (["--goal", "bowl; in [x"], "cannot be read: at column 10"),
        (["--objective", "speed"], "found the objective 'speed', expected one of units"),
        (["--objective", "units,units"], "the objective 'units' is listed twice"),
        (["--data", "/no/such/folder"], "/no/such/folder: no such file or folder"),
        (["--constraint", "nothing.lp"], "nothing.lp: no such file"),
        (["--encodings", "/no/encodings"], "/no/encodings"),
        (["-c", "nothing=1"], "no encoding in use has the constant 'nothing'"),
        (["-c", "nothing"], "found the constant 'nothing', expected NAME=VALUE"),
        (["pancake"], "found 'pancake', expected a recipe, a folder or a store"),
        (["--", "--opt-mode=ignore"], "would change what an answer means"),
        (["--", "--no-such-option"], "unknown option: 'no-such-option'"),
        (["--", "-"], "found '-' after --"),
        (["--format", "xml"], "is not one of 'text', 'json', 'csv', 'markdown', 'foon'"),
        (["--no-such-option"], "No such option"),
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
        ("FOON.txt", "[pan]", "[[pan]", "FOON.txt:27:5: error: found '\\t[[pan]', expected"),
        ("motion.txt", "flip\t0.5", "flip\t1.5", "motion.txt:4:6: error: found the success rate 1.5"),
        ("motion.txt", "flip\t0.5", "flip\thigh", "motion.txt:4:6: error: found 'high', expected a success"),
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
    assert "no kitchen is given" in ran.err
    assert "success" not in ran.out
    pieces = ["--network", data / "FOON.txt", "--kitchen", data / "kitchen.json", "--goals"]
    ran = cli("solve", *pieces, data / "goal_nodes.json")
    assert ran.code == 0
    assert "4 units, 11 inputs\n" in ran.out
    ran = cli("solve", *pieces, data / "goal_nodes.json", "--objective", "success")
    assert ran.code == 2
    assert "give a rates file, with --rates" in ran.err


def test_optima_of_the_goals_file(cli: Cli, data: Path) -> None:
    ran = cli("optima", "--data", data, "--goal", "pancake", "--goal", "cake; warm")
    assert ran.code == 0
    rows = [line.split() for line in ran.out.splitlines()]
    assert ["pancake", "units", "4", "11", "0.2430", "optimal"] in [row[:6] for row in rows]
    assert ["inputs,", "success", "5", "10", "0.3240", "optimal"] in [row[:6] for row in rows]
    assert ["cake", "infeasible"] in [row[:2] for row in rows]
    listed = cli("optima", "--data", data, "--format", "json").json
    assert [outcome["status"] for outcome in listed["answers"]] == ["optimal"] * 3


def test_help_and_version(cli: Cli) -> None:
    assert "solve" in cli("--help").out
    assert "--time-limit" in cli("solve", "-h").out
    assert cli("--version").out.startswith("foon-asp")


@pytest.mark.parametrize("verb", group.list_commands(click.Context(group)))
def test_examples_in_help_stand_on_lines_of_their_own(cli: Cli, verb: str) -> None:
    text = cli(verb, "--help").out
    assert "\\b" not in text
    assert all(line.count("foon-asp ") < 2 for line in text.splitlines())


def test_a_list_says_what_is_made_too_late_and_what_never(cli: Cli) -> None:
    text = cli("search", "bfs", "--goal", "macaroni").out
    assert "       stove; on  (step 6, which is later)\n" in text
    circle = cli("search", "bfs", "--goal", "apple pie").out
    assert "       pie crust; rolled  (step 5, which is later)\n" in circle


def test_a_bug_of_ours_exits_with_70(cli: Cli, data: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise ZeroDivisionError("oops")

    monkeypatch.setattr("foon_asp.questions.answer.find", fail)
    ran = cli("solve", "--data", data)
    assert ran.code == 70
    assert "foon-asp has a bug: ZeroDivisionError: oops" in ran.err
    assert "Traceback" not in ran.err
    assert "Traceback" in cli("solve", "--data", data, "--debug").err


def test_without_a_verb_the_help_is_shown(cli: Cli) -> None:
    ran = cli()
    assert ran.code == 2
    assert ran.err == cli("--help").out
    assert "\nSolve:\n  solve " in ran.err


def test_a_missing_word_is_named_with_its_choices(cli: Cli) -> None:
    ran = cli("search", "--goal", "ice")
    assert (
        ran.code,
        ran.err.splitlines()[-1].endswith("Choose from: bfs, dfs, ids, greedy-success, greedy-inputs"),
    ) == (2, True)


def test_a_certificate_that_is_not_there(cli: Cli, tmp_path: Path) -> None:
    ran = cli("verify", tmp_path / "none.json")
    assert ran.err == f"error: {tmp_path / 'none.json'}: cannot be read: No such file or directory\n"
