"""Tables as CSV and Markdown, of the rows of the JSON, and stacked where a terminal is narrow."""

import csv
import io
from pathlib import Path

import pytest

import foon_asp
from foon_asp.questions.constraint_list import list_constraints
from foon_asp.questions.result import Result
from foon_asp.results.table import blocks_text
from foon_asp.results.table_columns import csv_text, flat_row, markdown_text
from tests.conftest import Cli
from tests.questions.recipes import posed

THREE = ["units", "inputs", "success"]
EGG = {"node": "=egg; in [a|b]", "label": "egg"}
ROWS: list[dict[str, object]] = [
    {"item": EGG, "unit": None, "loss": {"exact": "1/2", "approx": 0.5}},
    {"item": None, "unit": {"id": 3, "units": [{"id": 1}]}, "loss": None, "proved": True, "ids": [1, 2]},
    {"item": None, "unit": None, "loss": 2},
]


def test_a_row_for_each_thing_that_is_listed() -> None:
    rows = [*csv.reader(io.StringIO(csv_text(map(flat_row, ROWS))))]
    assert rows == [
        ["item", "loss", "loss_exact", "unit.id", "proved", "ids"],
        ["'=egg; in [a|b]", "0.5", "1/2", "", "", ""],
        ["", "", "", "3", "true", "1 + 2"],
        ["", "2", "2", "", "", ""],
    ]
    assert markdown_text(map(flat_row, ROWS)).splitlines()[1:3] == [
        "| --- | --- | --- | --- | --- |",
        "| =egg; in [a\\|b] | 0.5 |  |  |  |",
    ]


def test_a_table_for_people_has_no_empty_columns_and_rounds(cli: Cli) -> None:
    headings, _, row, *_ = cli(
        "solve", "--all-goals", "--goal", "greek salad", "--format", "markdown"
    ).out.splitlines()
    cells = dict(zip(headings.split(" | "), row.split(" | "), strict=True))
    assert (cells["costs.units"], cells["costs.success"]) == ("29", "0.119151")
    assert not {"| schema", "stopped", "costs.price"} & cells.keys()
    assert markdown_text([]) == ""


@pytest.mark.parametrize(
    ("words", "rows"),
    [
        (("solve", "--goal", "ice"), 2),
        (("compare", "--search", "dfs", "--search", "ids", "--goal", "macaroni"), 2),
        (("stats", "--unit", "3"), 1),
        (("trace", "TREE", "--goal", "ice"), 2),
        (("diff", "TREE", "SLIP", "--goal", "ice"), 3),
        (("constraints", "--rule", ":- use(1)."), 1),
        (("lint", "SLIP"), 1),
    ],
)
def test_what_lists_things_has_tables(cli: Cli, tmp_path: Path, words: tuple[str, ...], rows: int) -> None:
    tree, slip = tmp_path / "TREE", tmp_path / "SLIP"
    tree.write_text(cli("solve", "--goal", "ice", "--format", "foon").out, encoding="utf-8")
    slip.write_text("//\nO egg\nM\tfry\nO\tomelette\n//\n", encoding="utf-8")
    words = tuple(str(tmp_path / word) if word in {"TREE", "SLIP"} else word for word in words)
    table = [*csv.reader(io.StringIO(cli(*words, "--format", "csv").out))]
    assert [len(row) for row in table] == [len(table[0])] * (1 + rows)
    lines = cli(*words, "--format", "markdown").out.splitlines()
    filled = [name for name, *cells in zip(*table, strict=True) if any(cells)]
    exact = [name for name in filled if name != "schema" and not name.endswith("_exact")]
    assert [line.count("|") for line in lines] == [len(exact) + 1] * (2 + rows)


def test_goals_that_nobody_named_have_rows_in_one_table(cli: Cli, tmp_path: Path) -> None:
    recipe = tmp_path / "two.txt"
    recipe.write_text("//\nO\tegg\nM\tfry\nO\tomelette\nO\tpan\nS\tdirty\n//\n", encoding="utf-8")
    table = cli("solve", "--network", recipe, "--format", "csv").out.splitlines()
    assert [row.split(",")[0] for row in table] == ["goals", "omelette", "pan; dirty"]


def shown(result: Result, columns: int) -> list[str]:
    """Return what a terminal shows."""
    return blocks_text(result.show(), columns).splitlines()


def test_a_narrow_terminal_shows_a_block_for_each_row() -> None:
    foon = foon_asp.load()
    problem, ice = foon.problem("macaroni"), foon.problem("ice")
    best = shown(foon_asp.solve_all_goals(problem, THREE), 60)
    block = ["goal: macaroni", "best by: units, inputs", "units: 9", "inputs: 21", "success: 0.4988"]
    assert best[2:8] == [*block, "status: optimal"]
    judged = shown(foon_asp.compare(problem, ["bfs"]), 74)
    assert judged[-9:-3] == [
        *("search: bfs", "units: 10  1.11×", "inputs: 24  1.14×"),
        *("success: 0.5955  0.95×", "executes: when reordered", "used up: yes"),
    ]
    front = shown(foon_asp.pareto(problem), 60)
    changes = "units that go (-) and come (+): - fill, heat  + fill, switch"
    assert front[-5:] == ["point: 3", "units: 11", "success: ≈ 0.6293", changes, "  on, pour"]
    beyond = "beyond: +15.3 %: - twist, pound, pour  + twist, crush"
    assert beyond in blocks_text(foon_asp.sensitivity(ice).show(), 60).splitlines()
    assert "the person takes: + 27 crush" in blocks_text(foon_asp.assist(ice).show(), 60).splitlines()
    # where there is room, a table
    assert shown(foon_asp.pareto(problem), 75)[-5:] == foon_asp.pareto(problem).text().splitlines()[-5:]
    assert any(
        line.startswith("macaroni  units, inputs")
        for line in shown(foon_asp.solve_all_goals(problem, THREE), 75)
    )


def test_tables_of_commands_are_as_narrow_as_the_terminal() -> None:
    parts = [*foon_asp.stats(foon_asp.load()).show(), *list_constraints().show()]
    assert max(map(len, blocks_text(parts, 60).splitlines())) <= 60


def test_lists_are_folded_to_the_terminal() -> None:
    foon = foon_asp.load()
    for result in (foon_asp.solve(foon.problem("ice", "tea")), foon_asp.search(foon.problem("ice"), "bfs")):
        text = result.text()
        lines = blocks_text(text.split("\n"), 40).splitlines()
        assert len(lines) > len(text.splitlines())
        assert [line for line in lines if len(line) > 40 and " " in line.strip()] == []  # a path may be long
        assert " ".join("\n".join(lines).split()) == " ".join(text.split())
    step = " 10  simmer    [data/FOON.txt:20] x"
    assert blocks_text([step], 30) == " 10  simmer\n       [data/FOON.txt:20] x\n"


def test_what_stands_over_and_under_a_table_is_not_folded_to_it() -> None:
    assert (
        "–" in foon_asp.solve_all_goals(posed("water", "tea", "water > tea"), "units").text()
    )  # without rates
    lines = shown(foon_asp.solve_all_goals(foon_asp.load().problem("ice", "apple pie")), 120)
    assert lines[0] == "The best task trees (strict containers)"
    assert lines[-2:] == [
        "optimal: proved best by the objective named",
        "infeasible: proved that no tree exists",
    ]
