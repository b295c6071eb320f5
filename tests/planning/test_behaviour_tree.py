"""Behaviour trees: valid XML of BehaviorTree.CPP 4, which py_trees runs to the goal whatever fails."""

import importlib.util
import json
import random
import re
import warnings
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest

import foon_asp
from foon_asp import Foon, NetworkBuilder, ObjectNode, Problem, Source, UsedUp, UserError
from foon_asp.questions.robot_plan import RobotPlan
from foon_asp.results.plain_values import read_plain
from tests.conftest import ROOT, Cli
from tests.oracle.used_up import random_problem as random_used_up
from tests.proof.by_hand import recipe
from tests.support.random_problems import random_problem
from tests.support.simulated_kitchen import run

needs_py_trees = pytest.mark.skipif(
    importlib.util.find_spec("py_trees") is None, reason="py_trees is not installed (foon-asp[robot])"
)
CONTROL = {"Sequence", "ReactiveSequence", "Fallback"}
DECORATORS = {"RetryUntilSuccessful"}
LEAVES = {"Action", "Condition", "AlwaysSuccess"}
FORBIDDEN = re.compile(r"""[\s<>&"'/\\:*?|.]""")


def faults(xml: str) -> Iterator[str]:
    """Yield what BehaviorTree.CPP 4 would refuse, by its documentation.

    The XML schema: a root with BehaviorTree elements, each with an ID and one child; control nodes have
    children, decorators one, leaves none; an explicit leaf has an ID. The rules for editors: every node is
    in the one TreeNodesModel, with its kind and its ports; the main tree exists. Names of models and ports
    have no characters that paths and XML reserve, and a value in braces would be an entry of the blackboard.
    """
    root = ElementTree.fromstring(xml)
    if root.tag != "root" or root.get("BTCPP_format") != "4":
        yield "no root of format 4"
    models = root.findall("TreeNodesModel")
    if len(models) != 1:
        yield f"{len(models)} models"
    known = {model.get("ID", ""): model for each in models for model in each}
    ports = {name: {port.get("name", "") for port in model} for name, model in known.items()}
    yield from (
        f"name {name!r}" for name in [*known, *set().union(*ports.values())] if FORBIDDEN.search(name)
    )
    trees = root.findall("BehaviorTree")
    if root.get("main_tree_to_execute") not in {tree.get("ID") for tree in trees}:
        yield "no main tree"
    for tree in trees:
        if len(tree) != 1:
            yield f"a tree of {len(tree)} children"
        for element in tree.iter():
            if element is not tree:
                yield from node_faults(element, known, ports)


def node_faults(
    element: ElementTree.Element, known: dict[str, ElementTree.Element], ports: dict[str, set[str]]
) -> Iterator[str]:
    tag, name = element.tag, element.get("ID", "")
    if tag not in CONTROL | DECORATORS | LEAVES:
        yield f"unknown node {tag}"
    if (tag in CONTROL and not len(element)) or (tag in DECORATORS and len(element) != 1):
        yield f"{tag} of {len(element)} children"
    if tag in LEAVES and len(element):
        yield f"{tag} with children"
    if tag in {"Action", "Condition"}:
        if name not in known or known[name].tag != tag:
            yield f"{tag} {name!r} is not in the model"
        elif extra := element.attrib.keys() - {"ID", "name"} - ports[name]:
            yield f"ports {extra} of {name} are not in the model"
    yield from (
        f"{value} is an entry of the blackboard" for value in element.attrib.values() if value[:1] == "{"
    )


def nodes_in(xml: str) -> Counter[str]:
    tree = ElementTree.fromstring(xml).find("BehaviorTree")
    assert tree is not None
    return Counter(element.tag for element in tree.iter()) - Counter(["BehaviorTree"])


def tree_of(problem: Problem, objective: str = "units") -> str:
    """Return the behaviour tree of the best tree; empty where there is none."""
    return foon_asp.solve(problem, objective).behaviour_tree()


@pytest.fixture(scope="module")
def bundled() -> Foon:
    return foon_asp.load()


GOALS = [entry["label"] for entry in json.loads((ROOT / "data/kitchen/goal_nodes.json").read_text())]


@pytest.mark.parametrize(
    "break_", ["BTCPP_format", 'ID="Plan"', 'input_port name="needs"', "<Condition .*/>", "<Action .*/>", "4"]
)
def test_the_check_finds_what_is_broken(bundled: Foon, break_: str) -> None:
    xml = tree_of(bundled.problem("ice"))
    assert not list(faults(xml))
    broken = (
        re.sub(break_, "<nothing/>" if "<" in break_ else "x", xml)
        if break_ != "4"
        else xml.replace("4", "3", 1)
    )
    try:
        assert list(faults(broken))
    except ElementTree.ParseError:
        assert break_ != "4"


def test_the_tree_of_two_steps(bundled: Foon) -> None:
    root = ElementTree.fromstring(tree_of(bundled.problem("ice")))
    (sequence,) = root.iter("ReactiveSequence")
    assert [fallback.get("name") for fallback in sequence] == ["1 twist", "2 crush"]
    condition, action = sequence[1]
    assert condition.attrib == {"ID": "NodesAvailable", "nodes": "o50-ice-crushed-in-drinking-glass"}
    assert action.attrib == {
        "ID": "ExecuteUnit",
        "name": "2 crush",
        "step": "2",
        "unit": "27",
        "motion": "crush",
        "needs": "o46-ice-cubed-in-drinking-glass;o47-drinking-glass-contains-ice;o49-muddler-clean",
        "makes": "o50-ice-crushed-in-drinking-glass",
        "acted_on": "o46-ice-cubed-in-drinking-glass",
        "tools": "o49-muddler-clean",
        "from": "o47-drinking-glass-contains-ice",
        "to": "o47-drinking-glass-contains-ice",
        "rate": "0.7",
    }


@pytest.mark.parametrize("goal", GOALS)
def test_a_tree_is_valid_and_has_three_nodes_for_each_step(bundled: Foon, goal: str) -> None:
    answer = foon_asp.solve(bundled.problem(goal))
    xml = answer.behaviour_tree()
    assert bool(xml) is bool(answer)
    if not answer:
        return
    assert not list(faults(xml))
    steps = len(answer.units or ())
    assert nodes_in(xml) == Counter(ReactiveSequence=1, Fallback=steps, Condition=steps, Action=steps)


@pytest.mark.parametrize("words", [(), ("--items", "used-up"), ("--objective", "attempts")])
def test_steps_alone_are_enough_to_build_the_tree(cli: Cli, words: tuple[str, ...]) -> None:
    question = ("solve", "--goal", "macaroni", "--durations", ROOT / "data/kitchen/durations.txt", *words)
    steps = cli(*question, "--format", "steps").json
    assert read_plain(RobotPlan, steps).behaviour_tree() == cli(*question, "--format", "behaviour-tree").out
    assert "duration" in cli(*question, "--format", "behaviour-tree").out


def test_whatever_a_thing_is_called_the_tree_is_valid() -> None:
    odd = ["<\"&;'>", "{x}", "näh; \x07", "//", "a\u2028b", ";", "\ud800"]
    builder = NetworkBuilder()
    inputs = [ObjectNode.of(name, [name], [("in", f"{{{name}}}")]) for name in odd]
    builder.add("{<fry>\n}", inputs, [ObjectNode.of("{done}")], Source("by hand", 1))
    problem = Problem(builder.build(), frozenset(range(len(odd))), (len(odd),), None, frozenset())
    xml = tree_of(problem)
    assert not list(faults(xml))
    (action,) = ElementTree.fromstring(xml).findall("BehaviorTree//Action")
    assert len(action.attrib["needs"].split(";")) == len(odd)


def test_what_the_kitchen_holds_already_needs_no_step() -> None:
    xml = tree_of(recipe("chop: onion > onion; chopped", kitchen="onion; chopped"))
    assert not list(faults(xml))
    assert nodes_in(xml) == Counter(ReactiveSequence=1, AlwaysSuccess=1)


def test_no_tree_is_no_behaviour_tree(cli: Cli, tmp_path: Path) -> None:
    assert tree_of(recipe("chop: onion > onion; chopped", kitchen="salt")) == ""
    ran = cli("solve", "--all-goals", "--goal", "ice", "--format", "behaviour-tree")
    assert ran.code == 2
    assert "this is no tree" in ran.err


@needs_py_trees
def test_a_step_that_fails_is_tried_again_and_no_other() -> None:
    problem = recipe("chop: onion > onion; chopped", "fry: onion; chopped > onion; fried", kitchen="onion")
    outcomes = iter([True, False, False, True])
    executed, there = [], {"o0-onion"}

    def execute(execution: foon_asp.Execution) -> bool:
        executed.append(execution.motion)
        success = next(outcomes)
        there.update(execution.makes if success else ())
        return success

    root = foon_asp.py_trees_root(tree_of(problem), execute, there.__contains__)
    statuses = []
    for _ in range(3):
        root.tick_once()
        statuses.append(root.status.name)
    assert executed == ["chop", "fry", "fry", "fry"]
    assert statuses == ["FAILURE", "FAILURE", "SUCCESS"]


@needs_py_trees
def test_what_is_lost_is_made_again() -> None:
    problem = recipe("chop: onion > onion; chopped", "fry: onion; chopped > onion; fried", kitchen="onion")
    there: set[str] = set()
    executed = []

    def execute(execution: foon_asp.Execution) -> bool:
        executed.append(execution.motion)
        if executed == ["chop", "fry"]:
            there.clear()  # the frying pan falls down
            return False
        there.update(execution.makes)
        return True

    root = foon_asp.py_trees_root(tree_of(problem), execute, there.__contains__)
    root.tick_once()
    root.tick_once()
    assert executed == ["chop", "fry", "chop", "fry"]
    assert root.status.name == "SUCCESS"


@needs_py_trees
def test_a_tree_of_others_is_refused(tmp_path: Path) -> None:
    def runs(xml: str | Path) -> None:
        foon_asp.py_trees_root(xml, lambda _: True, lambda _: True)

    tree = tree_of(recipe("chop: onion > onion; chopped", kitchen="onion"))
    for xml, message in [
        ("<root", "unclosed token"),
        ("<root/>", "no <BehaviorTree>"),
        ('<root><BehaviorTree ID="x"><Parallel/></BehaviorTree></root>', "Parallel"),
        (tree.replace(' motion="chop"', ""), "the behaviour tree: found an element without 'motion'"),
        (tree.replace(' step="1"', ' step="one"'), "invalid literal"),
        (
            '<root><BehaviorTree ID="x"><RetryUntilSuccessful num_attempts="2"/></BehaviorTree></root>',
            "no child",
        ),
    ]:
        with pytest.raises(UserError, match=message):
            runs(xml)
    with pytest.raises(UserError, match=r"none\.xml: cannot be read"):
        runs(tmp_path / "none.xml")
    (tmp_path / "some.xml").write_text(tree_of(recipe("chop: onion > onion; chopped", kitchen="onion")))
    runs(tmp_path / "some.xml")


@needs_py_trees
@pytest.mark.parametrize("seed", range(30))
def test_random_trees_reach_their_goals(seed: int) -> None:
    rule = random.Random(seed).choice(list(foon_asp.ContainerRule))
    for problem in (random_problem(seed, rule), random_used_up(seed)):
        xml = tree_of(problem)
        if xml:
            assert not list(faults(xml))
            for failing in (0.0, 0.3):
                run(problem, xml, failing, seed)


def kinds(problem: Problem) -> Iterator[Problem]:
    yield problem
    yield replace(problem, items=UsedUp())


@needs_py_trees
@pytest.mark.parametrize(
    "goal", ["ice", "macaroni", *(pytest.param(g, marks=pytest.mark.slow) for g in GOALS)]
)
def test_bundled_goals_are_reached(bundled: Foon, goal: str, runs: int) -> None:
    for problem in kinds(bundled.problem(goal)):
        reach(problem, foon_asp.solve(problem), runs)


@pytest.fixture
def runs(request: pytest.FixtureRequest) -> int:
    """How often a tree is run: a hundred times by the slow tests."""
    markers = map(request.node.get_closest_marker, ("slow", "nightly"))
    return 100 if any(markers) else 3


def reach(problem: Problem, answer: foon_asp.Answer, runs: int) -> None:
    """Run the tree without failures, where each run is the same, and with 30 % of them, in many runs."""
    xml = answer.behaviour_tree()
    assert bool(xml) is bool(answer)
    if not answer:
        return
    assert not list(faults(xml))
    assert run(problem, xml, 0, 0).executed == [*(answer.ids or ())]
    for seed in range(runs):
        assert run(problem, xml, 0.3, seed).executed == [*(answer.ids or ())]


@needs_py_trees
@pytest.mark.nightly
def test_goals_of_the_corpus_are_reached(universal: Path, runs: int) -> None:
    with warnings.catch_warnings(action="ignore", category=foon_asp.FoonWarning):
        foon = foon_asp.load(universal)
    goals = [
        node for outputs in foon.network.outputs for node in map(foon.network.objects.__getitem__, outputs)
    ]
    units = []
    for goal in random.Random(0).sample(goals, len(goals)):
        problem = foon.problem(goal)
        answer = foon_asp.solve(problem)
        if len(answer.units or ()) > 2:
            reach(problem, answer, runs)
            units.append(len(answer.units or ()))
        if len(units) == 20:
            break
    assert (len(units), max(units) > 20) == (20, True)
