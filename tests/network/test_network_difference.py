"""``foon-asp diff`` of two networks and ``merge --report``: what two networks have in common."""

import json
import re
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings

import foon_asp
from foon_asp.network import FunctionalUnit, node_at_level, unit_at_level
from foon_asp.network.near_units import nearest_units, unit_differences, units_with_one_difference
from foon_asp.network.slip import nearest_nodes
from foon_asp.pictures.page import digest
from foon_asp.text.line_parser import parse_node
from foon_asp.text.writer import write_units
from tests.conftest import Cli
from tests.text.foon_strategies import steady, units


def unit(text: str) -> FunctionalUnit:
    """Read ``motion: input + input → output``."""
    motion, _, rest = text.partition(": ")
    inputs, _, outputs = rest.partition(" → ")
    sides = ([parse_node(node) for node in side.split(" + ") if node] for side in (inputs, outputs))
    return FunctionalUnit.of(motion, *sides)


CHOP = unit("chop: onion; whole + knife → onion; chopped + knife")


@pytest.mark.parametrize(
    ("other", "differences"),
    [
        ("chop: knife + onion; whole → knife + onion; chopped", []),
        ("dice: onion; whole + knife → onion; chopped + knife", [("motion", "chop", "dice")]),
        ("chop: onion; whole + knife → onion; diced + knife", [("state", "chopped", "diced")]),
        ("chop: onion + knife → onion; chopped + knife", [("state", "whole", "")]),
        (
            "chop: onion; whole; in [bowl] + knife → onion; chopped + knife",
            [("relation", "", "in [bowl]")],
        ),
        ("chop: leek; whole + knife → leek; chopped + knife", [("label", "onion", "leek")]),
        ("chop: onion; whole → onion; chopped", [("input", "knife", ""), ("output", "knife", "")]),
        (
            "chop: onion; whole + knife + board → onion; chopped + knife; dirty",
            [("input", "", "board"), ("state", "", "dirty")],
        ),
    ],
)
def test_in_what_units_differ(other: str, differences: list[tuple[str, str, str]]) -> None:
    assert [difference[:3] for difference in unit_differences(CHOP, unit(other))] == differences
    turned = [(kind, right, left) for kind, left, right in differences]
    assert sorted(each[:3] for each in unit_differences(unit(other), CHOP)) == sorted(turned)


def test_a_label_counts_once_wherever_it_stands() -> None:
    one = unit("pour: cup; contains {salt} + salt; in [cup] + bowl → bowl; contains {salt} + cup")
    other = unit("pour: mug; contains {salt} + salt; in [mug] + bowl → bowl; contains {salt} + mug")
    assert unit_differences(one, other) == (("label", "cup", "mug", ""),)


@pytest.mark.parametrize(
    ("left", "right", "near"),
    [
        ("mix: egg → dough", "mix: egg → cake", True),
        ("mix: egg → dough", "stir: egg → cake", False),  # a third of what they say is the same
        ("mix: egg; raw → dough", "stir: egg; raw → cake", False),  # half of it
        ("mix: egg; raw; cold → dough", "stir: egg; raw; cold → cake", True),
        ("mix: a; b; c; d; e; f → dough", "stir: a; b; c; d; e; x → cake", True),
        ("mix: a; b; c; d; e; f; g → dough", "stir: a; b; c; d; e; x → cake", False),  # four differences
    ],
)
def test_which_units_are_nearly_the_same(left: str, right: str, near: bool) -> None:
    assert bool(nearest_units([unit(left)], [unit(right)])) is near


def test_the_nearest_nodes_have_the_same_label_and_most_else() -> None:
    named = [
        "tea; hot; in [pot]",
        "milk",
        "milk; hot",
        "milk; hot; in [pot]",
        "milk; hot; on [pot]; in [pot]",
    ]
    milk, *others = map(parse_node, ["milk; hot; in [pot]", *named])
    assert [str(node) for node in nearest_nodes(milk, others, 2)] == [
        "milk; hot",
        "milk; hot; in [pot]; on [pot]",
    ]


def test_units_kept_apart_differ_in_one_thing() -> None:
    listed = [
        CHOP,
        unit("dice: onion; whole + knife → onion; chopped + knife"),  # another motion
        unit("chop: onion; whole + knife → onion; chopped; wet + knife"),  # one state more
        unit("chop: leek; whole + knife → leek; chopped + knife"),  # another thing
        unit("chop: onoin; whole + knife → onoin; chopped + knife"),  # a slip
    ]
    found = [
        (listed.index(p.left), listed.index(p.right), *p.differences[0][:3])
        for p in units_with_one_difference(listed)
    ]
    assert found == [
        (0, 1, "motion", "chop", "dice"),
        (0, 2, "state", "", "wet"),
        (0, 4, "label", "onion", "onoin"),
    ]


@pytest.mark.filterwarnings("ignore::foon_asp.FoonWarning")  # of units without outputs
@settings(steady, max_examples=30)
@given(left=units(), right=units())
def test_figures_are_those_of_sets(
    tmp_path_factory: pytest.TempPathFactory, left: list[FunctionalUnit], right: list[FunctionalUnit]
) -> None:
    folder = tmp_path_factory.getbasetemp()
    files = [folder / "left.txt", folder / "right.txt"]
    for file, listed in zip(files, (left, right), strict=True):
        file.write_text(write_units(listed), encoding="utf-8", newline="")
    found: Any = foon_asp.diff(files[0], files[1])
    for level in (1, 2, 3):
        one, other = ({unit_at_level(u, level) for u in side} for side in (left, right))
        agreement, of_nodes = found.agreement[level - 1].units, found.agreement[level - 1].nodes
        assert (agreement.a, agreement.b, agreement.both) == (len(one), len(other), len(one & other))
        assert agreement.jaccard == (Fraction(len(one & other), len(one | other)) if one | other else 1)
        nodes = [
            {node_at_level(n, level) for u in side for n in (*u.inputs, *u.outputs)} for side in (left, right)
        ]
        assert of_nodes.both == len(nodes[0] & nodes[1])
    total = {*left, *right}
    near = [u for pair in found.nearly_the_same for u in (pair.a, pair.b)]
    assert sorted(map(str, (*found.only_in_a, *found.only_in_b, *near, *found.in_both))) == sorted(
        map(str, total)
    )


A = "O\tice<b>\nS\tcubed\nM\tcrush\nO\tice<b>\nS\tcrushed\n//\nO\ttea\nM\tbrew\nO\ttea\nS\thot\n//\n"
B = A.replace("crushed", "broken & wet").replace("O\ttea\nM", "O\tcup\nM") + "O\tpie\nM\teat\nO\tjoy\n//\n"


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[str, str]:
    """Give two networks."""
    monkeypatch.chdir(tmp_path)
    Path("a.txt").write_text(A)
    Path("b.txt").write_text(B)
    return "a.txt", "b.txt"


def test_a_page_has_two_columns_and_runs_nothing(files: tuple[str, str], cli: Cli) -> None:
    assert cli("diff", *files, "-o", "page.html").code == 0
    page = Path("page.html").read_text(encoding="utf-8")
    assert page == cli("diff", *files, "--format", "html").out
    assert "<script" not in page
    assert {"crushed", "broken &amp; wet"} <= {*re.findall(r"<b\b[^>]*>(.*?)<", page)}
    assert page.count('class="none"') == page.count("<section") - page.count("<section>") == 1
    (style,) = re.findall(r"<style>(.*?)</style>", page, re.DOTALL)
    assert f"default-src 'none'; style-src {digest(style)};" in page


def test_all_formats_have_all_units(files: tuple[str, str], cli: Cli) -> None:
    document = cli("diff", *files, "--format", "json").json
    pairs = document["nearly_the_same"]
    kinds = [[(d["kind"], d["a"], d["b"]) for d in pair["differences"]] for pair in pairs]
    assert kinds == [[("state", "crushed", "broken & wet")], [("label", "tea", "cup")]]
    assert [unit["motion"] for unit in document["only_in_b"]] == ["eat"]
    rows = cli("diff", *files, "--format", "csv").out.splitlines()[1:]
    assert len(rows) == 5
    assert cli("diff", *files, "--level", "1", "--format", "json").json["in_both"] != []
    foon_asp.diff(files[0], Path(files[1])).write("diff.json")
    assert json.loads(Path("diff.json").read_text()) == document
    python = foon_asp.diff(foon_asp.load("a.txt", kitchen="@starting", level=2), "b.txt")
    assert python.json() == document | {"a": "a"}


def test_what_was_assumed_in_reading_is_said(files: tuple[str, str], cli: Cli) -> None:
    Path("a.txt").write_text(A.replace("S\tcubed", "S cubed"))
    assert "a.txt:2:2: warning: no tab after S" in cli("diff", *files).err


def test_a_merge_reports_what_it_kept_apart(files: tuple[str, str], cli: Cli) -> None:
    plain, reported = cli("merge", *files), cli("merge", *files, "--report")
    assert reported.out == plain.out
    assert "nearly the same, and kept apart: 1 pair\n\nA crush    [a.txt:1]" in reported.err
    assert "ice<b>: state 'crushed' in A, 'broken & wet' in B" in reported.err
    assert reported.err.endswith(plain.err)
