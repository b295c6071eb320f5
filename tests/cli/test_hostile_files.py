"""Names of a user's that meet ours: an answer is that of brute force, or the file is refused with a place."""

from collections import Counter
from pathlib import Path

import pytest

from foon_asp.asp import Settings, Status, solve
from foon_asp.asp.soft import solve_soft
from foon_asp.problem import ContainerRule, Problem, parse_objectives
from foon_asp.text.diagnostics import InputError
from tests.oracle import task_trees
from tests.support.hostile_files import HostileFile, hostile_files, our_names, some_hostile_files
from tests.support.random_problems import random_problem

OBJECTIVES = (["units"], ["success"], ["kitchen", "success"])


def refused(error: InputError, file: Path) -> str:
    """Look at how a file was refused: every fault has a place in it, and says what to do."""
    for diagnostic in error.diagnostics:
        assert Path(diagnostic.source.file).parent == file.parent
        assert 0 < diagnostic.source.line <= 2
        assert diagnostic.source.column > 0
        assert "expected" in diagnostic.message or "give" in diagnostic.message, diagnostic.message
    return "refused"


def answer(problem: Problem, objectives: list[str], hostile: HostileFile, settings: Settings) -> str:
    """Ask under a hostile file; give how it went."""
    try:
        outcome = solve(problem, parse_objectives(objectives), settings)
    except InputError as error:
        (file,) = settings.constraints
        assert isinstance(file, Path)
        return refused(error, file)
    expected = task_trees.best(list(task_trees.trees(problem, hostile.keeps)), problem, objectives)
    if expected is None:
        assert outcome.status is Status.INFEASIBLE, hostile
        return "infeasible"
    assert outcome.status is Status.OPTIMAL, hostile
    assert outcome.units is not None
    tree = tuple(map(problem.network.unit, outcome.units))
    assert task_trees.makes(problem, tree), hostile
    assert hostile.keeps(tree), hostile
    assert task_trees.key(problem, tree, objectives) == expected, hostile
    return "optimal"


def ask(files: list[HostileFile], folder: Path) -> Counter[str]:
    endings: Counter[str] = Counter()
    for number, hostile in enumerate(files):
        problem = random_problem(number, ContainerRule.STRICT, units=6)
        settings = Settings(constraints=(hostile.write(folder),))
        endings[answer(problem, OBJECTIVES[number % 3], hostile, settings)] += 1
    return endings


@pytest.mark.slow
def test_some_hostile_files(tmp_path: Path) -> None:
    files = some_hostile_files(len(our_names()) // 2, seed=1)
    endings = ask(files, tmp_path)
    assert endings.keys() == {"refused", "infeasible", "optimal"}


@pytest.mark.slow
def test_some_hostile_files_that_are_soft(tmp_path: Path) -> None:
    endings: Counter[str] = Counter()
    for number, hostile in enumerate(some_hostile_files(120, seed=3)):
        problem = random_problem(number, ContainerRule.STRICT, units=6)
        file = hostile.write(tmp_path)
        found = list(task_trees.trees(problem))
        try:
            soft = solve_soft(problem, parse_objectives(["units"]), Settings(), {file: 3})
        except InputError as error:
            endings[refused(error, file)] += 1
            continue
        if not found:
            assert soft.outcome.status is Status.INFEASIBLE
            continue
        kept = [tree for tree in found if hostile.keeps(tree)]
        assert soft.outcome.status is Status.OPTIMAL
        assert (soft.penalty == 0) == bool(kept), hostile
        if kept:
            assert soft.outcome.costs is not None
            assert soft.outcome.costs.units == min(map(len, kept)), hostile
        endings["kept" if kept else "broken"] += 1
    assert endings.keys() == {"refused", "kept", "broken"}


@pytest.mark.nightly
@pytest.mark.parametrize("part", range(10))
def test_all_hostile_files(part: int, tmp_path: Path) -> None:
    ask(list(hostile_files())[part::10], tmp_path)
