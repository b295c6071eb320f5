"""What `stats` counts, on a network small enough to count by hand, and on real ones."""

import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foon_asp.network import Network, NetworkBuilder, ObjectNode, Source
from foon_asp.network.graph import UNREACHED, cycles, layers, parts
from foon_asp.network.statistics import count, most_connected_labels, most_connected_objects
from foon_asp.problem import ContainerRule
from tests.conftest import CORPUS, Cli
from tests.random_problems import random_problem


def network_of(*units: tuple[str, str]) -> Network:
    """Build units from letters: the inputs and the outputs."""
    builder = NetworkBuilder()
    for line, (inputs, outputs) in enumerate(units, 1):
        sides = ([ObjectNode.of(letter) for letter in side] for side in (inputs, outputs))
        builder.add("mix", *sides, Source("f.txt", line))  # type: ignore[arg-type]
    return builder.build()


def named(network: Network, nodes: list[int]) -> str:
    return "".join(sorted(network.objects[o].label for o in nodes))


def test_layers_go_by_the_highest_input_and_the_lowest_maker() -> None:
    network = network_of(("ab", "c"), ("c", "d"), ("ad", "e"), ("a", "e"), ("x", "y"))
    node_layer, unit_layer = layers(network, [network.object_id(ObjectNode.of(o)) or 0 for o in "ab"])
    assert {n.label: layer for n, layer in zip(network.objects, node_layer, strict=True)} == {
        "a": 0, "b": 0, "c": 1, "d": 2, "e": 1, "x": UNREACHED, "y": UNREACHED,
    }  # fmt: skip
    assert unit_layer == [1, 2, 3, 1, UNREACHED]


def test_cycles_are_sets_of_nodes_that_need_each_other() -> None:
    network = network_of(("a", "b"), ("b", "c"), ("c", "a"), ("c", "d"), ("de", "e"), ("f", "g"))
    assert sorted(named(network, circle) for circle in cycles(network)) == ["abc", "e"]


def test_parts_share_no_node() -> None:
    assert parts(network_of(("a", "b"), ("b", "c"), ("x", "y"), ("bz", "z"))) == [3, 1]
    assert parts(network_of()) == []


@pytest.mark.slow
def test_a_long_chain_is_no_trouble() -> None:
    builder = NetworkBuilder()
    nodes = [ObjectNode.of(str(number)) for number in range(20_000)]
    for line, (one, other) in enumerate(zip(nodes, [*nodes[1:], nodes[0]], strict=True), 1):
        builder.add("go", [one], [other], Source("f.txt", line))
    network = builder.build()
    assert list(map(len, cycles(network))) == [20_000]
    assert max(layers(network, [0])[1]) == 20_000


def test_counts_by_hand() -> None:
    builder = NetworkBuilder()
    empty, full = ObjectNode.of("bowl", ["empty"]), ObjectNode.of("bowl", contents=[("contains", ["egg"])])
    egg, cooked = (
        ObjectNode.of("egg", [], [("in", "box")]),
        ObjectNode.of("egg", ["cooked"], [("in", "bowl")]),
    )
    builder.add("add", [egg, empty], [full], Source("a.txt", 1, 1, ("v",)), Source("b.txt", 1))
    builder.add("cook", [full], [cooked, full], Source("a.txt", 9))
    builder.add("eat", [cooked, full], [empty], Source("a.txt", 19))
    network = builder.build()
    counted = count(network)
    assert (counted.units, counted.objects, counted.labels, counted.motions) == (3, 4, 2, 3)
    assert (counted.states, counted.relations, counted.contents) == (2, 2, 1)
    assert (counted.mean_inputs, counted.most_inputs) == (5 / 3, 2)
    assert counted.producers == (1, 2, 1, 0, 0)
    assert counted.most_producers == 2
    assert (counted.unused, counted.unchanged) == (0, 0)
    assert (counted.cycles, counted.in_cycles, counted.largest_cycle) == (1, 3, 3)
    # the egg in its box alone makes nothing: no bowl is at hand
    assert (counted.at_hand, counted.depth, counted.unreached_objects, counted.unreached_units) == (
        1,
        0,
        3,
        3,
    )
    reached = count(network, [network.object_id(egg) or 0, network.object_id(empty) or 0])
    assert (reached.depth, reached.median_depth, reached.unreached_units) == (3, 2, 0)
    assert most_connected_labels(network, 1) == [("bowl", 3)]
    assert most_connected_objects(network, 1) == [(network.object_id(full), 2, 2)]


def test_ties_go_by_the_alphabet_and_by_the_order_of_reading() -> None:
    network = network_of(("za", "c"), ("b", "y"))
    assert [label for label, _ in most_connected_labels(network, 9)] == ["a", "b", "c", "y", "z"]
    assert [node for node, _, _ in most_connected_objects(network, 9)] == [0, 1, 2, 3, 4]


def test_lists_of_objects_and_other_json_are_no_networks(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "one.txt").write_text("O\ta\nM\tmix\nO\tb\n//\n")
    (tmp_path / "package.json").write_text('{"name": "no FOON"}')
    (tmp_path / "pantry.json").write_text('[{"label": "a"},\n {"label": "b"}]')
    (tmp_path / "pantry.txt").write_text("O\ta\nO\tb\n")
    ran = cli("stats", tmp_path, "--format", "json")
    assert ran.code == 0
    assert ran.json["units_read"] == 1
    assert ran.err.count("2 objects and no motion: a list such as a kitchen or goals") == 2
    assert "package.json" not in ran.err


@settings(deadline=None, derandomize=True, max_examples=100)
@given(seed=st.integers(0, 10_000))
def test_layers_are_rounds_of_all_that_can_run(seed: int) -> None:
    problem = random_problem(seed, ContainerRule.STRICT)
    network = problem.network
    node_layer, unit_layer = layers(network, problem.kitchen)
    at_hand, number = set(problem.kitchen), 0
    while True:
        assert at_hand == {o for o, layer in enumerate(node_layer) if 0 <= layer <= number}
        running = [u for u, needs in enumerate(network.inputs) if at_hand.issuperset(needs)]
        if all(0 <= unit_layer[u] <= number for u in running):
            break
        number += 1
        assert running == [u for u, layer in enumerate(unit_layer) if 0 <= layer <= number]
        at_hand.update(o for u in running for o in network.outputs[u])
    assert max(unit_layer) <= number


@settings(deadline=None, derandomize=True, max_examples=100)
@given(seed=st.integers(0, 10_000))
def test_cycles_are_what_reaches_itself(seed: int) -> None:
    network = random_problem(seed, ContainerRule.STRICT).network
    size = len(network.objects)
    reach = [set[int]() for _ in range(size)]
    for inputs, outputs in zip(network.inputs, network.outputs, strict=True):
        for node in inputs:
            reach[node].update(outputs)
    for middle in range(size):
        for node in range(size):
            if middle in reach[node]:
                reach[node] |= reach[middle]
    wanted = {frozenset(o for o in reach[n] if n in reach[o]) for n in range(size) if n in reach[n]}
    assert {frozenset(circle) for circle in cycles(network)} == wanted


def test_the_bundled_kitchen_for_people(cli: Cli) -> None:
    ran = cli("stats")
    assert ran.code == 0
    assert ran.err == ""
    lines = ran.out.splitlines()
    assert lines[0].startswith("220 units read from 1 file")
    row = next(line for line in lines if line.startswith("functional units"))
    assert row.split()[2:][-1] == "220"
    assert "reach from the kitchen" in lines


def test_files_and_folders_may_be_named(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "one.txt").write_text("O\ta\nM\tmix\nO\tb\n//\n")
    (tmp_path / "two.json").write_text(
        '[{"input_nodes":[{"label":"a"}],"motion_node":"mix","output_nodes":[{"label":"b"}]}]'
    )
    (tmp_path / "kitchen.txt").write_text("O\ta\n")
    ran = cli("stats", tmp_path, "--format", "json")
    assert ran.code == 0, ran.err
    told = json.loads(ran.out)
    assert (told["units_read"], told["copies"], told["videos"]) == (2, 1, [])
    assert told["files"] == [{"file": str(tmp_path / name), "units": 1} for name in ("one.txt", "two.json")]
    assert told["reached_from"] == "kitchen"
    assert [level["level"] for level in told["levels"]] == [1, 2, 3]
    assert cli("stats", "--data", tmp_path, "--format", "json").out == ran.out
    together = json.loads(cli("stats", tmp_path / "one.txt", tmp_path / "two.json", "--format", "json").out)
    assert together["reached_from"] == "not made"
    assert [level["units"] for level in together["levels"]] == [1, 1, 1]


@pytest.mark.skipif(not CORPUS.exists(), reason="the corpus of real FOON files is not here")
def test_the_real_corpus(cli: Cli) -> None:
    told = json.loads(cli("stats", "--data", CORPUS / "universal", "--format", "json").out)
    assert [(level["units"], level["objects"]) for level in told["levels"]] == [
        (2079, 502),
        (2280, 2528),
        (2376, 4305),
    ]
    assert told["levels"][2]["at_hand"] == 1173
    told = json.loads(cli("stats", CORPUS / "subgraphs", "--format", "json").out)
    assert (len(told["files"]), told["units_read"], len(told["videos"])) == (56, 1131, 26)
    assert [(level["units"], level["objects"]) for level in told["levels"]] == [
        (991, 337),
        (1061, 1331),
        (1099, 2152),
    ]
    ran = cli("stats", CORPUS / "dialects", "--format", "json")
    assert ran.code == 0
    assert ran.json["reached_from"] == "kitchen"
    assert len(ran.json["files"]) == 5  # neither the kitchen nor the goals
