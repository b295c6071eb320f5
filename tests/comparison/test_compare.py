"""``foon-asp compare``: tables, files that are resumed, summaries, the published table."""

import csv
import io
import json
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import pytest
from msgspec import structs

import foon_asp
from foon_asp.asp import Status
from foon_asp.comparison.comparison import Comparison, Obstruction, Optimum, SearchResult
from foon_asp.comparison.comparison_rows import read_comparison
from foon_asp.comparison.summary import Distance, summarize_comparisons
from foon_asp.problem import Objective
from foon_asp.proof.simulation import Verdict
from foon_asp.questions.comparison_tables import summary_tables
from foon_asp.results.plain_values import plain
from foon_asp.results.table import blocks_text
from foon_asp.results.values import Node
from foon_asp.searches import Ending
from tests.cli.test_command_line import KITCHEN, NETWORK, RATES
from tests.conftest import Cli

U, S = Objective.UNITS, Objective.SUCCESS


def node(label: str) -> Node:
    return Node(None, label, label, (), (), ())


def row(goal: str, units: int, best: int, verdict: Verdict, cycle: bool = False) -> Comparison:
    """Make a comparison of one search with so many units beside so many in the optimum."""
    obstacle = Obstruction("mix", node("dough"), cycle) if verdict is Verdict.NEVER else None
    ratios: dict[Objective, Fraction | None] = {U: Fraction(units, best), S: Fraction(best, units)}
    measures: dict[Objective, int | Fraction] = {U: units, S: Fraction(1, units)}
    tree = tuple(range(units))
    result = SearchResult("bfs", Ending.TREE, None, tree, measures, ratios, verdict, (1,), obstacle)
    optima = {U: Optimum(Status.OPTIMAL, best), S: Optimum(Status.OPTIMAL, Fraction(1, best))}
    return Comparison(node(goal), optima, (result,))


ROWS = [
    row("a", 2, 2, Verdict.AS_LISTED),
    row("b", 3, 2, Verdict.REORDERED),
    row("c", 9, 3, Verdict.AS_LISTED),
    row("d", 1, 2, Verdict.NEVER, cycle=True),
    row("e", 5, 2, Verdict.NEVER),
    structs.replace(row("f", 2, 2, Verdict.NEVER), searches=(SearchResult("bfs", Ending.STUCK),)),
]


def test_a_summary_counts_and_measures_what_executes() -> None:
    (summary,) = summarize_comparisons(ROWS)
    units = summary.distances[U]
    assert units == Distance(
        Fraction(1, 3), Fraction(11, 6), Fraction(3, 2), Fraction(3), Fraction(3), "c"
    )  # of 1, 1.5 and 3
    assert summary.distances[S] == units  # the optimum over the product: 2/2, 3/2, 9/3
    assert Objective.INPUTS not in summary.distances
    said, _, headings, counts, *_ = blocks_text(summary_tables([summary], proved=False)).splitlines()
    assert said == "6 goals; NOT every optimum is proved"
    assert headings.split("  ")[-2:] == ["(cycle)", "† smaller"]
    shares = "5 (83.3%) 3 (60.0%) 2 (40.0%) 1 (20.0%) 2 (40.0%) 0 (0.0%) 1 (20.0%) 1 (20.0%)"
    assert counts.split() == ["bfs", *shares.split()]


@pytest.mark.parametrize("comparison", ROWS)
def test_results_survive_the_file(comparison: Comparison) -> None:
    assert read_comparison(json.loads(json.dumps(plain(comparison)))) == comparison


def test_measures_of_any_length_are_cells(tmp_path: Path, cli: Cli) -> None:
    """A product of six rates with 900 digits has more than Python writes at once."""
    nodes = [f"O\tdough\nS\t{step}\n" for step in range(7)]
    units = [f"{before}M\tknead {step}\n{after}//\n" for step, (before, after) in enumerate(pairwise(nodes))]
    network, kitchen, rates = (tmp_path / name for name in ("net.txt", "kitchen.txt", "motion.txt"))
    network.write_text("//\n" + "".join(units))
    kitchen.write_text(nodes[0])
    rates.write_text("".join(f"knead {step}\t0.{'9' * 899}{step + 1}\n" for step in range(6)))
    files = ("--network", network, "--kitchen", kitchen, "--rates", rates, "--goal", "dough; 6")
    ran = cli("compare", *files, "--search", "bfs", "--format", "csv")
    assert ran.code == 0, ran.err
    (row,) = csv.DictReader(io.StringIO(ran.out))
    assert len(row["success_exact"]) > 10_000
    assert row["success_exact"] == row["success_optimum_exact"]


@pytest.fixture
def data(tmp_path: Path) -> Path:
    folder = tmp_path / "pancake"
    folder.mkdir()
    (folder / "FOON.txt").write_text(NETWORK)
    (folder / "kitchen.json").write_text(KITCHEN)
    (folder / "motion.txt").write_text(RATES)
    return folder


def test_all_makeable_goals_are_summed_up_resumed_and_shared(cli: Cli, data: Path, tmp_path: Path) -> None:
    results = tmp_path / "all.jsonl"
    words = ["compare", "--data", data, "--all-makeable", "--search", "bfs", "--search", "ids"]
    one = cli(*words, "--results", results)
    assert one.code == 0
    lines = results.read_text().splitlines(keepends=True)
    assert [json.loads(line)["goal"]["node"] for line in lines[1:]] == [
        "bowl; contains {flour}",
        "batter; in [bowl]",
        "pancake; raw on top; in [pan]",
        "pancake; done",
        "pancake; done; on [plate]",
    ]
    assert one.out.startswith("5 goals; every optimum is proved\n\nsearch  with a tree")
    results.write_text("".join(lines[:-3]))
    again = cli(*words, "--results", results, "--jobs", "2")
    assert again.out == one.out
    assert results.read_text() == "".join(lines)
    other = cli("compare", "--data", data, "--all-makeable", "--results", results)
    assert other.code == 2
    assert "started for another question" in other.err
    assert results.read_text() == "".join(lines)


def test_a_search_that_is_stuck_and_data_without_rates(cli: Cli, data: Path) -> None:
    (data / "motion.txt").unlink()
    ran = cli("compare", "--data", data, "--goal", "cake; warm", "--format", "json")
    assert "greedy-success" in ran.err
    (row,) = ran.json["comparisons"]
    assert [search["search"] for search in row["searches"]] == ["bfs", "dfs", "ids", "greedy-inputs"]
    assert [search["ending"] for search in row["searches"]] == ["stuck", "stuck", "none", "stuck"]
    assert "success" not in row["optimum"]


def test_the_published_table_stands_beside_what_is_measured(cli: Cli, universal: Path) -> None:
    ran = cli("compare", "--data", universal, "--published", "--containers", "implied")
    assert ran.code == 0
    assert "greek salad 31 → 28 31 → 35 30 → 31 28 = 25" in " ".join(ran.out.split())
    assert "Agreeing: bfs 2 of 5, greedy-success 2 of 5, greedy-inputs 3 of 5, ids 5 of 5" in ran.out
    strict = cli("compare", "--data", universal, "--published")
    assert "the published searches use implied containers" in strict.err


def test_results_from_python_are_those_of_the_command_line(cli: Cli, data: Path, tmp_path: Path) -> None:
    problem = foon_asp.load(data).problem("cake; warm")
    everything = foon_asp.compare(problem, all_makeable=True, results=tmp_path / "python.jsonl")
    ran = cli("compare", "--data", data, "--all-makeable", "--results", tmp_path / "cli.jsonl")
    assert str(everything) == ran.out.rstrip()
    assert (tmp_path / "python.jsonl").read_text() == (tmp_path / "cli.jsonl").read_text()


def test_a_problem_of_an_open_store_is_handed_to_processes(cli: Cli, data: Path, tmp_path: Path) -> None:
    store = tmp_path / "data.foon"
    assert cli("merge", "--data", data, "--store", store).code == 0
    problem = foon_asp.load(store).problem("pancake; done")
    here = foon_asp.compare(problem, ["bfs"])
    assert foon_asp.compare(problem, ["bfs"], jobs=2).comparisons == here.comparisons


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("--search magic", "'magic' is not one of"),
        ("--published --all-makeable", "the published table has the goals greek salad"),
        ("--jobs 0", "0 is not in the range"),
        ("--goal ice --chart chart.gif", "ends in .svg or .png"),
    ],
)
def test_bad_words_are_refused(cli: Cli, words: str, message: str) -> None:
    ran = cli("compare", *words.split())
    assert (ran.code, message in ran.err) == (2, True)


def test_a_chart_is_written(cli: Cli, tmp_path: Path) -> None:
    assert cli("compare", "--goal", "ice", "--chart", tmp_path / "chart.svg").code == 0
    text = (tmp_path / "chart.svg").read_text()
    assert [word for word in ("greedy-success", "optimum") if word not in text] == []


def test_trees_of_searches_are_told_which_rules_they_break(cli: Cli, tmp_path: Path) -> None:
    rules = ["--rule", ':- use(U), motion(U,"crush").', "--constraint", "at_most_units", "-c", "max_units=9"]
    searches = ("--search", "bfs", "--search", "greedy-success")
    given = ["compare", "--goal", "ice", "--goal", "macaroni", *searches]
    shown = cli(*given, *rules, "--results", tmp_path / "a.jsonl", "--format", "json").json
    crush = 'rule 1:1: :- use(U), motion(U,"crush").'
    breaks = [[search["breaks"] for search in row["searches"]] for row in shown["comparisons"]]
    [ice, [[one], [other]]] = breaks
    assert ice == [[crush], []]
    assert one == other
    assert one.endswith("> max_units. -c max_units=9")
    assert shown["comparisons"][0]["optimum"]["units"]["value"] == 3
    again = cli(*given, *rules, "--results", tmp_path / "a.jsonl")
    assert f"(2) breaks {crush}" in again.out
    assert "as listed (2)" in again.out
    assert "was started for another question" in cli(*given, "--results", tmp_path / "a.jsonl").err
    assert "searches know nothing of other encodings" in cli(*given, "--encodings", "by_need").err


def test_searches_where_items_are_used_up(cli: Cli, tmp_path: Path) -> None:
    """Of an egg that is laid once, two things cannot be made: what executes otherwise does not."""
    network, kitchen = tmp_path / "net.txt", tmp_path / "kitchen.txt"
    units = (("hen", "egg"), ("egg", "white"), ("egg", "yolk"), ("white\nO\tyolk", "batter"))
    network.write_text("".join(f"O\t{takes}\nM\tmake {makes}\nO\t{makes}\n//\n" for takes, makes in units))
    kitchen.write_text("O\then\n")
    words = ("compare", "--network", network, "--kitchen", kitchen, "--search", "bfs", "--format", "json")
    found = []
    for goal, items in (("batter", "lasting"), ("batter", "used-up"), ("yolk", "used-up")):
        (row,) = cli(*words, "--goal", goal, "--items", items).json["comparisons"]
        found.append((row["searches"][0]["verdict"], row["optimum"]["units"]["status"]))
    assert found == [
        ("executes as listed", "optimal"),
        ("does not execute", "optimal"),
        ("executes as listed", "optimal"),
    ]
