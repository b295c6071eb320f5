"""Whether a tree would run with each item used once: by brute force, in words, and in every verb."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import permutations
from pathlib import Path

import pytest

import foon_asp
from foon_asp.errors import UserError
from foon_asp.json_layout import read_json
from foon_asp.network import FunctionalUnit
from foon_asp.problem import ContainerRule, Problem, UsedUp
from foon_asp.proof.replay import replay_for
from foon_asp.proof.used_up_run import used_up_run
from tests.conftest import Cli
from tests.oracle import used_up
from tests.proof.by_hand import recipe
from tests.support import random_problems

HINT = "with each item used once, see --items used-up"


def listed(problem: Problem) -> list[FunctionalUnit]:
    return [problem.network.unit(unit) for unit in range(len(problem.network))]


def orders_that_run(problem: Problem, units: Sequence[FunctionalUnit]) -> Iterator[tuple[int, ...]]:
    """Give every order of units in which they run where items are used up, the listed one first."""
    if problem.items is None:
        problem = replace(problem, items=UsedUp())
    for order in permutations(range(len(units))):
        if replay_for(problem, [units[position] for position in order]).shortage is None:
            yield order


@random_problems.SERIES
def test_an_order_is_found_where_there_is_one(part: int) -> None:
    found = {True: 0, False: 0}
    for seed in range(450 // part):
        problem = used_up.random_problem(seed)
        units = listed(problem)
        for asked in (problem, replace(problem, items=None)):
            run = used_up_run(asked, units)
            orders = [*orders_that_run(asked, units)]
            assert run.runs is bool(orders), seed
            assert run.order in orders if orders else run.order is None
            assert (run.order == tuple(range(len(units)))) is (orders[:1] == [tuple(range(len(units)))])
            if run.shortage is not None:
                steps = [*run.shortage.consumers, *([] if run.shortage.step is None else [run.shortage.step])]
                assert all(run.shortage.node in units[step].inputs for step in steps)
            found[bool(orders)] += 1
    assert min(found.values()) > 15 // part


@random_problems.SERIES
@pytest.mark.parametrize("rule", ContainerRule)
def test_an_answer_is_in_an_order_that_runs_or_has_a_note(part: int, rule: ContainerRule) -> None:
    noted = 0
    for seed in range(300 // part):
        problem = random_problems.random_problem(seed, rule)
        answer = foon_asp.solve(problem)
        if answer.tree is None or len(answer.tree) > 6:
            continue
        runs = next(orders_that_run(problem, answer.tree.units), None)
        said = answer.json()["used_up"]
        assert said["runs"] is (runs is not None), seed
        assert (HINT in answer.text()) is (runs is None)
        assert runs is None or runs == tuple(range(len(answer.tree)))
        noted += runs is None
    assert noted > 1


OF_E = ("a: E > A", "b: E > B", "c: E > C")


@pytest.mark.parametrize(
    ("units", "goals", "said"),
    [
        (
            (
                "crack: egg > egg; cracked",
                "fry: egg; cracked > A",
                "boil: egg; cracked > B",
                "eat: A + B > C",
            ),
            "C",
            "steps 2 and 3 both take egg; cracked",
        ),
        (
            *(("x: egg > E + F", "y: egg > E + G", *OF_E, "eat: A + B + C + F + G > D"), "D"),
            "steps 2, 3 and 4 all take E, of which there are 2",
        ),
        (("x: egg > E + F", "a: E > A", "look: A + F > B + F", "b: B + F > C"), "C", None),
        (("x: egg > E", "a: E > A"), "E + A", "step 2 uses up the goal E"),
        (("x: egg > E", "a: E > A", "look: A + E > B + E"), "B", "step 3 needs E, which step 2 uses up"),
    ],
)
def test_a_note_names_the_steps_and_the_node(units: Sequence[str], goals: str, said: str | None) -> None:
    answer = foon_asp.solve(recipe(*units, kitchen="egg", goals=goals, utensils="bowl knife"))
    lines = answer.text().splitlines()
    place = next(n for n, line in enumerate(lines) if line.startswith("optimal"))
    assert (lines[place + 1] == f"note: {said}: {HINT}") is (said is not None), lines
    assert answer.json()["used_up"]["runs"] is (said is None)
    assert [answer.remark(form) != "" for form in ("csv", "foon", "json")] == [said is not None] * 2 + [False]


def test_nothing_is_claimed_where_the_search_is_given_up() -> None:
    """Of each pair, the step listed first uses up what the other looks at; one pair has no order at all."""
    units = [f"make{n}: egg > s{n}" for n in range(25)]
    units += [each for n in range(25) for each in (f"take{n}: s{n} > t{n}", f"look{n}: s{n} > s{n} + l{n}")]
    units += ["z: egg > Z", "a: Z > A", "b: A + Z > B + Z"]
    problem = recipe(*units, kitchen="egg")
    run = used_up_run(problem, listed(problem))
    assert run.runs is None
    assert run.order is None


GREEK = ("--goal", "greek salad")


@pytest.mark.parametrize(
    "words",
    [
        ("solve", *GREEK, "--format", "foon"),
        ("alternatives", *GREEK, "--best", "1"),
        ("solve", *GREEK, "--goal", "ice"),
        ("pareto", *GREEK),
        ("regret", *GREEK),
        ("sensitivity", *GREEK),
        ("assist", *GREEK, "--assist", "1"),
        ("compare", "--search", "ids", "--trees", *GREEK),
        ("shopping-list", "--goal", "hot cocoa", "--lists", "1"),
        ("solve", *GREEK, "--certificate", "proof.json"),
        ("diff", "greek.json", "greek.json"),
    ],
    ids=lambda words: words[0],
)
def test_every_verb_says_so(
    words: tuple[str, ...], cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    if "greek.json" in words:
        Path("greek.json").write_text(cli("solve", *GREEK, "--format", "json").out)
    ran = cli(*words)
    assert re.search(r"note: .*with each item used once, see --items used-up", ran.out + ran.err)


def test_optima_mark_it_and_plans_have_no_note(cli: Cli) -> None:
    ran = cli("solve", "--all-goals", *GREEK, "--goal", "ice")
    assert re.search(r"greek salad +units \* ", ran.out)
    assert re.search(r"ice +units +2 ", ran.out)
    plan = cli("solve", *GREEK, "--items", "used-up")
    assert "note:" not in plan.out
    assert cli("solve", *GREEK, "--items", "used-up", "--format", "json").json["used_up"] is None
    assert cli("solve", *GREEK, "--level", "2", "--format", "json").json["used_up"]["runs"] is None


def test_batch_says_it_in_each_row(cli: Cli, tmp_path: Path) -> None:
    questions, results = tmp_path / "q.jsonl", tmp_path / "r.jsonl"
    questions.write_text(
        '{"goal": ["greek salad", "ice", "hot cocoa"]}\n{"goal": "ice", "items": "used-up"}\n'
    )
    cli("batch", questions, "--results", results)
    rows = [read_json(line) for line in results.read_text().splitlines()[1:]]
    assert [row["runs_used_up"] for row in rows] == [False, True, None, True]


def test_the_real_network(cli: Cli, universal: Path) -> None:
    ran = cli("solve", "--data", universal, *GREEK)
    assert f"note: steps 2 and 27 both take bottle; contains {{olive oil}}: {HINT}" in ran.out


def test_a_trace_reads_its_plan_with_items_used_up(cli: Cli, tmp_path: Path) -> None:
    tree = tmp_path / "tree.txt"
    tree.write_text(cli("solve", *GREEK, "--format", "foon").out)
    ran = cli("trace", tree, *GREEK)
    assert ran.code == 1
    assert re.search(r"step 14, core .* lacks a copy of knife; clean; used up by step 4 \(cut\)\n", ran.out)
    assert ran.out.endswith("--items lasting\n")
    assert cli("trace", tree, *GREEK, "--format", "json").json["items"] == "used-up"
    lasting = cli("trace", tree, *GREEK, "--items", "lasting", "--format", "json")
    assert (lasting.code, lasting.json["items"], lasting.json["stopped"]) == (0, "lasting", None)
    level = cli("trace", tree, *GREEK, "--level", "2")
    assert level.code == 2
    assert "--items lasting" in level.err
    with pytest.raises(UserError, match="found the items 'once', expected one of lasting, used-up"):
        foon_asp.trace(foon_asp.load().problem("greek salad"), tree, items="once")


def test_compare_says_it_of_each_search(cli: Cli) -> None:
    words = ("compare", *GREEK, "--goal", "ice", "--search", "bfs")
    rows = cli(*words, "--format", "json").json["comparisons"]
    assert [row["searches"][0]["runs_used_up"] for row in rows] == [False, True]
    text = [line for line in cli(*words).out.splitlines() if line.startswith("bfs")]
    assert [line.split()[-1] for line in text[:2]] == ["no", "yes"]
    assert text[2].endswith("  1 (50.0%)")  # of the summary
