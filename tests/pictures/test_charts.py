"""Charts: what a reader finds in the one of compare, and how all of them are written."""

import re
import struct
import sys
from fractions import Fraction
from pathlib import Path
from xml.etree import ElementTree

import matplotlib as mpl
import pytest

from foon_asp.comparison.comparison import Comparison, SearchResult
from foon_asp.errors import UserError
from foon_asp.pictures.comparison_chart import write_comparison_chart
from foon_asp.problem import Objective
from foon_asp.proof.simulation import Verdict
from foon_asp.results.values import Node
from foon_asp.searches import Ending

SVG = "{http://www.w3.org/2000/svg}"
STRICT = "strict containers"
SEARCHES = ("bfs", "greedy $1 & <2>", "lost")


def goal(name: str, optimum: int, *trees: tuple[int, Verdict] | None) -> Comparison:
    judged = [
        SearchResult(search, Ending.STUCK)
        if tree is None
        else SearchResult(
            search,
            Ending.TREE,
            ratios={Objective.UNITS: Fraction(tree[0], optimum)},
            verdict=tree[1],
        )
        for search, tree in zip(SEARCHES, trees, strict=True)
    ]
    return Comparison(Node(None, name, name, (), (), ()), {}, tuple(judged))


GOALS = [
    goal("salad", 20, (30, Verdict.REORDERED), (15, Verdict.NEVER), None),
    goal("tea", 4, (4, Verdict.AS_LISTED), (8, Verdict.AS_LISTED), None),
    goal("ice", 2, (2, Verdict.AS_LISTED), None, None),
]


def points(file: Path) -> tuple[list[str], int]:
    """Return the texts of a chart, and count the points of goals, which are clipped to the axes."""
    root = ElementTree.parse(file).getroot()
    groups = [g for g in root.iter(f"{SVG}g") if g.get("id", "").startswith("PathCollection")]
    clipped = [g for group in groups for g in group.iter(f"{SVG}g") if "clip-path" in g.attrib]
    return [text.text or "" for text in root.iter(f"{SVG}text")], sum(
        len([*group.iter(f"{SVG}use")]) for group in clipped
    )


@pytest.mark.parametrize("times", [1, 100])
def test_each_search_has_its_figures_and_a_point_for_each_tree(times: int, tmp_path: Path) -> None:
    write_comparison_chart(GOALS * times, STRICT, tmp_path / "chart.svg")
    texts, drawn = points(tmp_path / "chart.svg")
    assert drawn == 5 * times
    for name in (*SEARCHES, *map(str, Verdict), "optimum", "mean 1.17", "median 1", "mean 1.38"):
        assert name in texts
    assert {f"{3 * times} trees", f"{2 * times} trees", "no tree to compare"} <= {*texts}
    assert {f"{3 * times} execute", f"{times} execute"} <= {*texts}
    assert any(text.endswith(f"{3 * times} goals (strict containers)") for text in texts)


@pytest.mark.parametrize("suffix", [".svg", ".png"])
def test_the_same_chart_is_the_same_file(suffix: str, tmp_path: Path) -> None:
    write_comparison_chart(GOALS, STRICT, tmp_path / f"one{suffix}")
    with mpl.rc_context({"font.size": 20, "lines.linewidth": 9, "axes.grid": False}):  # a user's own
        write_comparison_chart(GOALS, STRICT, tmp_path / f"two{suffix}")
    content = (tmp_path / f"one{suffix}").read_bytes()
    assert content == (tmp_path / f"two{suffix}").read_bytes()
    if suffix == ".png":
        assert struct.unpack(">II", content[16:24]) == (2145, 1260)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("chart.pdf", r"\.svg or \.png"),
        (".svg", r"\.svg or \.png"),
        ("nowhere/chart.svg", "cannot be written: No such file"),
    ],
)
def test_what_cannot_be_written_is_refused(name: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(UserError, match=message):
        write_comparison_chart(GOALS, STRICT, tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_without_matplotlib(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(UserError, match=re.escape("pip install 'foon-asp[pictures]'")):
        write_comparison_chart(GOALS, STRICT, tmp_path / "chart.svg")
