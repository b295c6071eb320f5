"""Tables as CSV and Markdown, of the rows of the JSON, and stacked where a terminal is narrow."""

import csv
import io
from pathlib import Path

import pytest
from rich.console import Console

import foon_asp
from foon_asp.network.statistics import count
from foon_asp.questions.result import Result
from foon_asp.report.constraint_list import constraints_text
from foon_asp.report.frame import csv_text, markdown_text
from foon_asp.report.stacked import folded, room
from foon_asp.report.statistics_table import statistics_text
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


def test_a_table_for_people_has_no_empty_columns_and_rounds(cli: Cli) -> None:
    headings, _, row, *_ = cli("optima", "--goal", "greek salad", "--format", "markdown").out.splitlines()
    cells = dict(zip(headings.split(" | "), row.split(" | "), strict=True))
    assert (cells["costs.units"], cells["costs.success"]) == ("29", "0.119151")
    assert not {"| schema", "stopped", "costs.price"} & cells.keys()
    assert markdown_text({"schema": "foon-asp/lint/1", "findings": []}) == ""


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
    filled = [name for name, *cells in zip(*table, strict=True) if any(cells)]
    exact = [name for name in filled if name != "schema" and not name.endswith(".approx")]
    assert {line.count("|") for line in lines} == {len(exact) + 1}


def test_goals_that_nobody_named_have_rows_in_one_table(cli: Cli, tmp_path: Path) -> None:
    recipe = tmp_path / "two.txt"
    recipe.write_text("//\nO\tegg\nM\tfry\nO\tomelette\nO\tpan\nS\tdirty\n//\n", encoding="utf-8")
    table = cli("solve", "--network", recipe, "--format", "csv").out.splitlines()
    assert [row.split(",")[0] for row in table] == ["goals", "omelette", "pan; dirty"]


@pytest.mark.slow
def test_in_python_the_same(cli: Cli) -> None:
    front = foon_asp.pareto(foon_asp.load().problem("macaroni"))
    assert front.csv() == cli("pareto", "--goal", "macaroni", "--format", "csv").out
    assert front.markdown() == cli("pareto", "--goal", "macaroni", "--format", "markdown").out


def shown(result: Result, columns: int) -> list[str]:
    """Give what a terminal shows, without blanks at the ends of lines."""
    with room(columns):
        drawn = result.renderable() or result.text().rstrip()
    console = Console(file=io.StringIO(), width=columns, color_system=None)
    with console.capture() as captured:
        console.print(drawn, markup=False, highlight=False)
    return [line.rstrip() for line in captured.get().splitlines()]


def test_a_narrow_terminal_shows_a_block_for_each_row() -> None:
    problem = foon_asp.load().problem("macaroni")
    best = shown(foon_asp.optima(problem), 60)
    assert best[2:8] == [
        "goal: macaroni",
        "best by: units, inputs",
        "units: 9",
        "inputs: 21",
        "success: 0.4988",
        "status: optimal",
    ]
    judged = shown(foon_asp.compare_searches(problem, ["bfs"]), 74)
    assert judged[-7:-2] == [
        "search: bfs",
        "units: 10  1.11×",
        "inputs: 24  1.14×",
        "success: 0.5955  0.95×",
        "executes: when reordered",
    ]
    front = shown(foon_asp.pareto(problem), 60)
    assert front[-4:] == [
        "point: 3",
        "units: 11",
        "success: ≈ 0.6293",
        "changes: - fill, heat  + fill, switch on, pour",
    ]
    assert "beyond: above 0.8075 (+15.3 %): - twist, pound, pour  +" in shown(
        foon_asp.sensitivity(foon_asp.load().problem("ice")), 60
    )
    helped = shown(foon_asp.assist(foon_asp.load().problem("ice")), 60)
    assert "the person takes: + 27 crush" in helped
    network = foon_asp.load().network
    with room(60):
        assert max(map(len, constraints_text(library_constraints()[:2]).splitlines()[1:4])) <= 60
        assert max(map(len, statistics_text(network, [count(network)], False).splitlines()[3:38])) <= 60


def test_lists_are_folded_to_the_terminal() -> None:
    foon = foon_asp.load()
    results = [
        foon_asp.regret(foon.problem("macaroni"), "success", motions="pour", pairs=True),
        foon_asp.menu(foon.problem("ice", "tea")),
        foon_asp.retrieve(foon.problem("macaroni"), "bfs"),
    ]
    for result in results:
        text = result.text()
        with room(40):
            lines = folded(text).splitlines()
        assert len(lines) > len(text.splitlines())
        assert [line for line in lines if len(line) > 40 and " " in line.strip()] == []  # a path may be long
        assert " ".join("\n".join(lines).split()) == " ".join(text.split())
        assert folded(text) == text  # where there is no terminal
    with room(30):
        assert folded(" 10  simmer    [data/FOON.txt:20] x") == " 10  simmer\n       [data/FOON.txt:20] x"


def test_what_stands_over_and_under_a_table_is_not_folded_to_it() -> None:
    shown_lines = shown(foon_asp.optima(foon_asp.load().problem("ice")), 120)
    assert shown_lines[0] == "The best task trees (strict containers)"
    assert shown_lines[-1] == "optimal: proved best by the objective named"  # and no status that no row has
    shown_lines = shown(foon_asp.optima(foon_asp.load().problem("ice", "apple pie")), 120)
    assert shown_lines[-2:] == [
        "optimal: proved best by the objective named",
        "infeasible: proved that no tree exists",
    ]


def test_at_75_columns_tables_are_tables() -> None:
    problem = foon_asp.load().problem("macaroni")
    front = foon_asp.pareto(problem)
    assert shown(front, 75)[-5:] == front.text().splitlines()[-5:]
    assert any(line.startswith("macaroni units, inputs") for line in shown(foon_asp.optima(problem), 75))
