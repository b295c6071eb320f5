"""Tables as CSV and Markdown: the rows of the JSON, and cells that break neither."""

import csv
import io
from pathlib import Path

import pytest

import foon_asp
from foon_asp.report.frame import csv_text, markdown_text
from foon_asp.rules.constraint_library import library_constraints
from tests.conftest import Cli

EGG = {"node": "=egg; in [a|b]", "label": "egg"}
DOCUMENT = {
    "schema": "foon-asp/regret/1",
    "regrets": [
        {"item": EGG, "unit": None, "loss": {"exact": "1/2", "approx": 0.5}},
        {"item": None, "unit": {"id": 3, "units": [{"id": 1}]}, "loss": None, "proved": True, "ids": [1, 2]},
        {"item": None, "unit": None, "loss": 2},
    ],
}


def test_a_row_for_each_thing_that_is_listed() -> None:
    rows = [*csv.reader(io.StringIO(csv_text(DOCUMENT)))]
    assert rows == [
        ["item", "loss", "loss.approx", "unit.id", "proved", "ids"],
        ["'=egg; in [a|b]", "1/2", "0.5", "", "", ""],
        ["", "", "", "3", "yes", "1 + 2"],
        ["", "2", "2", "", "", ""],
    ]
    assert markdown_text(DOCUMENT).splitlines()[1:3] == [
        "| --- | --- | --- | --- | --- |",
        "| =egg; in [a\\|b] | 0.5 |  |  |  |",
    ]


@pytest.mark.parametrize(
    ("words", "rows"),
    [
        (("optima", "--goal", "ice"), 3),
        (("pareto", "--goal", "macaroni"), 3),
        (("regret", "--goal", "ice"), 6),
        (("units", "--unit", "3"), 1),
        (("solve", "--goal", "ice"), 2),
        (("search", "dfs", "--goal", "macaroni"), 10),
        (("trace", "TREE", "--goal", "ice"), 2),
        (("diff", "TREE", "solve --goal ice --objective success"), 5),
        (("stats",), 3),
        (("constraints",), len(library_constraints())),
        (("constraints", "--rule", ":- use(1)."), 1),
        (("lint", "SLIP"), 1),
    ],
)
def test_what_lists_things_has_tables(cli: Cli, tmp_path: Path, words: tuple[str, ...], rows: int) -> None:
    if "SLIP" in words:
        (tmp_path / "SLIP").write_text("//\nO egg\nM\tfry\nO\tomelette\n//\n", encoding="utf-8")
    if "TREE" in words:
        tree = cli("solve", "--goal", "ice", "--format", "foon").out
        (tmp_path / "TREE").write_text(tree, encoding="utf-8")
    words = tuple(str(tmp_path / word) if word in {"SLIP", "TREE"} else word for word in words)
    table = [*csv.reader(io.StringIO(cli(*words, "--format", "csv").out))]
    assert {*map(len, table)} == {len(table[0])}
    assert len(table) == 1 + rows
    lines = cli(*words, "--format", "markdown").out.splitlines()
    assert len(lines) == 2 + rows
    exact = [name for name in table[0] if not name.endswith(".approx")]
    assert {line.count("|") for line in lines} == {len(exact) + 1}


def test_goals_that_nobody_named_have_rows_in_one_table(cli: Cli, tmp_path: Path) -> None:
    recipe = tmp_path / "two.txt"
    recipe.write_text("//\nO\tegg\nM\tfry\nO\tomelette\nO\tpan\nS\tdirty\n//\n", encoding="utf-8")
    table = cli("solve", "--network", recipe, "--format", "csv").out.splitlines()
    assert [row.split(",")[0] for row in table] == ["goals", "omelette", "pan; dirty"]


def test_in_python_the_same(cli: Cli) -> None:
    front = foon_asp.pareto(foon_asp.load().problem("macaroni"))
    assert front.csv() == cli("pareto", "--goal", "macaroni", "--format", "csv").out
    assert front.markdown() == cli("pareto", "--goal", "macaroni", "--format", "markdown").out
