"""The real universal FOON: what is known of it, and engines that agree on all of it."""

from dataclasses import replace
from pathlib import Path

import pytest

from foon_asp.asp import Status, solve
from foon_asp.problem import ContainerRule, Objective, Problem, reach
from foon_asp.text.data_folder import Data, find_data, read_data
from tests.conftest import Cli
from tests.support.random_problems import random_prices

# Proved optima: units, inputs, success, each from its own objective.
KNOWN = [
    ("greek salad", "strict", "30", "87", "407953774917/7450580596923828125000"),
    ("greek salad", "implied", "25", "76", "3486784401/19073486328125000000"),
    ("macaroni", "strict", "6", "16", "2187/100000"),
    ("sweet potato", "implied", "3", "7", "3/250"),
    ("ice", "strict", "1", "3", "4/5"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("goal", "rule", "units", "inputs", "success"), KNOWN)
def test_known_optima(
    cli: Cli, universal: Path, goal: str, rule: str, units: str, inputs: str, success: str
) -> None:
    for objective, value in (("units", units), ("inputs", inputs), ("success", success)):
        words = ["--data", universal, "--goal", goal, "--containers", rule, "--objective", objective]
        answer = cli("solve", *words, "--format", "json").json
        assert answer["status"] == "optimal"
        found = answer["costs"][objective]
        assert str(found["exact"] if objective == "success" else found) == value


@pytest.fixture(scope="module")
def data(universal: Path) -> Data:
    return read_data(find_data(universal))


def test_the_dirt_is_met_with_warnings(data: Data) -> None:
    found: dict[str, int] = {}
    for warning in data.warnings:
        found[warning.code] = found.get(warning.code, 0) + 1
    assert found.pop("repeated-ingredient") > 0
    assert found == {"outer-space": 2, "no-outputs": 1, "space-for-tab": 5, "kitchen-item": 1}
    assert data.left_out == 0


@pytest.mark.nightly
@pytest.mark.parametrize("rule", list(ContainerRule))
def test_every_makeable_object_is_proved(data: Data, rule: ContainerRule) -> None:
    given = data.network, data.kitchen, (0,), data.rates, data.utensils, rule
    one = Problem(*given, unit_prices=random_prices(data.network, 0))
    goals = [o for o in sorted(reach(one).makers) if o not in data.kitchen]
    assert len(goals) > 2500
    for goal in goals[::8]:
        best = {each: solve(replace(one, goals=(goal,)), (each,)) for each in Objective}
        assert {outcome.status for outcome in best.values()} == {Status.OPTIMAL}
        for objective, own in best.items():
            keys = [outcome.costs.key((objective,)) for outcome in best.values() if outcome.costs]
            assert own.costs is not None
            assert own.costs.key((objective,)) == min(keys)


def test_nothing_comes_from_nothing(data: Data) -> None:
    """The units that put out a container that they skipped, and what cannot be made without that."""
    network = data.network

    def ask(goal: int) -> Problem:
        rule = ContainerRule.IMPLIED
        return Problem(network, data.kitchen, (goal,), data.rates, data.utensils, rule)

    problem = ask(0)
    assert sum(gives != outputs for gives, outputs in zip(problem.gives, network.outputs, strict=True)) == 24
    nodes = list(enumerate(network.objects))
    syrup = [o for o, n in nodes if n.label == "french toast" and "maple syrup" in n.ingredients]
    assert syrup
    assert all(solve(ask(o), ()).status is Status.INFEASIBLE for o in syrup)
    (cheese,) = (o for o, n in nodes if n.label == "macaroni and cheese" and n.is_in("plate"))
    for objective in (Objective.UNITS, Objective.INPUTS):
        costs = solve(ask(cheese), (objective,)).costs
        assert costs is not None
        assert (costs.units, costs.inputs) == (20, 61)
