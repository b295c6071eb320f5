"""The bar chart: what a reader finds in it, and how it is written."""

import builtins
import os
import re
import struct
import sys
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree

import matplotlib as mpl
import pytest

from foon_asp.errors import UserError
from foon_asp.report.bar_chart import Bar, BarChart, BarGroup, write_chart

SVG = "{http://www.w3.org/2000/svg}"
SEARCHES = ("BFS", "DFS", "greedy $1 & <2>")
OPTIMUM = "the optimum"
BLUE, ORANGE, GREEN, BLACK = "#0072b2", "#e69f00", "#009e73", "#000000"


def group(goal: str, *trees: tuple[int | None, str]) -> BarGroup:
    return BarGroup(
        goal, tuple(Bar(name, *tree) for name, tree in zip((*SEARCHES, OPTIMUM), trees, strict=True))
    )


CHART = BarChart(
    "Sizes of task trees",
    (
        group("greek salad", (28, "reordered"), (35, "never"), (31, "as listed"), (28, "as listed")),
        group("macaroni", (7, "as listed"), (7, "as listed"), (5, "never"), (7, "as listed")),
        group("sweet potato; chopped, cooked; in [cutting board]", *[(None, "none")] * 4),
        group("ice", *[(1, "as listed")] * 4),
    ),
    OPTIMUM,
)


def large(groups: int) -> BarChart:
    return CHART._replace(groups=tuple(CHART.groups[n % 4]._replace(goal=f"goal {n}") for n in range(groups)))


class Drawing:
    """The parts of a chart as an SVG has them, in the order in which they are drawn."""

    def __init__(self, chart: BarChart, file: Path) -> None:
        write_chart(chart, file)
        root = ElementTree.parse(file).getroot()
        self.width, self.height = (
            float(root.attrib[name].removesuffix("pt")) for name in ("width", "height")
        )
        texts = [(style(text), text.text or "") for text in root.iter(f"{SVG}text")]
        self.texts = [text for _, text in texts]
        values = [(look, text) for look, text in texts if look["font-size"] == "7px"]
        self.values = [text for _, text in values]
        self.strong = [text for look, text in values if look.get("font-weight") == "700"]
        self.crosses = [look["fill"] for look, text in texts if text == "×"]
        # What is clipped to the axes is a bar or a line of the grid; only bars are filled.
        clipped = [style(path) for path in root.iter(f"{SVG}path") if "clip-path" in path.attrib]
        self.bars = [(look["stroke"], look["fill"]) for look in clipped if look["fill"] != "none"]


def style(element: ElementTree.Element) -> dict[str, str]:
    """Give the style of an element of an SVG, which is filled black where it does not say."""
    return {"fill": BLACK, **dict(part.split(": ") for part in element.attrib["style"].split("; "))}


@pytest.fixture(scope="module")
def drawing(tmp_path_factory: pytest.TempPathFactory) -> Drawing:
    return Drawing(CHART, tmp_path_factory.mktemp("chart") / "chart.svg")


@pytest.mark.slow
def test_title_goals_series_and_ways_are_named(drawing: Drawing) -> None:
    together = " ".join(drawing.texts)
    for name in (CHART.title, OPTIMUM, *SEARCHES, *(group.goal for group in CHART.groups)):
        assert name in together
    ways = {"executes as listed", "executes when reordered", "never executes", "no tree"}
    assert ways < set(drawing.texts)


def test_every_bar_has_its_number(drawing: Drawing) -> None:
    assert drawing.values == ["28", "35", "31", "28", "7", "7", "5", "7", "1", "1", "1", "1"]
    assert drawing.strong == ["28", "7", "1"], "those of the optimum"
    assert len(drawing.bars) == len(drawing.values)


def test_a_series_has_one_color_and_the_optimum_black(drawing: Drawing) -> None:
    assert [color for color, _ in drawing.bars] == [BLUE, ORANGE, GREEN, BLACK] * 3
    assert drawing.crosses == [BLUE, ORANGE, GREEN, BLACK]


def test_a_bar_shows_how_its_tree_executes(drawing: Drawing) -> None:
    filled = ["hatched" if fill.startswith("url(") else fill for _, fill in drawing.bars]
    assert filled[:4] == ["hatched", "#ffffff", GREEN, BLACK]
    assert filled[4:8] == [BLUE, ORANGE, "#ffffff", BLACK]


def test_the_place_of_a_series_without_a_bar_stays_empty(tmp_path: Path) -> None:
    groups = (CHART.groups[0], CHART.groups[1]._replace(bars=CHART.groups[1].bars[1:]))
    drawn = Drawing(CHART._replace(groups=groups), tmp_path / "chart.svg")
    assert [color for color, _ in drawn.bars] == [BLUE, ORANGE, GREEN, BLACK, ORANGE, GREEN, BLACK]


def test_numbers_of_the_axis_are_whole(tmp_path: Path) -> None:
    drawn = Drawing(CHART._replace(groups=CHART.groups[3:]), tmp_path / "chart.svg")
    axis = [text for text in drawn.texts if re.fullmatch(r"[\d.]+", text)]
    assert Counter(axis) == {"0": 1, "1": 1 + 4}, "two ticks and four bars"


def test_long_numbers_stand_upright(tmp_path: Path) -> None:
    chart = CHART._replace(groups=(group("pizza", *[(123, "as listed")] * 4),))
    write_chart(chart, tmp_path / "chart.svg")
    upright = re.findall(r"rotate\(-90\b[^>]*>123<", (tmp_path / "chart.svg").read_text(encoding="utf-8"))
    assert len(upright) == 4


@pytest.mark.slow
def test_the_figure_grows_to_the_width_of_a_page_and_then_in_rows(tmp_path: Path) -> None:
    three, six, fifteen = (Drawing(large(n), tmp_path / f"{n}.svg") for n in (3, 6, 15))
    assert three.width < six.width
    assert three.height == pytest.approx(six.height, abs=20)
    assert fifteen.width <= 7.2 * 72
    assert fifteen.height > 1.5 * six.height
    assert {f"goal {n}" for n in range(15)} < set(fifteen.texts)
    assert len(fifteen.bars) == 4 * 15 - len(fifteen.crosses)


@pytest.mark.parametrize("suffix", [".svg", ".png"])
def test_the_same_chart_is_the_same_file(suffix: str, tmp_path: Path) -> None:
    write_chart(CHART, tmp_path / f"one{suffix}")
    with mpl.rc_context({"font.size": 20, "lines.linewidth": 9, "axes.grid": False}):  # a user's own
        write_chart(CHART, tmp_path / f"two{suffix}")
    assert (tmp_path / f"one{suffix}").read_bytes() == (tmp_path / f"two{suffix}").read_bytes()


def test_matplotlib_is_left_as_it_was(tmp_path: Path) -> None:
    before = mpl.rcParams.copy()
    write_chart(CHART, tmp_path / "chart.svg")
    after = mpl.rcParams.copy()
    assert [name for name in before if name != "backend" and after[name] != before[name]] == []
    assert "matplotlib.pyplot" not in sys.modules


def test_png(tmp_path: Path) -> None:
    file = tmp_path / "chart.PNG"
    write_chart(CHART, file)
    picture = file.read_bytes()
    assert picture.startswith(b"\x89PNG\r\n\x1a\n")
    width, height = struct.unpack(">II", picture[16:24])
    drawn = Drawing(CHART, tmp_path / "chart.svg")
    assert (width, height) == pytest.approx((drawn.width / 72 * 300, drawn.height / 72 * 300), abs=1)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["chart.PNG", "chart.svg"]


@pytest.mark.parametrize("name", ["chart.pdf", "chart", ".svg"])
def test_another_suffix_is_refused(name: str, tmp_path: Path) -> None:
    with pytest.raises(UserError, match=r"\.svg or \.png"):
        write_chart(CHART, tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_what_cannot_be_drawn_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="no goal"):
        write_chart(CHART._replace(groups=()), tmp_path / "chart.svg")
    bars = tuple(Bar(f"search {n}", 3, "as listed") for n in range(8))
    with pytest.raises(UserError, match="at most 7 searches"):
        write_chart(CHART._replace(groups=(BarGroup("ice", bars),)), tmp_path / "chart.svg")
    assert not list(tmp_path.iterdir())


def test_without_matplotlib(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    there = builtins.__import__

    def missing(name: str, *rest: object) -> object:
        if name.partition(".")[0] == "matplotlib":
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
        return there(name, *rest)  # type: ignore[arg-type]

    monkeypatch.setattr(builtins, "__import__", missing)
    with pytest.raises(UserError, match=re.escape("pip install 'foon-asp[pictures]'")):
        write_chart(CHART, tmp_path / "chart.svg")
    assert not list(tmp_path.iterdir())


def test_a_file_that_cannot_be_written(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="cannot be written: No such file"):
        write_chart(CHART, tmp_path / "nowhere" / "chart.svg")
    (tmp_path / "folder.svg").mkdir()
    with pytest.raises(UserError, match=r"folder\.svg: cannot be written"):
        write_chart(CHART, tmp_path / "folder.svg")
    assert [path.name for path in tmp_path.iterdir()] == ["folder.svg"]


def test_a_failure_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "chart.svg"
    file.write_text("the old one", encoding="utf-8")

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(UserError, match="No space left on device"):
        write_chart(CHART, file)
    assert file.read_text(encoding="utf-8") == "the old one"
    assert list(tmp_path.iterdir()) == [file]
