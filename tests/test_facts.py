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
from foon_asp.encoding.encoding import read_encoding
from foon_asp.encoding.facts import (
    FACT_PREDICATES,
    READ_BY_OURS,
    write_facts,
    write_facts_read,
    write_product,
)
from foon_asp.encoding.scales import Scales
from foon_asp.errors import UserError
from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.reduce import ALL, NONE
from foon_asp.resources import encodings_folder
from foon_asp.rules.constraint import RuleText
from tests.conftest import Cli
from tests.random_problems import random_problem

MINE = ':- use(U), motion(U,"whisk").\n:- #count { U : use(U), motion(U,"pour") } > 3.\n'


def bare_clingo(*files: Path) -> tuple[str, list[int], list[int]]:
    """Run clingo on our encodings and some files; give status, costs and the units used."""
    folder = encodings_folder()
    encodings = [str(folder / name) for name in ("task_tree.lp", "objectives.lp", "show.lp")]
    command = [sys.executable, "-m", "clingo", *encodings, *map(str, files), "--opt-strategy=usc,oll,4"]
    output = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    costs = re.findall(r"^Optimization: (.*)$", output, re.MULTILINE)
    answers = re.findall(r"^use\(.*$", output, re.MULTILINE)
    status = "optimal" if "OPTIMUM FOUND" in output else "infeasible" if "UNSAT" in output else output
    units = re.findall(r"use\((\d+)\)", answers[-1] if answers else "")
    return status, [int(cost) for cost in (costs[-1] if costs else "").split()], sorted(map(int, units))


@pytest.mark.parametrize("goal", ["whipped cream", "macaroni", "hot cocoa"])
@pytest.mark.parametrize("rule", list(ContainerRule))
@pytest.mark.sampled(2)
def test_bare_clingo_finds_the_same_optimum(cli: Cli, tmp_path: Path, goal: str, rule: str) -> None:
    mine, facts = tmp_path / "mine.lp", tmp_path / "facts.lp"
    mine.write_text(MINE)
    words = ["--goal", goal, "--containers", rule, "--objective", "inputs,units"]
    for constraint in ([], ["--constraint", str(mine)]):
        facts.write_text(cli("facts", *words, *constraint).out)
        solved = cli("solve", *words, *constraint, "--format", "json").json
        status, costs, units = bare_clingo(facts, *map(Path, constraint[1:]))
        assert status == solved["status"]
        if solved["units"] is not None:
            assert costs == [solved["costs"]["inputs"], solved["costs"]["units"]]
            assert len(units) == solved["costs"]["units"]


def test_the_facts_say_what_the_table_says() -> None:
    builder = NetworkBuilder()
    cup = ObjectNode.of("cup", [], [], [("contains", ["salt"])])
    salt = ObjectNode.of("salt", ["fine"], [("in", "cup")])
    soup = ObjectNode.of('the "soup"', [], [], [("contains", ["salt", "salt", "water"])])
    water = ObjectNode.of("water")
    unit = builder.add("stir\\in", [cup, salt, water], [soup, cup], Source("x", 1))
    builder.add("unrelated", [water], [ObjectNode.of("tea")], Source("x", 9))
    network = builder.build()
    kitchen = frozenset(o for o in range(3))
    rates = {"stir\\in": Fraction(1), "unrelated": Fraction(1)}
    problem = Problem(network, kitchen, (3,), rates, frozenset({"cup", "pot"}), ContainerRule.IMPLIED)
    text = bare_program(problem, (Objective.SUCCESS,), Settings(), {}).facts
    facts = set(re.findall(r"[a-z]+\((?:\"(?:\\.|[^\"\\])*\"|[^()\"])*\)(?=\.)", text))
    assert facts == {
        *(f"unit({unit})", r'motion(0,"stir\\in")', "inputs(0,3)", "ingredients(0,1)"),
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
    text = bare_program(other, (Objective.SUCCESS,), Settings(), {}).facts
    assert ("rate(0,1000000)" in text, "risk(0,0)" in text) == (True, False)  # the first is for rules to see


@pytest.mark.parametrize("rules", [(), (RuleText(":- use(U), needs(U,1), kitchen(1)."),)])
def test_what_is_taken_to_be_at_hand_is_in_no_kitchen_for_rules(
    rules: tuple[RuleText, ...],
) -> None:
    builder = NetworkBuilder()
    water, broth, soup = map(ObjectNode.of, ("water", "broth", "soup"))
    builder.add("boil", [water], [broth], Source("x", 1))
    builder.add("thin", [broth, water], [soup], Source("x", 2))
    problem = Problem(builder.build(), frozenset({0}), (2,), None, frozenset())
    more = replace(problem, kitchen=frozenset({0, 1}), as_seen=problem)
    assert more.kitchen_seen == replace(problem, as_seen=more).kitchen_seen == {0}
    facts = bare_program(more, (Objective.UNITS,), Settings(rules), {}).facts.splitlines()
    assert [line for line in facts if "available" in line] == ["available(1)."]
    assert [f"kitchen({o})." in "\n".join(facts) for o in range(3)] == [True, False, False]
    for reductions in (ALL, NONE):
        found = solve(more, settings=Settings(rules, reductions=reductions))
        assert found.units == (1,)
    assert solve(replace(more, as_seen=None), settings=Settings(rules)).units == (None if rules else (1,))


def test_numbers_too_large_for_clingo_are_refused() -> None:
    assert write_product(4, {0: 2**31 - 1}) == "_product(4,0,2147483647).\n"
    with pytest.raises(UserError, match="32 bits"):
        write_product(4, {0: 2**31})


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


def test_what_encodings_of_ours_look_at_is_always_written() -> None:
    folder = encodings_folder()
    files = [folder / name for name in ("task_tree.lp", "objectives.lp", "show.lp", "exact_success.lp")]
    read = {each for file in (*files, *folder.glob("questions/*.lp")) for each in read_encoding(file).used}
    facts = {(name, arity) for name, arity in FACT_PREDICATES.items()} - {("uses_up", 2), ("stays", 2)}
    assert read & facts <= READ_BY_OURS


def test_facts_that_are_read_are_those_that_are_written() -> None:
    """All of them where everything is looked at, and else no others."""
    problem = random_problem(7, ContainerRule.STRICT)
    units = range(len(problem.network))
    scales = Scales(problem, units, (Objective.SUCCESS, Objective.UNITS))

    def atoms(text: str) -> set[str]:
        return {atom.strip(". ") for line in text.splitlines() for atom in line.split(". ")}

    every = atoms(write_facts(problem, list(units), scales, set(FACT_PREDICATES.items())))
    assert atoms(write_facts_read(problem, list(units), set(FACT_PREDICATES.items()), scales)) == every
    few = atoms(write_facts_read(problem, list(units), {("needs", 2), ("risk", 2), ("label", 2)}, scales))
    names = {"needs", "risk", "label", "goal", "utensil"}
    assert few == {atom for atom in every if atom.partition("(")[0] in names}
