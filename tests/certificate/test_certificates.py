"""Certificates of answers: found for every optimum, verified without a solver, never claiming too much."""

import json
import random
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.asp import Proof, Settings, Status, solve
from foon_asp.certificate import (
    Certificate,
    NotBestError,
    certify,
    certify_outcome,
)
from foon_asp.network import TaskTree
from foon_asp.problem import ContainerRule, Objective, Problem, levels
from foon_asp.proof.certificate_json import read_certificate
from foon_asp.proof.simulation import simulate_for
from foon_asp.proof.verified_claim import Verified
from foon_asp.resources import bundled_kitchen
from foon_asp.text.data_folder import find_data, read_data
from foon_asp.text.node_lookup import find_goal
from foon_asp.text.writer import write_units
from tests.conftest import ROOT, STRUCK_WHILE_READING, Cli
from tests.oracle import task_trees
from tests.proof.by_hand import recipe
from tests.support.gap_problem import gap_problem
from tests.support.handmade_certificate import check
from tests.support.random_problems import random_objectives, random_problem

RULES = list(ContainerRule)


def verified(certificate: Certificate, problem: Problem) -> Verified:
    """Verify what is written, not what was meant."""
    return check(read_certificate(certificate.text()), problem)


@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES)
def test_every_optimum_of_random_networks(rule: ContainerRule) -> None:
    trees = 0
    for seed in range(100):
        problem = random_problem(seed, rule)
        lists: list[tuple[Objective, ...]] = [(objective,) for objective in Objective]
        lists.append(random_objectives(random.Random(seed), 3))
        for objectives in lists:
            outcome, found = certify_outcome(solve(problem, objectives), Settings())
            assert found is not None
            assert outcome.proof is Proof.CERTIFICATE
            claim = verified(found, problem)
            if outcome.status is Status.INFEASIBLE:
                assert claim.claim == "infeasible"
                continue
            trees += bool(outcome.units)
            assert claim.claim == "optimal"
            assert claim.tree == outcome.units
            assert claim.objectives == outcome.certified == levels(objectives)
    assert trees > 70


@pytest.mark.slow
@pytest.mark.parametrize(("corners", "seeds"), [(3, 8), (4, 8), (5, 4), (9, 2)])
def test_branching_closes_gaps(corners: int, seeds: int) -> None:
    branched = 0
    for seed in range(seeds):
        problem = gap_problem(seed, corners, density=0.5 if corners == 9 else 0.7)
        for objectives in (*((each,) for each in Objective), random_objectives(random.Random(seed), 2)):
            outcome, found = certify_outcome(solve(problem, objectives), Settings())
            assert outcome.proof is Proof.CERTIFICATE
            assert found is not None
            assert verified(found, problem).claim == "optimal"
            branched += "branch" in found.content["proof"]
    assert branched > 10 or corners == 9


@pytest.mark.slow
def test_a_tree_that_is_not_the_best_is_told_so() -> None:
    worse = 0
    for seed in range(100):
        problem = random_problem(seed, ContainerRule.STRICT)
        found = list(task_trees.trees(problem))
        for objective in Objective:
            wanted = levels((objective,))
            best = task_trees.best(found, problem, [str(objective)])
            for tree in random.Random(seed).sample(found, min(3, len(found))):
                ordered = simulate_for(problem, TaskTree(tree)).order
                units = [u for step in ordered if (u := problem.network.unit_id(tree[step])) is not None]
                if task_trees.key(problem, tree, [str(objective)]) == best:
                    certificate = certify(problem, wanted, units)
                    assert certificate is not None
                    assert certificate.claim == "optimal"
                    continue
                worse += 1
                with pytest.raises(NotBestError) as better:
                    certify(problem, wanted, units)
                rival = tuple(map(problem.network.unit, better.value.units))
                assert task_trees.makes(problem, rival)
                assert better.value.costs.key(wanted) < problem.costs(units).key(wanted)
    assert worse > 100


# --- constraints


def test_replaced_encodings_are_named() -> None:
    problem = random_problem(3, ContainerRule.STRICT)
    settings = Settings(encodings=Path("by_need"))
    outcome, found = certify_outcome(solve(problem, (), settings), settings)
    assert found is not None
    assert outcome.proof is Proof.CERTIFICATE
    assert found.content["not_covered"] == ["encodings by_need"]


# --- the edges


def two_ways(one: str, other: str) -> Problem:
    """Make a thing by pouring or by mixing, which succeed at two rates."""
    return recipe("pour: start > end", "mix: start > end", rates={"pour": one, "mix": other})


def test_rates_that_floats_cannot_tell_apart() -> None:
    for nines in (10, 20, 60, 200):  # beyond what fifty digits of a logarithm tell
        problem = two_ways("0." + "9" * nines, "0." + "9" * nines + "1")
        found = certify(problem, (Objective.SUCCESS,), [1])
        assert found is not None
        assert found.claim == "optimal"
        with pytest.raises(NotBestError):
            certify(problem, levels((Objective.SUCCESS,)), [0])


def test_rates_of_one_and_zero() -> None:
    certain = certify(two_ways("1", "0.5"), (Objective.SUCCESS,), [0])
    assert certain is not None
    assert certain.claim == "optimal"
    assert certain.content["costs"] == ["1"]
    only = certify(two_ways("1", "1"), levels((Objective.SUCCESS,)), [1])
    assert only is not None
    assert only.claim == "optimal"
    # a rates file cannot hold 0; a problem can, and then nothing is certified by success
    assert certify(two_ways("0.5", "0"), levels((Objective.SUCCESS,)), [0]) is None
    assert certify(two_ways("0.5", "0"), (Objective.UNITS,), [0]) is not None


def test_a_goal_at_hand_and_several_goals() -> None:
    problem = two_ways("1", "0.5")
    empty = certify(replace(problem, goals=(0,)), levels((Objective.KITCHEN,)), [])
    assert empty is not None
    assert empty.content["cuts"] == []
    both = certify(replace(problem, goals=(0, 1)), levels((Objective.KITCHEN,)), [0])
    assert both is not None
    assert both.content["costs"] == [1, 1]


# --- the command line


def test_solve_writes_a_certificate_that_verify_accepts(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "proof.json"
    words = ("--goal", "greek salad", "--objective", "success", "--certificate", file)
    ran = cli("solve", *words, "--format", "json")
    assert ran.code == 0
    assert ran.json["proof"] == "certificate"
    assert ran.json["proof_by_objective"] == {"success": "certificate", "units": "certificate"}
    assert ran.json["seconds"]["certificate"] > 0
    assert "proof: certificate" in ran.err
    assert cli("solve", *words).out.endswith(f"proof: certificate ({file}, 32 cuts)\n")
    checked = cli("verify", file)
    assert checked.code == 0
    assert "verified: no task tree is better by success, then units (strict containers)" in checked.out
    success = ran.json["costs"]["success"]
    assert success["exact"] in checked.out
    assert cli("verify", file, "--format", "json").json["costs"] == {"success": success, "units": 31}
    assert cli("solve", "--goal", "ice", "--format", "json").json["proof"] == "cuts"
    plain = cli("solve", "--goal", "ice", "--reduce", "none", "--format", "json")
    assert plain.json["proof"] == "solver"


def test_verify_refuses_other_data_and_changes(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "proof.json"
    assert cli("solve", "--goal", "ice", "--certificate", file).code == 0
    rates = tmp_path / "motion.txt"
    rates.write_text((bundled_kitchen() / "motion.txt").read_text().replace("0.9", "0.8", 1))
    other = cli("verify", file, "--rates", rates)
    assert other.code == 2
    assert "is about other data (rates: not the one that the certificate is about): add --rates" in other.err
    content = json.loads(file.read_text())
    content["costs"] = [1]
    file.write_text(json.dumps(content))
    changed = cli("verify", file, "--format", "json")
    assert changed.code == 1
    reason = "the seal does not match: something was changed"
    assert changed.json == {"schema": "foon-asp/refused/1", "verified": False, "reason": reason}
    file.write_text("{")
    assert cli("verify", file).code == 1
    assert cli("verify", tmp_path / "none.json").code == 2


def test_certify_a_given_tree(cli: Cli, tmp_path: Path) -> None:
    tree, file = tmp_path / "tree.txt", tmp_path / "proof.json"
    tree.write_text(cli("solve", "--goal", "macaroni", "--format", "foon").out)
    words = ("check", tree, "--goal", "macaroni", "--certificate", file)
    good = cli(*words)
    assert good.code == 0
    assert good.out.endswith(f"proved best by units ({file}, 9 cuts)\n")
    assert cli("verify", file).code == 0
    file.unlink()
    forbidden = cli(*words, "--constraint", "forbid_object", "-c", "forbidden_object=macaroni")
    assert forbidden.code == 1
    assert "it breaks 2 rules:\n" in forbidden.out
    worse = cli(*words, "--objective", "success")
    assert worse.code == 1
    assert "\nnot the best by success, then units: there is one with 11 units" in worse.out
    assert not file.exists()
    data = read_data(find_data(bundled_kitchen()))
    tree.write_text(write_units([data.network.unit(0)]))
    assert cli(*words).code == 1
    tree.write_text("//\nO\tnothing\nM\tlook\nO\tsomething\n//\n")
    foreign = cli(*words)  # none of its units is in the bundled kitchen, so it is its own network
    assert foreign.code == 2
    assert "No --network: using" in foreign.err
    assert "add --certificate" in cli("check", tree, "--objective", "success").err


NO_CRUSHING = ':- N = #count { U : use(U), motion(U,"crush") }, N > 0.'  # which nothing is known of


@STRUCK_WHILE_READING
def test_an_answer_says_what_its_certificate_proves(cli: Cli, tmp_path: Path) -> None:
    proof = tmp_path / "proof.json"
    found = cli("solve", "--goal", "apple pie", "--certificate", proof)
    assert found.code == 1
    assert json.loads(proof.read_text())["claim"] == "infeasible"
    none = cli("solve", "--goal", "ice", "--time-limit", "0", "--certificate", proof)
    assert none.code == 3


def test_the_answer_stands_when_the_search_for_a_certificate_is_interrupted(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("foon_asp.questions.certifying.certify_outcome", interrupt)
    file = tmp_path / "proof.json"
    ran = cli("solve", "--goal", "ice", "--certificate", file, "--format", "json")
    assert ran.code == 0
    assert (ran.json["status"], ran.json["proof"]) == ("optimal", "cuts")
    assert "proof: cuts (no certificate was found, and nothing is written)" in ran.err
    assert not file.exists()


def test_a_bound_is_said_to_be_one(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "proof.json"
    words = ("--rule", NO_CRUSHING)
    ran = cli("solve", "--goal", "ice", *words, "--certificate", file, "--format", "json")
    assert ran.code == 0
    assert ran.json["status"] == "optimal"
    assert ran.json["proof"] == "solver"
    assert "units at least 2; the tree has 3 (gap 1)" in ran.err
    checked = cli("verify", file)
    assert checked.code == 0
    assert "verified: a bound on all task trees" in checked.out
    assert "not covered, so among all trees: " in checked.out


@pytest.mark.slow
@pytest.mark.parametrize("level", [1, 2])
@pytest.mark.parametrize("rule", RULES)
def test_levels_below_three_are_certified(cli: Cli, tmp_path: Path, rule: ContainerRule, level: int) -> None:
    file = tmp_path / "proof.json"
    data = read_data(find_data(bundled_kitchen()), level=level)
    labels = sorted({entry.pattern.label for entry in data.goals})
    for label in labels[::3]:
        goal = str(data.network.objects[find_goal(label, data.network, data.goals)])
        words = ("--level", str(level), "--containers", str(rule), "--format", "json")
        ran = cli("solve", "--goal", goal + ";", *words, "--objective", "success", "--certificate", file)
        assert ran.json["proof"] == "certificate"
        checked = cli("verify", file, "--level", str(level), "--format", "json")
        assert checked.code == 0
        assert checked.json["level"] == level
        assert checked.json["claim"] == ran.json["status"]
    other = cli("verify", file)
    assert other.code == 2
    assert "(not a claim about level 3): add --level N" in other.err


# --- the verifier stands alone


def test_the_verifier_loads_nothing_but_the_plain_network(tmp_path: Path) -> None:
    _, found = certify_outcome(solve(foon_asp.load().problem("ice")), Settings())
    assert found is not None
    (tmp_path / "proof.json").write_text(found.text())
    alone = f"""
import importlib.util, sys
sys.path.insert(0, {str(ROOT)!r})
spec = importlib.util.spec_from_file_location("alone", {str(ROOT / "foon_asp" / "proof" / "verifier.py")!r})
module = importlib.util.module_from_spec(spec)
sys.modules["alone"] = module
spec.loader.exec_module(module)
print(*sys.modules)
"""
    loaded = run_python("-I", "-c", alone).split()
    ours = {name for name in loaded if name.split(".")[0] == "foon_asp"}
    names = {"foon_asp", "foon_asp.escapes"}  # public names, and how names are quoted
    own_parts = (
        *("canonical_json", "certificate_fields", "certificate_header", "certificate_limits"),
        *("certificate_rules", "certificate_subject", "compiled_rules", "refusal", "rule_meaning"),
        *("stand_ins", "verified_claim", "step_budget", "exact_amounts", "unit_costs", "unit_effects"),
    )
    names |= {"foon_asp.proof", *(f"foon_asp.proof.{part}" for part in own_parts)}
    assert ours == names | {name for name in ours if name.startswith("foon_asp.network")}
    assert not {"clingo", "highspy", "numpy", "lark", "click"} & {*loaded}

    whole = """
import sys
from foon_asp.cli.main import main
try:
    main(sys.argv[1:])
except SystemExit as end:
    print(end.code, *({"clingo", "highspy", "numpy"} & {*sys.modules}))
"""
    said = run_python("-c", whole, "verify", str(tmp_path / "proof.json"))
    assert said.endswith("\n0\n")


def run_python(*arguments: str) -> str:
    command = [sys.executable, *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT).stdout


# --- an answer and a certificate that cannot both be true


def test_a_broken_finder_ends_with_70(cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A bound above what the tree costs is never written beside ``optimal``."""

    def above(*asked: Any) -> Certificate:
        right = certify(*asked)
        assert right is not None
        return Certificate({**right.content, "claim": "bound", "bound": ["1000"]}, "bound", right.certified)

    monkeypatch.setattr("foon_asp.certificate.certified_outcome.certify", above)
    file = tmp_path / "proof.json"
    ran = cli("solve", "--goal", "ice", "--certificate", file)
    assert ran.code == 70
    assert "optimal" not in ran.out
    assert "the certificate proves the bound ['1000'], and the tree costs less" in ran.err
    assert "goals: ice; crushed; in [drinking glass]" in ran.err
    assert not file.exists()


def test_a_tree_called_optimal_that_is_not_ends_with_70(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def worse(problem: Problem, *_: Any, **__: Any) -> Any:
        outcome = solve(problem)
        assert outcome.units is not None
        return outcome._replace(units=(*outcome.units, 0), costs=problem.costs((*outcome.units, 0)))

    monkeypatch.setattr("foon_asp.questions.answer.solve", worse)
    ran = cli("solve", "--goal", "ice", "--certificate", tmp_path / "proof.json")
    assert ran.code == 70
    assert "but there is a better tree, the units [" in ran.err
