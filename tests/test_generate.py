"""The synthetic FOONs of the benchmarks: what they promise, on small sizes."""

import hashlib
import importlib
import json
from collections import Counter
from collections.abc import Callable
from functools import cache
from itertools import islice
from pathlib import Path
from typing import Any

import pytest

from foon_asp.network import Network
from foon_asp.problem import ContainerRule, Problem, first_tree, reach, relevant
from foon_asp.proof.simulation import Verdict, simulate
from foon_asp.text.data_folder import Data, find_data, read_data
from foon_asp.text.goal_name import find_goal
from foon_asp.text.plain_file import read_plain_text
from foon_asp.text.reader import FoonReader
from tests.conftest import Cli

pytestmark = pytest.mark.sampled(2)  # by default each second case of a test: there are many

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


def components(network: Network) -> list[set[int]]:
    """Give the strongly connected components of the graph from inputs to outputs, the largest first."""
    ahead: list[set[int]] = [set() for _ in network.objects]
    behind: list[set[int]] = [set() for _ in network.objects]
    for inputs, outputs in zip(network.inputs, network.outputs, strict=True):
        for o in inputs:
            ahead[o].update(outputs)
        for o in outputs:
            behind[o].update(inputs)
    left: list[int] = []  # in the order in which a search leaves them
    met: set[int] = set()
    for root in range(len(ahead)):
        stack = [(root, iter(ahead[root]))] if root not in met else []
        met.add(root)
        while stack:
            o, following = stack[-1]
            for other in following:
                if other not in met:
                    met.add(other)
                    stack.append((other, iter(ahead[other])))
                    break
            else:
                left.append(o)
                stack.pop()
    found: list[set[int]] = []
    placed: set[int] = set()
    for root in reversed(left):
        if root not in placed:
            component, queue = {root}, [root]
            while queue:
                queue += (new := behind[queue.pop()] - placed - component)
                component |= new
            placed |= component
            found.append(component)
    return sorted(found, key=len, reverse=True)


def layers(whole: Problem) -> dict[int, int]:
    """Give the layer of each node that can be made: one above the highest input of its lowest maker."""
    network = whole.network
    layer = dict.fromkeys(whole.kitchen, 0)
    missing = [len(needs) for needs in whole.needs]
    front, depth = list(whole.kitchen), 0
    while front:
        depth += 1
        ready = []
        for o in front:
            for unit in network.consumers[o]:
                missing[unit] -= 1
                if not missing[unit]:
                    ready.append(unit)
        front = [o for o in dict.fromkeys(o for u in ready for o in network.outputs[u]) if o not in layer]
        layer.update(dict.fromkeys(front, depth))
    return layer


def test_same_seed_same_bytes(family: str, written: Written, tmp_path: Path) -> None:
    first = digests(written(family))
    generator.generate(generator.Family(family), UNITS, 1, tmp_path)
    assert digests(tmp_path) == first
    assert set(first) == {"FOON.txt", "kitchen.json", "motion.txt", "utensils.txt", "goal_nodes.json"}
    other = digests(written(family, seed=2))
    assert all(other[name] != first[name] for name in ("FOON.txt", "motion.txt", "goal_nodes.json"))


@pytest.mark.parametrize("units", [generator.LEAST_UNITS, 777, UNITS])
@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.sampled(3)
def test_as_many_distinct_units_as_asked(family: str, units: int, seed: int, written: Written) -> None:
    folder = written(family, units, seed)
    data = read(folder)
    assert len(data.network) == units
    assert (
        len(FoonReader().tree_units(read_plain_text(folder / "FOON.txt"), str(folder / "FOON.txt"))) == units
    )  # without merging
    assert not data.warnings
    assert not data.left_out
    assert len(data.kitchen) == len(json.loads((folder / "kitchen.json").read_text(encoding="utf-8")))


@pytest.mark.parametrize("seed", [1, *(pytest.param(n, marks=pytest.mark.slow) for n in (2, 3))])
@pytest.mark.parametrize("rule", list(ContainerRule))
def test_each_goal_has_a_tree(family: str, seed: int, rule: ContainerRule, written: Written) -> None:
    folder = written(family, seed=seed)
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


def test_the_smallest_instances_have_a_goal(family: str, written: Written) -> None:
    for seed in range(20):
        assert goals(written(family, generator.LEAST_UNITS, seed))


def test_everything_can_be_made_and_every_unit_executes(family: str, written: Written) -> None:
    question = problem(written(family), 0)
    reached = reach(question)
    assert all(reached.available)
    assert len(reached.units) == UNITS


def test_units_are_made_after_what_they_need(family: str) -> None:
    made: set[int] = set()
    chosen = generator.Goals(generator.random.Random(1))
    for unit in islice(generator.unit_stream(generator.Family(family), 2 * UNITS, 1, chosen), UNITS):
        assert all(node.kitchen or node.number in made for node in unit.inputs)
        made.update(node.number for node in unit.outputs)
    assert {node.number for node in chosen.nodes} <= made


def test_sizes_of_units_and_nodes(family: str, written: Written) -> None:
    network = read(written(family)).network
    inputs, outputs = (Counter(map(len, side)) for side in (network.inputs, network.outputs))
    assert set(inputs) == {1, 2, 3, 4, 5}
    assert set(outputs) == {1, 2, 3}
    assert 2.5 < sum(n * count for n, count in inputs.items()) / UNITS < 3.5
    assert 1.5 < sum(n * count for n, count in outputs.items()) / UNITS < 2.2
    lines = Counter(len(o.states) + len(o.relations) + len(o.contents) for o in network.objects)
    assert set(lines) <= {1, 2, 3, 4, 5, 6}
    producers = Counter(map(len, network.producers))
    kitchen_only = producers.pop(0)
    assert kitchen_only <= len(read(written(family)).kitchen)
    assert set(producers) == {1, 2, 3, 4}


def test_the_text_is_like_that_of_merged_recipes(family: str, written: Written) -> None:
    text = (written(family) / "FOON.txt").read_text(encoding="utf-8")
    assert 200 < len(text) / UNITS < 270
    mentions = text.count("\nO\t")
    assert 2 < mentions / len(read(written(family)).network.objects) < 6
    assert len(text.splitlines()) > 10 * len(set(text.splitlines()))


@pytest.mark.sampled(2)
def test_goals_go_from_easy_to_hard(family: str, written: Written) -> None:
    folder = written(family, 6000)
    asked = goals(folder)
    cones = []
    for goal in asked:
        question = problem(folder, goal)
        cones.append(len(relevant(question, reach(question))))
    assert cones[0] < 100
    assert max(cones) == max(cones[len(cones) // 2 :])
    assert max(cones) > 6000 // 10
    layer = layers(problem(folder, 0))
    depths = [layer[goal] for goal in asked]
    assert min(depths) < 10
    assert 25 <= max(depths) <= 40
    assert max(layer.values()) <= generator.DEEPEST


@pytest.mark.slow
def test_the_families_differ(written: Written) -> None:
    networks = {family: read(written(family, 6000)).network for family in FAMILIES}
    largest = {family: components(network)[0] for family, network in networks.items()}
    inside = {
        family: sum(
            not largest[family].isdisjoint(inputs) and not largest[family].isdisjoint(outputs)
            for inputs, outputs in zip(network.inputs, network.outputs, strict=True)
        )
        for family, network in networks.items()
    }
    assert inside[ADVERSARIAL] > 0.75 * 6000
    assert all(50 < inside[family] < 0.25 * 6000 for family in (RECIPE_LIKE, DEEP))
    choice = {}
    for family, network in networks.items():
        made = [len(makers) for makers in network.producers if makers]
        choice[family] = sum(made) / len(made)
    assert choice[RECIPE_LIKE] < choice[DEEP] < 1.6
    assert choice[ADVERSARIAL] > 2
    deep = {family: layers(problem(written(family, 6000), 0)) for family in (RECIPE_LIKE, DEEP)}
    means = {family: sum(layer.values()) / len(layer) for family, layer in deep.items()}
    assert means[RECIPE_LIKE] < means[DEEP]


def test_a_vessel_is_empty_full_and_empty_again(written: Written) -> None:
    network = read(written(RECIPE_LIKE)).network
    cycles = [component for component in components(network) if len(component) > 1]
    again = [
        o for component in cycles for o in component if network.objects[o].states == frozenset({"empty"})
    ]
    assert again
    assert any(network.objects[o].contents for component in cycles for o in component)


def test_rates_are_exact_decimals(family: str, written: Written) -> None:
    data = read(written(family))
    assert data.rates is not None
    assert set(data.network.motions) <= set(data.rates)
    assert all(0.5 <= rate <= 1 and 1000 % rate.denominator == 0 for rate in data.rates.values())
    assert len(set(data.rates.values())) > 30


def test_the_dialect_with_ids_says_the_same(family: str, written: Written) -> None:
    plain, ids = written(family), written(family, dialect="ids")
    assert not read(ids).warnings
    one, other = read(plain).network, read(ids).network
    assert (one.objects, one.motions, one.inputs, one.outputs) == (
        other.objects, other.motions, other.inputs, other.outputs,
    )  # fmt: skip
    lines = (ids / "FOON.txt").read_bytes().decode().split("\r\n")
    meanings: dict[str, set[str]] = {}
    for line in lines[1:-1]:
        if line != "//":
            id_, name, *_ = line.split("\t")
            assert id_[1:].isdecimal()
            meanings.setdefault(id_, set()).add(name.rstrip("*"))
    assert all(len(names) == 1 for names in meanings.values())
    assert {line.split("\t")[2] for line in lines if line[:1] == "O"} == {"0", "1"}
    times = [line.split("\t")[2:] for line in lines if line[:1] == "M"]
    assert all(len(pair) == 2 for pair in times)
    assert ["Assumed", "Assumed"] in times


def test_dish_names_are_never_the_same() -> None:
    names = {generator.dish_name(recipe) for recipe in range(600_000)}
    assert len(names) == 600_000


def test_every_recipe_gets_two_vessels_however_the_dice_fall() -> None:
    class Unlucky(generator.random.Random):  # type: ignore[misc]
        draws = 0

        def random(self) -> float:
            self.draws += 1
            return 1 / 48 if self.draws < 100 else float(super().random())  # never in the kitchen at first

    for family in (RECIPE_LIKE, DEEP):
        world = generator._World(generator.Family(family), UNITS, Unlucky(1))
        chosen = world.vessels(0, True)
        assert len({vessel.label for vessel in chosen}) == len(chosen) >= 2
        assert all(vessel.empty.kitchen for vessel in chosen)


def test_a_failure_leaves_no_network(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError("no space left")

    monkeypatch.setattr(generator, "_write_entries", full)
    with pytest.raises(OSError, match="no space"):
        generator.generate(generator.Family(DEEP), UNITS, 1, tmp_path)
    assert not list(tmp_path.glob("*FOON*"))


def test_too_few_units_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="expected at least"):
        generator.generate(generator.Family(DEEP), generator.LEAST_UNITS - 1, 1, tmp_path / "new")
    assert not (tmp_path / "new").exists()


def test_solve_reads_the_folder(family: str, written: Written, cli: Cli) -> None:
    folder = written(family, generator.LEAST_UNITS)
    easiest = read(folder).goals[0].pattern.label
    ran = cli("solve", "--data", folder, "--goal", easiest, "--format", "json")
    assert ran.code == 0
    assert ran.json["status"] == "optimal"
