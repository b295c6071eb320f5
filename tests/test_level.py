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
from foon_asp.proof import Verdict, simulate_for
from foon_asp.text import find_data, kitchen_nodes, read_data
from tests.conftest import CORPUS, Cli
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
    above = network_at_level(network, 2)
    assert [str(above.unit(unit)) for unit in range(len(above))] == [
        "add: egg; raw + bowl → bowl",
        "add: salt + bowl → bowl",
    ]
    assert above.stands_for == ((0, 1), (2,))
    assert above.detailed is network
    assert [source.line for source in above.sources[0]] == [1, 9]
    assert (above.level, network.level) == (2, 3)
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


@settings(deadline=None, derandomize=True, max_examples=60)
@given(seed=st.integers(0, 10_000), level=st.sampled_from([1, 2]))
def test_what_can_be_made_can_be_made_at_every_level_below_and_costs_no_more(seed: int, level: int) -> None:
    problem = random_problem(seed, ContainerRule.STRICT)
    outcome = solve(problem, [Objective.UNITS])
    above = at_level(problem, level)
    if outcome.units is None:
        return
    tree = TaskTree(tuple(unit_at_level(problem.network.unit(unit), level) for unit in outcome.units))
    assert simulate_for(above, tree).verdict is not Verdict.NEVER
    best = solve(above, [Objective.UNITS])
    assert best.status is Status.OPTIMAL
    assert best.costs is not None
    assert outcome.costs is not None
    assert best.costs.units <= outcome.costs.units


@settings(deadline=None, derandomize=True, max_examples=60)
@given(seed=st.integers(0, 10_000))
def test_a_level_is_the_image_of_the_one_above(seed: int) -> None:
    network = random_problem(seed, ContainerRule.STRICT).network
    sizes = []
    for level in LEVELS:
        above = network_at_level(network, level)
        wanted = {unit_at_level(network.unit(unit), level) for unit in range(len(network))}
        assert {above.unit(unit) for unit in range(len(above))} == wanted
        assert set(above.objects) == {node_at_level(node, level) for node in network.objects}
        sizes.append((len(above), len(above.objects)))
        if level < 3:
            assert sorted(unit for units in above.stands_for for unit in units) == list(range(len(network)))
            for unit, units in enumerate(above.stands_for):
                assert {unit_at_level(network.unit(u), level) for u in units} == {above.unit(unit)}
    assert sizes == sorted(sizes)


def test_answers_say_their_level_and_what_steps_stand_for(cli: Cli) -> None:
    ran = cli("solve", "--goal", "macaroni", "--level", "2")
    assert ran.code == 0
    assert "optimal by units (strict containers, level 2)" in ran.out
    assert "stands for 1 unit at level 3:\n       78: open: macaroni box; sealed" in ran.out
    answer = json.loads(cli("solve", "--goal", "macaroni", "--level", "2", "--format", "json").out)
    assert answer["level"] == 2
    detailed = json.loads(cli("solve", "--goal", "macaroni", "--format", "json").out)
    assert detailed["level"] == 3
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
