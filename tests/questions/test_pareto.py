"""Pareto fronts, held against brute force over every tree of small networks."""

import random
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import combinations, pairwise
from pathlib import Path
from xml.etree import ElementTree

import pytest
from msgspec import structs

import foon_asp
from foon_asp.network import FunctionalUnit
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.questions.pareto import Front, pareto
from foon_asp.results.figure_text import success_text, success_texts
from tests.conftest import STRUCK_WHILE_READING, Cli
from tests.oracle import task_trees
from tests.questions.test_alternatives import choosing
from tests.support.random_problems import MOTIONS, NEAR_1, SERIES, USUAL

SVG = "{http://www.w3.org/2000/svg}"
RULES = list(ContainerRule)
SETS = [
    some
    for size in (2, 3)
    for some in combinations(USUAL, size)
    if sum(not objective.row.whole for objective in some) <= 1  # only one that is rounded can be settled
]
Point = tuple[Fraction, ...]


def measures(problem: Problem, tree: tuple[FunctionalUnit, ...], objectives: Sequence[Objective]) -> Point:
    return tuple(task_trees.measure(problem, tree, objective) for objective in objectives)


def nondominated(points: set[Point]) -> set[Point]:
    """Give the points than which none is as small everywhere."""
    return {
        p
        for p in points
        if not any(q != p and all(a <= b for a, b in zip(q, p, strict=True)) for q in points)
    }


def assert_agrees(front: Front, trees: Sequence[tuple[FunctionalUnit, ...]]) -> None:
    """Hold points, trees and their order against all trees that there are."""
    problem, objectives = front.problem, front.objectives
    everything = {measures(problem, tree, objectives) for tree in trees}
    assert front.complete
    shown = []
    for point in front.points:
        units = tuple(map(problem.network.unit, point.ids))
        assert task_trees.makes(problem, units)
        assert set(units) in map(set, trees)
        shown.append(measures(problem, units, objectives))
        same = [tree for tree in trees if measures(problem, tree, objectives) == shown[-1]]
        assert len(units) == min(map(len, same))
    assert shown == sorted(nondominated(everything))


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize(
    "seeds",
    [range(9300, 9309), pytest.param(range(9309, 9500), marks=pytest.mark.nightly)],
    ids=["few", "many"],
)
def test_every_front_of_two_and_of_three_objectives(rule: ContainerRule, seeds: range) -> None:
    """Of one goal, of several, and under a constraint."""
    long = 0
    for seed in seeds:
        problem, rng, motion = choosing(seed, rule), random.Random(seed), ""
        if seed % 3 == 0:
            made = [o for o in range(len(problem.network.objects)) if o not in problem.kitchen]
            problem = replace(problem, goals=tuple(rng.sample(made, min(2, len(made)))))
        elif seed % 3 == 1:
            motion = rng.choice(MOTIONS)

        def allowed(tree: tuple[FunctionalUnit, ...], motion: str = motion) -> bool:
            return all(unit.motion != motion for unit in tree)

        trees = list(task_trees.trees(problem, allowed))
        for objectives in rng.sample(SETS, 2):
            rules = f'forbid_motion:forbidden_motion="{motion}"' if motion else ()
            front = pareto(problem, objectives, constraints=rules)
            assert_agrees(front, trees)
            long += len(front.points) > 2
    assert long >= 2


@SERIES
@pytest.mark.default_cases("3")
def test_fronts_are_exact_where_rounding_hides_nearly_everything(part: int) -> None:
    for seed in range(9700, 9700 + 30 // part):
        drawn, rng = choosing(seed, ContainerRule.STRICT), random.Random(seed)
        problem = replace(drawn, rates={motion: Fraction(rng.choice(NEAR_1)) for motion in drawn.rates or {}})
        for others in ([Objective.INPUTS], [Objective.UNITS, Objective.KITCHEN]):
            front = pareto(problem, [*others, Objective.SUCCESS])
            assert_agrees(front, list(task_trees.trees(problem)))


# --- The command, and what it prints and draws.


def test_one_objective_or_four_are_no_trade_off(cli: Cli) -> None:
    for listed in ("units", "units,inputs,success,kitchen"):
        ran = cli("pareto", "--goal", "tea", "--objective", listed)
        assert ran.code == 2
        assert "expected 2 or 3" in ran.err


def test_a_front_of_a_goal_at_hand_by_costs_that_no_unit_has() -> None:
    """Nothing is left to do, so no unit has a cost; and still no tree costs less than 0."""
    units = [("brew", "water", "tea")]
    problem = foon_asp.build(units, kitchen="tea", goals="tea", rates={"brew": 0.5}).problem("tea")
    for objectives in ("attempts,success", "success,attempts", "units,attempts", "attempts,kitchen,success"):
        front = foon_asp.pareto(problem, objectives)
        assert [list(point.ids) for point in front.points] == [[]]
        assert front.complete


def test_units_that_come_and_go_lead_from_each_tree_to_the_next(cli: Cli) -> None:
    ran = cli("pareto", "--goal", "macaroni", "--objective", "success,units", "--format", "json")
    points = ran.json["points"]
    assert [point["measures"]["units"] for point in points] == [11, 10, 9]  # the best success first
    assert points[0]["gone"] == points[0]["new"] == []
    for before, point in pairwise(points):
        ids, earlier = ({unit["id"] for unit in each["units"]} for each in (point, before))
        assert (set(point["gone"]), set(point["new"])) == (earlier - ids, ids - earlier)


@STRUCK_WHILE_READING
def test_exit_codes(cli: Cli, tmp_path: Path) -> None:
    none = cli("pareto", "--goal", "apple pie", "--chart", tmp_path / "none.svg")
    assert none.code == 1
    assert "infeasible: proved" in none.out
    assert "no point to draw" in none.err
    assert cli("pareto", "--goal", "tea", "--time-limit", "0").code == 3
    assert cli("pareto", "--goal", "tea", "--chart", tmp_path / "front.pdf").code == 2
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("successes", "shown"),
    [
        (["1/2", "1/3"], ["0.5", "≈ 0.3333"]),
        (["0.12341", "0.123412", "0.12341"], ["0.12341", "0.123412", "0.12341"]),
        (["1/3000000000"], ["≈ 3.333e-10"]),
    ],
)
def test_successes_look_different_when_they_are(successes: list[str], shown: list[str]) -> None:
    assert success_texts(list(map(Fraction, successes))) == shown


def test_rates_next_to_1_and_next_to_0_are_not_shown_as_either() -> None:
    assert success_text(1 - Fraction(1, 10**11)) == "≈ 1 - 1e-11"
    assert success_text(Fraction(1, 10**400)) == "1e-400"


def drawing(front: Front, file: Path) -> tuple[set[str], int, int]:
    """Draw a front, and give the texts of the SVG, its markers and its lines."""
    front.write_chart(file)
    root = ElementTree.parse(file).getroot()
    texts = {text.text or "" for text in root.iter(f"{SVG}text")}
    series = [group for group in root.iter(f"{SVG}g") if group.get("id", "").startswith("line2d_")]
    clipped = [group for group in series if any("clip-path" in part.attrib for part in group.iter())]
    paths = [path for group in clipped for path in group.iter(f"{SVG}path") if "clip-path" in path.attrib]
    lines = sum("stroke: #dddddd" not in path.get("style", "") for path in paths)
    return texts, sum(len(list(group.iter(f"{SVG}use"))) for group in clipped), lines


def test_a_chart_has_all_points_and_lines_only_where_the_front_is_whole(tmp_path: Path) -> None:
    problem = foon_asp.load().problem("macaroni")
    two = pareto(problem)
    three = pareto(problem, (Objective.SUCCESS, Objective.INPUTS, Objective.UNITS))
    for front, said, lines in (
        (two, {"macaroni", "functional units", "success rate", "0.4988", "0.5955", "0.6293"}, 1),
        (structs.replace(two, complete=False), {"stopped at a limit: points may be missing"}, 0),
        (three, {"9", "10", "11", "input object nodes"}, 3),  # a series for each number of units
    ):
        texts, markers, drawn = drawing(front, tmp_path / "front.svg")
        assert said <= texts
        assert (markers, drawn) == (len(front.points), lines)


@pytest.mark.slow
@pytest.mark.parametrize(("goal", "units"), [("macaroni", [6]), ("potato; cooked; in [pot]", [6, 8])])
def test_fronts_on_the_universal_foon(cli: Cli, universal: Path, goal: str, units: list[int]) -> None:
    words = ("--data", universal, "--containers", "implied", "--format", "json", "--goal", goal)
    found = cli("pareto", *words).json
    assert found["complete"]
    assert [point["measures"]["units"] for point in found["points"]] == units
