"""Prices of units, from files to problems: folders, JSON, merging, stores, levels, Python."""

import json
import random
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, ObjectNode, UnitPrices
from foon_asp.problem import Problem
from foon_asp.store.import_files import import_files
from foon_asp.text.data_folder import DataFiles, find_data, read_data
from foon_asp.text.diagnostics import InputError
from tests.conftest import Cli

pytestmark = pytest.mark.filterwarnings("ignore:No kitchen given")

A, B, C, D = (ObjectNode.of(label) for label in "abcd")
B_RED, B_BLUE = ObjectNode.of("b", ["red"]), ObjectNode.of("b", ["blue"])


def listed(motion: str, inputs: str, outputs: str, price: object = None) -> dict[str, Any]:
    """Give a unit as JSON lists have it; ``b/red`` is a label with a state."""

    def node(name: str) -> dict[str, Any]:
        label, *states = name.split("/")
        return {"label": label, "states": states, "ingredients": [], "container": None}

    sides = [[node(name) for name in side.split()] for side in (inputs, outputs)]
    found = {"input_nodes": sides[0], "motion_node": motion, "output_nodes": sides[1]}
    return found if price is None else {**found, "price": price}


def write(file: Path, *units: dict[str, Any]) -> Path:
    file.write_text(json.dumps(list(units)), encoding="utf-8")
    return file


def unit(motion: str, start: ObjectNode, end: ObjectNode) -> FunctionalUnit:
    return FunctionalUnit(motion, (start,), (end,))


def shown(problem: Problem) -> list[str | None]:
    return [None if price is None else str(price) for price in problem.prices]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Give a folder with prices of every kind: one unit of each, and one without any."""
    folder = tmp_path / "data"
    folder.mkdir()
    units = listed("mix", "a", "b", 0.1), listed("mix", "b", "c", "0.20"), listed("mix", "c", "d")
    write(folder / "net.json", *units, listed("cut", "a", "d", 0), listed("go", "a", "c"))
    write_lines(folder / "unit_prices.txt", "mix\t7", "mix\tb\t->\tc\t3.5", "unknown\t1")
    (folder / "kitchen.json").write_text('[{"label": "a"}]')
    return folder


def write_lines(file: Path, *lines: str) -> Path:
    file.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
    return file


FOUND = ["1/10", "7/2", "7", "0", None]


# --- reading


def test_a_folder_has_prices_by_motion_by_unit_and_in_its_network(folder: Path) -> None:
    assert find_data(folder).unit_prices == folder / "unit_prices.txt"
    problem = foon_asp.load(folder).problem("d;")
    assert shown(problem) == FOUND
    assert problem.price(1) == Fraction(7, 2)
    with pytest.raises(ValueError, match="no price of unit 4 is known"):
        problem.price(4)


def test_prices_given_on_their_own_replace_those_of_the_folder(folder: Path, tmp_path: Path) -> None:
    file = write_lines(tmp_path / "other.txt", "go\t1", "mix\t0.5")
    assert shown(foon_asp.load(folder, unit_prices=file).problem("d;")) == ["1/10", "1/5", "1/2", "0", "1"]
    alone = foon_asp.load(folder / "net.json", kitchen=folder / "kitchen.json").problem("d;")
    assert shown(alone) == ["1/10", "1/5", None, "0", None]
    (folder / "net.json").rename(folder / "net.txt")  # the tables are no networks
    assert find_data(folder).network == (folder / "net.txt",)


def test_a_price_of_a_unit_that_is_not_there_is_a_warning(folder: Path, cli: Cli) -> None:
    write_lines(folder / "unit_prices.txt", "mix\ta\t->\td\t1")
    said = f"{folder / 'unit_prices.txt'}:1:1: warning: the unit 'mix: a → d' is not in the network"
    with pytest.warns(foon_asp.FoonWarning, match="is not in the network"):
        assert foon_asp.load(folder).warnings == (said,)
    ran = cli("solve", "--data", str(folder), "--goal", "d;")
    assert (ran.code, ran.err.startswith(said)) == (0, True)
    store = folder / "net.foon"
    assert said in cli("merge", "--data", str(folder), "--store", str(store)).err
    prices = "--unit-prices", str(folder / "unit_prices.txt")
    assert said in cli("solve", "--network", str(store), *prices, "--goal", "d;").err


@pytest.mark.parametrize("price", [-1, "1,5", "", [], True, {"is": 1}, 1e-30, "1e3", "NaN"])
def test_a_price_in_json_that_is_none_has_its_place(tmp_path: Path, price: object) -> None:
    file = tmp_path / "net.json"
    file.write_text("[\n" + json.dumps(listed("mix", "a", "b", price)) + "]")
    with pytest.raises(InputError) as caught:
        read_data(DataFiles((file,)))
    (error,) = caught.value.diagnostics
    assert (error.source.line, error.source.column) == (2, 1)
    assert '"price"' in error.message
    assert "expected a price from 0, as a decimal such as 1.99" in error.message


# --- copies


def test_copies_that_disagree_are_an_error_unless_a_line_chooses(tmp_path: Path, cli: Cli) -> None:
    one = write(tmp_path / "one.json", listed("mix", "a", "b", 1), listed("cut", "a", "b"))
    two = write(tmp_path / "two.json", listed("cut", "a", "b", 5), listed("mix", "a", "b", "1.00"))
    assert read_data(DataFiles((one, two))).unit_prices == UnitPrices(
        {}, {unit("mix", A, B): Fraction(1), unit("cut", A, B): Fraction(5)}
    )
    bad = write(tmp_path / "bad.json", listed("mix", "a", "b", 2))
    said = (
        f"{bad}:1:2: error: found a copy of the unit 'mix' of {one}:1 with another price, expected "
        "one price: choose one with a line for this unit in a file of prices (--unit-prices FILE)"
    )
    files = [str(one), str(bad)]
    network = [word for file in files for word in ("--network", file)]
    motion = write_lines(tmp_path / "motion_prices.txt", "mix\t1")
    for words in (
        ["solve", *network, "--goal", "b;", "--unit-prices", str(motion)],
        ["merge", *files],
        ["merge", *files, "--store", str(tmp_path / "x.foon")],
    ):
        ran = cli(*words)
        assert (ran.code, said in ran.err, ran.out) == (2, True, ""), ran.err
    assert not (tmp_path / "x.foon").exists()
    chosen = write_lines(tmp_path / "chosen.txt", "mix\ta\t->\tb\t2")
    for words in (
        ["merge", *files, "--unit-prices", str(chosen)],
        ["merge", *files, "--store", str(tmp_path / "x.foon"), "--unit-prices", str(chosen)],
    ):
        assert cli(*words).code == 0
    assert shown(foon_asp.load(tmp_path / "x.foon").problem("b;")) == ["2", None]
    assert shown(foon_asp.load(files, unit_prices=chosen).problem("b;")) == ["2", None]


def test_merging_says_that_prices_are_lost(tmp_path: Path, cli: Cli) -> None:
    file = write(
        tmp_path / "net.json", listed("mix", "a", "b", 1), listed("mix", "b", "c", 1), listed("go", "a", "d")
    )
    ran = cli("merge", str(file))
    assert "2 prices of units not in the result" in ran.err
    assert "prices of" not in cli("merge", str(write(file, listed("mix", "a", "b")))).err


def test_converting_keeps_prices_in_json_and_says_where_they_are_lost(tmp_path: Path, cli: Cli) -> None:
    units = [listed("mix", "a", "b", 0.1), listed("mix", "b", "c", ".50"), listed("mix", "c", "d")]
    file = write(tmp_path / "net.json", *units)
    prices = read_data(DataFiles((file,))).unit_prices
    assert prices is not None
    for form in ("json", "json-list"):
        to = tmp_path / f"{form}.json"
        ran = cli("convert", str(file), "--to", form, "-o", str(to))
        assert (ran.code, "prices of units" in ran.err) == (0, False)
        assert read_data(DataFiles((to,))).unit_prices == prices
        assert '"price": 0.1\n' in to.read_text()
        assert '"price": ".50"' in to.read_text()
        back = cli("convert", str(to), "--to", "json-list")
        assert [each.get("price") for each in json.loads(back.out)] == [0.1, ".50", None]
    for form in ("plain", "no-ids", "ids"):
        ran = cli("convert", str(file), "--to", form)
        assert f"2  prices of units; first at {file}:1" in ran.err


# --- stores


def test_stores_of_networks_at_random_have_the_prices_of_the_text(tmp_path: Path) -> None:
    """Units over several blocks, with copies, and prices of all kinds."""
    for seed in range(2):
        rng = random.Random(seed)
        labels = [f"n{number}" for number in range(60)]
        files, motions = [], ["mix", "cut", "go"]
        stated: dict[tuple[str, str, str], object] = {}
        for name in ("one.json", "two.json"):
            units = []
            for _ in range(100):
                key = rng.choice(motions), rng.choice(labels), rng.choice(labels)
                price = stated.setdefault(key, rng.choice([None, None, 0, "0.10", 12.5]))
                units.append(listed(*key, price if rng.random() < 0.7 else None))
            files.append(write(tmp_path / name, *units))
        lines = [f"{motion}\t{rng.choice(['0', '.3'])}" for motion in motions if rng.random() < 0.4]
        lines += [
            f"{m}\t{a}\t->\t{b}\t{rng.choice(['1', '2.0'])}" for m, a, b in stated if rng.random() < 0.3
        ]
        prices = write_lines(tmp_path / "prices.txt", *lines)
        data = DataFiles(tuple(files), unit_prices=prices if seed % 2 else None)
        store = tmp_path / "net.foon"
        import_files(data, store)
        for given in (prices, data.unit_prices):
            text = foon_asp.load(files, unit_prices=given)
            with foon_asp.load(store, unit_prices=given) as stored:
                assert text.unit_prices
                assert stored.unit_prices
                assert stored.unit_prices.of_units(stored.network) == text.unit_prices.of_units(text.network)
                for goal in text.network.objects[::20]:
                    asked = [foon.problem(goal) for foon in (text, stored)]
                    by_unit = [{p.network.unit(u): price for u, price in enumerate(p.prices)} for p in asked]
                    assert by_unit[1].items() <= by_unit[0].items()


# --- levels


def test_below_level_3_the_least_counts_and_each_needs_one(tmp_path: Path) -> None:
    units = listed("mix", "a", "b/red", 3), listed("mix", "a", "b/blue", "2.5")
    file = write(tmp_path / "net.json", *units, listed("go", "a", "c", 9))
    import_files(DataFiles((file,)), tmp_path / "net.foon")
    for source in (file, tmp_path / "net.foon"):
        problem = foon_asp.load(source, level=1).problem("b")
        assert shown(problem) == ["5/2", "9"]
        red = FunctionalUnit("mix", (A,), (B_RED,))
        assert shown(problem.vary(unit_prices={"mix": 1})) == ["5/2", "9"]
        assert shown(problem.vary(unit_prices={FunctionalUnit("mix", (A,), (B,)): 1})) == ["1", "9"]
        with pytest.raises(UserError, match="no unit of the network is 'mix: a → b; red'"):
            problem.vary(unit_prices={red: 1})
    lacking = write(tmp_path / "lacking.json", listed("mix", "a", "b/red", 3), listed("mix", "a", "b/blue"))
    problem = foon_asp.load(lacking, level=1).problem("b")
    assert shown(problem) == [None]
    assert [each.motion for each in problem.unpriced] == ["mix"]


# --- in Python


def test_prices_vary_in_python(folder: Path) -> None:
    foon = foon_asp.load(folder)
    problem = foon.problem("d;")
    changed: dict[str | FunctionalUnit, Any] = {"go": "0.3", "mix": Decimal("8.5"), unit("cut", A, D): 0.1}
    varied = problem.vary(unit_prices=changed)
    assert shown(varied) == ["1/10", "7/2", "17/2", "1/10", "3/10"]
    assert shown(foon.vary(unit_prices=changed).problem("d;")) == shown(varied)
    assert shown(varied.vary(kitchen="b;")) == shown(varied)
    assert shown(varied.vary(containers="implied").vary("c;")) == shown(varied)
    assert shown(problem) == FOUND
    assert shown(foon_asp.Foon.of(replace(varied, origin=None)).problem("d;")) == shown(varied)
    store = folder / "net.foon"
    import_files(find_data(folder), store)
    stored = foon_asp.load(store).problem("d;").vary(unit_prices=changed)
    assert stored.price(
        next(u for u in range(len(stored.network)) if stored.network.motions[u] == "cut")
    ) == Fraction(1, 10)
    assert shown(stored.whole) == shown(varied)
    assert list(stored.unpriced) == []


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"mixx": 1}, "no unit has the motion 'mixx'; similar are 'mix'"),
        ({"mix": -1}, "found -1 for the price of 'mix', expected a price from 0"),
        ({"mix": "cheap"}, "found 'cheap' for the price of 'mix', expected a number such as '0.85'"),
        ({"mix": float("nan")}, "found nan for the price of 'mix', expected a number"),
        ({"mix": 10**1001}, "of at most 1,000 digits"),
        ({"mix": "1e999999999"}, "found 1e999999999 for the price of 'mix', expected an exponent of at most"),
        ({"mix": Decimal("1E-999999999")}, "expected an exponent of at most 1,000"),
        ({unit("mix", D, A): 1}, "no unit of the network is 'mix: d → a'"),
    ],
)
def test_prices_in_python_that_are_none(folder: Path, changed: dict[Any, Any], said: str) -> None:
    store = folder / "net.foon"
    import_files(find_data(folder), store)
    for foon in (foon_asp.load(folder), foon_asp.load(store)):
        with pytest.raises(UserError) as caught:
            foon.problem("d;").vary(unit_prices=changed)
        assert said in str(caught.value)


# --- what goes by them


def test_a_missing_price_is_an_error_only_where_prices_are_asked_for(folder: Path) -> None:
    problem = foon_asp.load(folder).problem("d;")
    assert foon_asp.solve(problem, "units").units is not None
    with pytest.raises(UserError) as caught:
        foon_asp.solve(problem, "price")
    assert str(caught.value).startswith(
        f"{folder / 'net.json'}:1:1: error: the unit 'go' has no price\nadd a line"
    )
    with pytest.raises(UserError, match="price needs the prices of the units: give a file"):
        foon_asp.solve(replace(problem, unit_prices=None), "price")
    assert foon_asp.solve(problem.vary(unit_prices={"go": 1}), "price").ids == (3,)
    units = [listed(f"go {number}", "a", str(number)) for number in range(12)]
    file = write(folder / "many.json", *units, listed("go 0", "b", "c"), listed("mix", "a", "b", 1))
    with pytest.raises(UserError) as caught:
        foon_asp.solve(foon_asp.load(file, kitchen=folder / "kitchen.json").problem("11"), "price")
    first, *_, more, advice = str(caught.value).split("\n")
    assert first.endswith("error: the unit 'go 0' has no price, nor have 1 more with this motion")
    assert more == "... and units of 2 more motions"
    assert advice.startswith("add a line with the motion, a tab and its price to the file of prices")
