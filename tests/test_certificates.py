"""Certificates of answers: found for every optimum, verified without a solver, never claiming too much."""

import json
import random
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from foon_asp.asp import Proof, Settings, Status, solve
from foon_asp.certificate import (
    Certificate,
    Coverage,
    NotBestError,
    certify,
    certify_infeasible,
    certify_outcome,
    coverage,
)
from foon_asp.errors import BugError
from foon_asp.network import FunctionalUnit, NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Objective, Problem, levels
from foon_asp.proof.constraint import Rule
from foon_asp.proof.verify import RefusedError, Verified, read_certificate, verify
from foon_asp.resources import bundled_kitchen
from foon_asp.text.data_folder import find_data, read_data
from foon_asp.text.goal_name import find_goal
from foon_asp.text.writer import write_units
from tests import oracle
from tests.conftest import STRUCK_WHILE_READING, Cli
from tests.gap_problem import gap_problem
from tests.handmade_certificate import forbid
from tests.random_problems import MOTIONS, random_objectives, random_problem

RULES = list(ContainerRule)


def verified(certificate: Certificate, problem: Problem) -> Verified:
    """Verify what is written, not what was meant."""
    content = read_certificate(certificate.text())
    given = problem.network, problem.kitchen, problem.rates, problem.utensils
    return verify(content, *given, problem.unit_prices)


def leaves(proof: dict[str, Any]) -> int:
    return leaves(proof["without"]) + leaves(proof["using"]) if "branch" in proof else 1


@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.sampled(2)
def test_every_optimum_of_random_networks(rule: ContainerRule) -> None:
    trees = 0
    for seed in range(150):
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
    assert trees > 100


@pytest.mark.slow
@pytest.mark.parametrize("corners", [3, *(pytest.param(n, marks=pytest.mark.slow) for n in (4, 5))])
def test_branching_closes_gaps(corners: int) -> None:
    branched = 0
    for seed in range(8):
        problem = gap_problem(seed, corners)
        lists: list[tuple[Objective, ...]] = [(objective,) for objective in Objective]
        lists.append(random_objectives(random.Random(seed), 2))
        for objectives in lists:
            outcome, found = certify_outcome(solve(problem, objectives), Settings())
            assert outcome.proof is Proof.CERTIFICATE
            assert found is not None
            assert verified(found, problem).claim == "optimal"
            branched += leaves(found.content["proof"]) > 1
    assert branched > 10


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_branching_closes_large_gaps(seed: int) -> None:
    problem = gap_problem(seed, corners=9, density=0.5)
    for objective in Objective:
        outcome, found = certify_outcome(solve(problem, (objective,)), Settings())
        assert outcome.proof is Proof.CERTIFICATE
        assert found is not None
        assert verified(found, problem).claim == "optimal"


@pytest.mark.slow
def test_a_tree_that_is_not_the_best_is_told_so() -> None:
    worse = 0
    for seed in range(100):
        problem = random_problem(seed, ContainerRule.STRICT)
        found = list(oracle.trees(problem))
        for objective in Objective:
            wanted = levels((objective,))
            best = oracle.best(found, problem, [str(objective)])
            for tree in random.Random(seed).sample(found, min(3, len(found))):
                units = order(problem, tree)
                if oracle.key(problem, tree, [str(objective)]) == best:
                    certificate = certify(problem, wanted, units)
                    assert certificate is not None
                    assert certificate.claim == "optimal"
                    continue
                worse += 1
                with pytest.raises(NotBestError) as better:
                    certify(problem, wanted, units)
                rival = tuple(map(problem.network.unit, better.value.units))
                assert oracle.makes(problem, rival)
                assert better.value.costs.key(wanted) < problem.costs(units).key(wanted)
    assert worse > 100


def order(problem: Problem, tree: tuple[FunctionalUnit, ...]) -> list[int]:
    """Put a tree into an order that executes, one unit after the other."""
    at_hand = {problem.network.objects[o] for o in problem.kitchen}
    left, ordered = list(tree), []
    while left:
        unit = next(u for u in left if oracle.needed(u, problem.containers, problem.utensils) <= at_hand)
        left.remove(unit)
        at_hand |= oracle.made(unit, problem.containers, problem.utensils)
        number = problem.network.unit_id(unit)
        assert number is not None
        ordered.append(number)
    return ordered


# --- constraints


@pytest.mark.slow
def test_forbidden_motions_and_objects_are_certified() -> None:
    certified = 0
    for seed in range(150):
        problem = random_problem(seed, RULES[seed % 2])
        rng = random.Random(seed)
        motion = rng.choice(MOTIONS)
        label = rng.choice([node.label for node in problem.network.objects])
        name, constant = rng.choice(
            [
                ("forbid_motion", f"forbidden_motion={motion}"),
                ("forbid_object", f'forbidden_object="{label}"'),
            ]
        )
        settings = Settings((Path(name),), constants=(constant,))
        covered = coverage(settings)
        forbidden = forbid([motion]) if name == "forbid_motion" else forbid([], [label])
        assert covered == Coverage(tuple(forbidden))
        outcome, found = certify_outcome(solve(problem, (Objective.SUCCESS,), settings), settings)
        assert found is not None
        assert outcome.proof is Proof.CERTIFICATE
        claim = verified(found, problem)
        assert (claim.rules, claim.not_covered) == (covered.rules, covered.not_covered)

        def allowed(tree: tuple[FunctionalUnit, ...], by: tuple[Rule, ...] = covered.rules) -> bool:
            names = [name for rule in by for name in rule.values()]
            return not any(
                unit.motion in names or any(node.label in names for node in (*unit.inputs, *unit.outputs))
                for unit in tree
            )

        best = oracle.best(list(oracle.trees(problem, allowed)), problem, ["success"])
        if best is None:
            assert claim.claim == "infeasible"
        else:
            certified += 1
            assert claim.costs is not None
            assert (-best[0], best[1]) == claim.costs
    assert certified > 30


@pytest.mark.slow
def test_other_constraints_leave_a_bound_on_all_trees(tmp_path: Path) -> None:
    bounds = optimal = 0
    for seed in range(300):
        problem = random_problem(seed, RULES[seed % 2])
        motion = random.Random(seed).choice(MOTIONS)
        wrong = "< 2" if seed % 4 < 2 else "> 1"  # these are not used in proofs
        rule = f':- #count {{ U : use(U), motion(U,"{motion}") }} {wrong}.'
        settings = Settings((mine(tmp_path, rule),))
        outcome, found = certify_outcome(solve(problem, (), settings), settings)
        if outcome.status is Status.INFEASIBLE:
            free = list(oracle.trees(problem))
            assert (found is None) == bool(free)
            assert outcome.proof is (Proof.SOLVER if free else Proof.CERTIFICATE)
            continue
        assert found is not None
        claim = verified(found, problem)
        assert list(claim.not_covered) == found.content["not_covered"] != []
        best = oracle.best(list(oracle.trees(problem)), problem, [])
        assert best is not None
        assert outcome.costs is not None
        if found.claim == "bound":
            bounds += 1
            assert outcome.proof is Proof.SOLVER
            assert outcome.certified == ()
            assert Fraction(found.content["bound"][0]) <= best[0] < outcome.costs.units
        else:
            optimal += 1
            assert outcome.proof is Proof.CERTIFICATE
            assert best[0] == outcome.costs.units
    assert bounds > 10
    assert optimal > 10


def test_a_file_of_the_users_is_not_ours_by_its_name(tmp_path: Path) -> None:
    file = tmp_path / "forbid_motion.lp"
    file.write_text('#const forbidden_motion = "".\n:- use(U), motion(U,forbidden_motion), U > 3.\n')
    found = coverage(Settings((file,), constants=("forbidden_motion=pour",)))
    assert found.rules == ()
    assert [name.split()[0] for name in found.not_covered] == ["forbid_motion.lp", "forbidden_motion=pour"]


def test_a_file_is_named_in_one_line_of_letters(tmp_path: Path) -> None:
    file = tmp_path / "a\nb\udcff.lp"
    try:
        file.write_text(":- use(U), U > 1000.\n")
    except OSError:
        pytest.skip("such a file cannot be")
    covered = coverage(Settings((file,)))
    assert [name.split()[0] for name in covered.not_covered] == ["a\\nb\\udcff.lp"]
    found = certify(two_ways("1", "1/2"), (Objective.UNITS,), [0], covered)
    assert found is not None
    assert found.content["not_covered"] == list(covered.not_covered)


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
    builder = NetworkBuilder()
    start, end = ObjectNode.of("start"), ObjectNode.of("end")
    builder.add("pour", [start], [end], Source("two", 1))
    builder.add("mix", [start], [end], Source("two", 2))
    rates = {"pour": Fraction(one), "mix": Fraction(other)}
    return Problem(builder.build(), frozenset({0}), (1,), rates, frozenset())


def test_rates_that_floats_cannot_tell_apart() -> None:
    problem = two_ways("0." + "9" * 40, "0." + "9" * 40 + "1")
    found = certify(problem, levels((Objective.SUCCESS,)), [1])
    assert found is not None
    assert found.claim == "optimal"
    with pytest.raises(NotBestError):
        certify(problem, levels((Objective.SUCCESS,)), [0])
    for nines in (10, 20, 60, 200):  # beyond what fifty digits of a logarithm tell
        problem = two_ways("0." + "9" * nines, "0." + "9" * nines + "1")
        found = certify(problem, (Objective.SUCCESS,), [1])
        assert found is not None
        assert found.claim == "optimal"


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


def test_no_time_is_no_certificate() -> None:
    problem = gap_problem(0)
    outcome, found = certify_outcome(solve(problem), Settings(), expired=lambda: True)
    assert found is None
    assert outcome.proof is Proof.SOLVER
    assert certify_infeasible(problem) is None


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
    assert cli("certify", "--goal", "ice", "-o", file).code == 0
    rates = tmp_path / "motion.txt"
    rates.write_text((bundled_kitchen() / "motion.txt").read_text().replace("0.9", "0.8", 1))
    other = cli("verify", file, "--rates", rates)
    assert other.code == 1
    assert other.out == "refused: rates: not the one that the certificate is about\n"
    content = json.loads(file.read_text())
    content["costs"] = [1]
    file.write_text(json.dumps(content))
    changed = cli("verify", file, "--format", "json")
    assert changed.code == 1
    reason = "the seal does not match: something was changed"
    assert changed.json == {"schema": "foon-asp/verify/2", "verified": False, "reason": reason}
    file.write_text("{")
    assert cli("verify", file).code == 1
    assert cli("verify", tmp_path / "none.json").code == 2


def test_certify_a_given_tree(cli: Cli, tmp_path: Path) -> None:
    tree, file = tmp_path / "tree.txt", tmp_path / "proof.json"
    tree.write_text(cli("solve", "--goal", "macaroni", "--format", "foon").out)
    words = ("certify", "--goal", "macaroni", "--tree", tree, "-o", file)
    good = cli(*words)
    assert good.code == 0
    assert good.err == "proved best by units\n"
    assert cli("verify", file).code == 0
    file.unlink()
    forbidden = cli(*words, "--constraint", "forbid_object", "-c", "forbidden_object=macaroni")
    assert forbidden.code == 1
    said = "by the constraints, the tree has unit 78, which a rule removes"
    assert forbidden.err == f"no certificate: {said}\n"
    worse = cli(*words, "--objective", "success")
    assert worse.code == 1
    assert worse.err.startswith(
        "no certificate: the tree is not the best by success, then units: it has 9 units"
    )
    assert not file.exists()
    data = read_data(find_data(bundled_kitchen()))
    tree.write_text(write_units([data.network.unit(0)]))
    assert cli(*words).code == 1
    tree.write_text("//\nO\tnothing\nM\tlook\nO\tsomething\n//\n")
    foreign = cli(*words)
    assert foreign.code == 1
    assert "is not in the network" in foreign.err


def mine(folder: Path, rule: str) -> Path:
    """Write a rule of the user's own, of which certificates do not speak."""
    file = folder / "mine.lp"
    file.write_text(rule)
    return file


NO_CRUSHING = ':- N = #count { U : use(U), motion(U,"crush") }, N > 0.'  # which nothing is known of


@STRUCK_WHILE_READING
def test_certify_prints_what_it_finds(cli: Cli, tmp_path: Path) -> None:
    found = cli("certify", "--goal", "apple pie")
    assert found.code == 1
    assert found.json["claim"] == "infeasible"
    bound = cli("certify", "--goal", "ice", "--constraint", mine(tmp_path, NO_CRUSHING))
    assert bound.code == 3
    assert bound.json["claim"] == "bound"
    assert "units at least 2; the tree has 3 (gap 1)" in bound.err
    none = cli("certify", "--goal", "ice", "--time-limit", "0")
    assert none.code == 3


def test_the_answer_stands_when_the_search_for_a_certificate_is_interrupted(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("foon_asp.questions.certify.certify_outcome", interrupt)
    file = tmp_path / "proof.json"
    ran = cli("solve", "--goal", "ice", "--certificate", file, "--format", "json")
    assert ran.code == 0
    assert (ran.json["status"], ran.json["proof"]) == ("optimal", "cuts")
    assert "proof: cuts (no certificate was found, and nothing is written)" in ran.err
    assert not file.exists()


def test_a_bound_by_success_is_a_product(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "proof.json"
    words = ("--constraint", mine(tmp_path, ":- N = #count{U : use(U)}, N > 9."), "--objective", "success")
    ran = cli("solve", "--goal", "macaroni", *words, "--certificate", file, "--format", "json")
    assert ran.code == 0
    assert ran.json["proof"] == "solver"
    assert "success at most 0.6293; the tree has " in cli("verify", file).out


def test_a_bound_is_said_to_be_one(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "proof.json"
    words = ("--constraint", mine(tmp_path, NO_CRUSHING))
    ran = cli("solve", "--goal", "ice", *words, "--certificate", file, "--format", "json")
    assert ran.code == 0
    assert ran.json["status"] == "optimal"
    assert ran.json["proof"] == "solver"
    checked = cli("verify", file)
    assert checked.code == 0
    assert "verified: a bound on all task trees" in checked.out
    assert "not covered, so among all trees: mine.lp" in checked.out


@pytest.mark.slow
@pytest.mark.parametrize("level", [1, 2])
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.sampled(2)
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
    assert other.code == 1
    assert other.out == "refused: not a claim about level 3\n"


# --- the verifier stands alone


def test_the_verifier_loads_nothing_but_the_plain_network(tmp_path: Path) -> None:
    data = read_data(find_data(bundled_kitchen()))
    goal = find_goal("ice", data.network, data.goals)
    problem = Problem(data.network, data.kitchen, (goal,), data.rates, data.utensils)
    _, found = certify_outcome(solve(problem), Settings())
    assert found is not None
    (tmp_path / "proof.json").write_text(found.text())
    root = Path(__file__).resolve().parents[1]
    alone = f"""
import importlib.util, sys
sys.path.insert(0, {str(root)!r})
spec = importlib.util.spec_from_file_location("alone", {str(root / "foon_asp" / "proof" / "verify.py")!r})
module = importlib.util.module_from_spec(spec)
sys.modules["alone"] = module
spec.loader.exec_module(module)
print(*sys.modules)
"""
    loaded = run_python("-I", "-c", alone).split()
    ours = {name for name in loaded if name.split(".")[0] == "foon_asp"}
    names = {"foon_asp", "foon_asp.questions", "foon_asp.questions.index"}  # what there is, by name alone
    names |= {"foon_asp.proof", "foon_asp.proof.constraint", "foon_asp.proof.ruled"}  # its own parts
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
    root = Path(__file__).resolve().parents[1]
    command = [sys.executable, *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=True, cwd=root).stdout


def test_a_refusal_is_an_error_of_its_own() -> None:
    with pytest.raises(RefusedError, match="a key stands twice"):
        read_certificate('{"version": 1, "version": 1}')


# --- an answer and a certificate that cannot both be true


def broken(change: Callable[[dict[str, Any]], None]) -> Callable[..., Certificate]:
    """Give a finder whose certificates say something else, and were never verified."""

    def find(problem: Problem, objectives: Sequence[Objective], *rest: Any) -> Certificate:
        right = certify(problem, objectives, *rest)
        assert right is not None
        content = {**right.content}
        change(content)
        return Certificate(content, content["claim"], right.certified)

    return find


@pytest.mark.parametrize(
    ("values", "reason"),
    [
        ({"claim": "bound", "bound": [{"1/2": "1"}, "0"]}, "the tree costs less"),
        ({"claim": "bound", "bound": [{"9/10": "1"}, "2"]}, "the tree costs less"),
        ({"claim": "infeasible"}, "the certificate proves that there is no tree"),
        ({"tree": [1]}, "the certificate proves another tree optimal, the units [1] (1 units"),
        ({"goals": [{"id": 0, "node": "start"}]}, "the certificate speaks of the goals [0]"),
        ({"containers": "implied"}, "the certificate speaks of the goals [1] under implied containers"),
    ],
)
def test_an_answer_and_a_certificate_at_odds_are_a_bug(
    monkeypatch: pytest.MonkeyPatch, values: dict[str, Any], reason: str
) -> None:
    problem = two_ways("9/10", "1/2")
    outcome = solve(problem, (Objective.SUCCESS,))
    assert outcome.units == (0,)
    monkeypatch.setattr(
        "foon_asp.certificate.outcome.certify", broken(lambda content: content.update(values))
    )
    settings = Settings((Path("require_motion"),), constants=("required_motion=pour",))
    with pytest.raises(BugError) as bug:
        certify_outcome(outcome, settings)
    said = str(bug.value)
    assert reason in said
    assert "the answer is optimal, the units [0] (1 units, 1 inputs, 0 ingredients, 1 kitchen items" in said
    for line in ("goals: end", "containers: strict, level 3", "objectives: success, units"):
        assert line in said
    assert "constraint: require_motion\nconstant: required_motion=pour" in said


@pytest.mark.parametrize("bound", [[{"9/10": "1"}, "1"], [{}, "5"], [{"9/10": "1", "1/2": "-1"}, "7"]])
def test_a_bound_at_or_below_the_tree_is_no_bug(monkeypatch: pytest.MonkeyPatch, bound: list[Any]) -> None:
    outcome = solve(two_ways("9/10", "1/2"), (Objective.SUCCESS,))
    finder = broken(lambda content: content.update(claim="bound", bound=bound))
    monkeypatch.setattr("foon_asp.certificate.outcome.certify", finder)
    marked, found = certify_outcome(outcome, Settings())
    assert found is not None
    assert marked.proof is not Proof.CERTIFICATE


def test_no_tree_and_a_certificate_of_one_are_a_bug(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = two_ways("9/10", "1/2")
    outcome = solve(replace(problem, kitchen=frozenset()))
    assert outcome.status is Status.INFEASIBLE
    right = certify(problem, (Objective.UNITS,), [0])
    monkeypatch.setattr("foon_asp.certificate.outcome.certify_infeasible", lambda *_: right)
    with pytest.raises(
        BugError, match="the answer is infeasible, no tree, but the certificate claims optimal"
    ):
        certify_outcome(outcome, Settings())


@pytest.mark.parametrize("verb", [("certify",), ("solve", "--certificate")])
def test_a_broken_finder_ends_with_70(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, verb: tuple[str, ...]
) -> None:
    """A bound above what the tree costs is never written beside ``optimal``."""

    def above(content: dict[str, Any]) -> None:
        content.update(claim="bound", bound=["1000"])

    monkeypatch.setattr("foon_asp.certificate.outcome.certify", broken(above))
    file = tmp_path / "proof.json"
    words = (*verb, file) if "--certificate" in verb else (*verb, "-o", file)
    ran = cli(words[0], "--goal", "ice", *words[1:])
    assert ran.code == 70
    assert "optimal" not in ran.out
    assert "the certificate proves the bound ['1000'], and the tree costs less" in ran.err
    assert "goals: ice; crushed; in [drinking glass]" in ran.err
    assert not file.exists()


def test_a_tree_called_optimal_that_is_not_ends_with_70(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    def worse(problem: Problem, *_: Any, **__: Any) -> Any:
        outcome = solve(problem)
        assert outcome.units is not None
        return outcome._replace(units=(*outcome.units, 0), costs=problem.costs((*outcome.units, 0)))

    monkeypatch.setattr("foon_asp.questions.answer.find", worse)
    ran = cli("certify", "--goal", "ice")
    assert ran.code == 70
    assert "but there is a better tree, the units [" in ran.err
