"""Tables as CSV and Markdown: the rows of the JSON, and cells that break neither."""

import csv
import io

import pytest

import foon_asp
from foon_asp.report.frame import csv_text, markdown_text
from tests.conftest import Cli

EGG = {"node": "=egg; in [a|b]", "label": "egg"}
DOCUMENT = {
    "schema": "foon-asp/regret/1",
    "regrets": [
        {"item": EGG, "unit": None, "loss": {"exact": "1/2", "approx": 0.5}},
        {"item": None, "unit": {"id": 3, "units": [{"id": 1}]}, "loss": None, "proved": True, "ids": [1, 2]},
    ],
}


def test_a_row_for_each_thing_that_is_listed() -> None:
    rows = [*csv.reader(io.StringIO(csv_text(DOCUMENT)))]
    assert rows == [
        ["item", "loss", "unit.id", "proved", "ids"],
        ["'=egg; in [a|b]", "0.5", "", "", ""],
        ["", "", "3", "yes", "1 + 2"],
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
    ],
)
def test_questions_that_list_things_have_tables(cli: Cli, words: tuple[str, ...], rows: int) -> None:
    table = [*csv.reader(io.StringIO(cli(*words, "--format", "csv").out))]
    assert {*map(len, table)} == {len(table[0])}
    assert len(table) == 1 + rows
    lines = cli(*words, "--format", "markdown").out.splitlines()
    assert len(lines) == 2 + rows
    assert {line.count("|") for line in lines} == {len(table[0]) + 1}


def test_in_python_the_same(cli: Cli) -> None:
    front = foon_asp.pareto(foon_asp.load().problem("macaroni"))
    assert front.csv() == cli("pareto", "--goal", "macaroni", "--format", "csv").out
    assert front.markdown() == cli("pareto", "--goal", "macaroni", "--format", "markdown").out
