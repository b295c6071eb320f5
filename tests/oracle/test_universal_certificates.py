"""The real universal FOON: a verified certificate for every goal, and engines that agree."""

import random
from pathlib import Path

import pytest

from foon_asp.asp import Proof, Settings, Status, solve
from foon_asp.certificate import certify_outcome
from foon_asp.certificate.certificate import subject_of
from foon_asp.comparison.many import makeable
from foon_asp.engines import ClaimedAnswer, cross_check
from foon_asp.problem import ContainerRule, Objective, Problem, levels
from foon_asp.proof.certificate_json import read_certificate
from foon_asp.proof.verifier import verify
from foon_asp.text.data_folder import Data, find_data, read_data
from foon_asp.text.node_lookup import find_goal
from tests.conftest import Cli

RULES = list(ContainerRule)
OBJECTIVES = (Objective.UNITS, Objective.INPUTS, Objective.SUCCESS)


@pytest.fixture(scope="module")
def data(universal: Path) -> Data:
    return read_data(find_data(universal))


def ask(data: Data, goal: int, rule: ContainerRule) -> Problem:
    return Problem(data.network, data.kitchen, (goal,), data.rates, data.utensils, rule)


def certify_and_verify(problem: Problem, objective: Objective) -> Status:
    """Solve, certify, write, read and verify; the whole claim has to be proved."""
    outcome, found = certify_outcome(solve(problem, (objective,)), Settings())
    assert outcome.proof is Proof.CERTIFICATE
    assert found is not None
    content = read_certificate(found.text())
    claim = verify(content, subject_of(problem))
    assert claim.goals == problem.goals
    assert claim.containers == str(problem.containers)
    if outcome.status is Status.INFEASIBLE:
        assert claim.claim == "infeasible"
    else:
        assert claim.claim == "optimal"
        assert outcome.costs is not None
        assert claim.costs == tuple(outcome.costs.measure(level) for level in levels((objective,)))
    return outcome.status


@pytest.mark.slow
def test_goals_at_a_lower_level(universal: Path) -> None:
    data = read_data(find_data(universal), level=1)
    goals = sorted({node for entry in data.goals for node in data.network.find(entry.pattern)})
    problems = [ask(data, goal, rule) for rule in RULES for goal in goals]
    proved = [certify_and_verify(problem, Objective.SUCCESS) for problem in problems]
    assert proved.count(Status.OPTIMAL) >= 8


@pytest.mark.parametrize("rule", RULES)
def test_that_whipped_cream_has_no_tree_is_certified(
    cli: Cli, universal: Path, tmp_path: Path, rule: ContainerRule
) -> None:
    file = tmp_path / "proof.json"
    asked = "--goal", "whipped cream", "--containers", rule, "--certificate", file, "--format", "json"
    ran = cli("solve", "--data", universal, *asked)
    assert ran.code == 1
    assert (ran.json["status"], ran.json["units"], ran.json["proof"]) == ("infeasible", None, "certificate")
    checked = cli("verify", file, "--data", universal)
    assert checked.code == 0
    assert f"verified: there is no task tree ({rule} containers)" in checked.out


@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES)
def test_all_engines_agree_on_the_goals(data: Data, rule: ContainerRule) -> None:
    for entry in data.goals:
        goal = find_goal(entry.pattern.label, data.network, data.goals)
        for objective in OBJECTIVES:
            checks = cross_check(ClaimedAnswer(solve(ask(data, goal, rule), (objective,))), 60.0)
            assert {check.engine for check in checks if check.reason is None} >= {"clingo", "HiGHS"}
            assert all("not installed" in check.reason for check in checks if check.reason is not None)


@pytest.mark.slow
@pytest.mark.parametrize("objective", OBJECTIVES)
@pytest.mark.parametrize("rule", RULES)
def test_a_sample_of_all_that_can_be_made(data: Data, rule: ContainerRule, objective: Objective) -> None:
    for goal in random.Random(2).sample(makeable(ask(data, 0, rule)), 25):
        assert certify_and_verify(ask(data, goal, rule), objective) is Status.OPTIMAL
