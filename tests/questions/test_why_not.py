"""``foon-asp why-not``: dead ends, what is at their root, and names one edit away."""

import shutil
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

import pytest

import foon_asp
from foon_asp import deadline, why_not
from foon_asp.network import NodePattern, ObjectNode
from foon_asp.network.slip import slip_between
from foon_asp.problem import ContainerRule, Problem, reach
from foon_asp.problem.dead_ends import Cause
from foon_asp.resources import bundled_kitchen
from foon_asp.results.values import Node
from foon_asp.text.line_parser import parse_node
from tests.conftest import ROOT, Cli
from tests.oracle import task_trees
from tests.questions.recipes import posed
from tests.support.random_problems import random_problem


def roots(problem: Problem) -> list[tuple[str, Cause, bool]]:
    """Give what is at the root, its cause, and whether it is on the way to the goal."""
    return [
        (
            "".join(sorted(node.label for node in root.cycle_objects or [root.object])),
            root.cause,
            root.on_the_easiest_way,
        )
        for root in why_not(problem).roots
    ]


def test_a_missing_item_is_named_with_the_unit_it_stops() -> None:
    problem = posed("a", "d", "a+b>c", "c>d")
    found = why_not(problem)
    assert [node.label for node in found.unreachable_goals] == ["d"]
    stopped = {end.object.label: [unit.id for unit in end.makers] for end in found.dead_ends}
    assert stopped == {"d": [1], "c": [0], "b": []}
    assert roots(problem) == [("b", Cause.MISSING, True)]
    assert [unit.id for unit in found.roots[0].stops] == [0]


@pytest.mark.parametrize(
    ("problem", "expected"),
    [
        (posed("a", "e", "a+c>b", "b>c", "b>d", "d+a>e"), [("bc", Cause.CYCLE, True)]),
        (posed("a", "c", "a+c>b", "b>c", "a+x>b"), [("x", Cause.MISSING, True)]),  # it would start the cycle
        (posed("a", "d", "a+k>d+k"), [("k", Cause.MISSING, True)]),  # it is only handed on
        # with b and c at hand, d and e still wait for each other
        (
            posed("", "e", "c>b", "b>c", "e+b>d", "d+c>e"),
            [("de", Cause.CYCLE, True), ("bc", Cause.CYCLE, False)],
        ),
        # the unit that takes the fewest things comes first
        (
            posed("a", "g", "x+y>g", "a+z>g"),
            [("z", Cause.MISSING, True), ("x", Cause.MISSING, False), ("y", Cause.MISSING, False)],
        ),
    ],
)
def test_a_cycle_that_feeds_only_itself_is_told_from_what_waits_for_it(
    problem: Problem, expected: list[tuple[str, Cause, bool]]
) -> None:
    assert roots(problem) == expected


def closure(problem: Problem, at_hand: set[ObjectNode]) -> set[ObjectNode]:
    """Close a kitchen under all units, naively."""
    units = [problem.network.unit(u) for u in range(len(problem.network))]
    made = set(at_hand)
    for _ in units:
        for unit in units:
            if task_trees.needed(unit, problem.containers, problem.utensils) <= made:
                made |= task_trees.made(unit, problem.containers, problem.utensils)
    return made


def named(nodes: Iterable[Node]) -> set[ObjectNode]:
    return {parse_node(node.node) for node in nodes}


@pytest.mark.parametrize("rule", list(ContainerRule))
def test_roots_are_necessary_and_enough(rule: ContainerRule) -> None:
    explained = cycles = 0
    for seed in range(6000, 6200):
        problem = random_problem(seed, rule)
        objects = problem.network.objects
        kitchen = {objects[o] for o in problem.kitchen}
        goals = {objects[g] for g in problem.goals}
        found = why_not(problem)
        makeable = closure(problem, kitchen)
        assert named(found.unreachable_goals) == goals - makeable
        assert {objects[o] for o, there in enumerate(reach(problem).available) if there} == makeable
        explained += not found.tree_exists
        on_the_way: set[ObjectNode] = set()
        for root in found.roots:
            nodes = named(root.cycle_objects or [root.object])
            # necessary: with everything else at hand, nothing of it can be made
            assert not nodes & closure(problem, set(objects) - nodes)
            if root.on_the_easiest_way:
                on_the_way |= nodes
            cycles += root.cycle is not None
        assert goals <= closure(problem, kitchen | on_the_way)
        assert goals <= closure(problem, kitchen | named(found.fix or ()))
    assert explained > 10
    assert cycles > 2


@pytest.mark.parametrize(
    ("node", "other", "kind"),
    [
        ("drinking glass; empty", "drinking glas; empty", "label"),
        ("whisk; clean", "whisk; claen", "state"),
        ("salt; in [cup]", "salt; in [cupp]", "relation"),
        ("salt; in [cup]", "salt; on [cup]", "relation"),
        ("bowl; contains {flour,salt}", "bowl; contains {flour,slat}", "ingredient"),
        ("ice cube tray;", "icecube tray;", "label"),
        ("salt; in [cup]", "salt; on [mug]", None),
        ("bowl; contains {salt}", "bowl; salt", None),
    ],
)
def test_one_edit(node: str, other: str, kind: str | None) -> None:
    slip = slip_between(parse_node(node), parse_node(other))
    assert (slip and slip.kind) == kind


def test_a_container_stands_for_a_relation_of_any_word() -> None:
    pattern = NodePattern("salt", container="cupp")
    slip = slip_between(parse_node("salt; on [cup]"), pattern)
    assert slip is not None
    assert slip[1:] == ("cup", "cupp")


@pytest.fixture
def misspelt(tmp_path: Path) -> Path:
    """Give the bundled kitchen with a slip of the pen in its kitchen file."""
    shutil.copytree(bundled_kitchen(), tmp_path, dirs_exist_ok=True)
    file = tmp_path / "kitchen.json"
    file.write_text(file.read_text(encoding="utf-8").replace('"drinking glass"', '"drinking glas"'))
    return tmp_path


def test_a_slip_in_the_kitchen_file_is_pointed_at(cli: Cli, misspelt: Path) -> None:
    ran = cli("why-not", "--data", misspelt, "--goal", "ice")
    assert ran.code == 1
    assert "(1) drinking glass; empty" in ran.out
    assert "kitchen.json:55 has drinking glas; empty, which is no node" in ran.out
    (root,) = cli("why-not", "--data", misspelt, "--goal", "ice", "--format", "json").json["roots"][:1]
    assert root["near"][0]["name"] == "drinking glas; empty"
    assert root["near"][0]["differs_in"] == "label"


def test_a_node_at_hand_that_is_one_edit_away_is_pointed_at() -> None:
    units = [("crush", "ice; cubed; in [glas]", "ice; crushed"), ("fill", "water", "ice; cubed; in [glass]")]
    (root,) = why_not(foon_asp.build(units, kitchen="water").problem("ice; crushed")).roots
    (near,) = root.near
    assert (near.name, near.differs_in) == ("ice; cubed; in [glass]", "relation")


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["ice"], 0, "there is a task tree"),
        (["hot cocoa", "--containers", "implied"], 0, "there is a task tree"),
        (
            ["ice", "--constraint", "at_most_units", "-c", "max_units=1"],
            1,
            "1 constraint leaves no task tree",
        ),
        (["ice", "--constraint", "at_most_units", "-c", "max_units=2"], 0, "no clash"),
        (["ice", "--encodings", "by_need"], 0, "there is a task tree"),
        (["hot cocoa", "--goal", "apple pie"], 1, "1 object node is missing and 1 cycle feeds only itself"),
    ],
)
def test_exit_codes(cli: Cli, words: list[str], code: int, said: str) -> None:
    ran = cli("why-not", "--goal", *words)
    assert (ran.code, said in ran.out) == (code, True)
    # what several goals share is shown once
    assert sum("whisk    [" in line and "see above" not in line for line in ran.out.split("\n")) == (
        "apple pie" in words
    )


def test_causes_that_are_not_shown_are_counted() -> None:
    units = [
        ("cook", [f"herb {n}" for n in range(first, first + count)], "soup")
        for first, count in ((0, 1), (1, 12))
    ]
    said = why_not(foon_asp.build(units, kitchen=()).problem("soup")).text()
    assert "\n12 more behind other units; --format json lists all\n" in said


def test_the_last_line_says_what_to_add(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    ran = cli("why-not", "--goal", "apple pie")
    fix = ran.out.splitlines()[-1]
    assert fix.startswith(
        "try adding pie crust; in [pie dish] and pie dish; contains {pie crust} (foon-asp shop"
    )
    many = why_not(posed("", "soup", "a + b + c + d + e > soup")).text().splitlines()[-1]
    assert many.startswith("try adding a and b and c and d and 1 more (")
    # an empty jug is for sale, but a full one is needed anyway and becomes empty
    jug = why_not(posed("", "tea", "jug; full > water + jug; empty", "water + jug; empty > tea"))
    assert "try adding jug; full (" in jug.text()
    # the machine may be busy: nothing else ends it
    monkeypatch.setattr(deadline, "_PACE", deadline._PACE._replace(tolerance_seconds=60))
    ran = cli("why-not", "--goal", "apple pie", "--time-limit", "0")
    assert ran.out.splitlines()[-1].startswith("foon-asp shopping-list with the same options")


def test_it_takes_no_clingo_along() -> None:
    code = (
        "import sys\nfrom foon_asp.cli.main import main\n"
        "try:\n    main(['why-not', '--goal', 'apple pie'])\n"
        "except SystemExit:\n    print({'clingo', 'lark'} & {*sys.modules})"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT)
    assert "\ntry adding pie crust" in ran.stdout
    assert ran.stdout.endswith("\nset()\n")


@pytest.mark.slow
@pytest.mark.parametrize("rule", list(ContainerRule))
def test_the_text_is_a_small_tree(cli: Cli, universal: Path, rule: ContainerRule) -> None:
    ran = cli("why-not", "--data", universal, "--goal", "whipped cream", "--containers", rule)
    assert ran.code == 1
    assert "mixing bowl; in [mixer]; contains {condensed milk,cream cheese,pudding mix}  (1)" in ran.out
    assert "what gives it needs it too: pour and blend" in ran.out
    assert "(can be made)" in ran.out
    assert ran.out.count("\n") < 40
