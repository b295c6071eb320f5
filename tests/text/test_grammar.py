"""Lines and labels that need no parser against the grammar."""

from hypothesis import given

from foon_asp.text.clean_line import clean_line, clean_node
from foon_asp.text.line_builder import parse_by_grammar
from tests.text.foon_strategies import dirty_lines, names, nodes


@given(dirty_lines())
def test_a_clean_line_means_what_its_tokens_do(text: str) -> None:
    clean = clean_line(text)
    assert clean is None or clean == parse_by_grammar("line", text + "\n")


@given(names() | nodes().map(str))
def test_a_label_alone_is_a_node_as_its_token_says(notation: str) -> None:
    clean = clean_node(notation)
    assert clean is None or clean == parse_by_grammar("node", notation)


def test_most_labels_are_nodes_without_a_parser() -> None:
    assert clean_node(" greek  salad") == parse_by_grammar("node", " greek  salad")
    assert [clean_node(text) for text in ("tea;", "tea; hot", r"a\;b", "[tea]", "", " ")] == [None] * 6
