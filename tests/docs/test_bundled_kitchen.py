"""What the bundled kitchen promises to show, and what its README says of it."""

import json
import re
from functools import cache

import pytest

from foon_asp.asp import Outcome, Status, solve
from foon_asp.problem import ContainerRule, Problem, parse_objectives
from foon_asp.resources import bundled_kitchen
from foon_asp.text.data_folder import Data, find_data, read_data
from foon_asp.text.node_lookup import find_goal

FOLDER = bundled_kitchen()
FILES = find_data(FOLDER)
README = (FOLDER / "README.md").read_text(encoding="utf-8")
GOALS: list[str] = [
    entry["label"] for entry in json.loads((FOLDER / "goal_nodes.json").read_text(encoding="utf-8"))
]

NEVER = {"apple pie"}
IMPLIED_ONLY = {"hot cocoa"}
STRICT, IMPLIED = ContainerRule.STRICT, ContainerRule.IMPLIED


@cache
def data() -> Data:
    return read_data(FILES)


@cache
def problem(goal: str, rule: ContainerRule) -> Problem:
    read = data()
    node = find_goal(goal, read.network, read.goals)
    return Problem(read.network, read.kitchen, (node,), read.rates, read.utensils, rule)


@cache
def outcome(goal: str, rule: ContainerRule = STRICT, objectives: str = "units") -> Outcome:
    return solve(problem(goal, rule), parse_objectives([objectives]))


def fewest_units(goal: str, rule: ContainerRule) -> int:
    costs = outcome(goal, rule).costs
    assert costs is not None
    return costs.units


# --- The files.


def test_nothing_has_to_be_assumed_in_reading() -> None:
    assert [str(warning) for warning in data().warnings] == []
    assert data().left_out == 0
    assert [name for name, file in FILES._asdict().items() if file is None] == [
        "unit_prices",
        "unit_amounts",
        "stand_ins",
    ]


# --- What there is to choose.


def makers(node: int) -> list[int]:
    """Give the units that make a node out of something else."""
    network = data().network
    return [unit for unit in network.producers[node] if node not in network.inputs[unit]]


# --- What comes out.


@pytest.mark.parametrize("goal", GOALS)
def test_which_goals_have_a_tree(goal: str) -> None:
    expected = {
        STRICT: goal not in NEVER | IMPLIED_ONLY,
        IMPLIED: goal not in NEVER,
    }
    for rule, has_tree in expected.items():
        assert outcome(goal, rule).status is (Status.OPTIMAL if has_tree else Status.INFEASIBLE)


# --- What the README of the kitchen says.


def test_readme_figures() -> None:
    read = data()
    found = re.search(
        r"(\d+) functional units, (\d+) object nodes, (\d+) items at hand \(`kitchen.json`\), "
        r"(\d+) goals \(`goal_nodes.json`\), (\d+) motions",
        README,
    )
    assert found
    assert [int(figure) for figure in found.groups()] == [
        len(read.network),
        len(read.network.objects),
        len(read.kitchen),
        len(read.goals),
        len(read.rates or {}),
    ]
    contested = re.search(r"Several producers of an object \((\d+) nodes", README)
    assert contested
    assert int(contested[1]) == sum(len(makers(node)) > 1 for node in range(len(read.network.objects)))


def test_readme_tree_sizes() -> None:
    sizes = re.search(r"Trees of various size: (.*) \(fewest units, rule `strict`\)", README)
    assert sizes
    told: dict[str, int] = {}
    for names, units in re.findall(r"(\D+) (\d+)(?: units)?(?:, |$)", sizes[1]):
        told |= dict.fromkeys([names] if names in GOALS else names.split(" and "), int(units))
    solvable = set(GOALS) - NEVER - IMPLIED_ONLY
    assert told == {goal: fewest_units(goal, STRICT) for goal in solvable}
