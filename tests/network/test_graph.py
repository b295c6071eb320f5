"""The network as a graph, against the plainest ways to see the same: layers, cycles, parts, dead cycles."""

import json
from pathlib import Path
from statistics import median

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foon_asp.network import Network, NetworkBuilder, ObjectNode
from foon_asp.network.dead_cycles import dead_cycles
from foon_asp.network.statistics import most_connected_labels, most_connected_objects, network_statistics
from foon_asp.text.data_folder import DataFiles, read_data
from tests.text.foon_strategies import steady

UNITS = st.lists(st.tuples(st.text("abcdefg", max_size=3), st.text("abcdefg", max_size=2)), max_size=9)


def network(*units: tuple[str, str]) -> Network:
    """Build a network of nodes with one letter."""
    builder = NetworkBuilder()
    for inputs, outputs in units:
        builder.add("go", map(ObjectNode.of, inputs), map(ObjectNode.of, outputs))
    return builder.build()


@settings(steady, max_examples=200)
@given(UNITS.map(lambda units: [(a or "a", b) for a, b in units]), st.sets(st.integers(0, 6), max_size=3))
def test_what_is_counted(units: list[tuple[str, str]], start: set[int]) -> None:
    found = network(*units)
    at_hand = [node for node in start if node < len(found.objects)]
    counted = network_statistics(found, at_hand)
    sides = list(zip(map(set, found.inputs), map(set, found.outputs), strict=True))

    layer, step, unit_layers = dict.fromkeys(at_hand, 0), 0, dict[int, int]()
    while ready := [
        u for u, (needed, _) in enumerate(sides) if u not in unit_layers and needed <= layer.keys()
    ]:
        step += 1
        unit_layers.update(dict.fromkeys(ready, step))
        for unit in ready:
            for node in sides[unit][1]:
                layer.setdefault(node, step)
    assert (counted.depth, counted.median_depth) == (step, median(unit_layers.values()) if unit_layers else 0)
    assert counted.unreached_objects == len(found.objects) - len(layer)
    assert counted.unreached_units == len(found) - len(unit_layers)

    after = {node: {o for a, b in sides if node in a for o in b} for node in range(len(found.objects))}
    for _ in after:
        after = {node: near.union(*(after[o] for o in near)) for node, near in after.items()}
    circles = {frozenset(o for o in after[n] if n in after[o]) for n in after if n in after[n]}
    sizes = [len(circle) for circle in circles]
    assert (counted.cycles, counted.in_cycles, counted.largest_cycle) == (
        len(sizes),
        sum(sizes),
        max(sizes, default=0),
    )

    pieces: list[tuple[set[int], int]] = []
    for needed, made in sides:
        touched = [piece for piece in pieces if piece[0] & (needed | made)]
        pieces = [piece for piece in pieces if piece not in touched]
        pieces.append((needed.union(made, *(p[0] for p in touched)), 1 + sum(p[1] for p in touched)))
    assert (counted.parts, counted.largest_part) == (len(pieces), max((p[1] for p in pieces), default=0))

    makers = [sum(node in made for _, made in sides) for node in after]
    assert counted.producers == tuple(sum(min(n, 4) == most for n in makers) for most in range(5))
    touching = {node: sum(node in a | b for a, b in sides) for node in after}
    labels = sorted(((found.objects[n].label, k) for n, k in touching.items()), key=lambda e: (-e[1], e[0]))
    assert most_connected_labels(found, 3) == labels[:3]
    assert [node for node, _, _ in most_connected_objects(found, 3)] == (
        sorted(touching, key=lambda node: (-touching[node], node))[:3]
    )


def test_a_network_is_shown_in_few_words_and_held_against_others() -> None:
    found = network(("a", "b"), ("b", "a"))
    assert repr(found) == "<Network: 2 units, 2 object nodes, level 3>"
    assert found.is_like(network(("a", "b"), ("b", "a")))
    assert not found.is_like(network(("a", "b")))
    assert [found.unit_of_number(number) for number in (1, 2)] == [1, None]


@pytest.mark.parametrize(
    ("entry", "levels"),
    [
        ({"states": ["x"], "container": "c", "ingredients": ["i"]}, [1, 2, 3]),
        ({"states": ["x"], "container": "c", "ingredients": ["j"]}, [1, 2]),
        ({"states": ["y"]}, [1]),
    ],
)
def test_entries_are_held_against_what_a_level_knows(
    tmp_path: Path, entry: dict[str, object], levels: list[int]
) -> None:
    file, kitchen = tmp_path / "a.txt", tmp_path / "kitchen.json"
    file.write_text("O\ta\nS\tx\nS\tin\t[c]\nS\tcontains\t{i}\nM\tmix\nO\tb\n//\n")
    kitchen.write_text(json.dumps([{"label": "a", **entry}]))
    data = DataFiles((file,), kitchen)
    assert [level for level in (1, 2, 3) if read_data(data, level=level).kitchen] == levels


@pytest.mark.parametrize(
    ("units", "labels"),
    [
        ("a>b b>c c>a a>d d>e", ["abc"]),
        ("a>b b>a cb>a", ["ab"]),
        ("ak>bk", []),  # what a unit hands on it does not make
        ("a>b b>a c>d db>c", ["ab", "cd"]),  # two cycles, of which one waits for the other
        ("a>b b>c c>d d>a b>a", ["ab"]),  # a shortest way around a larger set
        # of two sets in one that can be made in part, the one that waits for the other is none
        ("a>b b>a ca>d d>c c>e f>e ea>b", ["ab"]),
    ],
)
def test_the_way_around_a_dead_cycle(units: str, labels: list[str]) -> None:
    sides = (unit.split(">") for unit in units.split())
    found = network(*((inputs, outputs) for inputs, outputs in sides))
    around = ["".join(found.objects[node].label for node, _ in cycle.steps) for cycle in dead_cycles(found)]
    assert sorted(around) == labels


@settings(steady, max_examples=200)
@given(UNITS)
def test_without_a_dead_cycle_everything_can_be_made(units: list[tuple[str, str]]) -> None:
    found = network(*units)
    makers = {
        node: [unit for unit in units_ if node not in found.inputs[unit]]
        for node, units_ in enumerate(found.producers)
    }
    there = {node for node, units_ in makers.items() if not units_}
    for _ in found.objects:
        for unit, inputs in enumerate(found.inputs):
            if there.issuperset(inputs):
                there.update(found.outputs[unit])
    cycles = dead_cycles(found)
    assert (not cycles) == (len(there) == len(found.objects))
    for steps, nodes in cycles:
        assert not nodes & there
        # Each is made, and only by units that need one of them.
        assert all(makers[node] for node in nodes)
        assert all(nodes & set(found.inputs[unit]) for node in nodes for unit in makers[node])
        for (node, unit), (following, _) in zip(steps, (*steps[1:], steps[0]), strict=True):
            assert node in found.inputs[unit]
            assert unit in makers[following]
            assert {node, following} <= nodes
