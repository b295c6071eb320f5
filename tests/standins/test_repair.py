"""The cheapest repair of a tree is that of brute force, and runs."""

import random
from pathlib import Path

import pytest

import foon_asp
from foon_asp.problem import Objective
from foon_asp.proof.simulation import Verdict, simulate_for
from foon_asp.standins.repair import Repair
from tests.conftest import Cli
from tests.oracle import stand_ins
from tests.standins.test_best_stand_ins import posed

SEEDS = pytest.mark.parametrize(
    "seeds", [range(20), pytest.param(range(20, 1000), marks=pytest.mark.slow)], ids=["few", "many"]
)
RECIPE = """O\tegg\nS\twhole\nO\tpan\nS\thot\nM\tfry\nO\tegg\nS\tfried\nS\ton\t[plate]\n//\n"""
NETWORK = """O\tpan\nM\theat\nO\tpan\nS\thot\n//\nO\teggs\nS\twhole\nM\tpack\nO\tbox\n//\n"""
KITCHEN = '[{"label": "eggs", "states": ["whole"]}, {"label": "pan"}, {"label": "egg", "states": ["raw"]}]'


@SEEDS
def test_the_cheapest_repair_is_that_of_brute_force(seeds: range) -> None:
    repaired = 0
    for seed in seeds:
        problem, table = posed(seed)
        network = problem.network
        steps = sorted(random.Random(seed).sample(range(len(network)), min(2, len(network))))
        tree = [network.unit(step) for step in steps]
        places = [network.sources[step][0] for step in steps]
        needed = Repair.of(problem, tree, places, table, lambda _: False)
        outcome = foon_asp.solve(needed.posed, "dissimilarity,units")
        expected = stand_ins.best(problem, table, ("dissimilarity", "units"), steps)
        assert (
            outcome.costs and outcome.costs.key((Objective.DISSIMILARITY, Objective.UNITS))
        ) == expected, seed
        if outcome.ids is not None:
            repaired += 1
            assert {*needed.steps} <= {*outcome.ids}
            shown = foon_asp.TaskTree(tuple(needed.shown.network.unit(unit) for unit in outcome.ids))
            assert simulate_for(needed.shown, shown).verdict is Verdict.AS_LISTED
    assert repaired > len(seeds) // 4


def test_a_tree_is_repaired(tmp_path: Path, cli: Cli) -> None:
    for name, text in (("tree.txt", RECIPE), ("FOON.txt", NETWORK), ("kitchen.json", KITCHEN)):
        (tmp_path / name).write_text(text)
    data = ("--network", str(tmp_path / "FOON.txt"), "--kitchen", str(tmp_path / "kitchen.json"))
    ran = cli("check", str(tmp_path / "tree.txt"), "--repair", *data)
    assert ran.code == 0
    lines = ran.out.splitlines()
    assert lines[1:7] == [
        "as it is: does not execute",
        "repaired (strict containers; proved cheapest): 1 stand-in, 1 step added",
        "stand-ins, with a dissimilarity of 1 in all:",
        "  eggs; whole",
        "    for egg; whole",
        "    costs 1: eggs instead of egg (1)",
    ]
    assert "     (added)" in lines
    written = cli("check", str(tmp_path / "tree.txt"), "--repair", *data, "--format", "foon")
    (tmp_path / "repaired.txt").write_text(written.out)
    checked = cli("check", str(tmp_path / "repaired.txt"), "--kitchen", str(tmp_path / "kitchen.json"))
    assert "executes as listed" in checked.out


def test_what_cannot_be_had_is_listed(tmp_path: Path, cli: Cli) -> None:
    (tmp_path / "tree.txt").write_text(RECIPE.replace("egg", "ostrich"))
    (tmp_path / "FOON.txt").write_text(NETWORK)
    (tmp_path / "kitchen.json").write_text(KITCHEN)
    data = ("--network", str(tmp_path / "FOON.txt"), "--kitchen", str(tmp_path / "kitchen.json"))
    ran = cli("check", str(tmp_path / "tree.txt"), "--repair", *data)
    assert ran.code == 1
    assert ran.out.splitlines()[2:] == [
        "no repair exists: proved (strict containers)",
        "nothing makes, and nothing stands in for:",
        "  ostrich; whole",
    ]
