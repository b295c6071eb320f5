"""The real universal FOON: what is known of it, and engines that agree on all of it."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from foon_asp.asp import Status, solve
from foon_asp.problem import ContainerRule, Objective, Problem, reach, relevant
from foon_asp.text.data_folder import Data, find_data, read_data
from foon_asp.text.goal_name import find_goal
from tests.conftest import Cli
from tests.random_problems import random_prices

# Proved optima: units, inputs, success, each from its own objective.
KNOWN = {
    ("greek salad", "strict"): (30, 87, Fraction(407953774917, 7450580596923828125000)),
    ("greek salad", "implied"): (25, 76, Fraction(3486784401, 19073486328125000000)),
    ("macaroni", "strict"): (6, 16, Fraction(2187, 100000)),
    ("macaroni", "implied"): (6, 16, Fraction(2187, 100000)),
    ("sweet potato", "strict"): (3, 7, Fraction(3, 250)),
    ("sweet potato", "implied"): (3, 7, Fraction(3, 250)),
    ("ice", "strict"): (1, 3, Fraction(4, 5)),
    ("ice", "implied"): (1, 3, Fraction(4, 5)),
}


@pytest.mark.slow
@pytest.mark.parametrize(("goal", "rule"), KNOWN)
@pytest.mark.sampled(3)
def test_known_optima(cli: Cli, universal: Path, goal: str, rule: str) -> None:
    for objective, value in zip(("units", "inputs", "success"), KNOWN[goal, rule], strict=True):
        words = ["--data", universal, "--goal", goal, "--containers", rule, "--objective", objective]
        ran = cli("solve", *words, "--format", "json")
        assert ran.code == 0
        assert ran.json["status"] == "optimal"
        found = ran.json["costs"][objective]
        assert (Fraction(found["exact"]) if objective == "success" else found) == value


@pytest.mark.parametrize("rule", list(ContainerRule))
def test_whipped_cream_has_no_tree(cli: Cli, universal: Path, rule: str) -> None:
    words = ["--data", universal, "--goal", "whipped cream", "--containers", rule, "--format", "json"]
    ran = cli("solve", *words)
    assert ran.code == 1
    assert ran.json["status"] == "infeasible"
    assert ran.json["units"] is None


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


@pytest.mark.parametrize("rule", list(ContainerRule))
def test_the_cut_leaves_little(data: Data, rule: ContainerRule) -> None:
    sizes = []
    for entry in data.goals:
        goal = find_goal(entry.pattern.label, data.network, data.goals)
        problem = Problem(data.network, data.kitchen, (goal,), data.rates, data.utensils, rule)
        sizes.append(len(relevant(problem, reach(problem))))
    assert max(sizes) <= 317


@pytest.mark.slow
@pytest.mark.parametrize("rule", list(ContainerRule))
def test_every_makeable_object_is_proved(data: Data, rule: ContainerRule) -> None:
    given = data.network, data.kitchen, (0,), data.rates, data.utensils, rule
    one = Problem(*given, unit_prices=random_prices(data.network, 0))
    reached = reach(one)
    goals = [o for o in sorted(reached.makers) if o not in data.kitchen]
    assert len(goals) > 2500
    for goal in goals[::8]:
        problem = replace(one, goals=(goal,))
        best = {objective: solve(problem, (objective,)) for objective in Objective}
        assert all(outcome.status is Status.OPTIMAL for outcome in best.values())
        for objective in Objective:
            costs = [outcome.costs for outcome in best.values() if outcome.costs]
            key = min(c.key((objective,)) for c in costs)
            own = best[objective].costs
            assert own is not None
            assert own.key((objective,)) == key


def test_nothing_comes_from_nothing(data: Data) -> None:
    """The units that put out a container that they skipped, and what could be made of that."""
    network = data.network

    def ask(goal: int) -> Problem:
        rule = ContainerRule.IMPLIED
        return Problem(network, data.kitchen, (goal,), data.rates, data.utensils, rule)

    problem = ask(0)
    skipping = [u for u, gives in enumerate(problem.gives) if gives != network.outputs[u]]
    assert len(skipping) == 24
    annotated = set(data.kitchen)
    while True:
        more = {
            o
            for unit, needs in enumerate(problem.needs)
            if annotated.issuperset(needs)
            for o in network.outputs[unit]
        }
        if annotated >= more:
            break
        annotated |= more
    available = reach(problem).available
    lost = [o for o in annotated if not available[o]]
    assert len(lost) == 103
    assert sum(available) == len(annotated) - len(lost)
    syrup = [
        o
        for o, node in enumerate(network.objects)
        if node.label == "french toast" and "maple syrup" in node.ingredients
    ]
    assert syrup
    assert set(syrup) <= set(lost)
    assert all(solve(ask(o), ()).status is Status.INFEASIBLE for o in syrup)
    (cheese,) = (
        o
        for o, node in enumerate(network.objects)
        if node.label == "macaroni and cheese" and node.is_in("plate")
    )
    for objective in (Objective.UNITS, Objective.INPUTS):
        costs = solve(ask(cheese), (objective,)).costs
        assert costs is not None
        assert (costs.units, costs.inputs) == (20, 61)
