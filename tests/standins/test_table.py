"""The table of stand-ins: what edits cost, and the three ways in which prices are worked out."""

import random
from fractions import Fraction
from pathlib import Path

import pytest

import foon_asp
from foon_asp.network import NetworkBuilder, ObjectNode, Source, StandInTable
from foon_asp.proof.stand_ins import price_of
from foon_asp.standins.pair_prices import NodePrices
from foon_asp.standins.table_file import read_stand_ins
from foon_asp.text.diagnostics import InputError
from tests.standins.test_best_stand_ins import PRICES

USUAL = StandInTable.usual()


def price(used: str, served: str, table: StandInTable = USUAL) -> Fraction | None:
    return table.dissimilarity(foon_asp.parse_node(used), foon_asp.parse_node(served))


@pytest.mark.parametrize(
    ("used", "served", "expected"),
    [
        ("egg; on [plate]", "egg; in [plate]", 1),
        ("egg; in [bowl]", "egg; in [pot]", 2),
        ("egg; in [bowl]", "egg", 2),
        ("egg; whole", "egg", 3),
        ("knife", "knife; clean", 4),
        ("soup; contains {leek,salt,water}", "soup; contains {leek,water}", 3),
        ("soup; contains {leek,water}", "soup; contains {leek,salt,water}", 5),
        ("soup; seasoned {leek,water}", "soup; contains {leek,water}", 1),
        ("cherry tomato", "cherrytomatoes", 1),
        ("egg; on [plate]; whole", "egg; in [plate]", 4),
        ("onion", "onion; chopped", None),  # somebody has to chop it
        ("pan; dirty", "pan", None),
        ("bowl; empty", "bowl; contains {milk}", None),
        ("bowl; contains {milk}", "bowl", None),
        ("plate; contains {onion}", "plate; contains {green bean}", None),
        ("tongs", "peeler", None),
        ("whisk", "egg", None),
    ],
)
def test_what_edits_cost(used: str, served: str, expected: int | None) -> None:
    assert price(used, served) == expected


def random_node(rng: random.Random) -> ObjectNode:
    words = ["egg", "eggs", "Egg", "red-egg", "pot", "salt", "raw", "hot"]
    contents = [(rng.choice(("contains", "seasoned")), rng.choices(words, k=rng.randint(1, 4)))]
    relations = [(rng.choice(("in", "on")), rng.choice(words)) for _ in range(rng.randint(0, 3))]
    states = rng.sample(words, rng.randint(0, 3))
    return ObjectNode.of(rng.choice(words), states, relations, contents * rng.randint(0, 2))


def random_prices(rng: random.Random, nodes: list[ObjectNode]) -> StandInTable:
    words = {(edit, rng.choice(("salt", "raw"))): rng.choice(PRICES) for edit in USUAL.edits}
    node, other = rng.sample(nodes, 2)
    pairs: dict[tuple[str | ObjectNode, str | ObjectNode], Fraction | None] = {
        ("egg", "pot"): rng.choice(PRICES),
        ("egg", "eggs"): rng.choice(PRICES),
        (node, other): rng.choice(PRICES),
    }
    return StandInTable({edit: rng.choice(PRICES) for edit in USUAL.edits}, words, pairs)


def test_the_table_the_search_and_the_verifier_agree_on_prices() -> None:
    priced = 0
    for seed in range(8):
        rng = random.Random(seed)
        nodes = list(dict.fromkeys(random_node(rng) for _ in range(20)))
        table = random_prices(rng, nodes)
        builder = NetworkBuilder()
        builder.add("go", nodes, nodes[:1], Source("random", 1))
        network = builder.build()
        prices = NodePrices(network, table)
        for served, node in enumerate(network.objects):
            found = prices.servers_of(served)
            for serving, other in enumerate(network.objects):
                if serving != served:
                    expected = table.dissimilarity(other, node)
                    assert price_of(table, other, node) == expected
                    assert found.get(serving) == (None if expected is None else expected * prices.scale)
                    assert expected is None or expected > 0
                    priced += expected is not None
    assert priced > 100


FILE = """# mine
word\t0.5
more state: dirty\t2
onion\tleek\t1
bowl; empty\tbowl; contains {milk}\t7
tongs\tpeeler\tnever
"""


def test_a_file_changes_the_table(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text(FILE)
    (tmp_path / "lexicon.txt").write_text("onion\tleek\t8\nham\tbacon\t2\ntongs\tpeeler\t2\nwhisk\tfork\t2\n")
    table = read_stand_ins([tmp_path / "mine.txt"], [tmp_path / "lexicon.txt"], {"whisk", "bowl"})
    assert price("egg; on [plate]", "egg; in [plate]", table) == Fraction(1, 2)
    assert price("onion", "leek", table) == 1
    assert price("onion; on [plate]", "leek; in [plate]", table) == Fraction(3, 2)
    assert price("pan; dirty", "pan", table) == 2
    assert price("bowl; empty", "bowl; contains {milk}", table) == 7
    assert price("ham", "bacon", table) == 2
    assert price("tongs", "peeler", table) is None
    assert price("whisk", "fork", table) is None  # a lexicon says nothing of utensils


@pytest.mark.parametrize(
    ("line", "column", "expected"),
    [
        ("word\t0", 6, "a number above 0"),
        ("sate\t1", 1, "a kind of edit (spelling, word"),
        ("word: on\t1", 1, "a kind of edit"),
        ("onion\tleek; raw\t1", 7, "two labels"),
        ("onion\tonion\t1", 7, "what it is used for"),
        ("onion", 6, "a tab and a number or never"),
        ("onion\tleek\t-1", 12, "never"),
    ],
)
def test_a_wrong_line_is_reported(tmp_path: Path, line: str, column: int, expected: str) -> None:
    file = tmp_path / "wrong.txt"
    file.write_text(f"# first\n{line}\n")
    with pytest.raises(InputError) as error:
        read_stand_ins([file])
    assert f"{file}:2:{column}: error" in str(error.value)
    assert expected in str(error.value)
