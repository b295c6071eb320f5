"""``foon-asp merge``: every distinct unit once, with the places of all its copies."""

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, Network, NetworkBuilder, ObjectNode, Source
from foon_asp.text.merged_network import merged_text
from foon_asp.text.reader import FoonReader
from foon_asp.text.writer import write_unit
from tests.conftest import CORPUS, Cli
from tests.text.foon_strategies import steady, units

TEA = """\
# Source:\thttps://example.org/tea.mp4
# Source:\thttps://example.org/a tea\tat 0:20
//
O1\twater\t1
S2\thot
M3\tpour\t0:10\t0:20
O4\ttea
//
O4\ttea
M5\tdrink
O6\tcup
S7\tempty
//
"""
PARTY = "O\ttea\nM\tdrink\nO\tcup\nS\tempty\n//\nO\tcup\nS\tempty\nM\twash\nO\tcup\n//\n"
MERGED = """\
# Universal FOON: 3 functional units from 2 files
//
# From:\tparty.txt:1
# From:\ttea.txt:9\thttps://example.org/tea.mp4\thttps://example.org/a tea at 0:20
O\ttea
M\tdrink
O\tcup
S\tempty
//
# From:\tparty.txt:6
O\tcup
S\tempty
M\twash
O\tcup
//
# From:\ttea.txt:4\thttps://example.org/tea.mp4\thttps://example.org/a tea at 0:20
O\twater
S\thot
M\tpour
O\ttea
//
"""


def parts(network: Network) -> object:
    return (
        network.objects,
        network.motions,
        network.inputs,
        network.outputs,
        tuple(tuple(dict.fromkeys(s._replace(column=1) for s in sources)) for sources in network.sources),
    )


def read_back(text: str) -> Network:
    reader = FoonReader()
    builder = NetworkBuilder()
    for motion, inputs, outputs, sources, _ in reader.units(text, "merged.txt"):
        builder.add(motion, inputs, outputs, *sources)
    reader.raise_errors()
    return builder.build()


@pytest.fixture
def recipes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "tea.txt").write_text(TEA)
    (tmp_path / "party.txt").write_text(PARTY)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_folder(cli: Cli, recipes: Path) -> None:
    ran = cli("merge", "party.txt", "tea.txt", "-o", "out.foon")
    assert (ran.code, ran.out) == (0, "")
    assert Path("out.foon").read_text() == MERGED
    assert ran.err == "wrote out.foon\n2 files: 3 units of 4 read, 4 object nodes\n"
    assert cli("merge", ".").out == MERGED
    assert parts(FoonReader().read_network([Path("out.foon")])) == parts(
        FoonReader().read_network([Path("party.txt"), Path("tea.txt")])
    )


def test_merging_again_keeps_the_places(cli: Cli, recipes: Path) -> None:
    cli("merge", ".", "-o", "out.foon")
    assert cli("merge", "out.foon").out.split("\n", 1)[1] == MERGED.split("\n", 1)[1]
    more = cli("merge", "out.foon", "tea.txt").out
    assert more.split("\n", 1)[1] == MERGED.split("\n", 1)[1]  # copies that are known already


def test_every_answer_shows_the_places(cli: Cli, recipes: Path) -> None:
    cli("merge", ".", "-o", "FOON.txt")
    Path("kitchen.json").write_text('[{"label": "water", "states": ["hot"]}]')
    ran = cli("solve", "--data", ".", "--goal", "cup; empty", "--format", "json")
    sources = [[(s["file"], s["line"]) for s in unit["source"]] for unit in ran.json["units"]]
    assert sources == [[("tea.txt", 4)], [("party.txt", 1), ("tea.txt", 9)]]


def test_json_is_merged_with_text(cli: Cli, recipes: Path) -> None:
    cli("convert", "tea.txt", "--to", "json", "-o", "tea.json")
    ran = cli("merge", "tea.json", "tea.txt")
    assert ran.code == 0
    assert ran.out.count("# From:\ttea.json:") == ran.out.count("# From:\ttea.txt:") == 2
    assert ran.out.count("\n//") == 3


def test_kitchens_and_goals_are_no_networks(cli: Cli, recipes: Path) -> None:
    """Known by name in a folder, and otherwise by what is in them."""
    for name in ("kitchen.txt", "at_home.txt"):
        Path(name).write_text("O\twater\nS\thot\nO\ttea\n")
    Path("motion.txt").write_text("pour\t0.9\n")
    ran = cli("merge", ".")
    assert ran.code == 0
    assert "at_home.txt:1:1: warning: 2 objects and no motion: a list such as a kitchen or goals" in ran.err
    assert "kitchen.txt" not in ran.err
    assert parts(read_back(ran.out)) == parts(read_back(MERGED))


def test_what_is_not_understood(cli: Cli, recipes: Path) -> None:
    Path("broken.txt").write_text("O\ttea\nwhat\nM\tsip\nO\ttea\n//\n")
    ran = cli("merge", ".", "-o", "out.foon")
    assert ran.code == 2
    assert "broken.txt:2:1: error: " in ran.err
    assert not Path("out.foon").exists()
    ran = cli("merge", ".", "-o", "out.foon", "--lenient")
    assert ran.code == 0
    assert "1 line left out" in ran.err


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["tea.txt", "-o", "tea.txt"], "is read by this command"),
        ([".", "-o", "./party.txt"], "is read by this command"),
        (["missing"], "no such file"),
        (["kitchen.txt"], "no functional unit"),
        (["bad\nname.txt"], "cannot be named in a line of text"),
        ([" bad.txt"], "cannot be named in a line of text"),
        (["names.json"], "a name that FOON text cannot hold"),
    ],
)
def test_what_cannot_be_merged(cli: Cli, recipes: Path, words: list[str], says: str) -> None:
    Path("kitchen.txt").write_text("O\twater\n")
    unit = '[{"input_nodes": [{"label": "%s"}], "motion_node": "%s", "output_nodes": []}]'
    Path("names.json").write_text(unit % ("a [b]", "cut"))
    for name in words[:1]:
        if "bad" in name:
            Path(name).write_text(TEA)
    ran = cli("merge", *words)
    assert (ran.code, ran.out) == (2, "")
    assert says in ran.err
    assert Path("tea.txt").read_text() == TEA
    assert Path("party.txt").read_text() == PARTY


@settings(steady, max_examples=40)
@given(st.lists(units(), min_size=1, max_size=3))
def test_merging_files_is_reading_them_together(
    tmp_path_factory: pytest.TempPathFactory, files: list[list[FunctionalUnit]]
) -> None:
    folder = tmp_path_factory.getbasetemp()
    paths = []
    for number, found in enumerate(files):
        paths.append(folder / f"{number}.txt")
        paths[-1].write_text("# Source: v\n//\n" + "".join(map(write_unit, found)), newline="")
    network = FoonReader().read_network(paths)
    once = "".join(merged_text(network, "once"))
    assert parts(read_back(once)) == parts(network)
    assert "".join(merged_text(read_back(once), "once")) == once


def test_a_network_that_text_cannot_hold() -> None:
    for node in (
        ObjectNode.of("bowl", relations=[("contains", "salt")]),
        ObjectNode.of("bowl", contents=[("contains", ["a,b"])]),
        ObjectNode.of("bowl\nS\thot"),
        ObjectNode.of("bowl", relations=[("in", "p,q")]),
    ):
        builder = NetworkBuilder()
        builder.add("wash", [node], [], Source("a", 1))
        with pytest.raises(UserError, match="cannot hold"):
            list(merged_text(builder.build(), "comment"))


def test_corpus(cli: Cli, universal: Path) -> None:
    """The numbers of the subgraphs, and the universal FOON as it is."""
    for folder, units_read, distinct, nodes in (
        ("subgraphs", 1131, 1099, 2152),
        ("universal", 2376, 2376, 4305),
    ):
        ran = cli("merge", CORPUS / folder)
        assert ran.code == 0
        assert f": {distinct:,} units of {units_read:,} read, {nodes:,} object nodes" in ran.err
        back = read_back(ran.out)
        assert (len(back), len(back.objects), sum(map(len, back.sources))) == (distinct, nodes, units_read)
