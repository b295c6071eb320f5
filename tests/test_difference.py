"""``foon-asp diff``: two trees beside each other."""

import json
import shutil
from pathlib import Path

import pytest

from foon_asp.network import FunctionalUnit, NetworkBuilder, Source
from foon_asp.problem import ContainerRule
from foon_asp.questions.diff import Side, diff, side
from foon_asp.resources import bundled_kitchen
from foon_asp.text.line_parser import parse_node
from tests.conftest import Cli


def tree(goal: str, kitchen: str, *units: str) -> Side:
    """Make a side from units ``a+b>c``, whose motion is their text; goal and kitchen are labels."""
    listed = []
    for line, text in enumerate(units, 1):
        inputs, outputs = (map(parse_node, part.split("+")) for part in text.split(">"))
        listed.append((FunctionalUnit.of(text, inputs, outputs), Source("tree", line)))
    goals = [parse_node(name) for name in goal]
    at_hand = frozenset(parse_node(name) for name in kitchen)
    return side(
        "tree", listed, goals, at_hand, ContainerRule.STRICT, frozenset(), None, NetworkBuilder().build()
    )


def parted(left: Side, right: Side) -> list[tuple[str, str | None, str | None]]:
    return [
        (str(p.object), p.left.motion if p.left else None, p.right.motion if p.right else None)
        for p in diff(left, right).partings
    ]


def test_trees_part_where_both_want_a_node_and_have_it_from_elsewhere() -> None:
    left = tree("d", "a", "a>b", "b>c", "c>d")
    right = tree("d", "a", "a>x", "x>c", "c>d")
    found = diff(left, right)
    assert [unit.motion for unit in found.only_left] == ["a>b", "b>c"]
    assert [unit.motion for unit in found.only_right] == ["a>x", "x>c"]
    assert [unit.motion for unit in found.both] == ["c>d"]
    assert parted(left, right) == [("c", "b>c", "x>c")]


def test_they_may_meet_and_part_again() -> None:
    left = tree("d", "ae", "a>b", "b>d")
    right = tree("d", "ae", "e>b", "b>c", "c+b>d")
    assert parted(left, right) == [("d", "b>d", "c+b>d"), ("b", "a>b", "e>b")]


def test_one_kitchen_has_it() -> None:
    assert parted(tree("c", "ab", "b>c"), tree("c", "a", "a>b", "b>c")) == [("b", None, "a>b")]
    assert parted(tree("c", "ab", "b>c"), tree("c", "a", "b>c")) == [("b", None, None)]


def test_without_goals_it_is_from_what_is_made_and_not_needed() -> None:
    assert parted(tree("", "a", "a>b", "b>c"), tree("", "a", "a>c")) == [("c", "b>c", "a>c")]


def test_a_tree_and_itself_in_another_order() -> None:
    left, right = tree("c", "a", "a>b", "a>x", "b+x>c"), tree("c", "a", "a>x", "a>b", "b+x>c")
    found = diff(left, right)
    assert (found.only_left, found.only_right, found.partings) == ((), (), ())
    assert not found.same_order
    assert diff(left, left).same_order


@pytest.fixture
def files(cli: Cli, tmp_path: Path) -> tuple[Path, Path]:
    """Give the tree with fewest units for macaroni as FOON text, and the most successful one in JSON."""
    text, answer = tmp_path / "units.txt", tmp_path / "success.json"
    text.write_text(cli("solve", "--goal", "macaroni", "--format", "foon").out)
    answer.write_text(cli("solve", "--goal", "macaroni", "--objective", "success", "--format", "json").out)
    return text, answer


def test_files_and_questions_say_the_same(cli: Cli, files: tuple[Path, Path]) -> None:
    text, answer = files
    asked = cli(
        "diff", "solve --goal macaroni", "solve --goal macaroni --objective success", "--format", "json"
    )
    read = cli("diff", text, answer, "--format", "json")
    assert asked.code == read.code == 0
    for key in ("costs",):
        assert [read.json[one][key] for one in "ab"] == [asked.json[one][key] for one in "ab"]
    for key in ("only_in_a", "only_in_b", "in_both"):
        assert [u["outputs"] for u in read.json[key]] == [u["outputs"] for u in asked.json[key]]
    assert [p["object"] for p in read.json["they_part_at"]] == [
        p["object"] for p in asked.json["they_part_at"]
    ]
    assert read.json["a"]["costs"]["units"] == 9
    assert read.json["b"]["costs"]["units"] == 11
    assert len(read.json["only_in_a"]) + len(read.json["in_both"]) == 9


def test_the_text(cli: Cli, files: tuple[Path, Path]) -> None:
    ran = cli("diff", *files, "--goal", "macaroni")
    assert ran.code == 0
    assert "6 units in both\nonly in A: 3 units\n  fill    [" in ran.out
    assert "they part at\n  macaroni; cooked; in [pot]\n    A: tilt    [" in ran.out
    same = cli("diff", files[0], files[0])
    assert "the same 9 units, in the same order" in same.out


def test_without_a_tree(cli: Cli, tmp_path: Path, files: tuple[Path, Path]) -> None:
    ran = cli("diff", files[0], "solve --goal 'apple pie'")
    assert (ran.code, ran.out) == (1, "")
    assert "no task tree exists" in ran.err
    answer = tmp_path / "none.json"
    answer.write_text(cli("solve", "--goal", "apple pie", "--format", "json").out)
    none = cli("diff", answer, files[0])
    assert (none.code, none.out) == (1, "")
    assert "the answer has no tree (infeasible)" in none.err


NODE = {"node": "bread", "label": "bread", "states": [], "relations": [], "contents": []}
UNIT = {"motion": "cut", "inputs": [NODE], "outputs": [NODE], "source": [{"file": "x", "line": 1}]}
ANSWER = {"schema": "foon-asp/answer/1", "goals": [NODE], "units": [UNIT]}


def test_the_answer_that_is_broken_above_is_one(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "x.json"
    file.write_text(json.dumps(ANSWER))
    assert cli("diff", file, file).code == 0


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ({**ANSWER, "units": [{"motion": "cut"}]}, "'inputs' is missing"),
        ({**ANSWER, "units": [UNIT | {"motion": 3}]}, "not written as one"),
        ({**ANSWER, "units": [UNIT | {"inputs": ["bread"]}]}, "expected an answer of foon-asp"),
        ({**ANSWER, "units": [UNIT | {"inputs": [NODE | {"label": "roll"}]}]}, "'bread' are those of 'roll'"),
        (
            {**ANSWER, "units": [UNIT | {"inputs": [NODE | {"states": [3]}]}]},
            "expected an answer of foon-asp",
        ),
        ({**ANSWER, "units": 3}, "expected an answer of foon-asp"),
        ({**ANSWER, "goals": None}, "expected an answer of foon-asp"),
        ({"units": []}, "expected 'foon-asp/answer/1'"),
        (
            {**ANSWER, "schema": "foon-asp/answer/2"},
            "found the schema 'foon-asp/answer/2', expected 'foon-asp/answer/1'",
        ),
        ({**ANSWER, "schema": 1}, "expected 'foon-asp/answer/1'"),
        ({"schema": "foon-asp/optima/1", "answers": [ANSWER]}, "has no tree, or more than one"),
        (
            {"schema": "foon-asp/menu/1", "answer": {**ANSWER, "schema": "x"}},
            "found the schema 'x', expected",
        ),
    ],
)
def test_what_is_no_answer(cli: Cli, tmp_path: Path, content: object, message: str) -> None:
    file = tmp_path / "x.json"
    file.write_text(json.dumps(content))
    ran = cli("diff", file, file)
    assert (ran.code, ran.out) == (2, "")
    assert message in ran.err


def test_faults_of_a_question(cli: Cli) -> None:
    assert cli("diff", "solve --gaol x", "solve --goal ice").code == 2
    soft = cli("diff", "solve --goal ice --soft forbid_motion=3", "solve --goal ice")
    assert soft.code == 2
    assert "expected a question without --certificate, --cross-check, --soft" in soft.err
    torn = cli("diff", "solve --goal 'ice", "solve --goal ice")
    assert torn.code == 2
    assert "expected the words of a command: No closing quotation" in torn.err
    assert cli("diff", "nothing.txt", "solve --goal ice").code == 2


@pytest.mark.slow
def test_two_kitchens(cli: Cli, universal: Path) -> None:
    words = f"--data '{universal}' --goal 'greek salad'"
    ran = cli("diff", f"solve {words}", f"solve {words} --containers implied", "--format", "json")
    assert ran.code == 0
    assert [ran.json[one]["costs"]["units"] for one in "ab"] == [30, 25]


def test_what_stands_beside_the_questions_counts_for_both(cli: Cli, tmp_path: Path) -> None:
    own = tmp_path / "own"
    shutil.copytree(bundled_kitchen(), own)
    beside = cli("diff", "solve", "solve --objective success", "--goal", "ice", "--data", own)
    assert beside.code == 0
    assert f"[{own / 'FOON.txt'}:" in beside.out
    assert f"[{bundled_kitchen() / 'FOON.txt'}:" not in beside.out
    named = cli("diff", "solve --goal tea", f"solve --goal tea --network {own}", "--kitchen", "nowhere.json")
    assert (named.code, "nowhere.json" in named.err) == (2, True)
    words = f"solve --goal tea --data {own}"
    assert cli("diff", words, words, "--kitchen", "nowhere.json").code == 0
