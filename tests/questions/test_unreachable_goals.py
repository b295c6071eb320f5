"""``solve --skip-unreachable``: one tree for the goals that can be made, and the cause of each other one."""

from dataclasses import replace
from pathlib import Path

import pytest

import foon_asp
from foon_asp.problem import ContainerRule, reach
from tests.conftest import Cli
from tests.questions.recipes import posed
from tests.support.random_problems import random_problem

UNITS = (
    "egg; whole > egg; cracked",
    "egg; cracked > egg; fried",
    "flour; white > bread; baked",
    "dough; sour > dough; fed",
    "dough; fed > dough; sour",
)


def test_goals_that_cannot_be_made_have_their_cause() -> None:
    problem = posed("egg; whole", "egg; fried", *UNITS).vary(
        goals=["egg; fried", "bread; baked", "dough; fed", "flour; white"]
    )
    assert not foon_asp.solve(problem)
    answer = foon_asp.solve(problem, skip_unreachable=True)
    assert isinstance(answer.skipped, tuple)
    assert (str(answer.status), list(map(str, answer.goals)), answer.costs and answer.costs.units) == (
        "optimal",
        ["egg; fried"],
        2,
    )
    assert [(str(s.goal), str(s.cause), str(s.object), s.cycle_size) for s in answer.skipped] == [
        ("bread; baked", "missing", "flour; white", 0),
        ("dough; fed", "cycle", "dough; fed", 2),
        ("flour; white", "missing", "flour; white", 0),
    ]
    assert "3 goals cannot be made" in answer.text()


def test_where_nothing_can_be_made_nothing_is_left_out(cli: Cli) -> None:
    problem = posed("egg; whole", "bread; baked", *UNITS)
    answer = foon_asp.solve(problem, skip_unreachable=True)
    assert (str(answer.status), answer.skipped) == ("infeasible", ())
    assert cli("solve", "--goal", "ice", "--all-goals", "--skip-unreachable").code == 2


@pytest.mark.parametrize("rule", list(ContainerRule))
def test_the_tree_is_that_of_the_goals_that_can_be_made(rule: ContainerRule) -> None:
    several = 0
    for seed in range(20):
        problem = random_problem(seed, rule)
        everything = tuple(range(len(problem.network.objects)))
        available = reach(problem).available
        made = tuple(o for o in everything if available[o])
        answer = foon_asp.solve(replace(problem, goals=everything), skip_unreachable=True)
        expected = foon_asp.solve(replace(problem, goals=made))
        assert (answer.status, answer.costs) == (expected.status, expected.costs)
        assert isinstance(answer.skipped, tuple)
        assert {skipped.goal.id for skipped in answer.skipped} == {o for o in everything if not available[o]}
        several += len(answer.skipped) > 1
        for skipped in answer.skipped:
            assert skipped.object.id is not None
            assert not available[skipped.object.id]
    assert several


@pytest.mark.parametrize("words", [("--reduce", "none"), ("--durations", "times.txt"), ("--", "--stats")])
def test_each_goal_by_itself_refuses_what_it_would_ignore(
    words: tuple[str, ...], tmp_path: Path, cli: Cli
) -> None:
    (tmp_path / "times.txt").write_text("twist\t3\n")
    words = tuple(str(tmp_path / word) if word == "times.txt" else word for word in words)
    ran = cli("solve", "--goal", "ice", "--all-goals", *words)
    assert ran.code == 2
    assert "--all-goals takes no --reduce, --durations or options of clingo" in ran.err
