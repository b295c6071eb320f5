"""The synthetic FOONs of the benchmarks: what they promise, on small sizes."""

import hashlib
import importlib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from foon_asp.problem import ContainerRule, Problem, first_tree, reach
from foon_asp.proof.simulation import Verdict, simulate
from foon_asp.text.data_folder import Data, find_data, read_data
from foon_asp.text.node_lookup import find_goal
from foon_asp.text.plain_file import read_plain_text
from foon_asp.text.reader import FoonReader

# A script and not a part of the package: it is found beside the tests, not through them.
generator: Any = importlib.import_module("benchmarks.generate")

RECIPE_LIKE, DEEP, ADVERSARIAL = FAMILIES = ("recipe-like", "deep", "adversarial")
UNITS = 1500
Written = Callable[..., Path]


@pytest.fixture(scope="session")
def written(tmp_path_factory: pytest.TempPathFactory) -> Written:
    """Give the folder of an instance, which is written once."""
    root = tmp_path_factory.mktemp("generated")

    @cache
    def write(family: str, units: int = UNITS, seed: int = 1, dialect: str = "plain") -> Path:
        folder = root / f"{family}-{units}-{seed}-{dialect}"
        done = generator.generate(generator.Family(family), units, seed, folder, generator.Dialect(dialect))
        assert done.units == units
        return folder

    return write


@pytest.fixture(params=FAMILIES)
def family(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@cache
def read(folder: Path) -> Data:
    return read_data(find_data(folder))


def problem(folder: Path, goal: int, rule: ContainerRule = ContainerRule.STRICT) -> Problem:
    data = read(folder)
    return Problem(data.network, data.kitchen, (goal,), data.rates, data.utensils, rule)


def goals(folder: Path) -> list[int]:
    """Give the node that each entry of the goals file means, by its label, as a user asks for it."""
    data = read(folder)
    return [find_goal(entry.pattern.label, data.network, data.goals) for entry in data.goals]


def digests(folder: Path) -> dict[str, str]:
    return {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in folder.iterdir()}


def test_same_seed_same_bytes(family: str, written: Written, tmp_path: Path) -> None:
    first = digests(written(family))
    generator.generate(generator.Family(family), UNITS, 1, tmp_path)
    assert digests(tmp_path) == first
    assert set(first) == {"FOON.txt", "kitchen.json", "motion.txt", "utensils.txt", "goal_nodes.json"}
    other = digests(written(family, seed=2))
    assert all(other[name] != first[name] for name in ("FOON.txt", "motion.txt", "goal_nodes.json"))


def test_as_many_distinct_units_as_asked(family: str, written: Written) -> None:
    for units in (generator.LEAST_UNITS, 777):
        file = written(family, units, 2) / "FOON.txt"
        data = read(file.parent)
        assert (len(data.network), data.warnings, data.left_out) == (units, (), 0)
        assert len(FoonReader().tree_units(read_plain_text(file), str(file))) == units  # without merging


@pytest.mark.parametrize("rule", list(ContainerRule))
def test_each_goal_has_a_tree(family: str, rule: ContainerRule, written: Written) -> None:
    folder = written(family)
    asked = goals(folder)
    assert len(asked) >= 4
    assert len(set(asked)) == len(asked)
    assert read(folder).kitchen.isdisjoint(asked)
    for goal in asked:
        question = problem(folder, goal, rule)
        units = first_tree(question, reach(question))
        assert units
        objects = question.network.objects
        kitchen = frozenset(objects[o] for o in question.kitchen)
        told = simulate(question.tree(units), kitchen, (objects[goal],), rule, question.utensils)
        assert told.verdict is Verdict.AS_LISTED


def test_the_dialect_with_ids_says_the_same(family: str, written: Written) -> None:
    plain, ids = written(family), written(family, dialect="ids")
    assert not read(ids).warnings
    one, other = read(plain).network, read(ids).network
    assert (one.objects, one.motions, one.inputs, one.outputs) == (
        other.objects, other.motions, other.inputs, other.outputs,
    )  # fmt: skip


def test_too_few_units_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="expected at least"):
        generator.generate(generator.Family(DEEP), generator.LEAST_UNITS - 1, 1, tmp_path / "new")
    assert not (tmp_path / "new").exists()
