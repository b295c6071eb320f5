"""``foon-asp diff-network`` and ``merge --report``: what two networks have in common."""

import random
import re
from fractions import Fraction
from html.parser import HTMLParser
from pathlib import Path

import pytest
from hypothesis import given, settings

import foon_asp
from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, node_at_level, unit_at_level
from foon_asp.network.near_units import nearest_units, unit_differences, units_kept_apart
from foon_asp.report.page import digest
from foon_asp.text.line_parser import parse_node
from foon_asp.text.writer import write_units
from tests.conftest import Cli
from tests.text.foon_strategies import steady, units

pytestmark = pytest.mark.sampled(2)  # by default each second case of a test: there are many


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


@pytest.mark.slow
@settings(steady, max_examples=40)
@given(left=units(), right=units())
def test_pairs_are_of_different_units_each_once(
    left: list[FunctionalUnit], right: list[FunctionalUnit]
) -> None:
    ours, theirs = [u for u in left if u not in right], [u for u in right if u not in left]
    pairs = nearest_units(ours, theirs)
    assert len({pair.left for pair in pairs}) == len({pair.right for pair in pairs}) == len(pairs)
    for pair in pairs:
        assert pair.left in ours
        assert pair.right in theirs
        assert 1 <= len(pair.differences) <= 3
    for here, there in zip(left, left[::-1], strict=True):
        assert (unit_differences(here, there) == ()) == (here == there)


def test_planted_changes_are_found_again() -> None:
    network = foon_asp.load().dataset.data.network
    before = [network.unit(u) for u in range(len(network))]
    rng = random.Random(7)
    planted = {}
    for place in rng.sample(range(len(before)), 30):
        old = before[place]
        new = FunctionalUnit.of(f"{old.motion} slowly", old.inputs, old.outputs)
        planted[old] = new
    gone = set(rng.sample(sorted(range(len(before)), key=lambda u: before[u] in planted)[:150], 20))
    left = [u for u in before if u in planted]
    left += [before[place] for place in gone]
    pairs = {pair.left: pair.right for pair in nearest_units(left, list(planted.values()))}
    assert pairs == planted


def test_units_kept_apart_differ_in_one_thing() -> None:
    listed = [
        CHOP,
        unit("dice: onion; whole + knife → onion; chopped + knife"),  # another motion
        unit("chop: onion; whole + knife → onion; chopped; wet + knife"),  # one state more
        unit("chop: leek; whole + knife → leek; chopped + knife"),  # another thing
        unit("chop: onoin; whole + knife → onoin; chopped + knife"),  # a slip
    ]
    found = [
        (listed.index(p.left), listed.index(p.right), *p.differences[0][:3]) for p in units_kept_apart(listed)
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
    found = foon_asp.diff_networks(*files)
    for level in (1, 2, 3):
        one, other = ({unit_at_level(u, level) for u in side} for side in (left, right))
        agreement = found.units[level]
        assert (agreement.left, agreement.right, agreement.both) == (len(one), len(other), len(one & other))
        assert agreement.jaccard == (Fraction(len(one & other), len(one | other)) if one | other else 1)
        nodes = [
            {node_at_level(n, level) for u in side for n in (*u.inputs, *u.outputs)} for side in (left, right)
        ]
        assert found.nodes[level].both == len(nodes[0] & nodes[1])
    total = {*left, *right}
    near = [u for pair in found.near for u in (pair.left, pair.right)]
    assert sorted(map(str, (*found.only_left, *found.only_right, *near, *found.both))) == sorted(
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


class Tags(HTMLParser):
    """What a page is made of, and what it marks."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: set[str] = set()
        self.marked: list[str] = []
        self._in_mark = False
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.tags.add(tag)
        self._in_mark = tag == "b"

    def handle_data(self, data: str) -> None:
        self.marked += [data] if self._in_mark else []
        self._in_mark = False


def test_a_page_has_two_columns_and_runs_nothing(files: tuple[str, str], cli: Cli) -> None:
    assert cli("diff-network", *files, "-o", "page.html").code == 0
    page = Path("page.html").read_text(encoding="utf-8")
    assert page == cli("diff-network", *files, "--format", "html").out
    parsed = Tags(page)
    assert "script" not in parsed.tags
    assert {"crushed", "broken & wet"} <= {*parsed.marked}
    assert page.count('class="none"') == page.count("<section") - page.count("<section>") == 1
    (style,) = re.findall(r"<style>(.*?)</style>", page, re.DOTALL)
    assert f"default-src 'none'; style-src {digest(style)};" in page


def test_all_formats_have_all_units(files: tuple[str, str], cli: Cli) -> None:
    document = cli("diff-network", *files, "--format", "json").json
    pairs = document["nearly_the_same"]
    kinds = [[(d["kind"], d["a"], d["b"]) for d in pair["differences"]] for pair in pairs]
    assert kinds == [[("state", "crushed", "broken & wet")], [("label", "tea", "cup")]]
    assert [unit["motion"] for unit in document["only_in_b"]] == ["eat"]
    rows = cli("diff-network", *files, "--format", "csv").out.splitlines()[1:]
    assert len(rows) == 5
    assert cli("diff-network", *files, "--level", "1", "--format", "json").json["in_both"] != []
    python = foon_asp.diff_networks(foon_asp.load("a.txt", kitchen="@starting"), "b.txt")
    assert repr(python) == "<NetworkDifference: 0 only left, 1 only right, 2 nearly the same, 0 in both>"


@pytest.mark.parametrize("level", ["0", "4"])
def test_there_are_three_levels(files: tuple[str, str], cli: Cli, level: str) -> None:
    assert cli("diff-network", *files, "--level", level).code == 2


def test_what_was_assumed_in_reading_is_said(files: tuple[str, str], cli: Cli) -> None:
    Path("a.txt").write_text(A.replace("S\tcubed", "S cubed"))
    assert "a.txt:2:2: warning: no tab after S" in cli("diff-network", *files).err


def test_data_of_another_level_are_refused(files: tuple[str, str]) -> None:
    with pytest.raises(UserError, match="found data of level 2, expected level 3"):
        foon_asp.diff_networks(foon_asp.load("a.txt", kitchen="@starting", level=2), "b.txt")


def test_a_merge_reports_what_it_kept_apart(files: tuple[str, str], cli: Cli) -> None:
    plain, reported = cli("merge", *files), cli("merge", *files, "--report")
    assert reported.out == plain.out
    assert "nearly the same, and kept apart: 1 pair\n\nA crush    [a.txt:1]" in reported.err
    assert "ice<b>: state 'crushed' in A, 'broken & wet' in B" in reported.err
    assert reported.err.endswith(plain.err)
