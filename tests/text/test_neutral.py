"""The neutral form: networks as JSON lines with plain names."""

from fractions import Fraction
from pathlib import Path

import pytest

import foon_asp
from foon_asp.errors import UserError
from foon_asp.network import ObjectNode
from foon_asp.problem import Objective
from foon_asp.store.import_files import import_files
from foon_asp.text.data_folder import DataFiles, network_files, read_data
from foon_asp.text.diagnostics import InputError
from foon_asp.text.folder_files import foon_files
from foon_asp.text.formats import format_of
from foon_asp.text.reader import FoonReader
from tests.conftest import Cli

pytestmark = [
    pytest.mark.filterwarnings("ignore:No kitchen given"),
    # the dough of its recipe is listed twice on purpose
    pytest.mark.filterwarnings("ignore:note. 1 unit lists an object node twice"),
]

TEXT = r"""{"id": "sift", "inputs": [], "outputs": ["flour; fine"], "price": 0.1}
{"id": "mix", "inputs": ["flour; fine", "in [a\tb]"], "outputs": ["dough"], "price": "2"}
{"id": "sift", "inputs": [], "outputs": ["flour; fine"], "price": 0.05}
{"id": "knead", "inputs": ["in [a\tb]", "flour; fine"], "outputs": ["dough"], "price": 1}
{"id": 7, "inputs": ["dough", "dough"], "outputs": ["bread"]}
{"id": "7", "inputs": ["dough"], "outputs": ["bread"], "price": 3}
{"id": "7", "inputs": ["dough"], "outputs": ["bread"], "price": 2.5}
"""


def written(tmp_path: Path, text: str = TEXT, name: str = "net.jsonl") -> Path:
    file = tmp_path / name
    file.write_text(text, encoding="utf-8")
    return file


def test_names_are_labels_to_the_letter_and_the_cheapest_copy_counts(tmp_path: Path) -> None:
    for name in ("net.jsonl", "net.ndjson", "net.txt", "net.json"):
        data = read_data(DataFiles((written(tmp_path, name=name),)))
        network, prices = data.network, data.unit_prices
        assert prices is not None
        assert network.motions == ("sift", "mix", "knead", "7")
        assert network.objects[0] == ObjectNode("flour; fine")
        assert network.objects[2] == ObjectNode("in [a\tb]") or network.objects[1] == ObjectNode("in [a\tb]")
        assert prices.of_units(network) == tuple(map(Fraction, ("0.05", "2", "1", "2.5")))
        assert [source.line for source in network.sources[3]] == [5, 6, 7]
        assert network.inputs[0] == ()


def test_solved_certified_and_verified_and_the_same_from_a_store(cli: Cli, tmp_path: Path) -> None:
    file, store = written(tmp_path), tmp_path / "net.foon"
    import_files(DataFiles((file,)), store)
    for network in (file, store):
        answer = foon_asp.solve(foon_asp.load(network).problem("bread"), "price")
        assert answer.costs is not None
        assert answer.costs.measure(Objective.PRICE) == Fraction(355, 100)
        assert [unit.motion for unit in answer.tree or ()] == ["sift", "knead", "7"]
    proof = tmp_path / "proof.json"
    asked = ("--network", str(file), "--goal", "bread", "--objective", "price")
    assert cli("solve", *asked, "--certificate", str(proof)).code == 0
    assert "verified" in cli("verify", str(proof), "--network", str(store)).out
    dearer = written(tmp_path, TEXT.replace("2.5", "2.25"), "other.jsonl")
    assert cli("verify", str(proof), "--network", str(dearer)).code != 0


def test_a_name_with_notation_in_it_is_found_quoted_or_as_it_is(tmp_path: Path) -> None:
    foon = foon_asp.load(written(tmp_path))
    for name in ("flour; fine", '"flour; fine"'):
        assert foon.problem(name).goals == (0,)


@pytest.mark.parametrize(
    ("line", "column", "said"),
    [
        ('{"id": "a", "inputs": ["x"]', 28, "not JSON"),
        ('{"id": "a", "inputs": ["x"],}', 28, "found a comma before }"),
        ('{"id": ' + "[" * 100_000, 1, "nested too deeply"),
        ('["a"]', 1, "found no unit, expected an object with id, inputs, outputs"),
        ('{"inputs": [], "outputs": ["x"]}', 1, "found no unit"),
        ('{"id": "a", "inputs": [], "outputs": ["x"], "cost": 3}', 1, "found the key 'cost'"),
        ('{"id": "a", "id": "b", "inputs": [], "outputs": ["x"]}', 1, "found the key 'id' twice"),
        ('{"id": "", "inputs": [], "outputs": ["x"]}', 2, 'found "" in "id", expected a name'),
        ('{"id": "a", "inputs": "x", "outputs": ["y"]}', 13, 'found "x" as "inputs", expected a list'),
        ('{"id": "a", "inputs": [], "outputs": [3]}', 27, 'found 3 in "outputs", expected a name'),
        ('{"id": "a", "inputs": [" x"], "outputs": ["y"]}', 13, "without blanks around it"),
        ('{"id": "a", "inputs": [], "outputs": ["y"], "price": -1}', 45, "expected a price from 0"),
        ('{"id": "a", "inputs": [], "outputs": ["y"], "price": Infinity}', 45, "expected a price from 0"),
        ('{"id": "a", "inputs": [], "outputs": ["y"], "price": 1e1000}', 45, "at most 1000 letters"),
        ('{"id": "a", "inputs": [], "outputs": ["y"], "price": [1]}', 45, 'found no number as "price"'),
    ],
)
def test_faults_have_their_place(tmp_path: Path, line: str, column: int, said: str) -> None:
    file = written(tmp_path, f"{TEXT}\n{line}\n")
    with pytest.raises(InputError) as raised:
        FoonReader().read_network([file])
    (fault,) = raised.value.diagnostics
    assert (fault.source.file, fault.source.line, fault.source.column) == (str(file), 9, column)
    assert said in fault.message
    lenient = FoonReader(lenient=True)
    assert len(lenient.read_network([file])) == 4
    assert [d.source.line for d in lenient.diagnostics] == [9]


def test_bytes_that_are_no_text_have_their_place_and_a_mark_is_none(tmp_path: Path) -> None:
    file = tmp_path / "net.jsonl"
    file.write_bytes(b"\xef\xbb\xbf" + TEXT.encode())
    assert len(FoonReader().read_network([file])) == 4
    assert len(FoonReader().read_network([written(tmp_path, TEXT * 3, "long.txt")])) == 4
    file.write_bytes(TEXT.encode() + b'{"id": "\xff"}')
    with pytest.raises(InputError, match=r":8:9: error: found the byte 0xff"):
        FoonReader().read_network([file])


def test_it_is_written_and_read_back(cli: Cli, tmp_path: Path) -> None:
    recipe = written(
        tmp_path, "O\tonion\nS\twhole\nO\tknife\nM\tchop\t<0:10,0:20>\nO\tonion\nS\tchopped\n//\n", "r.txt"
    )
    there = cli("convert", str(recipe), "--to", "neutral")
    assert there.out == '{"id": "chop", "inputs": ["onion; whole", "knife"], "outputs": ["onion; chopped"]}\n'
    assert "2  states, relations and contents: in the name of their object" in there.err
    assert "1  times" in there.err
    file = written(tmp_path)
    lines = format_of(TEXT, "net.jsonl")
    assert cli("convert", str(file), "--to", "neutral").out == lines.canonical_text(TEXT, "net.jsonl") == TEXT
    assert lines.canonical_text(TEXT.replace(", ", " ,"), "net.jsonl") == TEXT
    priced = written(
        tmp_path, '[{"input_nodes": [{"label": "a"}], "motion_node": "m", "output_nodes": [], "price": ".5"}]'
    )
    assert (
        '"price": 0.5}'
        in cli("convert", str(written(tmp_path, priced.read_text(), "p.json")), "--to", "neutral").out
    )


def test_what_the_other_forms_cannot_hold_is_refused(cli: Cli, tmp_path: Path) -> None:
    file = written(tmp_path)
    for form in ("plain", "json"):
        assert "the unit 'sift' has no input objects" in cli("convert", str(file), "--to", form).err
    plain = written(tmp_path, TEXT.splitlines()[0], "plain.jsonl")
    assert "no inputs, which FOON text cannot hold" in cli("merge", str(plain)).err
    tree = cli("solve", str(file), "--format", "foon")
    assert (tree.code, tree.out) == (2, "")
    with pytest.raises(UserError, match="no inputs"):
        foon_asp.write_units(foon_asp.load(file).network)
    two = written(
        tmp_path,
        '[{"input_nodes": [{"label": "a", "states": ["b"]}, {"label": "a; b"}], "motion_node": "m",'
        ' "output_nodes": []}]',
        "two.json",
    )
    assert "would be the name of two object nodes" in cli("convert", str(two), "--to", "neutral").err


def test_folders_take_what_is_a_network_and_leave_other_lines(cli: Cli, tmp_path: Path) -> None:
    file = written(tmp_path)
    written(tmp_path, '{"schema": "foon-asp/row/1", "goal": "x"}\n', "results.jsonl")
    assert network_files(tmp_path) == [file]
    assert [found.file for found in foon_files([tmp_path])] == [file]
    assert cli("lint", str(tmp_path)).out.count("is already on line") == 3
    (tmp_path / "kitchen.json").write_text('[{"label": "in [a\\tb]"}]')
    out = tmp_path / "out"
    assert cli("convert", str(tmp_path), "--to", "neutral", "-o", str(out)).code == 0
    assert sorted(found.name for found in out.iterdir()) == ["kitchen.json", "net.jsonl"]
    assert cli("solve", "--data", str(out), "--goal", "bread").code == 0
