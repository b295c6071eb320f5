"""Measures of the user's own: what rules say of units, and that they count as our objectives do."""

import hashlib
import json
import pickle
import random
import re
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.asp import Settings, Status, solve
from foon_asp.certificate import certify
from foon_asp.engines import ClaimedAnswer, cross_check
from foon_asp.errors import UserError
from foon_asp.hypergraph import ALL, NONE
from foon_asp.network import FunctionalUnit
from foon_asp.problem import ContainerRule, Objective, Problem, needed_inputs, parse_objectives, reach
from foon_asp.proof.certificate_header import seal
from foon_asp.proof.refusal import CheckLimitError
from foon_asp.results.figure_text import figure_text
from foon_asp.rules.measure import read_measures
from foon_asp.text.diagnostics import InputError
from tests.conftest import CORPUS, ROOT, Cli
from tests.oracle import task_trees
from tests.rules.test_constraint_meanings import small
from tests.support.handmade_certificate import check
from tests.support.random_problems import MOTIONS, random_problem

RULES = list(ContainerRule)
MINE = "cost(mine,U,N) :- inputs(U,N)."


def by_motion(seed: int) -> tuple[str, Callable[[Problem, FunctionalUnit], Fraction]]:
    """Give rules for random costs of motions, some of them decimals, and the same costs in Python."""
    rng = random.Random(f"measure {seed}")
    costs = {motion: rng.choice(("0", "1", "2", "7", "0.25", "2.50", "1.125")) for motion in MOTIONS}
    table = " ".join(f'pays("{m}",{c}).' if "." not in c else f'pays("{m}","{c}").' for m, c in costs.items())
    return f"{table} cost(mine,U,N) :- motion(U,M), pays(M,N).", lambda _, unit: Fraction(costs[unit.motion])


# Rules, and what they say in Python.
SAID: dict[str, tuple[str, Callable[[Problem, FunctionalUnit], Fraction | int]]] = {
    "inputs": (MINE, lambda _, unit: len(unit.inputs)),
    "counted": ("cost(mine,U,N) :- unit(U), N = #count{O : input(U,O)}.", lambda _, unit: len(unit.inputs)),
    "outputs": (
        "cost(mine,U,N+1) :- unit(U), N = #count{O : output(U,O)}.",
        lambda _, u: len(set(u.outputs)) + 1,
    ),
    "labels": (
        'w("salt",3). w("dough",2). '
        "cost(mine,U,S) :- unit(U), S = #sum{W,O : input(U,O), label(O,L), w(L,W)}.",
        lambda _, unit: sum({"salt": 3, "dough": 2}.get(node.label, 0) for node in unit.inputs),
    ),
    "states": (
        'cost(mine,U,4) :- hot(U). hot(U) :- output(U,O), state(O,"hot"). '
        'cost(mine,U,"0.5") :- unit(U), not hot(U).',
        lambda _, unit: 4 if any("hot" in node.states for node in unit.outputs) else Fraction(1, 2),
    ),
    "ingredients": (
        "cost(mine,U,N) :- unit(U), N = #count{O,I : input(U,O), ingredient(O,I)}.",
        lambda _, unit: sum(len(set(node.ingredients)) for node in unit.inputs),
    ),
    "needs": (
        "cost(mine,U,N) :- unit(U), N = #count{O : needs(U,O)}.",
        lambda problem, unit: len(needed_inputs(unit, problem.containers, problem.utensils)),
    ),
    "handed on": (
        "cost(mine,U,5) :- input(U,O), output(U,O).",
        lambda _, unit: 5 * (not set(unit.inputs).isdisjoint(unit.outputs)),
    ),
    "pairs": (
        "cost(mine,U,N) :- unit(U), N = #count{A,B : input(U,A), input(U,B), A < B}.",
        lambda _, unit: len(set(unit.inputs)) * (len(set(unit.inputs)) - 1) // 2,
    ),
    "utensils": (
        "cost(mine,U,N) :- unit(U), N = #count{O : input(U,O), label(O,L), utensil(L)}.",
        lambda problem, unit: sum(node.label in problem.utensils for node in set(unit.inputs)),
    ),
    "places": (
        "cost(mine,U,N) :- unit(U), N = #count{O,W,X : output(U,O), located(O,W,X)}.",
        lambda _, unit: sum(len(node.relations) for node in set(unit.outputs)),
    ),
    "alone": ("cost(mine,U,N) :- unit(U), N = #count{V : unit(V)}.", lambda *_: 1),
    "tables": (
        "t(1..3). s(X,Y) :- t(X), t(Y), X < Y. cost(mine,U,N) :- unit(U), N = #count{X,Y : s(X,Y)}.",
        lambda *_: 3,
    ),
    "rate": (
        "cost(mine,U,N) :- rate(U,R), N = (1000000 - R) / 1000.",
        lambda problem, unit: (
            (1_000_000 - int(problem.rates[unit.motion] * 1_000_000)) // 1000 if problem.rates else 0
        ),
    ),
    "places read": (
        "cost(mine,U,N) :- unit(U), N = #count{S : source(U,S)}. cost(mine,U,9) :- video(U,V).",
        lambda *_: 1,
    ),
    "numbers": (
        "cost(mine,U,N) :- p(U), N = #max{O : input(U,O)}. p(X) :- unit(X), X < 3.",
        lambda problem, unit: max(
            (problem.network.object_id(node) or 0 for node in unit.inputs)
            if (problem.network.unit_id(unit) or 0) < 3
            else (0,)
        ),
    ),
    "nothing": ("#defined p/1. cost(mine,U,5) :- unit(U), p(U).", lambda *_: 0),
    "1.0": ('cost(mine,U,1) :- unit(U). cost(mine,U,"1.0") :- unit(U).', lambda *_: 1),
}
MINE_OBJECTIVE = Objective.of_measure("mine")


def measured(problem: Problem, *rules: str) -> Problem:
    return replace(problem, measures=read_measures(rules))


@pytest.mark.parametrize("said", SAID)
def test_what_rules_say_of_each_unit(said: str) -> None:
    rules, expected = SAID[said]
    for seed in range(6):
        for containers in RULES:
            problem = measured(random_problem(seed, containers), rules)
            units = range(len(problem.network))
            costs = list(problem.figures(MINE_OBJECTIVE, units))
            assert costs == [expected(problem, problem.network.unit(unit)) for unit in units], (
                seed,
                containers,
            )
            assert [problem.measure("mine", unit) for unit in units] == costs


@pytest.mark.parametrize(
    "objectives", [["mine"], ["success", "mine"], ["mine", "kitchen"], ["units", "mine"]]
)
@pytest.mark.parametrize("reductions", [ALL, NONE])
def test_the_best_tree_is_that_of_brute_force(objectives: list[str], reductions: Any) -> None:
    for seed in range(8):
        rules, expected = by_motion(seed) if seed % 2 else random.Random(seed).choice([*SAID.values()])
        if "rate(" in rules:
            continue
        problem = measured(random_problem(seed, RULES[seed // 2 % 2], units=6), rules)
        chosen = parse_objectives(objectives, problem.measures)
        keys = [
            tuple(
                sum((Fraction(expected(problem, unit)) for unit in tree), start=Fraction(0))
                if objective == "mine"
                else task_trees.measure(problem, tree, objective)
                for objective in [*objectives, "units"]
            )
            for tree in task_trees.trees(problem)
        ]
        outcome = solve(problem, chosen, Settings(reductions=reductions))
        found = None
        if outcome.costs is not None:
            assert outcome.status is Status.OPTIMAL
            found = outcome.costs.key((*chosen, Objective.UNITS))
        assert found == min(keys, default=None), seed


def test_a_measure_equal_to_ours_gives_the_same_answers() -> None:
    foon = foon_asp.load(ROOT / "data" / "kitchen", measures=MINE)
    problem, both = foon.problem("ice"), foon.problem("ice", "macaroni")
    ours, mine = (solve(problem, parse_objectives([name], problem.measures)) for name in ("inputs", "mine"))
    assert (ours.units, ours.proof, ours.costs) == (mine.units, mine.proof, mine.costs)
    for first in ("units", "success"):
        fronts = [foon_asp.pareto(problem, f"{first},{name}") for name in ("inputs", "mine")]
        one, other = ([point.costs.key(front.objectives) for point in front.points] for front in fronts)
        assert one == other
    for ask, asked in (
        (foon_asp.regret, problem),
        (foon_asp.alternatives, problem),
        (foon_asp.shopping_list, problem),
        (foon_asp.solve, both),
    ):
        one, other = (re.findall(r'"id": (\d+)', ask(asked, name).json_text()) for name in ("inputs", "mine"))
        assert one == other != []


def test_help_is_priced_beside_a_measure() -> None:
    problem = foon_asp.load(ROOT / "data" / "kitchen", measures=MINE).problem("macaroni")
    assert str(foon_asp.assist(problem, most=1)) == str(foon_asp.assist(problem.vary(measures=()), most=1))


@pytest.mark.parametrize("said", ["inputs", "labels", "states"])
def test_engines_agree(said: str) -> None:
    for seed in (1, 4):
        problem = measured(random_problem(seed, RULES[seed % 2]), SAID[said][0])
        cross_check(ClaimedAnswer(solve(problem, (MINE_OBJECTIVE,)), Settings()), None)


@pytest.mark.parametrize(
    ("sum_", "text"),
    [
        (Fraction(1234567), "1234567"),
        (Fraction(1, 3), "≈ 0.3333"),
        (Fraction("0.1234567890123456"), "≈ 0.1235"),
        (Fraction(1, 10**30), "1e-30"),
        (Fraction(), "0"),
    ],
)
def test_a_sum_is_shown_whole_where_it_is_short(sum_: Fraction, text: str) -> None:
    assert figure_text(Objective.PRICE, sum_) == text


def test_there_is_one_objective_of_a_name() -> None:
    mine = Objective.of_measure("mine")
    assert mine is MINE_OBJECTIVE is pickle.loads(pickle.dumps(mine))
    assert pickle.loads(pickle.dumps(Objective.SUCCESS)) is Objective.SUCCESS is Objective("success")
    assert mine not in Objective
    assert "units" in Objective
    with pytest.raises(ValueError, match="no objective"):
        Objective("mine")
    with pytest.raises(AttributeError, match="does not change"):
        mine.row = Objective.UNITS.row
    problem = measured(random_problem(1, RULES[0]), MINE)
    again = pickle.loads(pickle.dumps(problem.plain))
    assert list(again.figures(mine, range(3))) == list(problem.figures(mine, range(3)))


@pytest.mark.parametrize(
    ("rules", "message"),
    [
        ("cost(mine,U,5) :- use(U).", "found use/1, which differs from tree to tree, .*--soft.*--encodings"),
        (
            "cost(mine,U,5) :- unit(U), output(U,O), available(O).",
            "found available/1, which differs from tree",
        ),
        ("cost(mine,U,5) :- times(U,2).", "found times/2, which differs from tree"),
        (
            "cost(mine,U,5) :- inputs(U,N), N > k.",
            "found k, which is above every number; set it, as in #const",
        ),
        ("cost(mine,U,1;2) :- unit(U).", r"found cost\(2\), expected a cost such as"),
        (
            "cost(mine,U,5) :- input(U,O), kitchen(O).",
            "found kitchen/1, which differs from question to question",
        ),
        ("cost(mine,U,5) :- output(U,O), goal(O).", "found goal/1, which differs from question"),
        ("cost(mine,U,N) :- risk(U,N).", "found risk/2, which is rounded for a question: read rate/2"),
        ("cost(mine,U,N) :- price(U,N).", "found price/2, which is there only where it is exact"),
        ("cost(mine,U,N) :- cost(price,U,N).", "found cost/3, which is rounded"),
        ('cost(mine,U,5) :- moton(U,"pour").', "no rule or fact defines moton/2.*did you mean motion/2"),
        ("cost(price,U,5) :- unit(U).", "found a measure 'price', which is a name of ours"),
        ("cost(_mine,U,5) :- unit(U).", "which is a name of ours"),
        ("cost(M,U,5) :- motion(U,M).", r"found cost\(M,...\), expected the name of a measure"),
        ('cost("mine",U,5) :- unit(U).', "expected the name of a measure"),
        ("cost(mine(1),U,5) :- unit(U).", "expected the name of a measure"),
        ("p :- q. q.", r"expected rules for what units cost, such as cost\(mine,U,5\)"),
        ("{ cost(mine,U,5) } :- unit(U).", "found a choice or a disjunction"),
        ("cost(mine,U,5) :- unit(U). :- unit(U).", "found a constraint, expected a rule"),
        ("cost(mine,U,5) :- unit(U), -p(U). -p(U) :- unit(U).", "with a minus before it"),
        ("cost(mine,U,5) :- unit(U). _p(1).", "names that begin with '_' are reserved"),
        ('cost(mine,U,5) :- unit(U). motion(U,"x") :- unit(U).', "found a rule for motion/2"),
        ("p(X+1) :- p(X). p(1). cost(mine,U,5) :- unit(U).", "found p/1, which depends on itself"),
        ("p :- not q. q :- not p. cost(mine,U,5) :- unit(U), p.", "depends on itself"),
        ("#const mine = 3. cost(mine,U,5) :- unit(U).", "found #const mine"),
        ("#external p. cost(mine,U,5) :- unit(U), not p.", "found a statement that is no rule"),
        ("#script (python) #end. cost(mine,U,5) :- unit(U).", "found #script"),
        ('#include "other.lp". cost(mine,U,5) :- unit(U).', "found #include"),
        ("cost(mine,U,4294967296) :- unit(U).", "found the number 4294967296"),
        ("cost(mine,U,5) :- unit(U)", "measure 1:1:.*syntax error"),
        ("cost(mine,U,N) :- unit(U).", "the variable 'N' is unsafe"),
    ],
)
def test_rules_that_are_refused(rules: str, message: str) -> None:
    with pytest.raises(UserError) as caught:
        list(measured(random_problem(1, RULES[0]), rules).figures(MINE_OBJECTIVE, (0,)))
    assert re.search(message, str(caught.value), re.DOTALL), str(caught.value)
    assert str(caught.value).startswith("measure 1")


@pytest.mark.parametrize(
    ("rules", "message"),
    [
        (
            "cost(mine,U,-1) :- unit(U).",
            r"measure 1:1:1: error: found the cost -1 of the unit '\w+' \(0, random:",
        ),
        (
            'cost(mine,U,"1,5") :- unit(U).',
            r'found the cost "1,5" of the unit .*expected a number from 0: 5, or',
        ),
        ('cost(mine,U,"-1") :- unit(U).', 'found the cost "-1"'),
        ('cost(mine,U,"1/2") :- unit(U).', 'found the cost "1/2"'),
        ("cost(mine,U,half) :- unit(U).", "found the cost half"),
        ("cost(mine,7777,5).", "found a cost of 7777 among the facts of the unit"),
        ("cost(mine,O,5) :- input(_,O).", "found a cost of .*a rule is about one unit"),
        ("cost(mine,U,N) :- motion(U,M), N = M + 1.", "measure 1:1:1: error: a term has no value here: M"),
        ("cost(mine,U,1) :- unit(U), 0 < #sum{M : motion(U,M)}.", "the weight in .* is not a number"),
        (
            "cost(mine,U,5) :- unit(U).\n\ncost(mine,U,N) :- inputs(U,M), N = M * 0 + 6.",
            r"measure 1:1:1: error: found the cost 5 of the unit '\w+' \(0, random:\d+\), expected one value "
            r"for each unit\n.*\nmeasure 1:3:1: error: found the cost 6 of the unit '\w+' \(0, random:\d+\)",
        ),
    ],
)
def test_costs_that_are_refused_are_named_with_their_places(rules: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        solve(measured(random_problem(1, RULES[0]), rules), (MINE_OBJECTIVE,))
    assert re.search(message, str(caught.value), re.DOTALL), str(caught.value)


def test_rules_that_take_no_end_are_stopped() -> None:
    numbers = "p(1..9999). q(X+Y+Z) :- p(X), p(Y), p(Z)."
    problem = measured(
        random_problem(1, RULES[0]), f"{numbers} cost(mine,U,N) :- unit(U), N = #max{{X : q(X)}}."
    )
    outcome = foon_asp.solve(problem, "mine", time_limit=0.3)
    assert outcome.status is Status.UNKNOWN
    assert outcome.stopped == "the time limit of 0.3 s while measuring units"


def test_a_measure_needs_its_rules_and_the_rates_that_it_reads() -> None:
    problem = random_problem(1, RULES[0])
    with pytest.raises(UserError, match="the objective mine needs the rules of its measure"):
        solve(problem, (MINE_OBJECTIVE,))
    with pytest.raises(
        UserError,
        match=r"found the objective 'mine', expected one of units, .*, dissimilarity, or a measure",
    ):
        foon_asp.solve(problem, "mine")
    with pytest.raises(UserError, match=r"expected one of units, .*, dissimilarity, mine, or a measure"):
        foon_asp.solve(measured(problem, MINE), "yours")
    with pytest.raises(ValueError, match="no measure yours is known"):
        problem.measure("yours", 0)
    with pytest.raises(UserError, match="the rules read rate/2: give a rates file"):
        measured(replace(problem, rates=None), SAID["rate"][0]).measure("mine", 0)


def test_an_unknown_objective_is_told_how_rules_are_given(cli: Cli) -> None:
    ran = cli("solve", "--goal", "ice", "--objective", "mine")
    assert ran.code == 2
    assert "or a measure whose rules are given" in ran.err


@pytest.mark.parametrize("given", ["  ", ["", MINE]])
def test_an_empty_text_is_no_measure(given: str | list[str]) -> None:
    refused = "found an empty text for a measure, expected a file, or rules"
    for read in (
        foon_asp.load,
        foon_asp.load().vary,
        partial(foon_asp.build, [("boil", "water", "tea")]),
    ):
        with pytest.raises(UserError, match=refused):
            read(measures=given)


def test_lists_of_trees_show_what_each_costs_by_a_measure(tmp_path: Path, cli: Cli) -> None:
    rules = tmp_path / "mine.lp"
    rules.write_text(MINE, encoding="utf-8")
    asked = ("--goal", "ice", "--objective", "mine", "--measure", str(rules))
    listed = cli("alternatives", *asked).out
    for before in ("tree 1: ", "proved (strict containers): "):
        assert f"{before}2 units, 6 inputs, success 0.644, mine 6\n" in listed
    found = cli("solve", "--all-goals", *asked, "--objective", "kitchen").out.splitlines()
    assert found[2].split() == ["goal", "best", "by", "units", "inputs", "success", "mine", "kitchen",
                                "status", "seconds"]  # fmt: skip
    assert found[3].split()[:-1] == ["ice", "all", "2", "6", "0.6440", "6", "4", "optimal"]
    assert "mine" not in cli("solve", "--all-goals", "--goal", "ice", "--measure", str(rules)).out


def test_two_files_may_not_name_the_same_measure(tmp_path: Path) -> None:
    one, two = tmp_path / "one.lp", tmp_path / "two.lp"
    one.write_text(MINE, encoding="utf-8")
    two.write_text(f"% other\n{MINE} cost(more,U,1) :- unit(U).", encoding="utf-8")
    with pytest.raises(
        InputError, match=r"two\.lp:2:1: error: found the measure 'mine' again, of which .*one\.lp"
    ):
        read_measures([one, two])
    assert read_measures(one) == read_measures([one, one]) == read_measures(str(one))
    assert list(read_measures(two)) == ["mine", "more"]


def test_a_constant_of_a_constraint_does_not_take_the_name(tmp_path: Path) -> None:
    rule = tmp_path / "rule.lp"
    rule.write_text("#const mine = units. :- use(U), mine = 3.", encoding="utf-8")
    problem = measured(random_problem(1, RULES[0]), MINE)
    with pytest.raises(UserError, match=r"found #const mine .* is the name of a measure"):
        solve(problem, (MINE_OBJECTIVE,), Settings(constraints=(rule,)))


def test_a_store_says_the_same_of_the_units_it_reads(tmp_path: Path, cli: Cli) -> None:
    rules = tmp_path / "mine.lp"
    rules.write_text(f"{SAID['counted'][0]} cost(where,U,U) :- unit(U).", encoding="utf-8")
    assert cli("merge", "--data", f"{ROOT}/data/kitchen", "--store", f"{tmp_path}/k.foon").code == 0
    data = ("--goal", "macaroni", "--objective", "mine,where", "--measure", str(rules), "--format", "json")
    whole = cli("solve", *data).json
    part = cli("solve", "--network", f"{tmp_path}/k.foon", *data).json
    assert (whole["costs"], whole["lower_bound"]) == (part["costs"], part["lower_bound"])
    assert whole["costs"]["mine"] == {"exact": "21", "approx": 21.0}
    problem = foon_asp.load(tmp_path / "k.foon", measures=rules).problem("macaroni")
    assert len(problem.network) < len(problem.whole.network)
    assert problem.vary(without="knife").measures == problem.whole.measures == problem.measures


def test_a_batch_by_a_measure(tmp_path: Path, cli: Cli) -> None:
    rules, questions = tmp_path / "mine.lp", tmp_path / "questions.jsonl"
    rules.write_text(MINE, encoding="utf-8")
    questions.write_text('{"goal": ["ice", "macaroni"], "objective": ["mine", "inputs"]}\n', encoding="utf-8")
    words = ("batch", str(questions), "--results", str(tmp_path / "rows.jsonl"), "--measure", str(rules))
    assert cli(*words).code == 0
    rows = [json.loads(line) for line in (tmp_path / "rows.jsonl").read_text(encoding="utf-8").splitlines()]
    rows = [row for row in rows if "goal" in row]
    found = {(row["goal"], row["objective"]): row["units"] for row in rows}
    for goal in ("ice", "macaroni"):
        assert found[goal, "mine"] == found[goal, "inputs"]
    assert all(row["costs"]["mine"]["exact"] == str(row["costs"]["inputs"]) for row in rows)
    rules.write_text("cost(other,U,1) :- unit(U).", encoding="utf-8")
    refused = cli(*words)
    assert refused.code == 2
    assert "found the objective 'mine'" in refused.err


def test_what_is_asked_of_other_units_is_asked_of_none() -> None:
    """Each unit has a world of its own: values do not change where other units come or go."""
    rules = (
        "cost(mine,U,1) :- motion(U,M), motion(V,M), V != U. cost(mine,U,2) :- lone(U). lone(U) :- unit(U)."
    )
    problem = small("pour: salt > soup", "pour: soup > end")
    assert list(measured(problem, rules).figures(MINE_OBJECTIVE, range(2))) == [2, 2]


def sealed(content: dict[str, Any], rules: str, name: str = "mine") -> dict[str, Any]:
    """Give a certificate other rules of its measure, and a seal and a digest that fit."""
    (stated,) = content["measures"].values()
    digest = hashlib.sha256(rules.encode()).hexdigest()
    changed = {**content, "measures": {name: {**stated, "rules": rules, "sha256": digest}}}
    return {**changed, "seal": seal(changed)}


@pytest.mark.parametrize("said", ["inputs", "labels", "states", "needs"])
def test_certificates_say_what_they_take_on_trust(said: str) -> None:
    for seed in range(6):
        problem = measured(random_problem(seed, RULES[seed % 2]), SAID[said][0])
        outcome = solve(problem, (MINE_OBJECTIVE, Objective.UNITS))
        if outcome.units is None:
            continue
        found = certify(problem, (MINE_OBJECTIVE, Objective.UNITS), outcome.units)
        assert found is not None
        assert foon_asp.verify(problem, found, with_clingo=True).claim == "optimal"
        proved = check(found.content, problem)
        assert outcome.costs is not None
        assert proved.costs == outcome.costs.key(found.certified)
        (trusted,) = proved.trusted
        assert trusted.costs.keys() >= set(outcome.units)
        assert all(problem.measure("mine", unit) == cost for unit, cost in trusted.costs.items())
        stated = found.content["measures"]["mine"]
        assert sorted(unit for units in stated["costs"].values() for unit in units) == sorted(trusted.costs)
        assert trusted.sha256 == hashlib.sha256(SAID[said][0].encode()).hexdigest()


def test_what_is_taken_on_trust_is_checked_with_clingo(tmp_path: Path, cli: Cli) -> None:
    rules, other, file = tmp_path / "mine.lp", tmp_path / "other.lp", tmp_path / "proof.json"
    rules.write_text(MINE, encoding="utf-8")
    other.write_text("cost(mine,U,N+1) :- inputs(U,N).", encoding="utf-8")
    asked = ("--goal", "ice", "--objective", "mine", "--measure", str(rules))
    assert cli("solve", *asked, "--certificate", str(file)).code == 0
    digest = hashlib.sha256(MINE.encode()).hexdigest()
    trusted = (
        "taken on trust: the costs of 4 units by mine, and that none is below 0; "
        f"rules with SHA-256 {digest} (--with-clingo checks it)\n"
    )
    assert trusted in cli("verify", str(file)).out
    assert trusted in cli("verify", str(file), "--measure", str(rules)).out
    refused = cli("verify", str(file), "--measure", str(other))
    assert (refused.code, refused.out) == (1, "refused: the rules of mine are not those that are given\n")
    assert (
        "\nchecked with clingo: the costs of 4 units by mine" in cli("verify", str(file), "--with-clingo").out
    )
    said = cli("verify", str(file), "--with-clingo", "--format", "json").json
    assert (said["trusted"], [digest in each for each in said["checked"]]) == ([], [True])
    content = json.loads(file.read_text(encoding="utf-8"))
    for text, why in (
        ("cost(mine,U,N+1) :- inputs(U,N).", r"refused: unit \d+ costs 4 by the rules of mine, and not 3"),
        ("cost(mine,U,3) :- unit(U), inputs(U,3).", None),
        (
            "cost(mine,U,3) :- inputs(U,3). cost(mine,U,-1) :- inputs(U,4).",
            "refused: the rules of mine:1:32: error: found the cost -1",
        ),
        ("cost(yours,U,3) :- inputs(U,3).", "refused: the rules say nothing of mine"),
        ("cost(mine,U,N) :- use(U), inputs(U,N).", "refused: the rules of mine:1:19: error: found use/1"),
        ("mine", "refused: the rules of mine:1:.*syntax error"),
    ):
        file.write_text(json.dumps(sealed(content, text)), encoding="utf-8")
        assert cli("verify", str(file)).code == 0
        ran = cli("verify", str(file), "--with-clingo")
        assert ran.code == (0 if why is None else 1), ran.out
        assert re.match(why or "goal", ran.out, re.DOTALL), ran.out
    file.write_text(json.dumps(sealed(content, MINE, "units")), encoding="utf-8")
    assert cli("verify", str(file)).out == "refused: a measure has no name of its own\n"


def test_rules_of_a_stranger_are_stopped(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("foon_asp.questions.verify.CLINGO_SECONDS", 0.3)
    problem = measured(random_problem(1, RULES[0]), MINE)
    found = foon_asp.solve(problem, "mine", certificate=tmp_path / "proof.json").certificate
    assert found is not None
    endless = "p(1..9999). q(X+Y+Z) :- p(X), p(Y), p(Z). cost(mine,U,N) :- inputs(U,N), q(_)."
    forged = found._replace(content=sealed(found.content, endless))
    assert foon_asp.verify(replace(problem, measures={}), forged)
    with pytest.raises(CheckLimitError, match=r"the rules of mine: the time limit of 0\.3 s while"):
        foon_asp.verify(replace(problem, measures={}), forged, with_clingo=True)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::foon_asp.FoonWarning")  # of what is assumed of the real files
@pytest.mark.skipif(not CORPUS.is_dir(), reason="the corpus is not here")
def test_makeable_objects_of_the_real_network() -> None:
    foon = foon_asp.load(CORPUS / "universal", measures=MINE)
    problem = foon.problem(foon.network.objects[0])
    for goal in random.Random("measures").sample(sorted(reach(problem).makers), 40):
        asked = replace(problem, goals=(goal,))
        ours, mine = (solve(asked, parse_objectives([name], asked.measures)) for name in ("inputs", "mine"))
        assert ours.costs == mine.costs
        plain = solve(asked, (MINE_OBJECTIVE,), Settings(reductions=NONE))
        assert mine.bounds == plain.bounds


# --- Numbers of more than 32 bits, which clingo does not have.


def cost_of(rules: str) -> Fraction | int:
    """Give what a unit of three inputs costs."""
    [cost] = measured(small("mix: a, b, c > end"), rules).figures(MINE_OBJECTIVE, [0])
    return cost


class _BeyondError(Exception):
    pass


def calculated(rng: random.Random, depth: int, inputs: int) -> tuple[str, int]:
    """Draw what a cost is calculated by; gives its text, and what it comes to, exactly."""
    if depth == 0 or rng.random() < 0.2:
        number = rng.choice((0, 1, 2, 3, 7, 46340, 46341, 65536, 2**30, 2**31 - 2))
        return rng.choice((("N", inputs), (str(number), number), (f"-{number}", -number)))
    operator = rng.choice(("+", "-", "*", "*", "**"))
    (one, a), (other, b) = (calculated(rng, depth - 1, inputs) for _ in range(2))
    if operator == "**" and not 0 <= b <= 40:
        operator = "+"
    value = {"+": a + b, "-": a - b, "*": a * b, "**": a**b if operator == "**" else 0}[operator]
    if abs(value) >= 2**31 - 1:  # clingo adds 1 to bounds
        raise _BeyondError(f"({one}{operator}{other})")
    return f"({one}{operator}{other})", value


@pytest.mark.parametrize("seeds", [range(12), pytest.param(range(12, 80), marks=pytest.mark.slow)])
@pytest.mark.default_cases("seeds0")
def test_numbers_of_more_than_32_bits_are_refused(seeds: range) -> None:
    met: Counter[str] = Counter()
    for seed in seeds:
        try:
            text, value = calculated(random.Random(seed), 3, 3)
            said = "" if value >= 0 else "expected a number from 0"
        except _BeyondError as beyond:
            text, value, said = (
                str(beyond),
                0,
                "found a number of more than 32 bits in the cost of the unit 'mix'",
            )
        met[said] += 1
        rules = placed(seed, text)
        if said:
            with pytest.raises(InputError, match=said):
                cost_of(rules)
        else:
            assert cost_of(rules) == value, text
    assert len(met) == 3


def placed(seed: int, text: str) -> str:
    """Give a measure that calculates a cost in one of several places."""
    return (
        f"cost(mine,U,{text}) :- inputs(U,N).",
        f"cost(mine,U,M) :- inputs(U,N), M = {text}.",
        f"pays(U,{text}) :- inputs(U,N). cost(mine,U,M) :- pays(U,M).",
        f"cost(mine,U,M) :- inputs(U,N), M = #sum {{ {text} }}.",
        f"cost(mine,U,M) :- unit(U), M = #max {{ {text} : inputs(U,N) }}.",
    )[seed % 5]


@pytest.mark.parametrize(
    ("rules", "cost"),
    [
        ("cost(mine,U,M) :- unit(U), M = #sum { 700000000,O : input(U,O) }.", 2_100_000_000),
        ("cost(mine,U,M) :- unit(U), M = #sum { 800000000,O : input(U,O) }.", None),
        ("cost(mine,U,M) :- unit(U), M = #sum+ { 2147483646,O : input(U,O) }.", None),
        ("cost(mine,U,M) :- unit(U), M = (2..3)*1000000000.", None),
        # what other conditions leave out is not calculated
        ('w("mix",7). w("mix","much"). cost(mine,U,N*2) :- motion(U,M), w(M,N), N < 100.', 14),
        ("cost(mine,U,1) :- inputs(U,N), not far(N*1000000000). far(2).", None),
        ("cost(mine,U,1) :- inputs(U,N), 5 < 0-N*1000000000.", None),
    ],
)
def test_where_numbers_of_more_than_32_bits_are(rules: str, cost: int | None) -> None:
    if cost is None:
        with pytest.raises(InputError, match="found a number of more than 32 bits"):
            cost_of(rules)
    else:
        assert cost_of(rules) == cost
