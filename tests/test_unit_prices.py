"""Prices of units, from files to problems: folders, JSON, merging, stores, levels, Python, sessions."""

import json
import random
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.asp import Settings, solve
from foon_asp.asp.session import Session
from foon_asp.compare.results_file import results_question
from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, Network, ObjectNode, UnitPrices
from foon_asp.problem import Known, Objective, Problem, Row
from foon_asp.proof.verify import digests
from foon_asp.search import SEARCHES, SearchSettings
from foon_asp.store.block import VERSION
from foon_asp.store.import_files import import_files
from foon_asp.store.store import Store
from foon_asp.text.data_folder import DataFiles, find_data, read_data
from foon_asp.text.diagnostics import InputError
from foon_asp.text.unit_price_list import read_unit_prices
from tests.conftest import Cli
from tests.test_objectives import made_up
from tests.test_store import write_soup

pytestmark = pytest.mark.filterwarnings("ignore:no kitchen is given")

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


def test_without_any_price_none_are_known() -> None:
    problem = foon_asp.load().problem("ice; cubed; in [drinking glass]")
    assert (problem.unit_prices, foon_asp.load().unit_prices) == (None, None)
    assert set(problem.prices) == {None}


def test_a_price_of_a_unit_that_is_not_there_is_a_warning(folder: Path, cli: Cli) -> None:
    write_lines(folder / "unit_prices.txt", "mix\ta\t->\td\t1")
    said = f"{folder / 'unit_prices.txt'}:1:1: warning: the unit 'mix: a → d' is not in the network"
    with pytest.warns(foon_asp.FoonWarning, match="is not in the network"):
        assert foon_asp.load(folder).warnings == (said,)
    ran = cli("solve", "--data", str(folder), "--goal", "d;")
    assert (ran.code, ran.err.startswith(said)) == (0, True)
    store = folder / "net.foon"
    assert said in cli("import", "--data", str(folder), "--store", str(store)).err
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


def test_a_price_of_null_is_none(tmp_path: Path) -> None:
    file = tmp_path / "net.json"
    file.write_text(json.dumps([{**listed("mix", "a", "b"), "price": None}]))
    assert read_data(DataFiles((file,))).unit_prices is None


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
        ["solve", *network, "--goal", "b;"],
        ["solve", *network, "--goal", "b;", "--unit-prices", str(motion)],
        ["merge", *files],
        ["import", *files, "--store", str(tmp_path / "x.foon")],
    ):
        ran = cli(*words)
        assert (ran.code, said in ran.err, ran.out) == (2, True, ""), ran.err
    assert not (tmp_path / "x.foon").exists()
    chosen = write_lines(tmp_path / "chosen.txt", "mix\ta\t->\tb\t2")
    for words in (
        ["merge", *files, "--unit-prices", str(chosen)],
        ["import", *files, "--store", str(tmp_path / "x.foon"), "--unit-prices", str(chosen)],
    ):
        assert cli(*words).code == 0
    assert shown(foon_asp.load(tmp_path / "x.foon").problem("b;")) == ["2", None]
    kept = foon_asp.load(tmp_path / "x.foon", unit_prices=motion).problem("b;")
    assert shown(kept) == ["2", None]
    assert shown(foon_asp.load(files, unit_prices=chosen).problem("b;")) == ["2", None]


def test_merging_says_that_prices_are_lost(tmp_path: Path, cli: Cli) -> None:
    file = write(
        tmp_path / "net.json", listed("mix", "a", "b", 1), listed("mix", "b", "c", 1), listed("go", "a", "d")
    )
    ran = cli("merge", str(file))
    assert "2  prices of units, which are not in the result" in ran.err
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


def same_prices(store: Path, files: DataFiles, unit_prices: Path | None, goals_apart: int = 1) -> None:
    """Hold what a store gives against what the text gives: of all of it, and of some goals."""
    text = read_data(files._replace(unit_prices=unit_prices or files.unit_prices))
    network = text.network
    known = None if text.unit_prices is None else text.unit_prices.each(network)
    with foon_asp.load(store, unit_prices=unit_prices) as foon:
        assert (foon.unit_prices is None) == (known is None)
        if foon.unit_prices is not None:
            assert foon.unit_prices.each(foon.network) == known
        digest = digests(network, (), None, (), text.unit_prices)["prices"]
        assert digests(foon.network, (), None, (), foon.unit_prices)["prices"] == digest
        lacking = foon_asp.Foon.of(whole(network, text.unit_prices)).dataset.unpriced()
        assert list(foon.dataset.unpriced()) == list(lacking)
        for goal in network.objects[::goals_apart]:
            problem = foon.problem(goal)
            numbers = [problem.network.unit_number(u) for u in range(len(problem.network))]
            assert problem.prices == tuple(None if known is None else known[n] for n in numbers)
            if problem.network.object_numbers:
                assert list(problem.unpriced) == list(lacking)


def whole(network: Network, prices: UnitPrices | None) -> Problem:
    return Problem(network, frozenset(), (0,), None, frozenset(), unit_prices=prices)


def test_a_store_has_the_prices_of_its_files(folder: Path, tmp_path: Path) -> None:
    files = find_data(folder)
    other = write_lines(tmp_path / "other.txt", "go\t1", "mix\ta\t->\tb\t0", "mix\tc\t->\td\t4")
    without = files._replace(unit_prices=None)
    for imported in (files, without):
        import_files(imported, tmp_path / "net.foon")
        same_prices(tmp_path / "net.foon", imported, None)
        same_prices(tmp_path / "net.foon", imported, other)
    assert foon_asp.load(folder, level=1).problem("d").unit_prices is not None


def test_stores_of_networks_at_random_have_the_prices_of_the_text(tmp_path: Path) -> None:
    """Units over several blocks, with copies, and prices of all kinds."""
    for seed in range(4):
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
        import_files(data, tmp_path / "net.foon")
        same_prices(tmp_path / "net.foon", data, None, goals_apart=20)
        same_prices(tmp_path / "net.foon", data, prices, goals_apart=20)


def test_a_store_of_before_there_were_prices_is_refused(tmp_path: Path, cli: Cli) -> None:
    import_files(
        DataFiles((write(tmp_path / "net.json", listed("mix", "a", "b", 1)),)), tmp_path / "net.foon"
    )
    content = bytearray((tmp_path / "net.foon").read_bytes())
    content[60:64] = (1).to_bytes(4)
    (tmp_path / "net.foon").write_bytes(content)
    ran = cli("solve", "--network", str(tmp_path / "net.foon"), "--goal", "b")
    assert ran.code == 2
    assert "has version 1 of the store format" in ran.err
    assert f"this foon-asp reads version {VERSION}: import its source files again" in ran.err


def test_a_store_without_prices_has_none(tmp_path: Path) -> None:
    files = write_soup(tmp_path / "soup")
    import_files(files, tmp_path / "soup.foon")
    same_prices(tmp_path / "soup.foon", files, None)
    with Store(tmp_path / "soup.foon") as store:
        assert (store.motion_prices, store.has_unit_prices) == (None, False)


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
    prices = UnitPrices({}, {FunctionalUnit("mix", (A,), (B_RED,)): Fraction(3)})
    merged = problem.network.unit(0)
    assert prices.price(merged, problem.network) is None
    assert prices.price(FunctionalUnit("mix", (A,), (B_RED,))) == 3


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


def test_build_takes_prices() -> None:
    network = foon_asp.load().network
    some = network.unit(3)
    foon = foon_asp.build(network, unit_prices={network.motions[0]: 1, some: "2.50"})
    assert foon.unit_prices == UnitPrices({network.motions[0]: Fraction(1)}, {some: Fraction(5, 2)})


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


WHOLE = made_up(Row("dear", "price", lambda unit: int(unit.price), needs=Known.PRICES, is_fact=True))


def test_a_missing_price_is_an_error_only_where_prices_are_asked_for(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = foon_asp.load(folder).problem("d;")
    assert solve(problem, (Objective.UNITS,)).units is not None
    with pytest.raises(UserError) as caught:
        solve(problem, (WHOLE,))
    assert str(caught.value).startswith(
        f"{folder / 'net.json'}:1:1: error: the unit 'go' has no price\nadd a line"
    )
    none = replace(problem, unit_prices=None)
    with pytest.raises(UserError, match="the objective dear needs the prices of the units: give a file"):
        solve(none, (WHOLE,))
    monkeypatch.setattr("foon_asp.problem.costs._MEASURED", (*Objective, WHOLE))
    assert solve(problem.vary(unit_prices={"go": 1}), (WHOLE,)).units == (3,)
    units = [listed(f"go {number}", "a", str(number)) for number in range(12)]
    file = write(folder / "many.json", *units, listed("go 0", "b", "c"), listed("mix", "a", "b", 1))
    with pytest.raises(UserError) as caught:
        solve(foon_asp.load(file, kitchen=folder / "kitchen.json").problem("11"), (WHOLE,))
    first, *_, more, advice = str(caught.value).split("\n")
    assert first.endswith("error: the unit 'go 0' has no price, nor have 1 more with this motion")
    assert more == "... and units of 2 more motions"
    assert advice.startswith("add a line with the motion, a tab and its price to the file of prices")


def test_a_session_does_not_answer_by_the_prices_of_before(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Asked again with other prices, what is kept says what was so before: it is not to be used."""
    monkeypatch.setattr("foon_asp.problem.costs._MEASURED", (*Objective, WHOLE))
    session = Session()
    problem = foon_asp.load(folder).problem("c;").vary(unit_prices={"go": 5})
    rule = write_lines(folder / "any.lp", ':- use(U), motion(U,"fry").')
    for price, units in ((5, (0, 1)), (1, (4,)), (20, (0, 1)), (2, (4,))):
        asked = problem.vary(unit_prices={"go": price, "mix": 3})
        alone, within = (
            solve(asked, (WHOLE,), Settings(constraints=(rule,), session=kept)) for kept in (session, None)
        )
        assert alone.costs == within.costs
        assert alone.units == within.units == units


def test_results_of_a_comparison_are_of_these_prices(folder: Path) -> None:
    problem = foon_asp.load(folder).problem("d;")
    settings = SearchSettings()
    before = results_question(problem, [*SEARCHES.values()][:1], settings)
    assert results_question(foon_asp.load(folder).problem("d;"), [*SEARCHES.values()][:1], settings) == before
    assert results_question(problem.vary(unit_prices={"go": 1}), [*SEARCHES.values()][:1], settings) != before
    assert results_question(replace(problem, unit_prices=None), [*SEARCHES.values()][:1], settings) != before


def test_the_shell_and_every_question_take_the_file(folder: Path, cli: Cli) -> None:
    file = str(folder / "unit_prices.txt")
    assert (
        cli("solve", "--network", str(folder / "net.json"), "--unit-prices", file, "--goal", "a;").code == 0
    )
    for verb in ("solve", "pareto", "batch", "facts", "shell", "import", "stats", "verify", "draw"):
        assert "--unit-prices FILE" in " ".join(cli(verb, "--help").out.split()), verb
    missing = cli("solve", "--unit-prices", str(folder / "nothing.txt"), "--goal", "ice")
    assert (missing.code, "nothing.txt: no such file" in missing.err) == (2, True)
    read_unit_prices(folder / "unit_prices.txt")
