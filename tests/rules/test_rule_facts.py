"""The facts that only rules look at: videos and prices, as exact as clingo's numbers allow."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

import foon_asp
from foon_asp.asp import Outcome, Settings, Status, solve
from foon_asp.asp.bare_program import bare_program
from foon_asp.encoding.exact import LARGEST
from foon_asp.errors import UserError
from foon_asp.network import UnitPrices
from foon_asp.problem import Objective, Problem
from foon_asp.rules.passed_constraint import given_constraint
from tests.conftest import Cli
from tests.rules.test_constraint_meanings import small

TOAST = """//
O\tbread
S\tsliced
M\t{motion}
O\tbread
S\ttoasted
//
"""


def folder(path: Path, *units: tuple[str, str, str]) -> Path:
    """Write a folder with a network file for each unit: its name, its motion and its source."""
    path.mkdir(exist_ok=True)
    for name, motion, source in units:
        (path / name).write_text(f"# Source: {source}\n{TOAST.format(motion=motion)}")
    (path / "kitchen.json").write_text('[{"label": "bread", "states": ["sliced"]}]')
    return path


def priced(prices: dict[str, str | Fraction], tmp_path: Path) -> Problem:
    """Give a problem with a unit for each motion with a price."""
    data = folder(tmp_path, *((f"{motion}.txt", motion, "v") for motion in ("fry", "grill", "bake")))
    problem = foon_asp.load(data).problem("bread; toasted")
    motions = {motion: Fraction(price) for motion, price in prices.items()}
    return replace(problem, unit_prices=UnitPrices(motions, {}))


def asked(problem: Problem, *constraints: str) -> Outcome:
    settings = Settings(tuple(map(given_constraint, constraints)))
    return solve(problem, (Objective.UNITS,), settings)


def facts(problem: Problem, *constraints: str) -> str:
    settings = Settings(tuple(map(given_constraint, constraints)))
    return bare_program(problem, (Objective.UNITS,), settings, {}).facts


def test_a_video_is_a_fact_of_each_unit_that_was_annotated_from_it(tmp_path: Path, cli: Cli) -> None:
    data = folder(
        tmp_path / "data",
        ("one.txt", "fry", "https://a"),
        ("two.txt", "fry", "https://b"),
        ("three.txt", "fry", "https://b"),
        ("four.txt", "grill", "https://b"),
    )
    words = ("--data", data, "--goal", "bread; toasted")
    text = cli("facts", *words, "--rule", ":- use(99).").out
    assert 'video(0,"https://b").' in text
    assert 'video(1,"https://a").' in text
    assert 'video(1,"https://b").' in text
    assert text.count("video(") == 3
    assert "video(" not in cli("facts", *words).out

    def code(rule: str) -> int:
        return cli("solve", *words, "--constraint", rule).code

    assert [code(f"at_least_videos:least_videos={n}") for n in (1, 2, 3)] == [0, 0, 1]
    motions = cli("solve", *words, "--constraint", "at_least_videos:least_videos=2", "--format", "json").json
    assert [unit["motion"] for unit in motions["units"]] == ["fry"]


def test_prices_are_facts_in_hundredths(tmp_path: Path) -> None:
    problem = priced({"fry": "2.5", "grill": "0.01"}, tmp_path)
    text = facts(problem, ":- use(99).")
    number = {motion: unit for unit, motion in enumerate(problem.network.motions)}
    assert f"price({number['fry']},250)." in text
    assert f"price({number['grill']},1)." in text
    assert text.count("price(") == 2
    assert "price(" not in facts(problem)


@pytest.mark.parametrize(
    ("most", "motions"), [("1", {"grill"}), ("249", {"grill"}), ("250", {"fry", "grill"}), ("0", set())]
)
def test_a_limit_is_met_to_the_hundredth(most: str, motions: set[str], tmp_path: Path) -> None:
    problem = priced({"fry": "2.5", "grill": "0.01"}, tmp_path)
    limit = f"at_most_price:max_price={most}"
    possible = {
        motion
        for motion in problem.network.motions
        if asked(problem, limit, f':- not use(U), unit(U), motion(U,"{motion}").').units is not None
    }
    assert possible == motions
    assert (asked(problem, limit).status is Status.OPTIMAL) == bool(motions)


@pytest.mark.parametrize(
    ("price", "message"),
    [
        ("0.125", "the price 0.125 of the unit 'fry' is not a whole number of hundredths"),
        (Fraction(1, 3), "the price 1/3 of the unit 'fry' is not a whole number of hundredths"),
        (Fraction(LARGEST, 100), "the prices of all units together are more than 21474836"),
        (Fraction(10**30), "the prices of all units together are more than 21474836"),
    ],
)
def test_prices_that_cannot_be_told_are_refused_where_they_are_looked_at(
    price: str | Fraction, message: str, tmp_path: Path
) -> None:
    problem = priced({"fry": price, "grill": "0.01"}, tmp_path)
    for rule in ("at_most_price:max_price=5", ":- use(U), price(U,N), N > 3."):
        with pytest.raises(UserError, match=message):
            asked(problem, rule)
    assert "price(" not in facts(problem, ":- use(99).")
    assert asked(problem, ":- use(99).").status is Status.OPTIMAL


def test_the_largest_sum_is_told(tmp_path: Path) -> None:
    problem = priced({"fry": Fraction(LARGEST - 1, 100), "grill": "0.01"}, tmp_path)
    assert asked(problem, "at_most_price:max_price=0").status is Status.INFEASIBLE
    assert asked(problem, f"at_most_price:max_price={LARGEST}").status is Status.OPTIMAL


def test_without_prices_a_rule_about_them_is_refused(tmp_path: Path, cli: Cli) -> None:
    data = folder(tmp_path, ("one.txt", "fry", "v"))
    ran = cli("solve", "--data", data, "--goal", "bread; toasted", "--constraint", "at_most_price")
    assert ran.code == 2
    assert "a rule looks at price/2, and no prices of units are known: give a file of prices" in ran.err


@pytest.mark.parametrize(
    ("rule", "said"),
    [
        (":- use(U), rate(U,N), N < 1000000.", "a rule looks at rate/2, and no success rates are known"),
        ("low(U) :- rate(U,_). :- use(U), low(U).", "a rule looks at rate/2, and no success rates are known"),
        (":- use(U), risk(U,N), N > 5.", "a rule looks at risk/2, and no success rates are known"),
        (":- use(U), cost(price,U,N), N > 0.", "a rule looks at cost(price,U,N), which only a question by"),
        (":- use(U), cost(mine,U,N), N > 0.", "a rule looks at cost(mine,U,N), which only a question by"),
        (":- use(U), cost(O,U,N), N > 0.", "a rule looks at cost(Objective,U,N), which only a question by"),
    ],
)
@pytest.mark.parametrize("how", ["--rule", "--soft", "--items=used-up"])
def test_facts_that_a_question_has_not(rule: str, said: str, how: str, cli: Cli, tmp_path: Path) -> None:
    """The rule would never hold, and what it forbids was called optimal."""
    network = tmp_path / "tea.jsonl"
    network.write_text('{"id": "brew", "inputs": ["water"], "outputs": ["tea"], "price": 5}\n')
    given = ["--soft", f"{rule}=2"] if how == "--soft" else ["--rule", rule, *([how] * (how != "--rule"))]
    ran = cli("solve", network, "--goal", "tea", *given)
    assert (ran.code, ran.out) == (2, "")
    assert said in ran.err


def test_facts_that_a_check_of_a_tree_has_not(cli: Cli, tmp_path: Path) -> None:
    tree = tmp_path / "tea.txt"
    tree.write_text("O\twater\nM\tbrew\nO\ttea\n//\n")
    ran = cli("check", tree, tree, "--goal", "tea", "--rule", ":- use(U), rate(U,N), N > 0.")
    assert ran.code == 2
    assert "a rule looks at rate/2, and no success rates are known" in ran.err


def test_costs_that_a_question_has(cli: Cli, tmp_path: Path) -> None:
    network = tmp_path / "tea.jsonl"
    network.write_text('{"id": "brew", "inputs": ["water"], "outputs": ["tea"], "price": 5}\n')
    for rule in (":- use(U), cost(price,U,N), N > 0.", ":- use(U), cost(_,U,N), N > 0."):
        assert cli("solve", network, "--goal", "tea", "--objective", "price", "--rule", rule).code == 1


def test_half_a_character_is_refused_where_rules_compare_it() -> None:
    problem = small("boil: water > end", "turn: water > b\ud83dx")
    with pytest.raises(UserError, match="half a character, which the solver cannot be given"):
        asked(problem, ':- not use(U) : output(U,O), label(O,L), L < "t".')
