"""``foon-asp facts`` and bare clingo give the optimum that ``foon-asp solve`` gives."""

import re
import subprocess
import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from foon_asp.asp import Settings, solve
from foon_asp.asp.bare_program import bare_program
from foon_asp.hypergraph import ALL, NONE
from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.resources import encodings_folder
from foon_asp.rules.passed_constraint import RuleText
from tests.conftest import Cli

MINE = ':- use(U), motion(U,"whisk").\n:- #count { U : use(U), motion(U,"pour") } > 3.\n'


def bare_clingo(*files: Path) -> tuple[str, list[int]]:
    """Run clingo on our encodings and some files; give status and costs."""
    folder = encodings_folder()
    encodings = [str(folder / name) for name in ("task_tree.lp", "objectives.lp", "show.lp")]
    command = [sys.executable, "-m", "clingo", *encodings, *map(str, files), "--opt-strategy=usc,oll,4"]
    # clingo cuts long paths short between bytes
    output = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False).stdout
    costs = re.findall(r"^Optimization: (.*)$", output, re.MULTILINE)
    status = "optimal" if "OPTIMUM FOUND" in output else "infeasible" if "UNSAT" in output else output
    return status, [int(cost) for cost in (costs[-1] if costs else "").split()]


@pytest.mark.parametrize("goal", ["whipped cream", "macaroni"])
@pytest.mark.parametrize("rule", list(ContainerRule))
def test_bare_clingo_finds_the_same_optimum(cli: Cli, tmp_path: Path, goal: str, rule: str) -> None:
    mine, facts = tmp_path / "mine.lp", tmp_path / "facts.lp"
    mine.write_text(MINE)
    words = ["--goal", goal, "--containers", rule, "--objective", "inputs,units"]
    for constraint in ([], ["--constraint", str(mine)]):
        facts.write_text(cli("facts", *words, *constraint).out)
        solved = cli("solve", *words, *constraint, "--format", "json").json
        status, costs = bare_clingo(facts, *map(Path, constraint[1:]))
        assert status == solved["status"]
        if solved["units"] is not None:
            assert costs == [solved["costs"]["inputs"], solved["costs"]["units"]]


def test_the_facts_say_what_the_table_says() -> None:
    builder = NetworkBuilder()
    cup = ObjectNode.of("cup", [], [], [("contains", ["salt"])])
    salt = ObjectNode.of("salt", ["fine"], [("in", "cup")])
    soup = ObjectNode.of('the "soup"', [], [], [("contains", ["salt", "salt", "water"])])
    water = ObjectNode.of("water")
    builder.add("stir\\in", [cup, salt, water], [soup, cup], Source("x", 1))
    builder.add("unrelated", [water], [ObjectNode.of("tea")], Source("x", 9))
    rates = {"stir\\in": Fraction(1), "unrelated": Fraction(1)}
    utensils = frozenset({"cup", "pot"})
    problem = Problem(builder.build(), frozenset({0, 1, 2}), (3,), rates, utensils, ContainerRule.IMPLIED)
    facts = bare_program(problem, (Objective.SUCCESS,), Settings(), {}).facts
    assert {fact for fact in re.split(r"\.\s", facts) if fact and not fact.startswith(("_", "%"))} == {
        *("unit(0)", r'motion(0,"stir\\in")', "inputs(0,3)", "ingredients(0,1)"),
        *("input(0,0)", "input(0,1)", "input(0,2)", "needs(0,1)", "needs(0,2)", "output(0,3)"),
        *("output(0,0)", "gives(0,3)"),  # the cup was let skip
        *("rate(0,1000000)", "risk(0,0)"),
        *("object(0)", 'label(0,"cup")', 'ingredient(0,"salt")', "kitchen(0)"),
        *("object(1)", 'label(1,"salt")', 'state(1,"fine")', 'located(1,"in","cup")', "kitchen(1)"),
        *("object(2)", 'label(2,"water")', "kitchen(2)"),
        *("object(3)", r'label(3,"the \"soup\"")', 'ingredient(3,"salt")', 'ingredient(3,"water")'),
        *('utensil("cup")', "goal(3)", "optimize(success,2)", "optimize(units,1)"),
    }
    other = replace(problem, rates={**rates, "stir\\in": Fraction(1, 2)}, as_seen=problem)
    facts = bare_program(other, (Objective.SUCCESS,), Settings(), {}).facts
    assert ("rate(0,1000000)" in facts, "risk(0,0)" in facts) == (
        True,
        False,
    )  # the first is for rules to see


def test_what_is_taken_to_be_at_hand_is_in_no_kitchen_for_rules() -> None:
    builder = NetworkBuilder()
    water, broth, soup = map(ObjectNode.of, ("water", "broth", "soup"))
    builder.add("boil", [water], [broth], Source("x", 1))
    builder.add("thin", [broth, water], [soup], Source("x", 2))
    problem = Problem(builder.build(), frozenset({0}), (2,), None, frozenset())
    more = replace(problem, kitchen=frozenset({0, 1}), as_seen=problem)
    rules = (RuleText(":- use(U), needs(U,1), kitchen(1)."),)
    facts = bare_program(more, (Objective.UNITS,), Settings(rules), {}).facts
    assert re.findall(r"(?:available|kitchen)\(\d\)\.", facts) == ["kitchen(0).", "available(1)."]
    for asked in ((), rules):
        for reductions in (ALL, NONE):
            assert solve(more, settings=Settings(asked, reductions=reductions)).units == (1,)
    assert solve(replace(more, as_seen=None), settings=Settings(rules)).units is None


@pytest.mark.slow
def test_the_same_input_gives_the_same_tree(tmp_path: Path) -> None:
    outputs = set()
    for seed in ("0", "1", "2", "random"):
        command = [sys.executable, "-m", "foon_asp", "solve", "--goal", "macaroni and cheese"]
        for objective in ("success", "units"):
            ended = subprocess.run(
                [*command, "--format", "foon", "--objective", objective],
                capture_output=True,
                check=True,
                env={"PYTHONHASHSEED": seed, "PATH": ""},
                cwd=tmp_path,
            )
            outputs.add(ended.stdout)
    assert len(outputs) == 2
