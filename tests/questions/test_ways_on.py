"""From a state: the units that lead to the goals and what lacks, against all trees by brute force."""

from dataclasses import replace
from pathlib import Path

import pytest

import foon_asp
from foon_asp import ContainerRule, Problem, UserError
from tests.conftest import Cli
from tests.oracle.task_trees import trees
from tests.support.random_problems import random_problem

GLASS = "ice; cubed; in [drinking glass]"


def test_what_lacks_is_named_and_what_runs_comes_first() -> None:
    problem = foon_asp.load().problem("ice")
    ways = foon_asp.ways_on(problem, [GLASS, "muddler; clean"])
    assert [str(node) for node in ways.lacks or ()] == ["drinking glass; contains {ice}"]
    ((crush,), answer) = ways.units, ways.answer
    assert (crush.motion, [str(node) for node in crush.lacks]) == (
        "crush",
        ["drinking glass; contains {ice}"],
    )
    assert answer is not None
    assert [unit.motion for unit in answer.units or ()] == ["crush"]

    ways = foon_asp.ways_on(problem, [GLASS, "muddler; clean", "drinking glass; contains {ice}"])
    assert (ways.lacks, [unit.lacks for unit in ways.units], ways.reached) == ((), [()], False)

    ways = foon_asp.ways_on(problem, ["ice; crushed; in [drinking glass]"])
    assert (ways.lacks, ways.units, ways.reached) == ((), (), True)
    assert "nothing to do" in ways.text()


def test_a_recipe_takes_the_place_of_the_plan(tmp_path: Path, cli: Cli) -> None:
    (tmp_path / "egg.txt").write_text("//\nO\tegg\nM\tboil\nO\tegg\nS\tboiled\n//\n")
    (tmp_path / "state.txt").write_text("O\tsalt\n")
    ran = cli("trace", tmp_path / "egg.txt", "--state", tmp_path / "state.txt", "--goal", "egg; boiled")
    assert ran.code == 1
    assert "it lacks\n  egg\n" in ran.out


@pytest.mark.parametrize("rule", list(ContainerRule))
@pytest.mark.parametrize("seed", range(25))
def test_the_units_are_those_of_some_tree_once_what_lacks_is_there(seed: int, rule: ContainerRule) -> None:
    problem = whole(random_problem(seed, rule, units=6))
    network = problem.network
    state = [network.objects[o] for o in problem.kitchen]
    ways = foon_asp.ways_on(problem, state)
    lacking = {node.node for node in ways.lacks or ()}
    assert bool(lacking) is not any(trees(problem))
    added = frozenset(o for o, node in enumerate(network.objects) if str(node) in lacking)
    stocked = replace(problem, kitchen=problem.kitchen | added)
    possible = list(trees(stocked))
    assert bool(possible) is (ways.lacks is not None)
    irredundant = [tree for tree in possible if not any(set(other) < set(tree) for other in possible)]
    named = {network.unit(unit.id) for unit in ways.units if unit.id is not None}
    assert {unit for tree in irredundant for unit in tree} <= named
    for unit in ways.units:
        assert unit.id is not None
        needed = {network.objects[o] for o in problem.needs[unit.id]}
        assert {node.node for node in unit.lacks} == {str(node) for node in needed if node not in state}


def whole(problem: Problem) -> Problem:
    """Return a problem of the same data, whose kitchen can be varied."""
    nodes = problem.network.objects
    kitchen = [nodes[o] for o in problem.kitchen]
    foon = foon_asp.build(problem.network, utensils=problem.utensils, kitchen=kitchen)
    return foon.problem(*(nodes[o] for o in problem.goals), containers=str(problem.containers))


def test_the_state_after_a_step_is_a_kitchen(cli: Cli, tmp_path: Path) -> None:
    plan, state = tmp_path / "plan.txt", tmp_path / "state.txt"
    plan.write_text(cli("solve", "--goal", "macaroni", "--format", "foon").out)
    for done in (5, 9):
        words = ("--goal", "macaroni", "--items", "lasting", "--after", str(done), "-o", state)
        assert cli("trace", plan, *words).code == 0
        ways = cli("trace", "--state", state, "--goal", "macaroni", "--format", "json")
        solved = cli("solve", "--kitchen", state, "--goal", "macaroni", "--format", "json")
        assert (ways.code, solved.code) == (0, 0)
        assert ways.json["reached"] is (done == 9)
        best = [unit["id"] for unit in ways.json["answer"]["units"]]
        assert best == [unit["id"] for unit in solved.json["units"]]
        assert len(best) <= 9 - done
        leading = [unit for unit in ways.json["units"] if not unit["lacks"]]
        assert done == 9 or leading[0]["id"] in best


def test_a_plan_or_a_state_is_needed_and_not_what_belongs_to_the_other(cli: Cli, tmp_path: Path) -> None:
    state = tmp_path / "state.txt"
    state.write_text("O\tegg\n")
    assert "name a file with one, or a state with --state" in cli("trace", "--goal", "ice").err
    ran = cli("trace", "--state", state, "--goal", "ice", "--after", "1")
    assert (ran.code, "leave --failed, --after" in ran.err) == (2, True)
    ran = cli("trace", "--state", state, "--goal", "ice", "--items", "used-up")
    assert (ran.code, "not built" in ran.err) == (2, True)
    problem = foon_asp.load().problem("ice", items="used-up")
    with pytest.raises(UserError, match="not built"):
        foon_asp.ways_on(problem, ["egg"])
