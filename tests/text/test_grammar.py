"""The tables of the grammar against the grammar."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given
from lark import Lark

from foon_asp.text import grammar, line_builder
from foon_asp.text.clean_line import clean_line, clean_node
from tests.text.foon_strategies import dirty_lines, names, nodes
from tests.text.grammar_tables import tables


def test_the_tables_are_those_of_the_grammar() -> None:
    """After a change of the grammar: ``make tables``."""
    assert json.loads(grammar.TABLES.read_text())["made_of"][1] == grammar.made_of()[1]


READ = """
import sys
from pathlib import Path
import foon_asp
from foon_asp.text import grammar
grammar.TABLES = Path(sys.argv[1])
lines = ["O onion", "O\t", "S\tcontains [salt", "S\tin [bowl}", "S\t[bowl]", "M\tpour*\tAssume", "X\ty"]
print(*(repr(foon_asp.FoonReader().parse(line)) for line in lines), repr(foon_asp.parse_node("a; b; in [c]")))
"""


def test_tables_read_what_the_grammar_reads(tmp_path: Path) -> None:
    fresh, other = tmp_path / "fresh.json", tmp_path / "other.json"
    fresh.write_text(tables())
    other.write_text(json.dumps({"made_of": ["another Lark", "another grammar"]}))
    told = [
        subprocess.run([sys.executable, "-c", READ, file], capture_output=True, text=True, check=True).stdout
        for file in (grammar.TABLES, fresh, other)
    ]
    assert told[0] == told[1] == told[2]
    assert "Relation(word='in', object='bowl')" in told[0]


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
