"""Levels: what counts of a node, which units become one, and answers that can be refined."""

from collections.abc import Iterable
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import foon_asp
from foon_asp.asp import solve
from foon_asp.network import (
    LEVELS,
    NodePattern,
    ObjectNode,
    network_at_level,
    node_at_level,
    pattern_at_level,
    unit_at_level,
)
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.text.data_folder import find_data, kitchen_nodes, read_data
from tests.conftest import Cli
from tests.support.random_problems import random_problem

BOWL = ObjectNode.of("bowl", ["clean"], [("on", "table")], [("contains", ["egg", "salt"])])


def test_what_counts_of_a_node_and_of_an_entry() -> None:
    entry = NodePattern("bowl", frozenset({"clean"}), ("egg",), "table")
    for level, node, pattern in (
        (3, BOWL, entry),
        (
            2,
            ObjectNode.of("bowl", ["clean"], [("on", "table")]),
            NodePattern("bowl", frozenset({"clean"}), (), "table"),
        ),
        (1, ObjectNode.of("bowl"), NodePattern("bowl")),
    ):
        assert (node_at_level(BOWL, level), pattern_at_level(entry, level)) == (node, pattern)


def at_level(problem: Problem, level: int) -> Problem:
    """Ask the same at a level."""
    network = network_at_level(problem.network, level)

    def nodes(ids: Iterable[int]) -> tuple[int, ...]:
        found = [network.object_id(node_at_level(problem.network.objects[o], level)) for o in ids]
        return tuple(dict.fromkeys(o for o in found if o is not None))

    kitchen = frozenset(nodes(problem.kitchen))
    given = problem.rates, problem.utensils, problem.containers
    return Problem(network, kitchen, nodes(problem.goals), *given)


@pytest.mark.parametrize(("rule", "costs"), [(ContainerRule.IMPLIED, 1), (ContainerRule.STRICT, None)])
def test_a_bowl_taken_as_given_is_taken_as_given_below(rule: ContainerRule, costs: int | None) -> None:
    units = [
        ("cook", [f"bowl; contains {{{held}}}", "onion; in [bowl]"], "soup")
        for held in ("onion", "garlic,onion")
    ]
    foon = foon_asp.build(units, kitchen="onion; in [bowl]", goals="soup", utensils=["bowl"])
    for level in LEVELS:
        outcome = solve(at_level(foon.problem(containers=rule), level), [Objective.UNITS])
        assert (outcome.costs and outcome.costs.units) == costs


@settings(deadline=None, derandomize=True, max_examples=60)
@given(seed=st.integers(0, 10_000))
def test_a_level_is_the_image_of_the_one_above(seed: int) -> None:
    network = random_problem(seed, ContainerRule.STRICT).network
    units = [network.unit(unit) for unit in range(len(network))]
    for level in (1, 2):
        below = network_at_level(network, level)
        there: list[object] = [below.unit(unit) for unit in range(len(below))]
        lowered: list[object] = [unit_at_level(unit, level) for unit in units]
        nodes: list[object] = [node_at_level(node, level) for node in network.objects]
        for found, parts, whole in (
            (there, below.stands_for, lowered),
            (list(below.objects), below.objects_stand_for, nodes),
        ):
            assert found == list(dict.fromkeys(whole))  # in the order of those that come first
            assert [[whole[part] for part in some] for some in parts] == [
                [one] * whole.count(one) for one in found
            ]
        for sources, each in zip(below.sources, below.stands_for, strict=True):
            assert list(sources) == [source for unit in each for source in network.sources[unit]]
    assert network_at_level(network, 3) is network


def test_answers_say_their_level_and_what_steps_stand_for(cli: Cli) -> None:
    asked = ("solve", "--goal", "macaroni", "--level", "2")
    ran = cli(*asked)
    assert "goal: macaroni; cooked; in [pot]\n  stands for 1 object node at level 3:\n" in ran.out
    assert "stands for 1 unit at level 3:\n       78    [FOON.txt:992]  open: macaroni box; sealed" in ran.out
    answer = cli(*asked, "--format", "json").json
    assert answer["level"] == 2
    for unit in answer["units"]:
        assert [source for each in unit["stands_for"] for source in each["source"]] == unit["source"]
    detailed = cli(*asked[:3], "--format", "json").json
    assert detailed["level"] == 3
    assert not any("stands_for" in each for each in (*detailed["goals"], *detailed["units"]))


@pytest.mark.parametrize(
    "words",
    [
        ["solve", "--format", "json"],
        ["compare", "--trees"],
        ["solve", "--all-goals"],
        ["facts"],
        ["view", "--format", "dot"],
        ["view", "--tree", "TREE", "--format", "dot"],
        ["check", "TREE"],
    ],
)
def test_every_verb_with_a_network_has_levels(cli: Cli, tmp_path: Path, words: list[str]) -> None:
    tree = tmp_path / "tree.txt"
    tree.write_text(cli("solve", "--goal", "macaroni", "--format", "foon").out)
    asked = [tree if word == "TREE" else word for word in words]
    ran = cli(*asked, "--goal", "macaroni", "--level", "2")
    assert (ran.code, ran.out) != (0, cli(*asked, "--goal", "macaroni").out)
    assert ran.code == 0
    assert words[0] in {"solve", "facts"} or "(strict containers, level 2)" in ran.out
    assert "not one of the network" not in ran.out


def test_long_lists_are_folded_in_text_and_whole_in_json(cli: Cli, tmp_path: Path) -> None:
    text = "".join(f"O\ta\nM\tmix\nO\tbowl\nS\tcontains\t{{{item}}}\n//\n" for item in "bcdefgh")
    (tmp_path / "FOON.txt").write_text(text)
    (tmp_path / "kitchen.txt").write_text("O\ta\n")
    asked = ("solve", "--data", tmp_path, "--goal", "bowl", "--level", "2")
    said = cli(*asked).out
    assert said.count("more; --format json lists all") == 2
    assert "stands for 7 units at level 3:" in said
    assert "stands for 7 object nodes at level 3:" in said
    (unit,) = cli(*asked, "--format", "json").json["units"]
    lines = [(detail["id"], detail["source"][0]["line"]) for detail in unit["stands_for"]]
    assert lines == [*enumerate(range(1, 36, 5))]


@pytest.mark.parametrize(
    ("words", "listed"),
    [
        (("solve", "--all-goals", "--objective", "units"), "answers"),
        (("compare", "--search", "bfs"), "comparisons"),
    ],
)
def test_goals_that_are_one_at_a_level_are_asked_once(
    cli: Cli, tmp_path: Path, words: tuple[str, ...], listed: str
) -> None:
    (tmp_path / "FOON.txt").write_text("O\ta\nM\tmix\nO\tb\nS\tx\nO\tb\nS\ty\n//\n")
    (tmp_path / "kitchen.txt").write_text("O\ta\n")
    (tmp_path / "goal_nodes.txt").write_text("O\tb\nS\tx\nO\tb\nS\ty\n")
    for level, goals in ((3, 2), (1, 1)):
        found = cli(*words, "--data", tmp_path, "--level", str(level), "--format", "json").json
        assert len(found[listed]) == goals


@pytest.mark.parametrize(
    ("goal", "level", "shown"),
    [
        ("macaroni box; contains {macaroni}", "3", "macaroni box; contains {macaroni}"),
        ("macaroni box; contains {macaroni}", "2", "macaroni box"),
        ("macaroni; cooked; in [pot]", "1", "macaroni"),
    ],
)
def test_a_goal_is_named_at_its_level(cli: Cli, goal: str, level: str, shown: str) -> None:
    assert f"goal: {shown}\n" in cli("solve", "--goal", goal, "--level", level).out


@pytest.mark.parametrize(("level", "units", "objects"), [(1, 2079, 502), (2, 2280, 2528), (3, 2376, 4305)])
def test_the_universal_foon_at_every_level(universal: Path, level: int, units: int, objects: int) -> None:
    data = read_data(find_data(universal), level=level)
    assert data.kitchen == kitchen_nodes(data.network, data.kitchen_items)
    assert (len(data.network), len(data.network.objects)) == (units, objects)
    problem = Problem(data.network, data.kitchen, (0,), data.rates, data.utensils)
    assert problem.costs(range(3)).success is not None
