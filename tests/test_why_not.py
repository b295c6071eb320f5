"""``foon-asp why-not``: dead ends, what is at their root, and names one edit away."""

import threading
from collections.abc import Iterable
from pathlib import Path

import pytest

import foon_asp
from foon_asp import why_not
from foon_asp.deadline import Deadline, LimitError
from foon_asp.network import NetworkBuilder, NodePattern, ObjectNode, Source
from foon_asp.network.near_nodes import slip_between
from foon_asp.problem import ContainerRule, Problem
from foon_asp.problem.dead_ends import Cause
from foon_asp.text.line_parser import parse_node
from tests import oracle
from tests.conftest import ROOT, Cli
from tests.random_problems import random_problem

pytestmark = pytest.mark.sampled(2)  # by default each second case of a test: there are many


def network_problem(kitchen: str, goal: str, *units: str) -> Problem:
    """Make a problem of units ``a+b>c``; kitchen and goal are labels."""
    builder = NetworkBuilder()
    for line, unit in enumerate(units, 1):
        inputs, outputs = ([ObjectNode.of(name) for name in side.split("+")] for side in unit.split(">"))
        builder.add(f"m{line}", inputs, outputs, Source("units", line))
    network = builder.build()
    ids = {node.label: o for o, node in enumerate(network.objects)}
    stocked = frozenset(ids[name] for name in kitchen)
    return Problem(network, stocked, tuple(ids[name] for name in goal), None, frozenset())


def named(problem: Problem, nodes: Iterable[int]) -> str:
    return "".join(sorted(problem.network.objects[o].label for o in nodes))


def test_a_missing_item_is_named_with_the_unit_it_stops() -> None:
    problem = network_problem("a", "d", "a+b>c", "c>d")
    found = why_not(problem)
    assert named(problem, found.goals) == "d"
    assert {named(problem, [o]): [b.unit for b in made] for o, made in found.dead_ends.items()} == {
        "d": [1],
        "c": [0],
        "b": [],
    }
    (root,) = found.roots
    assert (named(problem, [root.object]), root.cause, root.stops, root.on_the_way) == (
        "b",
        Cause.MISSING,
        (0,),
        True,
    )


def test_a_cycle_that_feeds_only_itself_is_told_from_what_waits_for_it() -> None:
    problem = network_problem("a", "e", "a+c>b", "b>c", "b>d", "d+a>e")
    (root,) = why_not(problem).roots
    assert root.cause is Cause.CYCLE
    assert root.cycle is not None
    assert named(problem, root.cycle.nodes) == "bc"


def test_a_cycle_that_a_missing_item_would_start_is_no_root() -> None:
    problem = network_problem("a", "c", "a+c>b", "b>c", "a+x>b")
    (root,) = why_not(problem).roots
    assert (named(problem, [root.object]), root.cause) == ("x", Cause.MISSING)


def test_a_cycle_behind_a_cycle_is_found_too() -> None:
    """With b and c at hand, d and e still wait for each other."""
    problem = network_problem("", "e", "c>b", "b>c", "e+b>d", "d+c>e")
    cycles = [root.cycle for root in why_not(problem).roots if root.cycle]
    assert sorted(named(problem, cycle.nodes) for cycle in cycles) == ["bc", "de"]


def test_the_unit_that_takes_the_fewest_things_comes_first() -> None:
    problem = network_problem("a", "g", "x+y>g", "a+z>g")
    found = why_not(problem)
    assert [blocked.unit for blocked in found.dead_ends[problem.goals[0]]] == [1, 0]
    assert [(named(problem, [r.object]), r.on_the_way) for r in found.roots] == [
        ("z", True),
        ("x", False),
        ("y", False),
    ]


def test_what_is_only_handed_on_is_missing() -> None:
    problem = network_problem("a", "d", "a+k>d+k")
    (root,) = why_not(problem).roots
    assert (named(problem, [root.object]), root.cause) == ("k", Cause.MISSING)


def closure(problem: Problem, at_hand: set[ObjectNode]) -> set[ObjectNode]:
    """Close a kitchen under all units, naively."""
    units = [problem.network.unit(u) for u in range(len(problem.network))]
    made = set(at_hand)
    for _ in units:
        for unit in units:
            if oracle.needed(unit, problem.containers, problem.utensils) <= made:
                made |= oracle.made(unit, problem.containers, problem.utensils)
    return made


@pytest.mark.slow
@pytest.mark.parametrize("rule", list(ContainerRule))
def test_roots_are_necessary_and_enough(rule: ContainerRule) -> None:
    explained = cycles = 0
    for seed in range(6000, 6400):
        problem = random_problem(seed, rule)
        objects = problem.network.objects
        kitchen = {objects[o] for o in problem.kitchen}
        found = why_not(problem)
        makeable = closure(problem, kitchen)
        assert {objects[g] for g in found.goals} == {objects[g] for g in problem.goals} - makeable
        assert {objects[o] for o, there in enumerate(found.available) if there} == makeable
        explained += bool(found.goals)
        on_the_way: set[ObjectNode] = set()
        for root in found.roots:
            nodes = {objects[root.object]} if root.cycle is None else {objects[o] for o in root.cycle.nodes}
            # necessary: with everything else at hand, nothing of it can be made
            assert not nodes & closure(problem, set(objects) - nodes)
            if root.on_the_way:
                on_the_way |= nodes
            cycles += root.cycle is not None
        assert {objects[g] for g in problem.goals} <= closure(problem, kitchen | on_the_way)
    assert explained > 20
    assert cycles > 5


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
        ("whisk; clean", "whisk; dirty", None),
        ("whisk; clean", "whisk;", None),
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
    for file in (ROOT / "data" / "kitchen").iterdir():
        text = file.read_text(encoding="utf-8")
        if file.name == "kitchen.json":
            assert text.count('"drinking glass"') == 1
            text = text.replace('"drinking glass"', '"drinking glas"')
        (tmp_path / file.name).write_text(text, encoding="utf-8")
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
    builder = NetworkBuilder()
    builder.add("crush", [parse_node("ice; cubed; in [glas]")], [parse_node("ice; crushed")], Source("f", 1))
    builder.add("fill", [parse_node("water;")], [parse_node("ice; cubed; in [glass]")], Source("f", 5))
    network = builder.build()
    goal, water = (network.object_id(parse_node(name)) for name in ("ice; crushed", "water;"))
    assert goal is not None
    assert water is not None
    (root,) = why_not(Problem(network, frozenset({water}), (goal,), None, frozenset())).roots
    (near,) = root.near
    assert near.name == "ice; cubed; in [glass]"
    assert near.slip.kind == "relation"


@pytest.mark.slow
def test_exit_codes(cli: Cli) -> None:
    there = cli("why-not", "--goal", "ice")
    assert (there.code, "there is a task tree" in there.out) == (0, True)
    assert cli("why-not", "--goal", "ice", "--format", "json").json["tree_exists"] is True
    assert cli("why-not", "--goal", "hot cocoa").code == 1
    assert cli("why-not", "--goal", "hot cocoa", "--containers", "implied").code == 0
    clash = cli("why-not", "--goal", "ice", "--constraint", "at_most_units", "-c", "max_units=1")
    assert clash.code == 1
    assert "1 constraint leaves no task tree" in clash.out
    holds = cli("why-not", "--goal", "ice", "--constraint", "at_most_units", "-c", "max_units=2")
    assert holds.code == 0
    assert "no clash" in holds.out
    assert "there is a task tree" in cli("why-not", "--goal", "ice", "--encodings", "by_need").out


def test_causes_that_are_not_shown_are_counted() -> None:
    builder = NetworkBuilder()
    soup = ObjectNode.of("soup")
    for count in (1, 12):
        missing = [ObjectNode.of(f"herb {count} {number}") for number in range(count)]
        builder.add("cook", missing, [soup], Source("soup", count))
    network = builder.build()
    goal = network.object_id(soup)
    assert goal is not None
    said = why_not(Problem(network, frozenset(), (goal,), None, frozenset())).text()
    assert "\n12 more behind other units; --format json lists all\n" in said


def test_the_last_line_is_the_cheapest_fix(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    ran = cli("why-not", "--goal", "hot cocoa")
    fix = "cheapest fix: add cocoa tin; contains {cocoa powder} (foon-asp shopping-list says more)"
    assert ran.out.splitlines()[-1] == fix
    fix = cli("why-not", "--goal", "hot cocoa", "--format", "json").json["fix"]
    assert ([item["label"] for item in fix["items"]], fix["proved"]) == (["cocoa tin"], True)
    monkeypatch.setattr("foon_asp.deadline._LATE", 60)  # the machine may be busy: nothing else ends it
    ran = cli("why-not", "--goal", "hot cocoa", "--time-limit", "0")
    assert ran.out.splitlines()[-1].startswith("foon-asp shopping-list with the same options")


@pytest.mark.slow
def test_the_text_is_a_small_tree(cli: Cli, universal: Path) -> None:
    for rule in ContainerRule:
        words = ["why-not", "--data", universal, "--goal", "whipped cream", "--containers", rule]
        ran = cli(*words)
        assert ran.code == 1
        assert "mixing bowl; in [mixer]; contains {condensed milk,cream cheese,pudding mix}  (1)" in ran.out
        assert "what gives it needs it too: pour and blend" in ran.out
        assert "(can be made)" in ran.out
        assert ran.out.count("\n") < 40
        found = cli(*words, "--format", "json").json
        assert [root["cause"] for root in found["roots"]] == ["missing"]


def test_several_goals_share_what_is_shown(cli: Cli) -> None:
    ran = cli("why-not", "--goal", "hot cocoa", "--goal", "apple pie")
    assert ran.code == 1
    assert "1 object node is missing and 1 cycle feeds only itself" in ran.out
    lines = ran.out.split("\n")
    assert sum("whisk    [" in line and "see above" not in line for line in lines) == 1


def test_at_a_limit_the_causes_are_given_without_what_would_help(monkeypatch: pytest.MonkeyPatch) -> None:
    def stopped(*_: object) -> None:
        assert "foon-asp limits" in {thread.name for thread in threading.enumerate()}
        raise KeyboardInterrupt

    problem = foon_asp.load().problem("apple pie")
    whole = foon_asp.why_not(problem)
    assert whole.fix is not None
    monkeypatch.setattr("foon_asp.questions.why_not._fix", stopped)
    found = foon_asp.why_not(problem, time_limit=600)
    assert (found.goals, found.roots, found.fix) == (whole.goals, whole.roots, None)
    monkeypatch.setattr("foon_asp.questions.why_not._Spellings", stopped)
    found = foon_asp.why_not(problem, time_limit=600)
    assert [root.object for root in found.roots] == [root.object for root in whole.roots]


def test_without_time_for_the_causes_there_is_no_answer(monkeypatch: pytest.MonkeyPatch, cli: Cli) -> None:
    def stopped(_: object) -> None:
        raise LimitError(Deadline(0))

    monkeypatch.setattr("foon_asp.questions.why_not.dead_ends", stopped)
    with pytest.raises(foon_asp.StoppedError):
        foon_asp.why_not(foon_asp.load().problem("apple pie"), time_limit=600)
    ran = cli("why-not", "--goal", "apple pie", "--time-limit", "600")
    assert ran.code == 3
    assert "before there was an answer" in ran.err
