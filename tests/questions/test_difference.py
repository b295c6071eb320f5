"""``foon-asp diff``: two trees beside each other, and what two files are compared as."""

import json
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.resources import bundled_kitchen
from tests.conftest import Cli


def tree(goal: str, kitchen: str, *units: str) -> foon_asp.Tree:
    """Make a tree from units ``a+b>c``, whose motion is their text; goal and kitchen are labels."""
    sides = [[part.split("+") for part in text.split(">")] for text in units]
    listed = zip(units, *zip(*sides, strict=True), strict=True)
    foon = foon_asp.build(listed, kitchen=[*kitchen], goals=goal)
    return foon_asp.Tree.given(foon.problem(), foon.network)


@pytest.mark.parametrize(
    ("left", "right", "where"),
    [
        (tree("d", "a", "a>b", "b>c", "c>d"), tree("d", "a", "a>x", "x>c", "c>d"), [("c", "b>c", "x>c")]),
        (
            tree("d", "ae", "a>b", "b+e>d"),
            tree("d", "ae", "a+e>b", "b>c", "c+b>d"),
            [("d", "b+e>d", "c+b>d"), ("b", "a>b", "a+e>b")],  # they meet and part again
        ),
        (tree("c", "ab", "a+b>c"), tree("c", "a", "a+b>c"), [("b", "from the kitchen", "not made")]),
        (tree("b", "a", "a>b"), tree("c", "a", "a>c"), [("b", "a>b", "not made"), ("c", "not made", "a>c")]),
    ],
)
def test_trees_part_where_both_want_a_node_and_have_it_from_elsewhere(
    left: foon_asp.Tree, right: foon_asp.Tree, where: list[tuple[str, str, str]]
) -> None:
    found: Any = foon_asp.diff(left, right)
    assert [
        (str(p.object), *(str(side).partition("    ")[0] for side in (p.a, p.b))) for p in found.they_part_at
    ] == where
    assert {unit.motion for unit in found.in_both} == {u.motion for u in left} & {u.motion for u in right}
    for only, units in ((found.only_in_a, left), (found.only_in_b, right)):
        assert len(only) + len(found.nearly_the_same) + len(found.in_both) == len(units)


def test_a_tree_and_itself_in_another_order() -> None:
    left, right = tree("c", "a", "a>b", "a>x", "b+x>c"), tree("c", "a", "a>x", "a>b", "b+x>c")
    found: Any = foon_asp.diff(left, right)
    assert (found.same_units, found.they_part_at) == (True, ())
    assert not found.same_order
    assert "the same 3 units, in another order" in found.text()


def test_the_same_tree_is_said_to_be_the_same(cli: Cli, tmp_path: Path) -> None:
    asked = ("solve", "--goal", "macaroni")
    text, answer = tmp_path / "tree.txt", tmp_path / "answer.json"
    text.write_text(cli(*asked, "--format", "foon").out)
    answer.write_text(cli(*asked, "--format", "json").out)
    same = cli("diff", text, answer)
    assert (same.code, "the same 9 units, in the same order" in same.out) == (0, True)
    python: Any = foon_asp.diff(text, str(answer))
    assert python.json() == cli("diff", text, answer, "--format", "json").json
    assert foon_asp.diff(python.trees[0], text).json()["b"]["name"] == str(text)


def test_what_files_are_compared_as(cli: Cli, tmp_path: Path) -> None:
    tree, network, store = (tmp_path / name for name in ("tree.txt", "network.txt", "ice.foon"))
    tree.write_text(cli("solve", "--goal", "ice", "--format", "foon").out)
    network.write_text(tree.read_text().partition("//")[2])
    assert cli("merge", network, "--store", store).code == 0
    for words in ((tree, network), (network, network, "--goal", "ice")):
        assert cli("diff", *words).out.startswith("compared as task trees\n")
    for other in (network, bundled_kitchen(), store):
        found = cli("diff", network, other, "--level", "2")
        assert found.out.startswith("compared as networks, at level 2\n")
    refused = cli("diff", tree, store)
    assert (refused.code, "ice.foon: found a task tree and a network" in refused.err) == (2, True)


def test_a_tree_is_for_the_goal_and_the_containers_of_its_answer(cli: Cli, tmp_path: Path) -> None:
    answer, tree = tmp_path / "answer.json", tmp_path / "tree.txt"
    for file, form in ((answer, "json"), (tree, "foon")):
        file.write_text(cli("solve", "--goal", "tea", "--containers", "implied", "--format", form).out)
    found = cli("diff", answer, tree, "--format", "json").json
    assert [found[side]["containers"] for side in "ab"] == ["implied", "strict"]
    assert found["a"]["goals"] == found["b"]["goals"]


def test_without_a_tree(cli: Cli, tmp_path: Path) -> None:
    answer = tmp_path / "none.json"
    answer.write_text(cli("solve", "--goal", "apple pie", "--format", "json").out)
    ran = cli("diff", answer, answer)
    assert (ran.code, ran.out, "the answer has no tree (infeasible)" in ran.err) == (1, "", True)


NODE = {"node": "bread", "label": "bread", "states": [], "relations": [], "contents": []}
UNIT = {"motion": "cut", "inputs": [NODE], "outputs": [NODE], "source": [{"file": "x", "line": 1}]}
ANSWER = {"schema": "foon-asp/answer/1", "goals": [NODE], "units": [UNIT]}


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (ANSWER, ""),
        ({**ANSWER, "units": [{"motion": "cut"}]}, "'inputs' is missing"),
        ({**ANSWER, "units": [UNIT | {"motion": 3}]}, "not written as one"),
        ({**ANSWER, "units": [UNIT | {"inputs": ["bread"]}]}, "expected an answer of foon-asp"),
        ({**ANSWER, "units": [UNIT | {"inputs": [NODE | {"label": "roll"}]}]}, "'bread' are those of 'roll'"),
        ({**ANSWER, "goals": None}, "expected an answer of foon-asp"),
        ({**ANSWER, "schema": "foon-asp/answer/2"}, "found the schema 'foon-asp/answer/2', expected 'foon-"),
        ({"schema": "foon-asp/optima/1", "answers": [ANSWER]}, "has no tree, or more than one"),
        (
            {"schema": "foon-asp/regret/1", "answer": {**ANSWER, "schema": "x"}},
            "found the schema 'x', expected",
        ),
    ],
)
def test_what_is_no_answer(cli: Cli, tmp_path: Path, content: object, message: str) -> None:
    file, network = tmp_path / "x.json", tmp_path / "x.txt"
    file.write_text(json.dumps(content))
    network.write_text("O\tbread\nM\tcut\nO\tbread\n//\n")
    ran = cli("diff", file, file, "--network", network)
    assert (ran.code, bool(ran.out)) == ((2, False) if message else (0, True))
    assert message in ran.err
