"""Levels: what counts of a node, which units become one, and answers that can be refined."""

import json
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foon_asp.asp import Status, solve
from foon_asp.network import (
    LEVELS,
    FunctionalUnit,
    Network,
    NetworkBuilder,
    NodePattern,
    ObjectNode,
    Source,
    TaskTree,
    network_at_level,
    node_at_level,
    pattern_at_level,
    unit_at_level,
)
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.proof.simulation import Verdict, simulate_for
from foon_asp.text.data_folder import find_data, kitchen_nodes, read_data
from tests.conftest import CORPUS, ROOT, Cli
from tests.oracle import needed
from tests.random_problems import random_problem

BOWL = ObjectNode.of("bowl", ["clean"], [("on", "table")], [("contains", ["egg", "salt"])])


def test_what_counts_of_a_node() -> None:
    assert node_at_level(BOWL, 3) == BOWL
    assert node_at_level(BOWL, 2) == ObjectNode.of("bowl", ["clean"], [("on", "table")])
    assert node_at_level(BOWL, 1) == ObjectNode.of("bowl")


def test_what_counts_of_an_entry() -> None:
    entry = NodePattern("bowl", frozenset({"clean"}), ("egg",), "table")
    assert pattern_at_level(entry, 3) == entry
    assert pattern_at_level(entry, 2) == NodePattern("bowl", frozenset({"clean"}), (), "table")
    assert pattern_at_level(entry, 1) == NodePattern("bowl")
    assert pattern_at_level(entry, 2).matches(node_at_level(BOWL, 2))
    assert pattern_at_level(entry, 1).matches(node_at_level(BOWL, 1))


def small() -> Network:
    """Eggs into a bowl, salt into a bowl with eggs: at level 2 the bowl does not change."""
    builder = NetworkBuilder()
    empty, eggs, both = (
        ObjectNode.of("bowl", contents=[("contains", items)] if items else [])
        for items in ([], ["egg"], ["egg", "salt"])
    )
    egg, salt = ObjectNode.of("egg", ["raw"]), ObjectNode.of("salt")
    builder.add("add", [egg, empty], [eggs], Source("a.txt", 1))
    builder.add("add", [egg, eggs], [eggs], Source("a.txt", 9))
    builder.add("add", [salt, eggs], [both], Source("b.txt", 1))
    return builder.build()


def test_units_that_are_the_same_become_one_and_say_which_they_were() -> None:
    network = small()
    below = network_at_level(network, 2)
    assert [str(below.unit(unit)) for unit in range(len(below))] == [
        "add: egg; raw + bowl → bowl",
        "add: salt + bowl → bowl",
    ]
    assert below.stands_for == ((0, 1), (2,))
    assert [str(node) for node in below.objects] == ["egg; raw", "bowl", "salt"]
    assert below.objects_stand_for == ((0,), (1, 2, 4), (3,))
    assert below.detailed is network
    assert [source.line for source in below.sources[0]] == [1, 9]
    assert (below.level, network.level) == (2, 3)
    assert network_at_level(network, 3) is network


@pytest.mark.parametrize("level", [0, 4])
def test_there_are_three_levels(level: int) -> None:
    with pytest.raises(ValueError, match="no way"):
        network_at_level(small(), level)
    with pytest.raises(ValueError, match="no way"):
        network_at_level(network_at_level(small(), 2), 2)


def at_level(problem: Problem, level: int) -> Problem:
    """Ask the same at a level."""
    network = network_at_level(problem.network, level)

    def nodes(ids: "tuple[int, ...] | frozenset[int]") -> list[int]:
        found = [network.object_id(node_at_level(problem.network.objects[o], level)) for o in ids]
        return [o for o in dict.fromkeys(found) if o is not None]

    return Problem(
        network,
        frozenset(nodes(problem.kitchen)),
        tuple(nodes(problem.goals)),
        problem.rates,
        problem.utensils,
        problem.containers,
    )


@pytest.mark.slow
@pytest.mark.parametrize("rule", ContainerRule)
@settings(deadline=None, derandomize=True, max_examples=60)
@given(
    seed=st.integers(0, 10_000),
    level=st.sampled_from([1, 2]),
    objective=st.sampled_from([Objective.UNITS, Objective.INPUTS, Objective.SUCCESS]),
)
def test_what_can_be_made_can_be_made_at_every_level_below_and_costs_no_more(
    rule: ContainerRule, seed: int, level: int, objective: Objective
) -> None:
    problem = random_problem(seed, rule)
    outcome = solve(problem, [objective])
    below = at_level(problem, level)
    best = solve(below, [objective])
    if outcome.units is None:
        assert outcome.status is Status.INFEASIBLE
        return
    tree = TaskTree(tuple(unit_at_level(problem.network.unit(unit), level) for unit in outcome.units))
    assert simulate_for(below, tree).verdict is not Verdict.NEVER
    assert best.status is Status.OPTIMAL
    assert best.costs is not None
    assert outcome.costs is not None
    assert best.costs.key((objective,)) <= outcome.costs.key((objective,))


@pytest.mark.slow
@pytest.mark.parametrize("level", [1, 2])
@settings(deadline=None, derandomize=True, max_examples=100)
@given(seed=st.integers(0, 10_000))
def test_a_unit_takes_as_given_what_one_of_its_level_3_units_does(level: int, seed: int) -> None:
    problem = random_problem(seed, ContainerRule.IMPLIED)
    below = at_level(problem, level)
    units = [problem.network.unit(u) for u in range(len(problem.network))]
    for unit, needs in enumerate(below.needs):
        whole = below.network.unit(unit)
        each = [
            {node_at_level(node, level) for node in needed(u, problem.containers, problem.utensils)}
            for u in units
            if unit_at_level(u, level) == whole
        ]
        assert {below.network.objects[o] for o in needs} == set.intersection(*each)
        assert needs == tuple(o for o in below.network.inputs[unit] if o in needs)


def test_a_bowl_taken_as_given_is_taken_as_given_below() -> None:
    onion, soup = ObjectNode.of("onion", [], [("in", "bowl")]), ObjectNode.of("soup")
    bowls = [
        ObjectNode.of("bowl", contents=[("contains", held)]) for held in (["onion"], ["garlic", "onion"])
    ]
    builder = NetworkBuilder()
    for line, bowl in enumerate(bowls, 1):
        builder.add("cook", [bowl, onion], [soup], Source("f.txt", line))
    network = builder.build()
    for rule, costs in ((ContainerRule.IMPLIED, 1), (ContainerRule.STRICT, None)):
        asked = Problem(network, frozenset({1}), (2,), None, frozenset({"bowl"}), rule)
        for level in LEVELS:
            outcome = solve(at_level(asked, level), [Objective.UNITS])
            assert (outcome.costs.units if outcome.costs else None) == costs


@settings(deadline=None, derandomize=True, max_examples=60)
@given(seed=st.integers(0, 10_000))
def test_a_level_is_the_image_of_the_one_above(seed: int) -> None:
    network = random_problem(seed, ContainerRule.STRICT).network
    sizes = []
    for level in LEVELS:
        below = network_at_level(network, level)
        wanted = {unit_at_level(network.unit(unit), level) for unit in range(len(network))}
        assert {below.unit(unit) for unit in range(len(below))} == wanted
        assert set(below.objects) == {node_at_level(node, level) for node in network.objects}
        sizes.append((len(below), len(below.objects)))
        if level < 3:
            assert sorted(unit for units in below.stands_for for unit in units) == list(range(len(network)))
            for unit, units in enumerate(below.stands_for):
                assert {unit_at_level(network.unit(u), level) for u in units} == {below.unit(unit)}
            assert sorted(o for nodes in below.objects_stand_for for o in nodes) == list(
                range(len(network.objects))
            )
            for o, nodes in enumerate(below.objects_stand_for):
                assert {node_at_level(network.objects[n], level) for n in nodes} == {below.objects[o]}
    assert sizes == sorted(sizes)


def test_answers_say_their_level_and_what_steps_stand_for(cli: Cli) -> None:
    ran = cli("solve", "--goal", "macaroni", "--level", "2")
    assert ran.code == 0
    assert "optimal by units (strict containers, level 2)" in ran.out
    assert "goal: macaroni; cooked; in [pot]\n  stands for 1 object node at level 3:\n" in ran.out
    place = "[" + str(ROOT / "data" / "kitchen" / "FOON.txt") + ":992]"
    assert f"stands for 1 unit at level 3:\n       78    {place}  open: macaroni box; sealed" in ran.out
    answer = json.loads(cli("solve", "--goal", "macaroni", "--level", "2", "--format", "json").out)
    assert answer["level"] == 2
    ((stands_for,),) = [goal["stands_for"] for goal in answer["goals"]]
    assert stands_for["node"] == "macaroni; cooked; in [pot]"
    detailed = json.loads(cli("solve", "--goal", "macaroni", "--format", "json").out)
    assert detailed["level"] == 3
    assert "stands_for" not in detailed["goals"][0]
    assert "stands_for" not in detailed["units"][0]
    for unit in answer["units"]:
        places = [(s["file"], s["line"]) for s in unit["source"]]
        assert [(s["file"], s["line"]) for u in unit["stands_for"] for s in u["source"]] == places


@pytest.mark.parametrize(
    "words",
    [
        ["solve", "--goal", "macaroni"],
        ["search", "bfs", "--goal", "macaroni"],
        ["compare", "--goal", "macaroni"],
        ["optima", "--goal", "macaroni"],
        ["facts", "--goal", "macaroni"],
        ["draw", "--goal", "macaroni"],
    ],
)
@pytest.mark.parametrize("level", ["1", "2"])
def test_every_verb_with_a_network_has_levels(cli: Cli, words: list[str], level: str) -> None:
    ran = cli(*words, "--level", level)
    assert ran.code == 0, ran.err
    assert ran.out
    assert ran.out != cli(*words).out


def test_a_tree_of_level_3_is_checked_at_the_level_asked(cli: Cli, tmp_path: Path) -> None:
    tree = tmp_path / "tree.txt"
    tree.write_text(cli("solve", "--goal", "macaroni", "--format", "foon").out)
    ran = cli("check", tree, "--goal", "macaroni", "--level", "2")
    assert ran.code == 0
    assert "level 2" in ran.out
    assert "not one of the network" not in ran.out


def test_long_lists_are_folded_in_text_and_whole_in_json(cli: Cli, tmp_path: Path) -> None:
    text = "".join(f"O\ta\nM\tmix\nO\tbowl\nS\tcontains\t{{{item}}}\n//\n" for item in "bcdefgh")
    (tmp_path / "FOON.txt").write_text(text)
    (tmp_path / "kitchen.txt").write_text("O\ta\n")
    asked = ("--data", tmp_path, "--goal", "bowl", "--level", "2")
    ran = cli("solve", *asked)
    assert ran.code == 0
    assert ran.out.count("more; --format json lists all") == 2
    assert "stands for 7 units at level 3:" in ran.out
    assert "stands for 7 object nodes at level 3:" in ran.out
    (unit,) = cli("solve", *asked, "--format", "json").json["units"]
    assert [detail["id"] for detail in unit["stands_for"]] == list(range(7))
    assert [detail["source"][0]["line"] for detail in unit["stands_for"]] == list(range(1, 36, 5))


def test_searches_and_comparisons_say_their_level(cli: Cli) -> None:
    asked = ("--goal", "macaroni", "--level", "2")
    ran = cli("search", "ids", *asked)
    assert "(strict containers, level 2)" in ran.out
    assert "at level 3" in ran.out
    found = cli("search", "ids", *asked, "--format", "json").json
    assert found["level"] == 2
    assert all(unit["stands_for"] for unit in found["units"])
    assert "(strict containers, level 2)" in cli("compare", *asked).out
    compared = cli("compare", *asked, "--format", "json").json
    assert (compared["level"], len(compared["comparisons"])) == (2, 1)
    assert "(strict containers, level 2)" in cli("optima", *asked).out


def test_goals_that_are_one_at_a_level_are_asked_once(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "FOON.txt").write_text("O\ta\nM\tmix\nO\tb\nS\tx\nO\tb\nS\ty\n//\n")
    (tmp_path / "kitchen.txt").write_text("O\ta\n")
    (tmp_path / "goal_nodes.txt").write_text("O\tb\nS\tx\nO\tb\nS\ty\n")
    asked = ("optima", "--data", tmp_path, "--objective", "units", "--format", "json")
    assert len(cli(*asked).json["answers"]) == 2
    assert len(cli(*asked, "--level", "1").json["answers"]) == 1
    compared = ("compare", "--data", tmp_path, "--search", "bfs", "--format", "json")
    assert len(cli(*compared).json["comparisons"]) == 2
    assert len(cli(*compared, "--level", "1").json["comparisons"]) == 1


def test_a_tree_is_drawn_at_its_level(cli: Cli, tmp_path: Path) -> None:
    tree = tmp_path / "tree.txt"
    tree.write_text(cli("solve", "--goal", "macaroni", "--format", "foon").out)
    ran = cli("draw", "--tree", tree, "--goal", "macaroni", "--level", "2", "--format", "dot")
    assert ran.code == 0
    assert "executes as listed (strict containers, level 2), 9 units" in ran.out


def test_a_goal_is_named_at_its_level(cli: Cli) -> None:
    goal = "macaroni box; contains {macaroni}"
    assert "goal: macaroni box; contains {macaroni}\n" in cli("solve", "--goal", goal).out
    assert "goal: macaroni box\n" in cli("solve", "--goal", goal, "--level", "2").out
    assert "goal: macaroni\n" in cli("solve", "--goal", "macaroni; cooked; in [pot]", "--level", "1").out


@pytest.mark.skipif(not CORPUS.exists(), reason="the corpus of real FOON files is not here")
def test_the_universal_foon_at_every_level() -> None:
    counts = []
    for level in LEVELS:
        data = read_data(find_data(CORPUS / "universal"), level=level)
        assert data.kitchen == kitchen_nodes(data.network, data.kitchen_items)
        counts.append((len(data.network), len(data.network.objects)))
        problem = Problem(data.network, data.kitchen, (0,), data.rates, data.utensils)
        assert problem.costs(range(3)).success is not None
        assert problem.costs([]).success == Fraction(1)
        assert isinstance(data.network.unit(0), FunctionalUnit)
    assert counts == [(2079, 502), (2280, 2528), (2376, 4305)]
