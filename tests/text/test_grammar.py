"""The tables of the grammar against the grammar."""

import json
from pathlib import Path

import pytest
from hypothesis import given
from lark import Lark

from foon_asp.resources import bundled_kitchen
from foon_asp.text import grammar, line_builder
from foon_asp.text.clean_line import CLEAN, clean_line, clean_node
from foon_asp.text.line import LineError
from tests.text.foon_strategies import dirty_lines, names, nodes
from tests.text.grammar_tables import tables

# what is written as it should be, what is mended, and what is refused, of every kind
LINES = [
    "O278\tmixing bowl\t1",
    "O\tonion \t01\t15",
    "O onion",
    "O",
    "S\tin\t[bowl]",
    "S41\tempty ",
    "S23\tcontains\t{salt,sugar}",
    "S\tcontains [salt",
    "S\tin [bowl}",
    "S\t[bowl]",
    "M54\tpour*\t1:10\t1:11",
    "M\tpour\tAssume\tRobot\t0.85",
    "M",
    "X\tonion",
    "",
]
NODES = [
    "sweet potato; chopped; in [cutting board]",
    "bowl; contains {a,b};",
    r"a\;b; c",
    "bowl; [in",
    ";",
    "",
]


def read(text: str, node: bool) -> object:
    try:
        return line_builder.build("node" if node else "lines", text if node else f"{text}\n")
    except LineError as error:
        return error.column, error.found, error.expected


def everything() -> list[object]:
    grammar._tables.cache_clear()
    line_builder._parser.cache_clear()
    kitchen = (bundled_kitchen() / "FOON.txt").read_text(encoding="utf-8").splitlines()
    return [
        line_builder._parser().options.lexer,
        grammar.patterns([*CLEAN, "NAME"]),
        *(read(text, node=False) for text in LINES),
        *(read(text, node=True) for text in NODES),
        *(str(line_builder.build("lines", f"{text}\n")) for text in kitchen if text[:1] in "OSM"),
    ]


def test_the_tables_are_those_of_the_grammar() -> None:
    """After a change of the grammar: ``make tables``."""
    assert json.loads(grammar.TABLES.read_text())["made_of"][1] == grammar.made_of()[1]


def test_tables_read_what_the_grammar_reads(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fresh = tmp_path / "tables.json"
    fresh.write_text(tables())
    monkeypatch.setattr(grammar, "TABLES", fresh)
    by_tables = everything()
    fresh.write_text(json.dumps({"made_of": ["another Lark", "another grammar"]}))
    by_grammar = everything()
    grammar._tables.cache_clear()
    line_builder._parser.cache_clear()
    assert by_tables == by_grammar
    assert len(by_tables) > len(LINES) + len(NODES) + 100


@pytest.fixture(scope="module")
def token_by_token() -> Lark:
    """The grammar without the tokens that are a whole line each."""
    text = grammar.GRAMMAR.read_text(encoding="utf-8")
    without = text.replace("lines: (clean | ", "lines: (")
    assert without != text
    return Lark(without, start="lines", parser="lalr", transformer=line_builder._LineBuilder())


@given(dirty_lines())
def test_a_clean_line_means_what_its_tokens_do(token_by_token: Lark, text: str) -> None:
    clean = clean_line(text)
    assert clean is None or [clean] == token_by_token.parse(text + "\n")


@given(names() | nodes().map(str))
def test_a_label_alone_is_a_node_as_its_token_says(notation: str) -> None:
    clean = clean_node(notation)
    assert clean is None or clean == line_builder.build("node", notation)


def test_most_labels_are_nodes_without_a_parser() -> None:
    assert clean_node(" greek  salad") == line_builder.build("node", " greek  salad")
    assert [clean_node(text) for text in ("tea;", "tea; hot", r"a\;b", "[tea]", "", " ")] == [None] * 6
