"""The store: what comes out is what went in, a question reads its cone, and damage is said in words."""

import contextlib
import json
import os
import random
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from itertools import count
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.asp import Settings, solve
from foon_asp.asp.bare_program import bare_program
from foon_asp.dataset.reading_store import read_store
from foon_asp.errors import UserError
from foon_asp.network import Network, starting_nodes
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.proof.certificate_subject import Subject
from foon_asp.store import builder, digests, store_tables
from foon_asp.store.digests import FILE_DIGEST, append_digest
from foon_asp.store.import_files import import_files
from foon_asp.store.store import Store
from foon_asp.store.store_tables import VERSION
from foon_asp.store.stored_ids import StoredIds
from foon_asp.store.stored_kitchen import StoredStartingKitchen
from foon_asp.store.tuning import StoreTuning
from foon_asp.text.data_folder import Data, DataFiles, find_data, read_data
from foon_asp.text.diagnostics import InputError
from foon_asp.text.foon_text import FoonText
from foon_asp.text.node_lookup import find_goal
from foon_asp.text.writer import write_units
from tests.conftest import ROOT, Cli, Ran
from tests.support.random_problems import random_problem

KITCHEN = ROOT / "data" / "kitchen"

SOUP = """\
# Source:\thttps://example.org/soup
O\tleek
S\twhole
O\tknife
M\tchop
O\tleek
S\tchopped
S\ton\t[board]
//
O\tleek
S\tchopped
S\ton\t[board]
O\tpot
S\tcontains\t{water,salt}
M\tadd
O\tsoup
S\traw
S\tin\t[pot]
//
O\tsoup
S\traw
S\tin\t[pot]
M\tcook
O\tsoup
S\tcooked
S\tin\t[pot]
//
"""
# The first unit again, with another video and the inputs the other way round; then a unit that is new.
MORE = """\
# Source:\thttps://example.org/more
# Source:\thttps://example.org/still-more
O\tknife
O\tleek
S\twhole
M\tchop
O\tleek
S\tchopped
S\ton\t[board]
//
O\tsoup
S\tcooked
S\tin\t[pot]
M\teat
O\tpot
//
"""
ENTRIES = [
    {"label": "leek", "states": ["whole"], "ingredients": [], "container": None},
    {"label": "knife", "states": [], "ingredients": [], "container": None},
    {"label": "pot", "states": [], "ingredients": ["salt", "water"], "container": None},
]
SOUP_NODE = "soup; cooked; in [pot]"


def write_soup(folder: Path) -> DataFiles:
    folder.mkdir(exist_ok=True)
    (folder / "a.txt").write_text(SOUP, encoding="utf-8")
    (folder / "b.txt").write_text(MORE, encoding="utf-8")
    (folder / "kitchen.json").write_text(json.dumps(ENTRIES), encoding="utf-8")
    (folder / "motion.txt").write_text("chop\t0.9\nadd\t0.5\ncook\t1\neat\t0.25\n", encoding="utf-8")
    (folder / "utensils.txt").write_text("knife\npot\n", encoding="utf-8")
    goals = [{"label": "soup", "states": ["cooked"], "ingredients": [], "container": "pot"}]
    (folder / "goal_nodes.json").write_text(json.dumps(goals), encoding="utf-8")
    return find_data(folder)


@pytest.fixture
def soup(tmp_path: Path) -> tuple[DataFiles, Path]:
    """Return the files of a small network, and a store made of them."""
    files = write_soup(tmp_path / "soup")
    import_files(files, tmp_path / "soup.foon")
    return files, tmp_path / "soup.foon"


@pytest.fixture(scope="module")
def kitchen_store(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a store of the bundled kitchen."""
    store = tmp_path_factory.mktemp("store") / "kitchen.foon"
    import_files(find_data(KITCHEN), store)
    return store


def same_network(one: Network, other: Network) -> bool:
    return (one.objects, one.motions, one.inputs, one.outputs, one.sources) == (
        other.objects,
        other.motions,
        other.inputs,
        other.outputs,
        other.sources,
    )


def assert_holds(store: Path, data: Data) -> None:
    """Hold everything in a store against what was read from the files."""
    opened = Store(store)
    network, kitchen = opened.read_whole()
    assert same_network(network, data.network)
    assert kitchen == (frozenset() if data.starting else data.kitchen)
    assert opened.goals_from == data.goals_from
    starting = {o for o in range(opened.object_count) if opened.is_starting(o)}
    assert starting == starting_nodes(network)
    assert opened.kitchen_items() == data.kitchen_items
    assert opened.goals == data.goals
    assert opened.rates == data.rates
    assert opened.utensils == data.utensils
    assert (opened.unit_count, opened.object_count) == (len(data.network), len(data.network.objects))
    stated = Subject(network, kitchen, data.rates, data.utensils, data.unit_prices).digests()
    assert opened.digests == {name: stated[name] for name in opened.digests}
    for unit in range(len(network)):
        assert network.unit_id(network.unit(unit)) == unit
        assert opened.unit_id(network.unit(unit)) == unit
    for o, node in enumerate(network.objects):
        assert opened.object_id(node) == network.object_id(node) == o
        assert opened.in_kitchen(o) == (o in kitchen)


def cone_problem(store: Path, problem: Problem, own_kitchen: bool) -> Problem:
    """Ask the same of the store: with the kitchen that is in it, or with one given by id."""
    opened = Store(store)
    at_hand = StoredIds(opened, "kitchen") if own_kitchen else problem.kitchen
    part = opened.read_part(
        opened.cone(problem.goals, problem.containers, problem.utensils, at_hand).units, problem.goals
    )
    numbers = part.object_numbers
    kitchen = frozenset(place for place, o in enumerate(numbers) if o in problem.kitchen)
    goals = tuple(numbers.index(goal) for goal in problem.goals)
    return Problem(part, kitchen, goals, problem.rates, problem.utensils, problem.containers)


def import_problem(problem: Problem, folder: Path) -> Path:
    """Write the network and the kitchen of a problem and import them."""
    network = problem.network
    (folder / "FOON.txt").write_text(
        write_units(network.unit(unit) for unit in range(len(network))), encoding="utf-8"
    )
    blocks = []
    for o in sorted(problem.kitchen):
        node = network.objects[o]
        lines = [f"O\t{node.label}", *(f"S\t{state}" for state in sorted(node.states))]
        lines += [f"S\t{word}\t[{related}]" for word, related in sorted(node.relations)]
        lines += [f"S\t{word}\t{{{','.join(items)}}}" for word, items in node.contents]
        blocks.append("\n".join(lines) + "\n")
    (folder / "kitchen.txt").write_text("".join(blocks), encoding="utf-8")
    store = folder / "network.foon"
    import_files(DataFiles((folder / "FOON.txt",), kitchen=folder / "kitchen.txt"), store)
    return store


def test_a_store_holds_what_the_files_do(soup: tuple[DataFiles, Path]) -> None:
    files, store = soup
    data = read_data(files)
    assert len(data.network) == 4
    assert_holds(store, data)


def test_the_bundled_kitchen(kitchen_store: Path) -> None:
    assert_holds(kitchen_store, read_data(find_data(KITCHEN)))


def test_copies_keep_their_places_and_videos(soup: tuple[DataFiles, Path]) -> None:
    files, store = soup
    network, _ = Store(store).read_whole()
    first, second = network.sources[0]
    assert (first.file, first.line, first.videos) == (
        str(files.network[0]),
        2,
        ("https://example.org/soup",),
    )
    assert (second.file, second.line, second.videos) == (
        str(files.network[1]),
        3,
        ("https://example.org/more", "https://example.org/still-more"),
    )


def test_copies_that_come_much_later(tmp_path: Path) -> None:
    unit = "O\tpan\nS\t{}\nM\theat\nO\tpan\nS\t{}\nS\thot\n//\n"
    once = "".join(unit.format(f"n{i}", f"n{i}") for i in range(800))
    files = DataFiles(tuple(tmp_path / f"{number}.txt" for number in range(4)))
    for file in files.network:
        file.write_text(once, encoding="utf-8")
    imported = import_files(files, tmp_path / "many.foon")
    assert (imported.copies, imported.units) == (3200, 800)
    assert_holds(tmp_path / "many.foon", read_data(files))


def test_an_import_that_remembers_little(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stores = [tmp_path / "one.foon", tmp_path / "other.foon"]
    import_files(find_data(KITCHEN), stores[0])
    monkeypatch.setattr(builder, "STORE", StoreTuning(rows_per_write=3, cached_nodes=3))
    monkeypatch.setattr(digests, "STORE", StoreTuning(digest_texts=3))
    monkeypatch.setattr(FoonText, "piece_letters", 50)
    import_files(find_data(KITCHEN), stores[1])
    assert_holds(stores[1], read_data(find_data(KITCHEN)))
    assert content(stores[0]) == content(stores[1])


def content(store: Path) -> list[object]:
    """Return all rows of a database."""
    with contextlib.closing(sqlite3.connect(store)) as database:
        tables = database.execute("SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY name")
        return [
            sorted(database.execute(f"SELECT * FROM {table}"), key=repr) for (table,) in tables.fetchall()
        ]


@pytest.mark.parametrize("listed", [False, True])
def test_prices_have_the_digest_that_certificates_name(tmp_path: Path, listed: bool) -> None:
    network, prices = tmp_path / "tasks.jsonl", tmp_path / "prices.txt"
    units = [("go", 'a"b', "c", 3), ("go", "c", "d", "0.5"), ("stay", "é", "a", None), ("go", "d", "a", 1)]
    network.write_text(
        "".join(
            json.dumps(
                {"id": name, "inputs": [need], "outputs": [give]} | ({"price": price} if price else {})
            )
            + "\n"
            for name, need, give, price in units
        ),
        encoding="utf-8",
    )
    prices.write_text("stay\t7\n", encoding="utf-8")
    files = DataFiles((network,), unit_prices=prices if listed else None)
    import_files(files, tmp_path / "tasks.foon")
    data = read_data(files)
    assert_holds(tmp_path / "tasks.foon", data)
    with contextlib.closing(read_store(DataFiles((tmp_path / "tasks.foon",)), 3)) as stored:
        assert stored.unit_prices == data.unit_prices


def test_units_without_outputs_and_names_of_any_letters(tmp_path: Path) -> None:
    file = tmp_path / "odd.txt"
    file.write_text(
        'O\tсуп\nS\tнесвежий\nM\tвылить\n//\nO\t鍋 "x" \\\nS\tin\t[🥣]\nM\tmix\nO\tcrème\n//\n',
        encoding="utf-8",
    )
    store = tmp_path / "odd.foon"
    import_files(DataFiles((file,)), store)
    assert_holds(store, read_data(DataFiles((file,))))


def test_a_network_without_units(tmp_path: Path) -> None:
    file = tmp_path / "empty.txt"
    file.write_text("# nothing\n", encoding="utf-8")
    import_files(DataFiles((file,)), tmp_path / "empty.foon")
    assert_holds(tmp_path / "empty.foon", read_data(DataFiles((file,))))
    with pytest.raises(UserError, match="no object node has the label 'soup'"):
        find_goal("soup", Store(tmp_path / "empty.foon"))


@pytest.mark.slow
@pytest.mark.parametrize("rule", list(ContainerRule))
def test_the_cone_has_the_optimum_of_the_whole(rule: ContainerRule, tmp_path: Path) -> None:
    smaller = 0
    for seed in range(30):
        problem = replace(random_problem(seed, rule, units=10, readable=True), unit_prices=None)
        store = import_problem(problem, tmp_path)
        network, kitchen = Store(store).read_whole()
        assert (network.objects, network.inputs, network.outputs) == (
            problem.network.objects,
            problem.network.inputs,
            problem.network.outputs,
        )
        assert kitchen == problem.kitchen
        for own_kitchen in (True, False):
            part = cone_problem(store, problem, own_kitchen)
            smaller += len(part.network) < len(network)
            for objectives in ([Objective.UNITS], [Objective.SUCCESS], [Objective.KITCHEN, Objective.INPUTS]):
                # The same text goes to clingo, ids and all, so that everything that follows is the same.
                settings = Settings()
                assert (
                    bare_program(part, objectives, settings, {}).facts
                    == bare_program(problem, objectives, settings, {}).facts
                )
                found, expected = solve(part, objectives), solve(problem, objectives)
                assert (found.status, found.costs) == (expected.status, expected.costs), seed
                if expected.units is not None and found.units is not None:
                    numbers = tuple(map(part.network.unit_number, found.units))
                    assert numbers == expected.units
    assert smaller > 15  # the cone is a part, or this would say nothing


def test_a_question_reads_what_it_is_about(tmp_path: Path, opened: list[sqlite3.Connection]) -> None:
    """The same recipe among ten and among a thousand others takes as many steps of the database."""
    steps = []
    for others in (10, 1000):
        stews = (SOUP.replace("soup", f"stew {n}").replace("leek", f"herb {n}") for n in range(others))
        file, kitchen = tmp_path / f"{others}.txt", tmp_path / "kitchen.json"
        file.write_text("".join([SOUP, *stews]), encoding="utf-8")
        kitchen.write_text(json.dumps(ENTRIES), encoding="utf-8")
        store = tmp_path / f"{others}.foon"
        import_files(DataFiles((file,), kitchen), store)
        with contextlib.closing(Store(store)) as asked:
            taken = steps_from_now(opened[-1])
            goal = find_goal(SOUP_NODE, asked)
            assert (
                len(
                    asked.read_part(
                        asked.cone(
                            [goal], ContainerRule.STRICT, frozenset(), StoredIds(asked, "kitchen")
                        ).units
                    )
                )
                == 3
            )
        steps.append(next(taken))
    assert 10 < steps[1] < 1.2 * steps[0]


def steps_from_now(connection: sqlite3.Connection) -> Iterator[int]:
    """Count the steps that a database takes; the next number is how many it took."""
    taken = count()
    connection.set_progress_handler(lambda: next(taken) < 0, 1)
    return taken


def message(name: str, names: Any, listed: Any = ()) -> str:
    with pytest.raises(UserError) as raised:
        find_goal(name, names, listed)
    return str(raised.value)


@pytest.mark.parametrize(
    "name",
    ["bowl", "onio", "onoin", "macaronni", "greek salat", "bowl; broken", "xyzzy", "o", "", "; ;"],
)
def test_goals_are_not_found_in_the_same_words(kitchen_store: Path, name: str) -> None:
    network = read_data(find_data(KITCHEN)).network
    assert message(name, Store(kitchen_store)) == message(name, network)


def test_similar_names_are_found_where_sqlite_has_no_trigrams(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(store_tables, "TRIGRAMS", "CREATE VIRTUAL TABLE label_trigram USING nothing(name)")
    import_files(find_data(KITCHEN), tmp_path / "kitchen.foon")
    network = read_data(find_data(KITCHEN)).network
    for name in ("onoin", "greek salat", "xyzzy"):
        assert message(name, Store(tmp_path / "kitchen.foon")) == message(name, network)


def test_goals_are_found(kitchen_store: Path) -> None:
    data = read_data(find_data(KITCHEN))
    store = Store(kitchen_store)
    for node in data.network.objects:
        assert find_goal(f"{node};", store) == data.network.object_id(node)
    for entry in data.goals:
        label = entry.pattern.label
        assert find_goal(label, store, store.goals) == find_goal(label, data.network, data.goals)
    for item in data.kitchen_items:
        assert tuple(store.find(item.pattern)) == data.network.find(item.pattern)


def test_a_label_that_begins_so_is_a_candidate(soup: tuple[DataFiles, Path]) -> None:
    files, store = soup
    expected = "no object node has the label 'so'; similar are\n  --goal 'soup; raw; in [pot]'\n"
    assert message("so", Store(store)).startswith(expected)
    assert message("so", read_data(files).network).startswith(expected)


# What a question prints, from the store as from the text.

QUESTIONS = (
    ("solve", "--goal", "greek salad", "--objective", "success", "--containers", "implied"),
    ("solve", "--goal", "greek salad", "--goal", "ice", "--format", "foon"),
    ("solve", "--goal", "macaroni", "--level", "2"),
    ("solve", "--goal", "ice", "--constraint", "forbid_motion", "-c", "forbidden_motion=crush"),
    ("solve", "--goal", "bowl"),
    ("facts", "--goal", "macaroni"),
    ("compare", "--search", "bfs", "--trees", "--goal", "macaroni", "--containers", "implied"),
    ("solve", "--all-goals", "--goal", "ice", "--objective", "inputs,success", "--format", "json"),
    ("compare", "--goal", "macaroni", "--goal", "ice", "--format", "csv"),
    pytest.param(("compare", "--all-makeable", "--search", "bfs"), marks=pytest.mark.slow),
    ("view", "--unit", "7", "--unit", "3", "--format", "dot"),
    ("view", "--unit", "999999", "--format", "dot"),
    ("view", "--format", "graphml"),
    ("stats",),
    ("solve", "--goal", "ice", "--objective", "success", "--level", "2", "--certificate", "/dev/null"),
)


def without_times(text: str) -> Any:
    """Return what was printed, as values where it is JSON, without what differs from run to run."""
    try:
        return dropped(json.loads(text))
    except json.JSONDecodeError:
        return text


def dropped(value: Any) -> Any:
    if isinstance(value, list):
        return [dropped(part) for part in value]
    if isinstance(value, dict):
        return {key: dropped(part) for key, part in value.items() if key != "seconds"}
    return value


@pytest.mark.parametrize("words", QUESTIONS, ids=" ".join)
@pytest.mark.default_cases(
    "solve --goal ice --constraint forbid_motion -c forbidden_motion=crush",
    "solve --goal macaroni --level 2",
    "solve --all-goals --goal ice --objective inputs,success --format json",
    "solve --goal greek salad --goal ice --format foon",
    "compare --search bfs --trees --goal macaroni --containers implied",
    "view --unit 7 --unit 3 --format dot",
    "facts --goal macaroni",
)
def test_answers_are_those_from_text(cli: Cli, kitchen_store: Path, words: tuple[str, ...]) -> None:
    from_text = cli(*words, "--data", KITCHEN)
    from_store = cli(*words, "--network", kitchen_store)
    assert from_store.code == from_text.code
    assert without_times(from_store.out) == without_times(from_text.out)
    assert from_store.err == from_text.err


def test_json_answers_have_the_ids_of_the_whole_network(cli: Cli, kitchen_store: Path) -> None:
    words = ("solve", "--goal", "greek salad", "--format", "json")
    from_text, from_store = cli(*words, "--data", KITCHEN).json, cli(*words, "--network", kitchen_store).json
    for answer in (from_text, from_store):
        assert answer.pop("seconds")["read"] > 0
    assert from_store == from_text
    assert max(unit["id"] for unit in from_store["units"]) > len(from_store["units"])


def test_proofs_speak_about_the_whole_network(cli: Cli, kitchen_store: Path, tmp_path: Path) -> None:
    proofs = tmp_path / "text.json", tmp_path / "store.json"
    for proof, words in zip(proofs, (("--data", KITCHEN), ("--network", kitchen_store)), strict=True):
        assert cli("solve", "--goal", "macaroni", "--certificate", proof, *words).code == 0
    for proof in proofs:
        said = cli("verify", proof)
        assert said.out.startswith("goal: macaroni; cooked")
        assert cli("verify", proof, "--network", kitchen_store, "--full") == said
        here = cli("verify", proof, "--network", kitchen_store)
        trusted = "the digests of kitchen, network and prices that the store states (--full computes them)"
        assert here.out == said.out.replace("\nproof:", f"\ntaken on trust: {trusted}\nproof:")
        assert here.code == said.code == 0
    tree = tmp_path / "tree.txt"
    tree.write_text(cli("solve", "--goal", "macaroni", "--format", "foon").out, encoding="utf-8")
    given = ("check", tree, "--goal", "macaroni", "--certificate", tmp_path / "tree.json")
    assert cli(*given, "--network", kitchen_store) == cli(*given, "--data", KITCHEN)


@pytest.mark.parametrize("name", ["network", "kitchen", "prices"])
def test_a_digest_that_is_not_true_is_trusted_and_found(
    name: str, cli: Cli, soup: tuple[DataFiles, Path], tmp_path: Path
) -> None:
    files, store = soup
    proof, asked = tmp_path / "proof.json", ("--network", store)
    assert cli("solve", "--goal", SOUP_NODE, "--certificate", proof, *asked).code == 0
    with contextlib.closing(Store(store)) as opened:
        digests = opened.digests
    stated = json.dumps({**digests, name: "0" * 64})
    forged(store, "UPDATE about SET value = ? WHERE name = 'digests'", stated)
    refused = cli("verify", proof, *asked)
    assert refused.code == 2
    assert f"is about other data ({name}: not the one that the certificate is about)" in refused.err
    assert cli("solve", "--goal", SOUP_NODE, "--certificate", proof, *asked).code == 0
    assert "taken on trust" in cli("verify", proof, *asked).out
    assert cli("verify", proof, "--data", files.network[0].parent).code == 2  # the text is not what it names
    full = cli("verify", proof, *asked, "--full")
    assert full.code == 2
    assert f"the digest of the {name} that the store states is not that of what is in it" in full.err


@pytest.mark.parametrize(
    "words",
    [
        ("--kitchen", "kitchen.txt"),
        ("--kitchen", "@starting"),
        ("--unit-prices", "prices.txt"),
        ("--rates", "rates.txt"),
    ],
)
def test_what_is_given_beside_a_store_is_digested(
    words: tuple[str, str], cli: Cli, soup: tuple[DataFiles, Path], tmp_path: Path
) -> None:
    files, store = soup
    (tmp_path / "kitchen.txt").write_text("O\tleek\nS\twhole\nO\tknife\n", encoding="utf-8")
    (tmp_path / "prices.txt").write_text("chop\t1\nadd\t2\ncook\t3\neat\t4\n", encoding="utf-8")
    (tmp_path / "rates.txt").write_text("chop\t0.5\nadd\t0.5\ncook\t1\neat\t1\n", encoding="utf-8")
    option, file = words
    beside = (option, file if file[0] == "@" else tmp_path / file)
    proof = tmp_path / "proof.json"
    made = cli("solve", "--goal", SOUP_NODE, "--certificate", proof, "--network", store, *beside)
    assert made.code in {0, 1}, made.err  # without pots there is no tree
    for more in ((), ("--full",)):
        assert cli("verify", proof, "--network", store, *beside, *more).code == 0
    assert cli("verify", proof, "--data", files.network[0].parent, *beside).code == 0
    # of this network, what no unit makes is the kitchen that was imported
    assert (cli("verify", proof, "--network", store).code == 0) is (file == "@starting")


@pytest.mark.parametrize("verb", ["lint", "fmt", "convert", "merge"])
def test_what_is_about_text_refuses_a_store(cli: Cli, kitchen_store: Path, tmp_path: Path, verb: str) -> None:
    words = {"convert": ("--to", "json"), "merge": ("-o", tmp_path / "merged.txt")}
    ran = cli(verb, kitchen_store, *words.get(verb, ()))
    assert ran.code == 2
    assert "is a store, expected text" in ran.err


def test_a_tree_is_checked_and_drawn(cli: Cli, kitchen_store: Path, tmp_path: Path) -> None:
    tree = tmp_path / "tree.txt"
    tree.write_text(cli("solve", "--goal", "macaroni", "--format", "foon").out, encoding="utf-8")
    strange = tmp_path / "strange.txt"
    strange.write_text(tree.read_text(encoding="utf-8") + MORE, encoding="utf-8")
    for file in (tree, strange):
        for words in (["check", file], ["view", "--tree", file, "--format", "dot"]):
            asked = (*words, "--goal", "macaroni")
            from_text, from_store = cli(*asked, "--data", KITCHEN), cli(*asked, "--network", kitchen_store)
            assert from_store == from_text
    assert cli("check", strange, "--goal", "macaroni", "--network", kitchen_store).code == 1


def test_what_is_named_beside_the_store_replaces_what_is_in_it(
    cli: Cli, soup: tuple[DataFiles, Path], tmp_path: Path
) -> None:
    _, store = soup
    words = ("solve", "--network", store, "--goal", SOUP_NODE, "--format", "json")
    assert cli(*words).json["costs"]["units"] == 3
    kitchen = tmp_path / "other.json"
    raw = {"label": "soup", "states": ["raw"], "ingredients": [], "container": "pot"}
    kitchen.write_text(json.dumps([raw, {"label": "spoon"}]), encoding="utf-8")
    rates = tmp_path / "rates.txt"
    rates.write_text("chop\t1\nadd\t1\ncook\t0.75\neat\t1\n", encoding="utf-8")
    ran = cli(*words, "--kitchen", kitchen, "--rates", rates)
    assert ran.json["costs"]["units"] == 1
    assert ran.json["costs"]["success"]["exact"] == "3/4"
    assert "'spoon' matches no object node of the network" in ran.err
    rates.write_text("cook\t0.75\n", encoding="utf-8")
    ran = cli(*words, "--rates", rates)
    assert ran.json["costs"]["success"] is None
    assert "no success is known, since the rates file has no rate for 'chop', 'add', 'eat'" in ran.err
    # motions that this goal does not need count too, as from text
    ran = cli(*words, "--rates", rates, "--objective", "success")
    assert ran.code == 2
    assert "b.txt:11:1: error: the motion 'eat' has no success rate" in ran.err


def test_a_store_without_a_kitchen(cli: Cli, soup: tuple[DataFiles, Path], tmp_path: Path) -> None:
    files, _ = soup
    store = tmp_path / "bare.foon"
    ran = cli("merge", *files.network, "--store", store)
    assert ran.code == 0
    assert ran.out.startswith(f"{store}: 4 units of 5 read, 7 object nodes\n")
    ran = cli("solve", "--network", store, "--goal", SOUP_NODE)
    assert ran.code == 0
    assert "No kitchen given" in ran.err
    ran = cli("solve", "--network", store, "--goal", SOUP_NODE, "--kitchen", files.kitchen or "")
    assert ran.code == 0


@pytest.mark.parametrize(
    "changes",
    [{"kitchen": ["leek; whole", "knife"]}, {"without": "knife"}, {"adding": "soup; raw; in [pot]"}],
)
def test_another_kitchen_than_the_starting_one(
    soup: tuple[DataFiles, Path], tmp_path: Path, changes: dict[str, Any]
) -> None:
    """What is assumed to be at hand gives way to what is named, in a store as in text."""
    files, _ = soup
    store = tmp_path / "bare.foon"
    import_files(DataFiles(files.network), store)
    loaded = [foon_asp.load(network, kitchen="@starting") for network in ([*files.network], store)]
    for goal in (SOUP_NODE, "pot"):
        text, part = (foon_asp.solve(foon.vary(**changes).problem(goal)) for foon in loaded)
        assert dropped(part.json()) == dropped(text.json())


def test_a_store_is_read_by_itself(cli: Cli, soup: tuple[DataFiles, Path]) -> None:
    files, store = soup
    ran = cli("solve", "--network", store, "--network", files.network[0], "--goal", "soup")
    assert ran.code == 2
    assert "a store is read alone" in ran.err
    for name, words in (
        (store, "is read by this command"),
        (store.with_name("new.foon"), "is a store already"),
    ):
        ran = cli("merge", store, files.network[0], "--store", name)
        assert (ran.code, words in ran.err) == (2, True)
    ran = cli("fmt", store)
    assert ran.code == 2
    assert "is a store, expected text" in ran.err
    assert_holds(store, read_data(files))


def test_bad_names(cli: Cli, soup: tuple[DataFiles, Path], tmp_path: Path) -> None:
    files, _ = soup
    assert "ends in .foon" in cli("merge", files.network[0], "--store", tmp_path / "x.db").err
    taken = tmp_path / "notes.foon"
    taken.write_text("my notes", encoding="utf-8")
    ran = cli("merge", files.network[0], "--store", taken)
    assert ran.code == 2
    assert "another file has this name" in ran.err
    assert taken.read_text(encoding="utf-8") == "my notes"
    assert cli("merge", files.network[0], "--store", tmp_path / "no" / "x.foon").code == 2
    assert cli("merge", "--store", tmp_path / "x.foon").code == 2
    assert cli("solve", "--network", tmp_path / "none.foon", "--goal", "x").code == 2


DIRTY = SOUP + "O\tsalt\nX nonsense\nM\tshake\nO\tsalt\nS\tshaken\n//\n"


def test_dirty_files(cli: Cli, soup: tuple[DataFiles, Path], tmp_path: Path) -> None:
    _, store = soup
    before = store.read_bytes()
    dirty = tmp_path / "dirty.txt"
    dirty.write_text(DIRTY, encoding="utf-8")
    ran = cli("merge", dirty, "--store", store)
    assert ran.code == 2
    assert "dirty.txt:29:1: error:" in ran.err
    assert store.read_bytes() == before
    ran = cli("merge", dirty, "--store", store, "--lenient")
    assert ran.code == 0
    assert "1 line left out" in ran.out
    with pytest.raises(InputError):
        import_files(DataFiles((dirty,)), tmp_path / "new.foon")
    assert not (tmp_path / "new.foon").exists()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["dirty.txt", "soup", "soup.foon"]
    assert_holds(store, read_data(DataFiles((dirty,)), lenient=True))
    ran = cli("solve", "--network", store, "--goal", "salt; shaken")
    assert "1 line left out when the store was made" in ran.err


def test_rates_have_to_be_there_for_every_motion_where_success_is_asked(
    cli: Cli, soup: tuple[DataFiles, Path]
) -> None:
    files, store = soup
    assert files.rates is not None
    files.rates.write_text("chop\t0.9\n", encoding="utf-8")
    ran = cli("merge", "--data", files.rates.parent, "--store", store)
    assert ran.code == 0
    assert "the rates file has no rate for 'add', 'cook', 'eat'" in ran.err
    assert cli("solve", "--network", store).code == 0
    ran = cli("solve", "--network", store, "--objective", "success")
    assert ran.code == 2
    assert "a.txt:10:1: error: the motion 'add' has no success rate" in ran.err


def killed_import(source: Path, store: Path) -> None:
    """Begin to import, and kill the process in the middle of writing."""
    words = [sys.executable, "-m", "foon_asp", "merge", str(source), "--store", str(store)]
    partial = store.with_name(f".{store.name}.partial")
    process = subprocess.Popen(words, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 60
    while not (partial.exists() and partial.stat().st_size > 100_000):
        assert process.poll() is None, "the import was over before it could be killed"
        assert time.monotonic() < deadline
        time.sleep(0.005)
    process.send_signal(signal.SIGKILL)
    process.wait()
    assert process.returncode == -signal.SIGKILL


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="there is no SIGKILL here")
def test_a_killed_import_leaves_the_old_store_or_none(soup: tuple[DataFiles, Path], tmp_path: Path) -> None:
    files, store = soup
    large = tmp_path / "large.txt"
    unit = "O\tpan\nS\tstate {}\nS\ton\t[table {}]\nM\theat\nO\tpan\nS\thot {}\n//\n"
    large.write_text("".join(unit.format(i, i, i) for i in range(20_000)), encoding="utf-8")
    before = store.read_bytes()
    killed_import(large, store)
    assert store.read_bytes() == before
    assert_holds(store, read_data(files))
    new = tmp_path / "new.foon"
    killed_import(large, new)
    assert not new.exists()
    assert (tmp_path / ".new.foon.partial").exists()  # or there was nothing to kill
    import_files(files, new)  # takes the leftover away
    assert_holds(new, read_data(files))
    assert not (tmp_path / ".new.foon.partial").exists()


def test_two_imports_at_once(soup: tuple[DataFiles, Path]) -> None:
    files, store = soup
    partial = store.with_name(f".{store.name}.partial")
    other = sqlite3.connect(partial, isolation_level=None)
    other.execute("PRAGMA journal_mode = OFF")
    other.execute("BEGIN EXCLUSIVE")
    other.execute("CREATE TABLE unit (number INTEGER)")
    with pytest.raises(UserError, match="another import is writing it"):
        import_files(files, store)
    assert partial.exists()
    other.close()
    import_files(files, store)
    assert not partial.exists()


def test_readers_at_once_and_a_new_import_under_them(soup: tuple[DataFiles, Path]) -> None:
    files, store = soup
    data = read_data(files)
    old = Store(store)
    with ThreadPoolExecutor(4) as pool:
        assert all(same_network(network, data.network) for network, _ in pool.map(read_whole, [store] * 16))
    import_files(DataFiles(files.network[1:]), store)
    assert same_network(old.read_whole()[0], data.network)  # the old one, as long as it is open
    assert len(Store(store).read_whole()[0]) == 2


def test_processes_that_read_at_once(soup: tuple[DataFiles, Path]) -> None:
    _, store = soup
    words = [sys.executable, "-m", "foon_asp", "solve", "--network", str(store), "--goal", SOUP_NODE]
    running = [subprocess.Popen(words, cwd=ROOT, stdout=subprocess.PIPE, text=True) for _ in range(4)]
    printed = {process.communicate()[0] for process in running}
    assert [process.returncode for process in running] == [0] * 4
    assert len(printed) == 1


def read_whole(store: Path) -> tuple[Network, frozenset[int]]:
    return Store(store).read_whole()


# A store that was opened is closed.


@pytest.fixture
def opened(monkeypatch: pytest.MonkeyPatch) -> list[sqlite3.Connection]:
    """Return the connections of all databases that are opened from now on."""
    connections: list[sqlite3.Connection] = []
    connect = sqlite3.connect

    def connected(*words: Any, **named: Any) -> sqlite3.Connection:
        connections.append(connect(*words, **named))
        return connections[-1]

    monkeypatch.setattr(sqlite3, "connect", connected)
    return connections


def all_closed(connections: list[sqlite3.Connection]) -> bool:
    assert connections, "nothing was opened"
    for connection in connections:
        with pytest.raises(sqlite3.ProgrammingError, match="closed"):
            connection.execute("SELECT 1")
    return True


def test_a_store_is_closed_at_the_end_of_with(
    soup: tuple[DataFiles, Path], opened: list[sqlite3.Connection]
) -> None:
    with Store(soup[1]) as store:
        assert store.unit_count == 4
    assert all_closed(opened)
    with pytest.raises(UserError, match=r"soup\.foon: the store was closed; open it again"):
        store.read_whole()
    with pytest.raises(UserError, match="the store was closed"):
        store.node(0)
    store.close()  # twice does no harm


def test_a_store_that_nothing_refers_to_is_closed(
    soup: tuple[DataFiles, Path], opened: list[sqlite3.Connection]
) -> None:
    store = Store(soup[1])
    network, _ = store.read_whole()
    opened[0].execute("SELECT 1")
    del store
    assert all_closed(opened)
    assert len(network) == 4


def test_a_store_that_turns_out_damaged_is_closed(
    soup: tuple[DataFiles, Path], opened: list[sqlite3.Connection]
) -> None:
    forged(soup[1], "DELETE FROM about")
    opened.clear()
    with pytest.raises(UserError, match="the store is damaged"):
        Store(soup[1])
    assert all_closed(opened)


@pytest.mark.parametrize("level", ["3", "2"])
@pytest.mark.parametrize("goal", ["soup", "nothing of the kind"])
def test_a_command_closes_the_store_that_it_read(
    soup: tuple[DataFiles, Path], cli: Cli, opened: list[sqlite3.Connection], level: str, goal: str
) -> None:
    cli("solve", "--network", soup[1], "--level", level, "--goal", goal)
    assert all_closed(opened)


# Damage.


def everything(store: Path) -> list[object]:
    """Ask all that can be asked of a part, and then of the whole."""
    opened = Store(store)
    goal = find_goal(SOUP_NODE, opened, opened.goals)
    cone = opened.read_part(
        opened.cone([goal], ContainerRule.IMPLIED, opened.utensils, StoredIds(opened, "kitchen")).units
    )
    answers: list[object] = [
        goal,
        cone.unit_numbers,
        cone.inputs,
        cone.objects,
        opened.outline.motions.tolist(),
    ]
    answers += [
        opened.rates,
        opened.utensils,
        opened.goals,
        opened.producers(goal),
        {*StoredIds(opened, "starting")},
    ]
    answers += [opened.unit_id(cone.unit(u)) for u in range(len(cone))]
    network, kitchen = opened.read_whole()
    answers += [network.objects, network.motions, network.inputs, network.outputs, network.sources, kitchen]
    answers += [
        opened.kitchen_items(),
        opened.motion_sources(),
        opened.near("sop", 3),
        opened.beginning("s", 9),
    ]
    answers += [opened.labelled("soup"), StoredStartingKitchen(opened).changes_for_goals([goal])]
    answers += [opened.left_out, opened.has_kitchen, opened.digests, opened.motion_prices]
    answers += [opened.unit_prices(network, from_file=True), opened.unpriced((), (), from_file=True)]
    return answers


@pytest.mark.slow
def test_damaged_bytes_are_reported(soup: tuple[DataFiles, Path]) -> None:
    """Of a part, damage is reported where it cannot be read; of the whole, always."""
    _, store = soup
    whole = store.read_bytes()
    everything(store)
    rng = random.Random(7)
    used = [place for place, byte in enumerate(whole) if byte]  # most of the file is empty
    for _ in range(600):
        damaged = bytearray(whole)
        for place in rng.sample(used, rng.choice((1, 1, 1, 2, 20))):
            damaged[place] ^= rng.randrange(1, 256)
        store.write_bytes(damaged)
        with pytest.raises(UserError, match="soup"):
            everything(store)


def test_a_truncated_store_is_refused(soup: tuple[DataFiles, Path], cli: Cli) -> None:
    _, store = soup
    whole = store.read_bytes()
    for length in (*range(0, 120, 7), *range(4096, len(whole), 3001), len(whole) - 1):
        store.write_bytes(whole[:length])
        with pytest.raises(UserError, match=r"damaged|is empty|is no store"):
            Store(store)
    ran = cli("solve", "--network", store, "--goal", "soup")
    assert ran.code == 2
    assert "the store is damaged (it has" in ran.err
    assert "Traceback" not in ran.err
    store.write_bytes(whole + b"\0" * 100)
    with pytest.raises(UserError, match="damaged"):
        Store(store)


@pytest.mark.parametrize("number", [0, VERSION + 1, 999])
def test_another_version_is_refused(soup: tuple[DataFiles, Path], cli: Cli, number: int) -> None:
    _, store = soup
    with sqlite3.connect(store) as database:
        database.execute(f"PRAGMA user_version = {number}")
    database.close()
    ran = cli("solve", "--network", store, "--goal", "soup")
    assert ran.code == 2
    words = (
        f"has version {number} of the store format"
        if number
        else "version 0 of the store format does not exist"
    )
    assert words in ran.err


def test_foreign_files_are_refused(tmp_path: Path, cli: Cli) -> None:
    store = tmp_path / "foreign.foon"
    with sqlite3.connect(store) as database:
        database.execute("CREATE TABLE bookmarks (address TEXT)")
    database.close()
    assert "is a database of another program" in cli("solve", "--network", store, "--goal", "x").err
    renamed = store.rename(tmp_path / "foreign.txt")  # whatever it is called
    assert "is a database of another program" in cli("solve", "--network", renamed, "--goal", "x").err
    store.write_text(SOUP, encoding="utf-8")
    ran = cli("solve", "--network", store, "--goal", "x")
    assert ran.code == 2
    assert f"{store}: is no store" in ran.err
    store.write_bytes(os.urandom(5000))
    assert "is no store" in cli("solve", "--network", store, "--goal", "x").err
    store.write_bytes(b"")
    assert "is empty" in cli("solve", "--network", store, "--goal", "x").err


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes here")
def test_a_pipe_is_no_store(tmp_path: Path, cli: Cli, soup: tuple[DataFiles, Path]) -> None:
    files, _ = soup
    pipe = tmp_path / "pipe.foon"
    os.mkfifo(pipe)
    ran = cli("solve", "--network", pipe, "--goal", "x")
    assert ran.code == 2
    assert "not a file, expected a store" in ran.err
    assert "another file has this name" in cli("merge", *files.network, "--store", pipe).err


@pytest.mark.slow
@pytest.mark.parametrize("rule", list(ContainerRule))
def test_the_real_universal_foon(universal: Path, tmp_path: Path, rule: ContainerRule) -> None:
    """Clingo is given the same about any object, whether the whole network was read or its cone."""
    files, store = find_data(universal), tmp_path / "universal.foon"
    import_files(files, store)
    data = read_data(files)
    assert_holds(store, data)
    for goal in random.Random(3).sample(range(len(data.network.objects)), 25):
        problem = Problem(data.network, data.kitchen, (goal,), data.rates, data.utensils, rule)
        part = cone_problem(store, problem, own_kitchen=True)
        chosen = (Objective.SUCCESS, Objective.INPUTS)
        assert (
            bare_program(part, chosen, Settings(), {}).facts
            == bare_program(problem, chosen, Settings(), {}).facts
        )


@pytest.mark.nightly
def test_a_hundred_thousand_units(tmp_path: Path, cli: Cli) -> None:
    folder = tmp_path / "generated"
    script = ROOT / "benchmarks" / "generate.py"
    words = ["--family", "recipe-like", "--units", "100000", "--out", str(folder)]
    subprocess.run([sys.executable, str(script), *words], check=True, stdout=subprocess.DEVNULL)
    store = tmp_path / "large.foon"
    files = find_data(folder)
    import_files(files, store)
    data = read_data(files)
    opened = Store(store)
    network, kitchen = opened.read_whole()
    assert same_network(network, data.network)
    assert kitchen == data.kitchen
    for entry in data.goals[::4]:
        (goal,) = data.network.find(entry.pattern)
        problem = Problem(data.network, data.kitchen, (goal,), data.rates, data.utensils)
        part = cone_problem(store, problem, own_kitchen=True)
        found, expected = solve(part), solve(problem)
        assert (found.status, found.costs) == (expected.status, expected.costs)


# --- stores that somebody made up


def forged(store: Path, statement: str, *values: object) -> None:
    """Change a store, and its digest with it."""
    with store.open("rb+") as file:
        file.truncate(store.stat().st_size - FILE_DIGEST)
    with contextlib.closing(sqlite3.connect(store)) as database, database:
        database.execute(statement, values)
    append_digest(store)


def read_all(cli: Cli, store: Path) -> list[Ran]:
    """Read a store in every way that there is."""
    return [
        cli("stats", "--network", store),
        cli("solve", "--network", store, "--goal", "soup; cooked; in [pot]", "--objective", "success"),
        cli("solve", "--network", store, "--goal", "soup; cooked; in [pot]", "--containers", "implied"),
        cli("why-not", "--network", store, "--goal", "lekk"),
        cli("solve", "--network", store, "--goal", "sou"),
        cli("compare", "--network", store, "--search", "bfs"),
    ]


WRONG: list[Any] = [7, -1, 2**62, 1.5, "x", "", "1/0", "1e99999999", "9" * 5000, b"x\xff"]
WRONG += ["[]", "[[]]", "[7]", "[null]", "[-1]", "{}", '{"x":1}', '[["x"]]', "[" * 100_000, "NaN"]


def forgeries(store: Path) -> list[tuple[str, Any]]:
    """Return statements that put wrong values in each column."""
    with contextlib.closing(sqlite3.connect(store)) as database:
        tables = database.execute(
            "SELECT name FROM sqlite_master WHERE sql LIKE 'CREATE TABLE %(%'"
        ).fetchall()
        columns = [
            (table, column)
            for (table,) in tables
            if not table.startswith("label_trigram")
            for _, column, *_ in database.execute(f"PRAGMA table_info({table})")
        ]
    return [
        (f'UPDATE OR REPLACE {table} SET "{column}" = ? WHERE "{column}" = '
         f'(SELECT "{column}" FROM {table} ORDER BY random())', value)
        for table, column in columns
        for value in WRONG
    ]  # fmt: skip


def test_a_value_that_is_made_up_is_damage(soup: tuple[DataFiles, Path]) -> None:
    """Some values can stand in the place of others, and most cannot."""
    files, store = soup
    prices = files.network[0].with_name("prices.txt")
    prices.write_text("chop\t1\nadd\t2\ncook\t3\neat\t4\n", encoding="utf-8")
    import_files(files._replace(unit_prices=prices), store)
    original = store.read_bytes()
    refused = 0
    for statement, value in random.Random(3).sample(forgeries(store), 200):
        store.write_bytes(original)
        try:
            forged(store, statement, value)
        except (sqlite3.Error, OverflowError):
            continue
        try:
            everything(store)
        except UserError as error:
            refused += f"{store}: the store is damaged (" in str(error)
    assert refused >= 80


@pytest.mark.slow
def test_no_value_that_is_made_up_is_a_bug_of_a_command(soup: tuple[DataFiles, Path], cli: Cli) -> None:
    _, store = soup
    original = store.read_bytes()
    for statement, value in random.Random(5).sample(forgeries(store), 60):
        store.write_bytes(original)
        with contextlib.suppress(sqlite3.Error, OverflowError):
            forged(store, statement, value)
            for ran in read_all(cli, store):
                assert ran.code in {0, 1, 2}, (statement, value)


@pytest.mark.parametrize(
    ("statement", "words"),
    [
        ("UPDATE unit SET inputs = '[0,0]' WHERE id = 0", "an object node twice"),
        ("UPDATE unit SET inputs = '[999]' WHERE id = 0", "the store is damaged"),
        ("UPDATE node SET (label, states, relations, contents) = (SELECT label, states, relations, contents"
         " FROM node WHERE id = 0) WHERE id = 1", "an object node or a unit is there twice"),
        ("DELETE FROM unit WHERE id = 3", "3 of 4 units, 7 of 7 nodes"),
        ("DELETE FROM node WHERE id = 6", "4 of 4 units, 6 of 7 nodes"),
    ],
)  # fmt: skip
def test_a_network_that_is_made_up_is_damage(
    soup: tuple[DataFiles, Path], statement: str, words: str
) -> None:
    _, store = soup
    forged(store, statement)
    with pytest.raises(UserError, match=words):
        Store(store).read_whole()


def test_a_change_after_the_import_is_noticed_where_all_is_read(
    soup: tuple[DataFiles, Path], cli: Cli
) -> None:
    _, store = soup
    content = store.read_bytes()
    store.write_bytes(content.replace(b'["whole"]', b'["wholE"]'))
    assert store.read_bytes() != content
    assert "(it was changed after the import)" in cli("stats", "--network", store).err


@pytest.mark.parametrize(
    "statement",
    [
        "CREATE VIEW more AS SELECT * FROM unit",
        "CREATE TRIGGER more AFTER INSERT ON unit BEGIN DELETE FROM unit; END",
        "CREATE TABLE more (number INTEGER PRIMARY KEY, content BLOB NOT NULL)",
        "CREATE INDEX more ON unit (inputs)",
        "ALTER TABLE unit RENAME TO node_2",
        "DROP TABLE price",
        "DROP TABLE label_trigram; CREATE VIEW label_trigram_data AS SELECT 1",
        "DROP TABLE unit; CREATE VIEW unit AS SELECT 0 AS number, x'00' AS content",
        "DROP TABLE unit; CREATE VIEW unit AS WITH RECURSIVE n(number) AS (SELECT 0 UNION ALL"
        " SELECT number + 1 FROM n) SELECT number, zeroblob(1000000000) AS content FROM n",
        "DROP TABLE unit; CREATE TABLE unit (number TEXT, content BLOB)",
        "DROP TABLE unit; CREATE TABLE unit (number INTEGER PRIMARY KEY, content BLOB AS (zeroblob(1000)))",
        "DROP TABLE unit; CREATE VIRTUAL TABLE unit USING fts5(number, content)",
    ],
)
def test_a_database_has_our_tables_and_nothing_else(
    soup: tuple[DataFiles, Path], cli: Cli, statement: str
) -> None:
    _, store = soup
    store.write_bytes(store.read_bytes()[:-FILE_DIGEST])
    with contextlib.closing(sqlite3.connect(store)) as database:
        try:
            database.executescript(statement)
        except sqlite3.OperationalError as error:
            pytest.skip(str(error))
    append_digest(store)
    ran = cli("solve", "--network", store, "--goal", "soup")
    assert ran.code == 2
    assert "the store is damaged (its tables are not those of a store)" in ran.err
