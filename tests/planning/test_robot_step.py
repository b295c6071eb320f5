"""The steps of a plan for a robot's program: each object on both sides, roles, and a row for each step."""

import csv
import io
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp import Problem
from foon_asp.planning.robot_step import RobotStep
from tests.conftest import Cli
from tests.proof.by_hand import recipe

PAN = "fry: egg; raw; in [bowl] + bowl; contains {egg} + pan; hot; on [stove] + spoon; clean + salt"
PAN += " > egg; fried; in [pan] + bowl; empty + pan; hot; contains {egg} + spoon; clean + shell"


def one_step(problem: Problem) -> RobotStep:
    plan = foon_asp.solve(problem, durations={"fry": "90"}).robot_plan()
    assert plan is not None
    (step,) = plan.robot_steps
    return step


def fry(**more: Any) -> Problem:
    kitchen = PAN.partition(":")[2].partition(">")[0]
    return replace(recipe(PAN, kitchen=kitchen, goals="egg; fried; in [pan]", rates={"fry": "0.9"}), **more)


def names(nodes: Any) -> list[str]:
    return [str(node) for node in nodes]


def test_every_object_has_its_node_before_and_after() -> None:
    step = one_step(fry())
    changes = [(change.object, str(change.before), str(change.after)) for change in step.objects]
    assert changes == [
        ("egg", "egg; raw; in [bowl]", "egg; fried; in [pan]"),
        ("bowl", "bowl; contains {egg}", "bowl; empty"),
        ("pan", "pan; hot; on [stove]", "pan; hot; contains {egg}"),
        ("spoon", "spoon; clean", "spoon; clean"),
        ("salt", "salt", "None"),
        ("shell", "None", "shell"),
    ]


def test_places_are_nodes_and_tools_are_inferred_without_utensils() -> None:
    step = one_step(fry())
    assert names(step.origins) == ["bowl; contains {egg}", "stove"]
    assert [node.id for node in step.origins] == [step.needs[1].id, None]  # no unit lists the stove
    assert names(step.destinations) == ["pan; hot; contains {egg}"]
    assert (names(step.tools), names(step.acted_on)) == (["spoon; clean"], ["egg; raw; in [bowl]", "salt"])
    assert (step.rate, step.duration, step.clip) == (Fraction(9, 10), Fraction(90), None)
    told = one_step(fry(utensils=frozenset({"bowl", "pan"})))
    assert (names(told.tools), names(told.acted_on)[-2:]) == ([], ["spoon; clean", "salt"])


def test_what_a_step_needs_says_where_it_comes_from() -> None:
    problem = recipe(
        "chop: onion > onion; chopped", "fry: onion; chopped + oil > onion; fried", kitchen="onion + oil"
    )
    plan = foon_asp.solve(problem).robot_plan()
    assert plan is not None
    needs = [(str(node), str(node.origin)) for node in plan.robot_steps[1].needs]
    assert needs == [("onion; chopped", "step 1"), ("oil", "kitchen")]
    assert (plan.tools_inferred, plan.robot_steps[1].after) == (True, (1,))
    taken = recipe(
        "put: salt; in [cup] + cup; contains {salt} > soup", kitchen="salt; in [cup]", utensils="cup"
    )
    implied = one_step(replace(taken, containers=foon_asp.ContainerRule.IMPLIED))
    assert names(implied.needs) == ["salt; in [cup]"]  # the cup is taken as given


def test_a_row_for_each_step(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "egg.txt").write_text(
        "# Source: https://example.org/egg\n//\nO\tegg\nS\traw\nO\tpan\nM\tfry\t<0:10-0:14>\n"
        "O\tegg\nS\tfried\nO\tpan\n//\n"
    )
    ran = cli("solve", tmp_path / "egg.txt", "--format", "steps-csv")
    assert "no utensils are known (--utensils): tools are what a step leaves as it is" in ran.err
    (row,) = csv.DictReader(io.StringIO(ran.out))
    shown = {name: row[name] for name in ("step", "motion", "objects", "needs", "makes", "tools", "acted_on")}
    assert shown == {
        "step": "1",
        "motion": "fry",
        "objects": "egg; raw → egg; fried + pan → pan",
        "needs": "egg; raw + pan",
        "makes": "egg; fried",
        "tools": "pan",
        "acted_on": "egg; raw",
    }
    assert (row["clip.begin"], row["clip.end"], row["clip.seconds"]) == ("10", "14", "4")
    assert row["source"].endswith("egg.txt:3")
    steps = cli("solve", tmp_path / "egg.txt", "--format", "steps").json
    assert steps["tools_inferred"]
    assert steps["steps"][0]["source"][0]["videos"] == ["https://example.org/egg"]


@pytest.mark.parametrize("items", ["lasting", "used-up"])
def test_each_need_was_made_by_the_step_it_names(items: str) -> None:
    foon = foon_asp.load()
    for goal in ("macaroni", "greek salad", "lemonade"):
        plan = foon_asp.solve(foon.problem(goal, items=items)).robot_plan()
        assert plan is not None
        for step in plan.robot_steps:
            for node in step.needs:
                maker = node.origin.step
                if isinstance(maker, int):
                    assert maker < step.step
                    assert node.node in names(plan.robot_steps[maker - 1].makes)
                    assert maker in step.after
