"""What is printed as a node is read back as the same node, on every road and whatever letters it has."""

import json
from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st

import foon_asp
from foon_asp.batch.question_file import read_questions
from foon_asp.errors import UserError
from foon_asp.foon import Foon
from foon_asp.network import FunctionalUnit, NetworkBuilder, NodePattern, ObjectNode, Source, UnitPrices
from foon_asp.results.plain_values import plain
from foon_asp.results.values_of import named_node
from foon_asp.text.line_parser import parse_name, parse_node
from foon_asp.text.node_lookup import find_goal, nodes_beginning
from foon_asp.text.object_list import ListedObject, read_object_list
from foon_asp.text.reader import FoonReader
from foon_asp.text.tables import PRICES, STAYS, read_stock
from foon_asp.text.unit_price_list import read_unit_prices, write_unit_prices
from tests.conftest import Cli
from tests.text.foon_strategies import steady

NOTHING = NetworkBuilder().build()

_letters = st.one_of(st.sampled_from("ab;,[]{}()\"\\'\t\n\r #@:->→\u2028\u200b"), st.characters())
_names = st.text(_letters, max_size=5) | st.sampled_from(
    ["contains", "in", "onion", "in [bowl]", "contains {a,b}", "//", "# a", "@makeable", "->", "::error::x"]
)
_held = st.tuples(_names, st.lists(_names, max_size=2))
_related = st.tuples(_names, _names)
NODES = st.builds(
    ObjectNode.of,
    _names,
    st.lists(_names, max_size=2),
    st.lists(_related, max_size=2),
    st.lists(_held, max_size=2),
)


def built(nodes: Iterable[ObjectNode]) -> Foon:
    """Make data of a network that also has the label of each node alone, and lists each label as a goal."""
    whole = dict.fromkeys(each for node in nodes for each in (node, ObjectNode(node.label)))
    foon = foon_asp.build([("mix", ["start"], [*whole])], kitchen=["start"])
    return Foon(foon.dataset.with_goals([_entry(NodePattern.of(node)) for node in nodes]), "nodes")


def _entry(pattern: NodePattern) -> ListedObject:
    return ListedObject(pattern, Source("goals.json", 1, 1))


@given(NODES)
@steady
def test_the_notation_of_any_node_is_one_line_and_is_read_back(node: ObjectNode) -> None:
    assert parse_node(str(node)) == parse_node(f"{node};") == node
    assert not set(str(node)) & set("\t\n\r\u2028\u200b")


@given(st.lists(NODES, min_size=1, max_size=3))
@steady
def test_a_printed_node_is_found_as_goal(nodes: list[ObjectNode]) -> None:
    foon = built(nodes)
    names, listed = foon.dataset.names, foon.dataset.goal_entries
    for node in nodes:
        assert names.node(find_goal(str(node), names, listed)) == node
        assert foon.problem(str(node)).goal_nodes == (node,)
        assert node in [names.node(o) for o in nodes_beginning(str(node), names, 9)]
        assert [*foon.dataset.command_goal_ids((str(node),))] == [names.object_id(node)]


@given(NODES)
@steady
def test_a_printed_node_is_read_from_files(node: ObjectNode) -> None:
    printed = str(node)
    with TemporaryDirectory() as folder:
        file = Path(folder) / "file"

        def written(text: str) -> Path:
            file.write_text(text, "utf-8", newline="")
            return file

        entries = read_object_list(written(json.dumps([printed, plain(named_node(NOTHING, node))])))
        assert [entry.pattern for entry in entries] == [NodePattern.of(node)] * 2
        assert PRICES.read(written(f"{printed}\t2\n")) == {parse_name(printed): 2}
        assert read_stock(written(f"{printed}\t3\n")) == {node: 3}
        assert STAYS.read(written(f"{printed}\tstays\n")) == {parse_name(printed): True}
        unit = FunctionalUnit.of("mix", [node], [ObjectNode("->")])
        prices = UnitPrices({}, {unit: Fraction(1)})
        assert read_unit_prices(written(write_unit_prices(prices))).units == prices.units
        (line,) = read_questions(written(json.dumps({"goal": printed}) + "\n"), None)
        assert line.goal == printed


@given(NODES)
@steady
def test_foon_text_holds_a_node_as_it_is_or_not_at_all(node: ObjectNode) -> None:
    unit = FunctionalUnit.of("mix", [node], [node])
    try:
        text = foon_asp.write_units([unit])
    except UserError:  # a name means something else there
        return
    reader = FoonReader()
    assert [found for found, _ in reader.tree_units(text, "a.txt")] == [unit]
    reader.raise_errors()


def test_an_answer_that_foon_text_cannot_hold_says_so(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "cell.jsonl").write_text(ATP)
    refused = cli("solve", tmp_path / "cell.jsonl", "--goal", "atp[c]", "--format", "foon")
    assert (refused.code, refused.out) == (2, "")
    assert "error: the object node '\"adp[c]\"' has a name that FOON text cannot hold" in refused.err


@pytest.mark.parametrize(
    ("node", "printed"),
    [
        (
            ObjectNode.of('3" pan, old', ["\\"], [], [("contains", ["b", "a"])]),
            '3" pan, old; \\; contains {a,b}',
        ),
        (ObjectNode.of("atp[c]"), '"atp[c]"'),
        (ObjectNode.of("a; b", [" x"]), '"a; b"; " x"'),
        (ObjectNode.of('"a"', ["t\tt"]), r'"\"a\""; "t\tt"'),
        (
            ObjectNode.of("pot", [], [("in", "a,b")], [("contains", ["a,b", "c"])]),
            'pot; in ["a,b"]; contains {"a,b",c}',
        ),
    ],
)
def test_a_name_is_in_quotes_only_where_it_would_mean_something_else(node: ObjectNode, printed: str) -> None:
    assert str(node) == printed


ATP = """{"id": "r1", "inputs": ["adp[c]", "b; c"], "outputs": ["atp[c]"]}
{"id": "r2", "inputs": ["atp[c]"], "outputs": ["d"]}
{"id": "r3", "inputs": ["d"], "outputs": ["d; s"]}
"""


@pytest.mark.parametrize("goal", ["atp[c]", '"atp[c]"', '"d; s"', "d; s", "d"])
def test_what_is_printed_as_goal_can_be_asked_for(cli: Cli, tmp_path: Path, goal: str) -> None:
    (tmp_path / "cell.jsonl").write_text(ATP)
    answered = cli("solve", tmp_path / "cell.jsonl", "--goal", goal)
    printed = next(line for line in answered.out.splitlines() if line.startswith("goal: "))
    again = cli("solve", tmp_path / "cell.jsonl", "--goal", printed.removeprefix("goal: "))
    assert (again.code, again.out) == (answered.code, answered.out) == (0, answered.out)


def test_a_node_comes_before_an_entry_of_the_goals_file_on_every_road(cli: Cli, tmp_path: Path) -> None:
    network, goals, asked, rows = (tmp_path / name for name in ("d.txt", "g.json", "q.jsonl", "rows.jsonl"))
    network.write_text("O\ta\nM\tx\nO\td\n//\nO\td\nM\ty\nO\td\nS\ts\n//\n")
    goals.write_text(json.dumps([{"label": "d", "states": ["s"]}]))
    asked.write_text('{"goal": "d"}\n{"goal": "d; s"}\n{"goal": "@goals"}\n')
    data = (network, "--goals", goals)
    for goal, units in (("d", 1), ("d;", 1), ("d; s", 2)):
        assert cli("solve", *data, "--goal", goal, "--format", "json").json["costs"]["units"] == units
        problem = foon_asp.load(network, goals=goals, kitchen="@starting").problem(goal)
        assert len(foon_asp.solve(problem).tree or ()) == units
    assert cli("solve", *data, "--format", "json").json["costs"]["units"] == 2
    assert cli("batch", asked, *data, "--results", rows).code == 0
    found = [json.loads(line) for line in rows.read_text().splitlines()]
    assert {row["goal"]: row["costs"]["units"] for row in found if "costs" in row} == {"d": 1, "d; s": 2}


def test_a_shell_completes_names_in_quotes(cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "cell.jsonl").write_text(ATP)
    for begun in ("at", "'\"at"):
        monkeypatch.setenv("FOON_ASP_LINE", f"foon-asp solve {tmp_path}/cell.jsonl --goal {begun}")
        monkeypatch.setenv("_FOON_ASP_COMPLETE", "fish_complete")
        assert cli().out.splitlines() == ['"atp[c]"']
