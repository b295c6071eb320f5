"""What the bundled kitchen promises to show, and what its README says of it."""

import json
import re
from collections.abc import Iterator
from functools import cache

import pytest

from foon_asp.asp import Outcome, Status, solve
from foon_asp.network import ObjectNode
from foon_asp.problem import ContainerRule, Objective, Problem, parse_objectives, reach
from foon_asp.resources import bundled_kitchen
from foon_asp.text.data_folder import Data, find_data, read_data
from foon_asp.text.goal_name import find_goal
from foon_asp.text.object_list import read_object_list

FOLDER = bundled_kitchen()
FILES = find_data(FOLDER)
README = (FOLDER / "README.md").read_text(encoding="utf-8")
GOALS: list[str] = [
    entry["label"] for entry in json.loads((FOLDER / "goal_nodes.json").read_text(encoding="utf-8"))
]
PUBLISHED = {"greek salad", "macaroni", "whipped cream", "sweet potato", "ice"}

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
    assert [name for name, file in FILES._asdict().items() if file is None] == ["unit_prices"]


def test_size() -> None:
    assert len(data().network) >= 150
    assert len(GOALS) >= 12
    assert len(set(GOALS)) == len(GOALS)
    assert set(GOALS) >= PUBLISHED | NEVER | IMPLIED_ONLY


def test_rates_and_motions_are_the_same() -> None:
    rates = data().rates
    assert rates is not None
    assert set(rates) == set(data().network.motions)
    assert all(0 < rate <= 1 for rate in rates.values())


def test_every_kitchen_item_is_in_the_network() -> None:
    assert FILES.kitchen is not None
    items = read_object_list(FILES.kitchen)
    assert items
    assert [str(item.pattern) for item in items if not data().network.find(item.pattern)] == []
    patterns = [item.pattern for item in items]
    assert len(set(patterns)) == len(patterns)


def test_every_goal_is_one_node_and_not_at_hand() -> None:
    for entry in data().goals:
        found = data().network.find(entry.pattern)
        assert len(found) == 1, entry.pattern
        assert found[0] not in data().kitchen
        assert data().network.producers[found[0]]


def test_utensils_are_labels_of_the_network() -> None:
    assert sorted(data().utensils - set(data().network.by_label)) == []


# --- What there is to choose.


def makers(node: int) -> list[int]:
    """Give the units that make a node out of something else."""
    network = data().network
    return [unit for unit in network.producers[node] if node not in network.inputs[unit]]


def test_many_nodes_have_several_producers() -> None:
    contested = [node for node in range(len(data().network.objects)) if len(makers(node)) > 1]
    assert len(contested) >= 20


def runnable() -> Iterator[tuple[ObjectNode, ObjectNode]]:
    """Give input and output nodes with one label, for every unit that can run from the kitchen."""
    network = data().network
    for unit in reach(problem("greek salad", STRICT)).units:
        for before in network.inputs[unit]:
            for after in network.outputs[unit]:
                if network.objects[before].label == network.objects[after].label:
                    yield network.objects[before], network.objects[after]


def test_a_bowl_is_filled_and_emptied_again() -> None:
    """Bowls go round: empty, containing something, empty, by units that can all run."""
    steps: dict[ObjectNode, set[ObjectNode]] = {}
    for before, after in runnable():
        if before != after:
            steps.setdefault(before, set()).add(after)

    def comes_back_empty(filled: ObjectNode, empty: ObjectNode) -> bool:
        seen, waiting = {filled}, [filled]
        while waiting:
            for after in steps.get(waiting.pop(), ()):
                if after == empty:
                    return True
                if after not in seen:
                    seen.add(after)
                    waiting.append(after)
        return False

    round_trips = {
        empty.label
        for empty, afterwards in steps.items()
        if empty.label.endswith("bowl") and "empty" in empty.states and not empty.ingredients
        if any(node.ingredients and comes_back_empty(node, empty) for node in afterwards)
    }
    assert "bowl" in round_trips


# --- What comes out.


@pytest.mark.parametrize("goal", GOALS)
def test_which_goals_have_a_tree(goal: str) -> None:
    expected = {
        STRICT: goal not in NEVER | IMPLIED_ONLY,
        IMPLIED: goal not in NEVER,
    }
    for rule, has_tree in expected.items():
        assert outcome(goal, rule).status is (Status.OPTIMAL if has_tree else Status.INFEASIBLE)


@pytest.mark.parametrize("goal", sorted(set(GOALS) - NEVER - IMPLIED_ONLY))
def test_implied_never_asks_for_more_units(goal: str) -> None:
    assert fewest_units(goal, IMPLIED) <= fewest_units(goal, STRICT)


def disagree(goal: str, rule: ContainerRule, one: Objective, other: Objective) -> bool:
    """Whether no tree is best under both objectives."""
    best = outcome(goal, rule, f"{one},{other}").costs
    ideal = outcome(goal, rule, f"{other},{one}").costs
    assert best is not None
    assert ideal is not None
    return best.measure(other) != ideal.measure(other)


def test_fewest_units_and_greatest_success_are_different_trees() -> None:
    solvable = sorted(set(GOALS) - NEVER - IMPLIED_ONLY)
    different = {goal for goal in solvable if disagree(goal, STRICT, Objective.UNITS, Objective.SUCCESS)}
    assert len(different) >= 3
    assert different == set(solvable) - {"tea"}, "README.md of the kitchen says so"


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


def test_readme_lists_the_dishes() -> None:
    dishes = re.search(r"Dishes: (.*?)\.", README)
    assert dishes
    assert re.split(r", | and (?!cheese)", dishes[1]) == GOALS


def test_readme_tree_sizes() -> None:
    sizes = re.search(r"Trees of various size: (.*) \(fewest units, rule `strict`\)", README)
    assert sizes
    told: dict[str, int] = {}
    for names, units in re.findall(r"(\D+) (\d+)(?: units)?(?:, |$)", sizes[1]):
        told |= dict.fromkeys([names] if names in GOALS else names.split(" and "), int(units))
    solvable = set(GOALS) - NEVER - IMPLIED_ONLY
    assert told == {goal: fewest_units(goal, STRICT) for goal in solvable}


@pytest.mark.parametrize(
    ("goal", "rule"),
    [
        ("whipped cream", STRICT),
        ("apple crumble", STRICT),
        ("chocolate mousse", STRICT),
        ("hot cocoa", IMPLIED),
    ],
)
def test_three_objectives_three_trees(goal: str, rule: ContainerRule) -> None:
    """No tree is best under two of fewest units, fewest inputs and greatest success."""
    assert "fewest inputs and greatest success are three different trees" in README
    for one, other in [("units", "inputs"), ("units", "success"), ("inputs", "success")]:
        assert disagree(goal, rule, Objective(one), Objective(other)), (one, other)


def test_implied_saves_a_unit_where_the_readme_says() -> None:
    solvable = set(GOALS) - NEVER - IMPLIED_ONLY
    saved = {goal: fewest_units(goal, STRICT) - fewest_units(goal, IMPLIED) for goal in solvable}
    told = re.search(r"`implied` saves a unit for (.*?)\.", README)
    assert told
    names = set(re.split(r", | and (?!cheese)", told[1]))
    assert {goal for goal, units in saved.items() if units} == names
    assert {saved[goal] for goal in names} == {1}
