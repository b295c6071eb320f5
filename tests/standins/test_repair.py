"""The cheapest repair of a tree is that of brute force, and runs."""

import random
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

import foon_asp
from foon_asp.certificate import certify_infeasible
from foon_asp.certificate.certificate import subject_of
from foon_asp.certificate.coverage import Coverage
from foon_asp.errors import BugError
from foon_asp.network import STAND_IN
from foon_asp.problem import Objective
from foon_asp.proof import verifier
from foon_asp.proof.certificate_header import seal
from foon_asp.proof.certificate_json import load_certificate
from foon_asp.proof.refusal import RefusedError
from foon_asp.proof.simulation import Verdict, simulate_for
from foon_asp.standins import with_stand_ins
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


@SEEDS
def test_certificates_hold_and_a_raised_bound_is_refused(seeds: range, tmp_path: Path) -> None:
    claims = {"optimal": 0, "infeasible": 0}
    for seed in seeds:
        problem, table = posed(seed)
        network = problem.network
        steps = random.Random(seed).sample(range(len(network)), min(2, len(network)))
        tree = [network.unit(step) for step in steps]
        asked = with_stand_ins(problem, table)
        repaired = foon_asp.repair(asked, tree, certificate=tmp_path / "proof.json")
        assert repaired.certificate is not None, seed
        claims[repaired.certificate.claim] += 1
        places = [network.sources[step][0] for step in steps]
        subject = subject_of(Repair.of(problem, tree, places, table, lambda _: False).shown)
        content = load_certificate(tmp_path / "proof.json")
        verified = verifier.verify(content, subject)
        expected = stand_ins.best(problem, table, ("dissimilarity", "units"), steps)
        assert (verified.costs or None) == expected, seed
        if expected is None:
            continue
        assert verified.tree is not None
        assert {*steps} <= {*verified.tree}
        dissimilarity, units = map(Fraction, expected)
        for raised in ((dissimilarity + 1, units), (dissimilarity, units + 1)):
            forged = {**content, "claim": "bound", "tree": None, "costs": None, "bound": [*map(str, raised)]}
            with pytest.raises(RefusedError, match=r"the weights do not add up|stand-in is missing"):
                verifier.verify({**forged, "seal": seal(forged)}, subject)
        fewer = [unit for unit in verified.tree if unit != steps[0]]
        forged = {**content, "tree": fewer}
        with pytest.raises(RefusedError):
            verifier.verify({**forged, "seal": seal(forged)}, subject)
    assert min(claims.values()) > len(seeds) // 8


def test_no_stand_in_may_be_missing_from_the_proof_that_no_repair_exists() -> None:
    missing = 0
    for seed in range(40):
        problem, table = posed(seed)
        steps = random.Random(seed).sample(range(len(problem.network)), 2)
        needed = Repair.over(problem, tuple(steps), table)
        units = foon_asp.solve(needed.posed, "dissimilarity,units").ids or ()
        covered = Coverage(({"rule": "all_steps", "units": sorted(steps)},))
        for unit in [unit for unit in units if needed.shown.network.motions[unit] == STAND_IN]:
            smaller = replace(needed.shown.network.without([unit]), unit_numbers=())
            marked = replace(
                needed.posed, network=replace(needed.posed.network.without([unit]), unit_numbers=())
            )
            if foon_asp.solve(marked).ids is None:
                missing += 1
                with pytest.raises(BugError, match="refused: a stand-in is missing"):
                    certify_infeasible(replace(needed.shown, network=smaller), covered)
    assert missing > 3


def test_a_repair_is_verified_from_the_files(tmp_path: Path, cli: Cli) -> None:
    tree, proof = tmp_path / "tree.txt", str(tmp_path / "proof.json")
    for file, text in (
        (tree, RECIPE),
        (tmp_path / "FOON.txt", NETWORK),
        (tmp_path / "kitchen.json", KITCHEN),
    ):
        file.write_text(text)
    data = ("--network", str(tmp_path / "FOON.txt"), "--kitchen", str(tmp_path / "kitchen.json"))
    ran = cli("check", str(tree), "--repair", *data, "--certificate", proof)
    assert ran.code == 0
    assert ran.out.splitlines()[-1].startswith(f"proof: certificate ({proof}, ")
    verified = cli("verify", proof, str(tree), *data)
    assert verified.code == 0
    assert verified.out.splitlines()[1:3] == [
        "verified: no task tree is better by dissimilarity, then units (strict containers): "
        "1 dissimilarity, 3 units",
        "among the trees that keep to all_steps (units: 0)",
    ]
    (tmp_path / "mine.txt").write_text("spelling\t2\n")
    other = cli("verify", proof, str(tree), *data, "--stand-in-table", str(tmp_path / "mine.txt"))
    assert (other.code, "add --stand-ins, and the files of stand-ins" in other.err) == (2, True)
    tree.write_text(RECIPE.replace("egg", "ostrich"))
    assert cli("check", str(tree), "--repair", *data, "--certificate", proof).code == 1
    assert "verified: there is no task tree" in cli("verify", proof, str(tree), *data).out


def test_a_certificate_needs_the_units_of_the_tree_in_the_network(tmp_path: Path) -> None:
    (tmp_path / "tree.txt").write_text(RECIPE)
    with pytest.raises(foon_asp.UserError, match="name the tree, too"):
        foon_asp.repair(
            foon_asp.load().problem("ice"), tmp_path / "tree.txt", certificate=tmp_path / "proof.json"
        )


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
