"""One recipe and nothing else: what is at hand, what the goals are, and what needs no rates."""

import json
from pathlib import Path

import pytest

from tests.conftest import Cli

RECIPE = """\
O\tstove
S\toff
M\tturn on
O\tstove
S\ton
//
O\tstove
S\ton
O\tegg
S\traw
O\tpan
S\tempty
M\tfry
O\tegg
S\tfried
S\tin\t[pan]
O\tpan
S\tcontains\t{egg}
O\tstove
S\ton
//
"""
EGG, PAN = "egg; fried; in [pan]", "pan; contains {egg}"
STARTING = ["stove; off", "egg; raw", "pan; empty"]


@pytest.fixture
def recipe(tmp_path: Path) -> Path:
    file = tmp_path / "egg.txt"
    file.write_text(RECIPE, encoding="utf-8")
    return file


def marked(recipe: Path) -> Path:
    recipe.write_text(RECIPE.replace("O\tegg\nS\tfried", "O\tegg\t!\nS\tfried"), encoding="utf-8")
    return recipe


def test_one_recipe_is_enough(cli: Cli, recipe: Path) -> None:
    ran = cli("solve", marked(recipe))
    assert ran.code == 0
    assert f"No --goal: using the goal marked in the files: {EGG}\n" in ran.err
    assert "No kitchen given" in ran.err
    assert "is available (3 items used; -v lists them)\n" in ran.err
    assert [line.strip() for line in cli("solve", recipe, "-v").err.splitlines()[-3:]] == STARTING
    assert "optimal by units (strict containers, starting kitchen): 2 units, 4 inputs" in ran.out
    shown = cli("solve", "--network", recipe, "--format", "json").json
    assert [node["node"] for node in shown["goals"]] == [EGG]
    assert [node["node"] for node in shown["starting_kitchen"]] == STARTING
    given = cli("solve", recipe, "--kitchen", "@starting")
    assert given.out == ran.out
    assert "No kitchen given" not in given.err


def test_without_marks_each_output_of_the_last_unit_has_its_tree(cli: Cli, recipe: Path) -> None:
    ran = cli("solve", recipe)
    assert ran.code == 0
    assert ran.out.startswith(f"goal: {EGG}\ngoal: {PAN}\noptimal by units")  # one tree makes both
    assert ran.out.count("optimal by units") == 1
    assert "No --goal: using what the last unit makes (2 goals), each by itself; -v lists them\n" in ran.err
    assert f"each by itself\n  {EGG}\n  {PAN}\n" in cli("solve", recipe, "-v").err
    each = cli("solve", recipe, "--format", "json").json
    assert each["schema"] == "foon-asp/each/1"
    assert [answer["goals"][0]["node"] for answer in each["answers"]] == [EGG, PAN]
    assert cli("why-not", recipe).out.count("goal: ") == 2
    ran = cli("solve", recipe, "--certificate", recipe.with_name("proof.json"))
    assert (ran.code, recipe.with_name("proof.json").exists()) == (2, False)
    assert "name one (--goal)" in ran.err


def test_a_last_unit_that_makes_nothing_has_no_goals(cli: Cli, recipe: Path) -> None:
    recipe.write_text(f"{RECIPE}O\tegg\nS\tfried\nM\teat\n", encoding="utf-8")
    store = recipe.with_name("egg.foon")
    assert cli("merge", recipe, "--store", store).code == 0
    for named in (recipe, store):
        ran = cli("solve", named)
        assert "what the last unit makes (2 goals), each by itself" in ran.err
    recipe.write_text("O\tegg\nM\teat\n//\n", encoding="utf-8")
    ran = cli("solve", recipe)
    assert (ran.code, "no functional unit makes anything" in ran.err) == (2, True)


@pytest.mark.parametrize("level", [1, 3])
def test_a_store_answers_the_same(cli: Cli, recipe: Path, level: int) -> None:
    store = recipe.with_name("egg.foon")
    assert cli("merge", recipe, "--store", store).code == 0
    found = [cli("solve", named, "--level", level) for named in (recipe, store)]
    assert [ran.code for ran in found] == [0, 0]
    assert (found[0].out, found[0].err) == (found[1].out, found[1].err)


def test_certificates_of_a_starting_kitchen_are_verified_under_it(cli: Cli, recipe: Path) -> None:
    proof = recipe.with_name("proof.json")
    assert cli("solve", marked(recipe), "--certificate", proof).code == 0
    assert cli("verify", proof, "--network", recipe).code == 0
    kitchen = recipe.with_name("kitchen.json")
    kitchen.write_text(json.dumps([{"label": "egg", "states": ["raw"]}]), encoding="utf-8")
    assert cli("verify", proof, "--network", recipe, "--kitchen", kitchen).code == 2


def test_rates_matter_where_success_is_asked(cli: Cli, recipe: Path) -> None:
    marked(recipe)
    ran = cli("pareto", recipe)
    assert ran.code == 0
    assert "success is left out, since no success rates are given" in ran.err
    rates = recipe.with_name("rates.txt")
    rates.write_text("fry\t0.5\n", encoding="utf-8")
    ran = cli("pareto", recipe, "--rates", rates)
    assert ran.code == 0
    assert "the rates file has no rate for 'turn on'" in ran.err
    ran = cli("solve", recipe, "--rates", rates, "--objective", "success")
    assert ran.code == 2
    assert "egg.txt:1:1: error: the motion 'turn on' has no success rate" in ran.err


@pytest.mark.parametrize("stored", [False, True])
def test_questions_of_a_batch_can_start_from_what_no_unit_makes(
    cli: Cli, recipe: Path, monkeypatch: pytest.MonkeyPatch, stored: bool
) -> None:
    monkeypatch.chdir(recipe.parent)
    if stored:
        assert cli("merge", recipe, "--store", "egg.foon").code == 0
    Path("bare.txt").write_text("O\tstove\nS\toff\n", encoding="utf-8")
    asked = {"goal": EGG, "kitchen": [None, "bare.txt", "@starting"]}
    Path("questions.jsonl").write_text(json.dumps(asked) + "\n", encoding="utf-8")
    data = ("--network", "egg.foon" if stored else recipe, "--kitchen", "bare.txt")
    assert cli("batch", "questions.jsonl", "--results", "rows.jsonl", *data).code == 0
    rows = [json.loads(line) for line in Path("rows.jsonl").read_text(encoding="utf-8").splitlines()[1:]]
    assert [(row["kitchen"], row["status"]) for row in rows] == [
        (None, "infeasible"),
        ("bare.txt", "infeasible"),
        ("@starting", "optimal"),
    ]


def test_a_recipe_follows_what_is_the_verbs_own(cli: Cli, recipe: Path) -> None:
    tree = recipe.with_name("tree.txt")
    tree.write_text(
        cli("compare", "--search", "bfs", marked(recipe), "--format", "foon").out, encoding="utf-8"
    )
    checked = cli("check", tree, recipe)
    assert (checked.code, checked.out) == (0, cli("check", tree, "--network", recipe).out)
    for words in ((recipe,), ("--network", recipe)):
        assert "the same 2 units" in cli("diff", tree, tree, *words).out
    ran = cli("compare", "egg")
    assert (ran.code, "goals are named with --goal" in ran.err) == (2, True)
