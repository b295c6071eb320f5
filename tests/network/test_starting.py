"""The starting kitchen: what makes the units of each file run, and what merging files does to it."""

import warnings
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import foon_asp
from foon_asp.network import STARTING, Network, NetworkBuilder, Source, starting_nodes
from foon_asp.network.object_node import ObjectNode
from foon_asp.problem import reach
from tests.conftest import CORPUS, Cli

SUBGRAPHS = sorted((CORPUS / "subgraphs").glob("*.txt"))
real = pytest.mark.skipif(not SUBGRAPHS, reason=f"the real corpus is not at {CORPUS}")

CARTON, EMPTY, FULL = (
    "O\tcarton\nS\tcontains\t{milk}\n",
    "O\tcup\nS\tempty\n",
    "O\tcup\nS\tcontains\t{milk}\n",
)
CUP = f"{CARTON}{EMPTY}M\tpour\n{FULL}//\n{FULL}M\tdrink\n{EMPTY}//\n"

Units = list[tuple[list[int], list[int]]]
_side = st.lists(st.integers(0, 6), min_size=1, max_size=3, unique=True)
_file: st.SearchStrategy[Units] = st.lists(st.tuples(_side, _side), min_size=1, max_size=5)


def merged(*files: Units) -> Network:
    builder = NetworkBuilder()
    for number, units in enumerate(files):
        for line, sides in enumerate(units, 1):
            inputs, outputs = ([ObjectNode(f"n{o}") for o in side] for side in sides)
            builder.add("m", inputs, outputs, Source(f"{number}.txt", line))
    return builder.build()


def executes(network: Network, kitchen: frozenset[int]) -> bool:
    """Whether all units run from a kitchen, items lasting."""
    there, waiting = set(kitchen), set(range(len(network)))
    while ready := {unit for unit in waiting if there.issuperset(network.inputs[unit])}:
        waiting -= ready
        there.update(o for unit in ready for o in network.outputs[unit])
    return not waiting


def optimum(network: Network, goal: str) -> int | None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        answer = foon_asp.solve(foon_asp.build(network).problem(ObjectNode(goal)))
    return None if answer.units is None else len(answer.units)


@given(_file, st.integers(0, 6))
def test_every_unit_of_a_file_runs_and_the_goal_is_never_assumed(units: Units, asked: int) -> None:
    network = merged(units)
    goal = network.object_id(ObjectNode(f"n{asked}"))
    goals = () if goal is None else (goal,)
    kitchen = starting_nodes(network, goals)
    assert executes(network, starting_nodes(network))
    assert executes(network, kitchen)
    makers = [] if goal is None else [u for u in network.producers[goal] if goal not in network.inputs[u]]
    assert not (makers and goal in kitchen)
    made = {o for u, outputs in enumerate(network.outputs) for o in outputs if o not in network.inputs[u]}
    raw = frozenset(range(len(network.objects))) - made
    if executes(network, raw):
        assert kitchen == raw


@given(st.lists(_file, min_size=2, max_size=3), st.data())
@settings(max_examples=25)
def test_merging_loses_no_goal_and_makes_no_optimum_worse(files: list[Units], data: st.DataObject) -> None:
    alone = files[data.draw(st.integers(0, len(files) - 1))]
    made = sorted({o for inputs, outputs in alone for o in outputs if o not in inputs})
    if not made:
        return
    goal = f"n{data.draw(st.sampled_from(made))}"
    first, together = optimum(merged(alone), goal), optimum(merged(*files), goal)
    assert first is not None
    assert together is not None
    assert together <= first


def test_a_cup_that_is_given_back(cli: Cli, tmp_path: Path) -> None:
    file, store = tmp_path / "cup.txt", tmp_path / "cup.foon"
    file.write_text(CUP, encoding="utf-8")
    assert cli("merge", file, "--store", store).code == 0
    for named in (file, store):
        for goal, made in (("cup; contains {milk}", "cup; empty"), ("cup; empty", "cup; contains {milk}")):
            ran = cli("solve", named, "--goal", goal)
            assert (ran.code, "optimal by units" in ran.out) == (0, True)
            assert "No kitchen given: assuming what the recipe does not make is available" in ran.err
            assert ran.err.endswith(f"and of what a unit makes too: {made}\n")
    proof = tmp_path / "proof.json"
    assert cli("solve", file, "--certificate", proof).code == 0
    assert cli("verify", proof, file).code == 0


def test_the_bare_vessel_is_proposed(cli: Cli, tmp_path: Path) -> None:
    file, kitchen = tmp_path / "cup.txt", tmp_path / "kitchen.txt"
    file.write_text(CUP + FULL + "M\tfroth\nO\tfoam\n//\n", encoding="utf-8")
    kitchen.write_text(CARTON, encoding="utf-8")
    words = (file, "--kitchen", kitchen, "--goal", "foam")
    assert "object node\n  cup; empty\n" in cli("shopping-list", *words).out
    assert "try adding cup; empty (" in cli("why-not", *words).out


def test_init_writes_the_kitchen_and_asks_for_no_goal(cli: Cli, tmp_path: Path) -> None:
    file, folder = tmp_path / "two.txt", tmp_path / "new"
    file.write_text(f"{CUP}{CARTON}M\tsplit\nO\tcream\nO\twhey\n//\n", encoding="utf-8")
    assert cli("init", folder, "--from", file).code == 0
    assert "O\tcup\nS\tempty\n" in (folder / "kitchen.txt").read_text(encoding="utf-8")
    for named in (file, folder):
        ran = cli("solve", named)
        assert (ran.code, ran.out.count("goal: "), ran.out.count("optimal by units")) == (0, 2, 1)


@real
def test_every_real_recipe_runs_and_merging_keeps_all_goals() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        foons = [foon_asp.load(file, kitchen=str(STARTING), lenient=True) for file in SUBGRAPHS]
        together = foon_asp.load(SUBGRAPHS, kitchen=str(STARTING), lenient=True)
    for foon in foons:
        for goal in foon.goals:
            problem = foon.problem(goal)
            assert executes(problem.network, problem.kitchen)
            assert all(reach(together.problem(goal)).available[o] for o in together.problem(goal).goals)
