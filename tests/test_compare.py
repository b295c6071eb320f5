"""``foon-asp compare``: tables, files that are resumed, summaries, the published table."""

import csv
import io
import json
import pickle
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any, Self

import pytest

import foon_asp
from foon_asp.compare import many
from foon_asp.compare.comparison import Comparison, Judgement, Optimum
from foon_asp.compare.results_file import ResultsFile, comparison_json, read_comparison
from foon_asp.compare.summary import Distance, summarize_comparisons
from foon_asp.errors import UserError
from foon_asp.problem import Objective
from foon_asp.proof.simulation import Verdict
from foon_asp.search import SEARCHES
from tests.conftest import Cli
from tests.test_command_line import KITCHEN, NETWORK, RATES

pytestmark = pytest.mark.sampled(2)  # by default each second case of a test: there are many

U, S = Objective.UNITS, Objective.SUCCESS


def row(goal: str, units: int, best: int, executes: Verdict, cycle: bool = False) -> Comparison:
    """Make a comparison of one search with so many units beside so many in the optimum."""
    obstacle = ("mix", "dough", cycle) if executes is Verdict.NEVER else None
    measures = {U: Fraction(units), S: Fraction(1, units)}
    judgement = Judgement("bfs", "tree", tuple(range(units)), measures, executes, (0,), obstacle)
    optima = {U: Optimum("optimal", Fraction(best)), S: Optimum("optimal", Fraction(1, best))}
    return Comparison(goal, "strict", optima, (judgement,))


ROWS = [
    row("a", 2, 2, Verdict.AS_LISTED),
    row("b", 3, 2, Verdict.REORDERED),
    row("c", 9, 3, Verdict.AS_LISTED),
    row("d", 1, 2, Verdict.NEVER, cycle=True),
    row("e", 5, 2, Verdict.NEVER),
    Comparison("f", "strict", {U: Optimum("optimal", Fraction(2))}, (Judgement("bfs", "stuck"),)),
]


def test_a_summary_counts_and_measures_what_executes() -> None:
    (summary,) = summarize_comparisons(ROWS)
    assert summary[:8] == ("bfs", 6, 2, 1, 2, 1, 1, 1)
    units = summary.distances[U]
    assert units == Distance(3, Fraction(1, 3), Fraction(3, 2), Fraction(3), Fraction(3), "c")  # 1, 1.5 and 3
    assert summary.distances[S] == units  # the optimum over the product: 2/2, 3/2, 9/3
    assert Objective.INPUTS not in summary.distances


def test_the_ninetieth_percentile_is_not_exceeded_by_nine_tenths() -> None:
    rows = [row(str(n), n, 1, Verdict.AS_LISTED) for n in range(1, 11)]
    distance = summarize_comparisons(rows)[0].distances[U]
    assert distance.median == Fraction(11, 2)
    assert distance.percentile_90 == 9
    assert distance.worst == 10


@pytest.mark.parametrize("comparison", ROWS)
def test_results_survive_the_file(comparison: Comparison) -> None:
    assert read_comparison(json.loads(json.dumps(comparison_json(comparison)))) == comparison


def test_a_results_file_goes_on_after_a_kill(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    with ResultsFile(path, {"searches": ["bfs"]}) as file:
        file.add(ROWS[0])
        file.add(ROWS[1])
    whole = path.read_bytes()
    path.write_bytes(whole[:-20])  # cut within the last line
    with ResultsFile(path, {"searches": ["bfs"]}) as file:
        assert list(file.done) == ["a"]
        file.add(ROWS[1])
    assert path.read_bytes() == whole


def test_a_results_file_of_another_question_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    with ResultsFile(path, {"searches": ["bfs"]}) as file:
        file.add(ROWS[0])
    before = path.read_bytes()
    with pytest.raises(UserError, match="started for another question"):
        ResultsFile(path, {"searches": ["dfs"]})
    assert path.read_bytes() == before
    path.write_text("no results\n")
    with pytest.raises(UserError, match=r"results\.jsonl:1: error: not a line of results"):
        ResultsFile(path, {})


GOALS = ["--goal", "whipped cream", "--goal", "ice", "--goal", "apple pie", "--containers", "implied"]


def test_the_table_has_every_search_beside_the_optimum(cli: Cli) -> None:
    ran = cli("compare", *GOALS)
    assert ran.code == 0
    lines = ran.out.splitlines()
    for name in ("optimum", "bfs", "dfs", "ids", "greedy-success", "greedy-inputs"):
        assert sum(line.startswith(name) for line in lines) == 3
    assert any(line.split() == ["optimum", "infeasible"] for line in lines)
    assert "no tree: none" in ran.out
    assert all(len(line) <= 80 for line in lines)


def test_json_csv_and_markdown_agree(cli: Cli) -> None:
    rows = cli("compare", *GOALS, "--format", "json").json["comparisons"]
    table = list(csv.DictReader(io.StringIO(cli("compare", *GOALS, "--format", "csv").out)))
    markdown = cli("compare", *GOALS, "--format", "markdown").out
    assert len(table) == sum(len(row["searches"]) for row in rows) == 3 * len(SEARCHES)
    for row, line in zip([(r, s) for r in rows for s in r["searches"]], table, strict=True):
        comparison, search = row
        assert line["goal"] == comparison["goal"]["node"]
        assert line["search"] == search["search"]
        assert line["units"] == str(search["measures"].get("units", ""))
        assert line["executes"] == (search["verdict"] or "")
        if search["ratios"].get("units"):
            assert float(line["units_ratio"]) == pytest.approx(
                float(Fraction(search["ratios"]["units"]["exact"])), rel=1e-5
            )
    assert sum(line.startswith("| ") for line in markdown.splitlines()) == 1 + 3 * (1 + len(SEARCHES))


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
    assert len(row["success"]) > 10_000
    assert row["success"] == row["success_optimum"]


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
    assert [json.loads(line)["goal"] for line in lines[1:]] == [
        "bowl; contains {flour}",
        "batter; in [bowl]",
        "pancake; raw on top; in [pan]",
        "pancake; done",
        "pancake; done; on [plate]",
    ]
    assert one.out.startswith("5 goals; every optimum is proved\n\nbfs: 5 trees\n")
    assert one.out.count("never 0 (0.0%)") == 2
    results.write_text("".join(lines[:-3]))
    again = cli(*words, "--results", results, "--jobs", "2")
    assert again.out == one.out
    assert results.read_text() == "".join(lines)
    other = cli("compare", "--data", data, "--all-makeable", "--results", results)
    assert other.code == 2
    assert "started for another question" in other.err


def test_the_published_table_stands_beside_what_is_measured(cli: Cli, universal: Path) -> None:
    ran = cli("compare", "--data", universal, "--published", "--containers", "implied")
    assert ran.code == 0
    assert "| greek salad | 31 → 28 | 31 → 35 | 30 → 31 | 28 = | 25 |" in ran.out
    assert "Agreeing: bfs 2 of 5, greedy-success 2 of 5, greedy-inputs 3 of 5, ids 5 of 5" in ran.out
    strict = cli("compare", "--data", universal, "--published")
    assert "the published searches use implied containers" in strict.err


def test_a_published_goal_may_be_named_twice(cli: Cli) -> None:
    words = ("compare", "--published", "--search", "bfs", "--containers", "implied", "--goal", "macaroni")
    once = cli(*words)
    assert once.code == 0
    assert "| macaroni | 8 → 10 |" in once.out
    assert cli(*words, "--goal", "macaroni").out == once.out


def test_results_from_python_are_those_of_the_command_line(cli: Cli, data: Path, tmp_path: Path) -> None:
    problem = foon_asp.load(data).problem("cake; warm")
    everything = foon_asp.compare_searches(problem, all_makeable=True, results=tmp_path / "python.jsonl")
    ran = cli("compare", "--data", data, "--all-makeable", "--results", tmp_path / "cli.jsonl")
    assert str(everything) == ran.out.rstrip()
    assert (tmp_path / "python.jsonl").read_text() == (tmp_path / "cli.jsonl").read_text()
    # what is there is not done again
    again = foon_asp.compare_searches(problem, all_makeable=True, results=tmp_path / "cli.jsonl")
    assert again.comparisons == everything.comparisons
    everything.write_chart(tmp_path / "all.svg")
    assert (tmp_path / "all.svg").read_text().startswith("<?xml")


def test_a_problem_of_an_open_store_is_handed_to_processes(
    cli: Cli, data: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = tmp_path / "data.foon"
    assert cli("import", "--data", data, "--store", store).code == 0
    problem = foon_asp.load(store).problem("pancake; done")
    here = foon_asp.compare_searches(problem, ["bfs"])

    class Pool:
        """Takes what it is given as a process would: pickled."""

        def __init__(self, jobs: int, context: object, initializer: Any, initargs: tuple[Any, ...]) -> None:
            initializer(*pickle.loads(pickle.dumps(initargs)))

        def __enter__(self) -> Self:
            return self

        def __exit__(self, *_: object) -> None: ...

        def map(self, work: Any, goals: Any, chunksize: int) -> Any:
            return map(work, goals)

        def shutdown(self, wait: bool, cancel_futures: bool) -> None: ...

    monkeypatch.setattr(many, "ProcessPoolExecutor", Pool)
    monkeypatch.setattr(many, "_work", None)
    assert foon_asp.compare_searches(problem, ["bfs"], jobs=2).comparisons == here.comparisons


def test_bad_words_are_refused(cli: Cli) -> None:
    assert cli("compare", "--search", "magic").code == 2
    ran = cli("compare", "--published", "--all-makeable")
    assert ran.code == 2
    assert "the published table has the goals greek salad" in ran.err
    assert cli("compare", "--jobs", "0").code == 2


def test_a_chart_is_written(cli: Cli, tmp_path: Path) -> None:
    chart = tmp_path / "chart.svg"
    ran = cli("compare", *GOALS, "--chart", chart)
    assert ran.code == 0
    text = chart.read_text()
    for word in ("whipped", "greedy-success", "optimum"):
        assert word in text
    assert cli("compare", *GOALS, "--chart", tmp_path / "chart.gif").code == 2
    ran = cli("compare", "--all-makeable", "--chart", tmp_path / "all.svg")
    assert ran.code == 2
    assert "would be unreadable; name up to 60" in ran.err


@pytest.mark.slow
def test_trees_of_searches_are_told_which_rules_they_break(cli: Cli, tmp_path: Path) -> None:
    rules = ["--rule", ':- use(U), motion(U,"crush").', "--constraint", "at_most_units", "-c", "max_units=9"]
    given = [
        "compare",
        "--goal",
        "ice",
        "--goal",
        "macaroni",
        "--search",
        "bfs",
        "--search",
        "greedy-success",
    ]
    shown = cli(*given, *rules, "--results", tmp_path / "a.jsonl", "--format", "json").json
    crush = 'rule 1:1: :- use(U), motion(U,"crush").'
    breaks = [[search["breaks"] for search in row["searches"]] for row in shown["comparisons"]]
    [ice, [[one], [other]]] = breaks
    assert ice == [[crush], []]
    assert one == other
    assert one.endswith("> max_units. -c max_units=9")
    assert shown["comparisons"][0]["optimum"]["units"]["value"] == 3
    again = cli(*given, *rules, "--results", tmp_path / "a.jsonl", "--format", "markdown")
    assert f"(2) breaks {crush}" in again.out
    assert "as listed (2)" in again.out
    assert "was started for another question" in cli(*given, "--results", tmp_path / "a.jsonl").err
    plans = cli(*given, "--items", "used-up", *rules, "--format", "json").json
    breaks = [[search["breaks"] for search in row["searches"]] for row in plans["comparisons"]]
    assert breaks[0] == [[crush], []]
    assert plans["comparisons"][0]["optimum"]["units"]["value"] == 3
    assert "searches know nothing of other encodings" in cli(*given, "--encodings", "by_need").err
