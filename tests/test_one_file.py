"""One recipe and nothing else: what is at hand, what the goals are, and what needs no rates."""

import json
import shutil
from pathlib import Path

import pytest

import foon_asp
from foon_asp.errors import FoonWarning, UserError
from foon_asp.problem import reach
from foon_asp.resources import bundled_kitchen
from tests.conftest import Cli

pytestmark = pytest.mark.sampled(2)  # by default each second case of a test: there are many

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
OLD, FRESH = "O\tstarter\nS\told\n", "O\tstarter\nS\tfresh\n"
LOOP = f"{OLD}M\tfeed\n{FRESH}//\n{FRESH}M\twait\n{OLD}//\n"


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
    assert f"what is marked as a goal in the files: {EGG}\n" in ran.err
    assert "no kitchen is given" in ran.err
    assert [line.strip() for line in ran.err.splitlines()[-3:]] == STARTING
    assert "optimal by units (strict containers, starting kitchen): 2 units, 4 inputs" in ran.out
    shown = cli("solve", "--network", recipe, "--format", "json").json
    assert [node["node"] for node in shown["goals"]] == [EGG]
    assert [node["node"] for node in shown["starting_kitchen"]] == STARTING
    given = cli("solve", recipe, "--kitchen", "@starting")
    assert given.out == ran.out
    assert "no kitchen is given" not in given.err


def test_without_marks_each_output_of_the_last_unit_has_its_tree(cli: Cli, recipe: Path) -> None:
    ran = cli("solve", recipe)
    assert ran.code == 0
    assert ran.out.count("optimal by units") == 2
    assert f"what the last unit makes, each by itself:\n  {EGG}\n  {PAN}\n" in ran.err
    each = cli("solve", recipe, "--format", "json").json
    assert each["schema"] == "foon-asp/each/1"
    assert [answer["goals"][0]["node"] for answer in each["answers"]] == [EGG, PAN]
    assert cli("why-not", recipe).out.count("goal: ") == 2
    assert cli("solve", recipe, "--format", "foon").out.count("# Task tree for") == 2
    ran = cli("solve", recipe, "--certificate", recipe.with_name("proof.json"))
    assert (ran.code, recipe.with_name("proof.json").exists()) == (2, False)
    assert "name one (--goal)" in ran.err


def test_a_last_unit_that_makes_nothing_has_no_goals(cli: Cli, recipe: Path) -> None:
    recipe.write_text(f"{RECIPE}O\tegg\nS\tfried\nM\teat\n", encoding="utf-8")
    store = recipe.with_name("egg.foon")
    assert cli("import", recipe, "--store", store).code == 0
    for named in (recipe, store):
        ran = cli("solve", named)
        assert f"what the last unit makes, each by itself:\n  {EGG}\n  {PAN}\n" in ran.err
    units = [("fry", "egg; raw", "egg; fried"), ("eat", "egg; fried", [])]
    with pytest.warns(FoonWarning):
        assert [str(node) for node in foon_asp.build(units).goals] == ["egg; fried"]
    recipe.write_text("O\tegg\nM\teat\n//\n", encoding="utf-8")
    ran = cli("solve", recipe)
    assert (ran.code, "no functional unit makes anything" in ran.err) == (2, True)


@pytest.mark.parametrize("level", [1, 2, 3])
def test_a_store_and_every_level_answer_the_same(cli: Cli, recipe: Path, level: int) -> None:
    store = recipe.with_name("egg.foon")
    assert cli("import", recipe, "--store", store).code == 0
    found = [cli("solve", named, "--level", level) for named in (recipe, store)]
    assert [ran.code for ran in found] == [0, 0]
    assert (found[0].out, found[0].err) == (found[1].out, found[1].err)


def test_what_cannot_be_made_from_it_is_said(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "sourdough.txt").write_text(LOOP, encoding="utf-8")
    ran = cli("solve", tmp_path / "sourdough.txt")
    assert ran.code == 1
    assert "infeasible: proved that no task tree exists (strict containers, starting kitchen)" in ran.out
    assert (
        "the cause: starter; fresh can only be made from starter; old, and that only from starter; fresh\n"
        in ran.out
    )
    assert "say what is at hand: --kitchen FILE" in ran.out
    assert "by itself" not in ran.out  # it is one recipe
    feed, wait = LOOP.split("//\n")[:2]
    (tmp_path / "sourdough.txt").write_text(f"{feed}//\n", encoding="utf-8")
    (tmp_path / "wait.txt").write_text(f"{wait}//\n", encoding="utf-8")
    ran = cli("solve", tmp_path / "sourdough.txt", tmp_path / "wait.txt", "--goal", "starter; fresh")
    assert f"asked about by itself, {tmp_path / 'sourdough.txt'} has more at hand\n" in ran.out
    assert cli("solve", tmp_path / "sourdough.txt", "--goal", "starter; fresh").code == 0


def test_of_a_long_cycle_the_beginning_is_named(cli: Cli, tmp_path: Path) -> None:
    states = ["fed", "risen", "stirred", "cold", "warm", "sour"]
    units = [
        f"O\tstarter\nS\t{a}\nM\twait\nO\tstarter\nS\t{b}\n//\n"
        for a, b in zip(states, [*states[1:], states[0]], strict=True)
    ]
    (tmp_path / "loop.txt").write_text("//\n" + "".join(units), encoding="utf-8")
    ran = cli("solve", tmp_path / "loop.txt", "--goal", "starter; fed")
    [cause] = [line for line in ran.out.splitlines() if line.startswith("the cause")]
    assert cause.count("and that only from") == 2
    assert cause.endswith("and so on: 6 object nodes wait for each other")


def test_an_empty_kitchen_is_empty(cli: Cli, recipe: Path) -> None:
    kitchen = recipe.with_name("none.json")
    kitchen.write_text("[]", encoding="utf-8")
    ran = cli("solve", marked(recipe), "--kitchen", kitchen)
    assert ran.code == 1
    assert "starting kitchen" not in ran.out + ran.err


def test_certificates_of_a_starting_kitchen_are_verified_under_it(cli: Cli, recipe: Path) -> None:
    proof = recipe.with_name("proof.json")
    assert cli("solve", marked(recipe), "--certificate", proof).code == 0
    assert cli("verify", proof, "--network", recipe).code == 0
    kitchen = recipe.with_name("kitchen.json")
    kitchen.write_text(json.dumps([{"label": "egg", "states": ["raw"]}]), encoding="utf-8")
    assert cli("verify", proof, "--network", recipe, "--kitchen", kitchen).code == 1


def test_rates_matter_where_success_is_asked(cli: Cli, recipe: Path) -> None:
    marked(recipe)
    for verb in ("optima", "pareto"):
        ran = cli(verb, recipe)
        assert ran.code == 0
        assert "success is left out, since no success rates are given" in ran.err
    ran = cli("compare", recipe)
    assert ran.code == 0
    assert f"what is marked as a goal in the files: {EGG}" in ran.err
    script = recipe.with_name("script.txt")
    script.write_text("solve\n", encoding="utf-8")
    ran = cli("shell", script, "--network", recipe)
    assert ran.code == 0
    assert "no kitchen is given" in ran.err
    assert "optimal by units" in ran.out
    ran = cli("compare", recipe)
    assert "greedy-success" in ran.err
    assert "greedy-success" not in ran.out
    rates = recipe.with_name("rates.txt")
    rates.write_text("fry\t0.5\n", encoding="utf-8")
    ran = cli("optima", recipe, "--rates", rates)
    assert ran.code == 0
    assert "the rates file has no rate for 'turn on'" in ran.err
    ran = cli("solve", recipe, "--rates", rates, "--objective", "success")
    assert ran.code == 2
    assert "egg.txt:1:1: error: the motion 'turn on' has no success rate" in ran.err


def test_in_python(recipe: Path) -> None:
    with pytest.warns(FoonWarning, match="no kitchen is given, so what no unit makes is at hand"):
        foon = foon_asp.load(recipe)
    assert [str(node) for node in foon.kitchen] == STARTING
    assert [str(node) for node in foon.goals] == [EGG, PAN]
    with pytest.raises(UserError, match="name a goal; no file lists goals"):
        foon.problem()
    problem = foon.problem(EGG)
    assert repr(problem) == f"<Problem: {EGG} (strict containers, starting kitchen)>"
    assert foon_asp.solve(problem).costs is not None
    assert foon_asp.solve(problem.vary(without="egg")).costs is None
    bundled = foon_asp.load().problem("ice").vary(kitchen="@starting")
    assert bundled.starting
    assert len(bundled.kitchen) < len(bundled.network.objects)
    foon = foon_asp.load(marked(recipe), kitchen="@starting")  # no warning: it was asked for
    assert [str(node) for node in foon.problem().goal_nodes] == [EGG]


def test_what_is_only_handed_on_is_at_hand(recipe: Path) -> None:
    problem = foon_asp.load(recipe, kitchen="@starting").problem(EGG)
    network = problem.network
    assert {str(network.objects[o]) for o in problem.kitchen} == set(STARTING)
    assert all(reach(problem).available)
    folder = recipe.parent / "folder"
    shutil.copytree(bundled_kitchen(), folder)
    (folder / "kitchen.json").unlink()
    with pytest.warns(FoonWarning, match="no kitchen is given"):
        assert foon_asp.load(folder).problem("ice").starting


@pytest.mark.parametrize("stored", [False, True])
def test_sessions_and_questions_of_a_batch_can_start_from_what_no_unit_makes(
    cli: Cli, recipe: Path, monkeypatch: pytest.MonkeyPatch, stored: bool
) -> None:
    monkeypatch.chdir(recipe.parent)
    network = recipe
    if stored:
        network = Path("egg.foon")
        assert cli("import", recipe, "--store", network).code == 0
    Path("bare.txt").write_text("O\tstove\nS\toff\n", encoding="utf-8")
    Path("lines.txt").write_text(
        f"goal '{EGG}'\nsolve\nkitchen @starting\nkitchen\nsolve\nkitchen bare.txt\nshow\n", encoding="utf-8"
    )
    ran = cli("shell", "lines.txt", "--network", network, "--kitchen", "bare.txt")
    assert (ran.code, "kitchen: 3 object nodes, all that no unit makes" in ran.err) == (0, True)
    assert "infeasible" in ran.out
    assert "starting kitchen" in ran.out
    assert all(f"\n{node}\n" in ran.out for node in STARTING)

    asked = {"goal": EGG, "kitchen": [None, "bare.txt", "@starting"]}
    Path("questions.jsonl").write_text(json.dumps(asked) + "\n", encoding="utf-8")
    words = (
        "batch",
        "questions.jsonl",
        "--results",
        "rows.jsonl",
        "--network",
        network,
        "--kitchen",
        "bare.txt",
    )
    assert cli(*words).code == 0
    rows = [json.loads(line) for line in Path("rows.jsonl").read_text(encoding="utf-8").splitlines()[1:]]
    assert {row["kitchen"]: row["status"] for row in rows} == {
        None: "infeasible",
        "bare.txt": "infeasible",
        "@starting": "optimal",
    }
    assert "3 of them answered before" in cli(*words).out


def test_a_recipe_follows_what_is_the_verbs_own(
    cli: Cli, recipe: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(recipe.parent)
    marked(recipe)
    tree, proof, asked = Path("tree.txt"), Path("proof.json"), Path("asked.jsonl")
    tree.write_text(cli("search", "bfs", recipe, "--format", "foon").out, encoding="utf-8")
    assert cli("check", tree, recipe).out == cli("check", tree, "--network", recipe).out
    assert cli("check", tree, recipe).code == 0
    for verb in ("trace", "schedule"):  # what they say of this tree is not the point
        named, option = cli(verb, tree, recipe), cli(verb, tree, "--network", recipe)
        assert (named.code, named.out) == (option.code, option.out)
    asked.write_text('{"goal": "@goals"}\n', encoding="utf-8")
    assert "1 optimal" in cli("batch", asked, recipe, "--results", "rows.jsonl").out
    assert (
        "1 of them answered before" in cli("batch", asked, "--network", recipe, "--results", "rows.jsonl").out
    )
    for words in ((recipe,), ("--network", recipe)):
        assert "the same 2 units" in cli("diff", tree, "solve", *words).out
    other = recipe.with_name("other.txt")
    other.write_text(RECIPE.replace("egg", "tofu"), encoding="utf-8")
    two = cli("diff", "solve", f"solve {other}", recipe).err  # what the last unit makes
    assert "name one with --goal" in two
    assert "tofu; fried" in cli("diff", "solve", f"solve {other} --goal 'tofu; fried; in [pan]'", recipe).out

    proof.write_text(cli("certify", recipe).out, encoding="utf-8")
    verified = cli("verify", proof, recipe)
    assert (verified.code, verified.out) == (0, cli("verify", proof, "--network", recipe).out)
    assert cli("verify", proof, other).code == 1
    for network in (recipe, recipe.parent):
        assert "data are named with --network or --data" in cli("shell", network).err
    Path("lines.txt").write_text("# a session\n" + "\n" * 1000 + "solve\n", encoding="utf-8")
    assert EGG in cli("shell", "lines.txt", recipe).out
    ran = cli("search", "bfs", "egg")
    assert (ran.code, "a goal is named with --goal" in ran.err) == (2, True)
