"""Pareto fronts, held against brute force over every tree of small networks."""

import math
import random
import re
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import combinations
from pathlib import Path
from xml.etree import ElementTree

import pytest

import foon_asp
from foon_asp.encoding import exact_success
from foon_asp.network import FunctionalUnit
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.questions.pareto import Front, pareto
from foon_asp.report.answer import success_text, success_texts
from foon_asp.resources import bundled_kitchen
from foon_asp.text.data_folder import find_data, read_data
from foon_asp.text.goal_name import find_goal
from tests import oracle
from tests.conftest import STRUCK_WHILE_READING, Cli
from tests.random_problems import MOTIONS, SERIES, random_problem
from tests.stopped_search import stopped_after
from tests.test_alternatives import choosing

pytestmark = pytest.mark.sampled(3)  # by default some cases of each test: there are many

SVG = "{http://www.w3.org/2000/svg}"
RULES = list(ContainerRule)
SETS = [
    some
    for size in (2, 3)
    for some in combinations(Objective, size)
    if sum(not objective.row.whole for objective in some) <= 1  # only one that is rounded can be settled
]
Point = tuple[Fraction, ...]


def measures(problem: Problem, tree: tuple[FunctionalUnit, ...], objectives: Sequence[Objective]) -> Point:
    return tuple(oracle.measure(problem, tree, objective) for objective in objectives)


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
        units = tuple(map(problem.network.unit, point.units))
        assert oracle.makes(problem, units)
        assert set(units) in map(set, trees)
        shown.append(measures(problem, units, objectives))
        same = [tree for tree in trees if measures(problem, tree, objectives) == shown[-1]]
        assert len(units) == min(map(len, same))
    assert shown == sorted(nondominated(everything))


@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize(
    "seeds", [range(9300, 9330), pytest.param(range(9330, 9500), marks=pytest.mark.slow)]
)
@pytest.mark.sampled(2)
def test_every_front_of_two_and_of_three_objectives(rule: ContainerRule, seeds: range) -> None:
    long = 0
    for seed in seeds:
        problem = choosing(seed, rule)
        trees = list(oracle.trees(problem))
        for objectives in random.Random(seed).sample(SETS, 4):
            front = pareto(problem, objectives)
            assert_agrees(front, trees)
            long += len(front.points) > 2
    assert long >= 3


@SERIES
@pytest.mark.parametrize("scale", [1, 7])
def test_fronts_are_exact_where_rounding_hides_nearly_everything(
    part: int, scale: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(exact_success, "_scale", lambda _: scale)
    for seed in range(9700, 9700 + 30 // part):
        problem = choosing(seed, ContainerRule.STRICT)
        for others in ([Objective.INPUTS], [Objective.UNITS, Objective.KITCHEN]):
            front = pareto(problem, [*others, Objective.SUCCESS])
            assert_agrees(front, list(oracle.trees(problem)))


@SERIES
@pytest.mark.parametrize("rule", RULES)
def test_fronts_for_several_goals(part: int, rule: ContainerRule) -> None:
    for seed in range(9500, 9500 + 30 // part):
        problem = random_problem(seed, rule)
        made = [o for o in range(len(problem.network.objects)) if o not in problem.kitchen]
        wanted = random.Random(seed).sample(made, min(2, len(made)))
        problem = replace(problem, goals=(*wanted, *problem.goals[len(wanted) :]))
        front = pareto(problem, (Objective.UNITS, Objective.SUCCESS, Objective.KITCHEN))
        assert_agrees(front, list(oracle.trees(problem)))


@SERIES
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("name", ["forbid", "require"])
@pytest.mark.sampled(6)
def test_fronts_under_a_constraint(part: int, rule: ContainerRule, name: str) -> None:
    fewer = 0
    for seed in range(9600, 9600 + 30 // part):
        problem = choosing(seed, rule)
        motion = random.Random(seed).choice(MOTIONS)

        def allowed(tree: tuple[FunctionalUnit, ...], motion: str = motion) -> bool:
            return any(unit.motion == motion for unit in tree) == (name == "require")

        word = {"forbid": "forbidden", "require": "required"}[name]
        constants = {f"{word}_motion": motion}
        trees = list(oracle.trees(problem, allowed))
        fewer += len(trees) < len(list(oracle.trees(problem)))
        for objectives in random.Random(seed).sample(SETS, 2):
            assert_agrees(
                pareto(problem, objectives, constraints=f"{name}_motion", constants=constants), trees
            )
    assert fewer >= 10 // part


# --- The command, and what it prints and draws.


def macaroni() -> Problem:
    data = read_data(find_data(bundled_kitchen()))
    goal = find_goal("macaroni", data.network, data.goals)
    return Problem(data.network, data.kitchen, (goal,), data.rates, data.utensils, ContainerRule.STRICT)


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
        assert [list(point.units) for point in front.points] == [[]]
        assert front.complete


def test_the_answer_in_json(cli: Cli) -> None:
    ran = cli("pareto", "--goal", "macaroni", "--objective", "success,units", "--format", "json")
    assert ran.code == 0
    assert ran.json["complete"]
    assert ran.json["objectives"] == ["success", "units"]
    points = ran.json["points"]
    assert [point["measures"]["units"] for point in points] == [11, 10, 9]  # the best success first
    rates = read_data(find_data(bundled_kitchen())).rates
    assert rates is not None
    before: list[int] = []
    for point in points:
        ids = [unit["id"] for unit in point["units"]]
        product = math.prod(rates[unit["motion"]] for unit in point["units"])
        assert Fraction(point["measures"]["success"]["exact"]) == product
        assert point["costs"]["units"] == len(ids)
        if before:
            assert set(ids) == set(before) - set(point["gone"]) | set(point["new"])
        before = ids


@STRUCK_WHILE_READING
def test_exit_codes(cli: Cli, tmp_path: Path) -> None:
    none = cli("pareto", "--goal", "apple pie", "--chart", tmp_path / "none.svg")
    assert none.code == 1
    assert "infeasible: proved" in none.out
    assert "no point to draw" in none.err
    assert not list(tmp_path.iterdir())
    hurried = cli("pareto", "--goal", "tea", "--time-limit", "0")
    assert hurried.code == 3
    assert cli("pareto", "--goal", "tea", "--chart", tmp_path / "front.pdf").code == 2


@pytest.mark.parametrize("interrupted", [True, False])
def test_what_was_found_before_a_limit_is_on_the_front(
    interrupted: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = macaroni()
    objectives = (Objective.UNITS, Objective.SUCCESS)
    whole = pareto(problem, objectives)
    # That there is no other point can be seen at once, so the last search is stopped by ctrl-C alone.
    for searches in range(len(whole.points) + interrupted):
        stopping = stopped_after(searches, lambda _: interrupted)
        monkeypatch.setattr("foon_asp.questions.pareto.solve", stopping)
        front = pareto(problem, objectives)
        assert not front.complete
        assert front.points == whole.points[len(whole.points) - searches :]
        assert "stopped at a limit" in front.text()


def test_successes_look_different_when_they_are() -> None:
    assert success_texts([Fraction(1, 2), Fraction(1, 3)]) == ["0.5", "≈ 0.3333"]
    close = [Fraction("0.12341"), Fraction("0.123412"), Fraction("0.12341")]
    assert success_texts(close) == ["0.12341", "0.123412", "0.12341"]
    assert success_texts([Fraction(1, 3 * 10**9)]) == ["≈ 3.333e-10"]


def drawing(front: Front, file: Path) -> tuple[list[str], int, int]:
    """Draw a front, and give the texts of the SVG, its markers and its lines."""
    front.write_chart(file)
    root = ElementTree.parse(file).getroot()
    texts = [text.text or "" for text in root.iter(f"{SVG}text")]
    series = [group for group in root.iter(f"{SVG}g") if re.fullmatch(r"line2d_\d+", group.get("id", ""))]
    clipped = [group for group in series if any("clip-path" in part.attrib for part in group.iter())]
    markers = sum(len(list(group.iter(f"{SVG}use"))) for group in clipped)
    colored = [
        p for g in clipped for p in g.iter(f"{SVG}path") if "stroke: #dddddd" not in p.get("style", "")
    ]
    lines = sum("clip-path" in path.attrib for path in colored)
    return texts, markers, lines


def test_rates_next_to_1_and_next_to_0_are_not_shown_as_either() -> None:
    assert success_text(Fraction(1)) == "1"
    assert success_text(1 - Fraction(1, 10**11)) == "≈ 1 - 1e-11"
    assert success_text(Fraction(1, 10**400)) == "1e-400"
    assert success_text(Fraction(782, 1000)) == "0.782"


@pytest.mark.slow
def test_a_chart_has_all_points_and_lines_only_where_the_front_is_whole(tmp_path: Path) -> None:
    problem = macaroni()
    two = pareto(problem, (Objective.UNITS, Objective.SUCCESS))
    texts, markers, lines = drawing(two, tmp_path / "two.svg")
    assert {"macaroni", "functional units", "success rate", "0.4988", "0.5955", "0.6293"} <= set(texts)
    assert (markers, lines) == (3, 1)
    texts, markers, lines = drawing(replace(two, complete=False), tmp_path / "open.svg")
    assert "stopped at a limit: points may be missing" in texts
    assert (markers, lines) == (3, 0)
    three = pareto(problem, (Objective.SUCCESS, Objective.INPUTS, Objective.UNITS))
    texts, markers, lines = drawing(three, tmp_path / "three.svg")
    assert {"9", "10", "11", "input object nodes"} <= set(texts)  # a series for each number of units
    assert (markers, lines) == (len(three.points), 3)
    three.write_chart(tmp_path / "three.png")
    assert (tmp_path / "three.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.slow
def test_fronts_on_the_universal_foon(cli: Cli, universal: Path) -> None:
    words = ("pareto", "--data", universal, "--containers", "implied", "--format", "json", "--goal")
    ran = cli(*words, "macaroni")
    assert (ran.code, ran.json["complete"]) == (0, True)
    assert [point["measures"]["units"] for point in ran.json["points"]] == [6]
    ran = cli(*words, "potato; cooked; in [pot]")
    assert (ran.code, ran.json["complete"]) == (0, True)
    assert [point["measures"]["units"] for point in ran.json["points"]] == [6, 8]
    few, many = (Fraction(point["measures"]["success"]["exact"]) for point in ran.json["points"])
    assert few < many
