"""What `stats` counts, on a network small enough to count by hand, and on real ones."""

from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import foon_asp
from foon_asp.network.graph import cycles
from foon_asp.problem import ContainerRule
from tests.conftest import CORPUS, Cli
from tests.support.random_problems import random_problem

COUNTS = {
    "units": 3,
    "objects": 4,
    "labels": 2,
    "motions": 3,
    "states": 2,
    "relations": 2,
    "contents": 1,
    "mean_inputs": 5 / 3,
    "most_inputs": 2,
    "producers": [1, 2, 1, 0, 0],
    "most_producers": 2,
    "unused": 0,
    "unchanged": 0,
    "cycles": 1,
    "in_cycles": 3,
    "largest_cycle": 3,
    "at_hand": 2,
    "depth": 3,
    "unreached_objects": 0,
    "unreached_units": 0,
    "parts": 1,
}


def counted(cli: Cli, tmp_path: Path, units: list[Any], *words: str) -> Any:
    """Give what is told about a network, and of level 3."""
    (tmp_path / "FOON.txt").write_text(foon_asp.write_units(foon_asp.build(units, kitchen=()).network))
    told = cli("stats", tmp_path / "FOON.txt", *words, "--format", "json").json
    return {**told, **told["levels"][2]}


def test_counts_by_hand(cli: Cli, tmp_path: Path) -> None:
    """With the egg in its box goes the bowl that eating gives back."""
    units = [
        ("add", ["egg; in [box]", "bowl; empty"], "bowl; contains {egg}"),
        ("cook", "bowl; contains {egg}", ["egg; cooked; in [bowl]", "bowl; contains {egg}"]),
        ("eat", ["egg; cooked; in [bowl]", "bowl; contains {egg}"], "bowl; empty"),
    ]
    told = counted(cli, tmp_path, units)
    assert {name: told[name] for name in COUNTS} == COUNTS
    assert told["most_connected_labels"] == [{"label": label, "units": 3} for label in ("bowl", "egg")]
    busiest = told["most_connected_objects"][0]
    assert (busiest["object"]["node"], busiest["needed_by"], busiest["made_by"]) == (
        "bowl; contains {egg}",
        2,
        2,
    )
    (tmp_path / "kitchen.txt").write_text("O\tegg\nS\tin\t[box]\n//\nO\tbowl\nS\tempty\n")
    reached = counted(cli, tmp_path, units, "--kitchen", str(tmp_path / "kitchen.txt"))
    assert [reached[name] for name in ("depth", "median_depth", "unreached_units")] == [3, 2, 0]


def test_parts_share_no_node(cli: Cli, tmp_path: Path) -> None:
    units = [("m", "a", "b"), ("m", "b", "c"), ("m", "x", "y"), ("m", ["b", "z"], "z")]
    told = counted(cli, tmp_path, units)
    assert (told["parts"], told["largest_part"]) == (2, 3)
    assert [each["label"] for each in told["most_connected_labels"]] == [*"bacxyz"]


@pytest.mark.slow
def test_a_long_chain_is_no_trouble(cli: Cli, tmp_path: Path) -> None:
    told = counted(cli, tmp_path, [("go", str(n), str((n + 1) % 9_000)) for n in range(9_000)])
    assert (told["cycles"], told["largest_cycle"]) == (1, 9_000)


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


def test_files_and_folders_may_be_named(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "one.txt").write_text("O\ta\nM\tmix\nO\tb\n//\n")
    (tmp_path / "two.json").write_text(
        '[{"input_nodes":[{"label":"a"}],"motion_node":"mix","output_nodes":[{"label":"b"}]}]'
    )
    (tmp_path / "kitchen.txt").write_text("O\ta\n")
    told = cli("stats", tmp_path, "--format", "json").json
    files = [tmp_path / name for name in ("one.txt", "two.json")]
    assert (told["units_read"], told["copies"], told["videos"]) == (2, 1, [])
    assert told["files"] == [{"file": str(file), "units": 1} for file in files]
    assert told["reached_from"] == "kitchen"
    together = cli("stats", *files, "--format", "json").json
    assert together["reached_from"] == "starting kitchen"
    assert [(level["level"], level["units"]) for level in together["levels"]] == [(1, 1), (2, 1), (3, 1)]


@pytest.mark.skipif(not CORPUS.exists(), reason="the corpus of real FOON files is not here")
@pytest.mark.parametrize(
    ("words", "counts", "sizes"),
    [
        (["--data", CORPUS / "universal"], (1, 2376, 0), [(2079, 502), (2280, 2528), (2376, 4305)]),
        ([CORPUS / "subgraphs"], (56, 1131, 26), [(991, 337), (1061, 1331), (1099, 2152)]),
        # neither the kitchen nor the goals are files of units
        ([CORPUS / "dialects"], (5, 149, 4), [(109, 68), (133, 211), (134, 294)]),
    ],
)
def test_the_real_corpus(
    cli: Cli, words: list[str | Path], counts: tuple[int, int, int], sizes: list[tuple[int, int]]
) -> None:
    told = cli("stats", *words, "--format", "json").json
    assert (len(told["files"]), told["units_read"], len(told["videos"])) == counts
    assert [(level["units"], level["objects"]) for level in told["levels"]] == sizes
