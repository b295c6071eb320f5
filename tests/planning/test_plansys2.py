"""What is exported is in the PDDL that PlanSys2 documents: typed, and no condition is negated."""

import ast
import re
import textwrap
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest

import foon_asp
from foon_asp import ContainerRule, Problem
from tests.conftest import ROOT, Cli
from tests.support.random_problems import random_problem

REQUIREMENTS = {":strips", ":typing", ":action-costs"}
NAME = re.compile(r"[a-z][a-z0-9-]*")


def parsed(text: str) -> Any:
    """Return PDDL as nested lists of words."""
    stack: list[Any] = [[]]
    for word in re.findall(r"[()]|[^\s()]+", re.sub(r";.*", "", text)):
        if word == "(":
            stack.append([])
        elif word == ")":
            done = stack.pop()
            stack[-1].append(done)
        else:
            stack[-1].append(word)
    ((definition,),) = stack
    return definition


def atoms(condition: Any, constants: set[str]) -> Iterator[str]:
    """Yield the constants of a conjunction of atoms; anything else is no condition that PlanSys2 checks."""
    word, *conjuncts = condition
    assert word == "and"
    for predicate, *arguments in conjuncts:
        assert predicate == "at-hand"
        (constant,) = arguments
        assert constant in constants
        yield constant


def check(problem: Problem, objective: str) -> None:
    files = foon_asp.export(problem, objective)
    domain, task = parsed(files.domain_file), parsed(files.problem_file)
    sections = {section[0]: section[1:] for section in domain[2:] if section[0] != ":action"}
    assert domain[1] == ["domain", "foon"]
    assert set(sections[":requirements"]) <= REQUIREMENTS
    assert sections[":types"] == ["item"]
    words = sections.get(":constants", [])
    constants = set(words[::3])
    assert words[1::3] == ["-"] * len(constants)
    assert set(words[2::3]) <= {"item"}
    assert all(map(NAME.fullmatch, constants))
    assert sections[":predicates"] == [["at-hand", "?o", "-", "item"]]
    for action in (section for section in domain[2:] if section[0] == ":action"):
        assert NAME.fullmatch(action[1])
        parts = dict(zip(action[2::2], action[3::2], strict=True))
        assert parts[":parameters"] == []
        list(atoms(parts[":precondition"], constants))
        effects = [effect for effect in parts[":effect"] if effect[0] != "increase"]
        list(atoms(effects, constants))
    sections = {section[0]: section[1:] for section in task[2:]}
    assert sections[":domain"] == ["foon"]
    list(atoms(["and", *(fact for fact in sections[":init"] if fact[0] == "at-hand")], constants))
    (goal,) = sections[":goal"]
    assert list(atoms(goal, constants))


@pytest.mark.parametrize("objective", ["units", "success"])
def test_the_bundled_goals_are_in_the_subset(objective: str) -> None:
    foon = foon_asp.load()
    for goal in foon.goals:
        check(foon.problem(goal), objective)


@pytest.mark.parametrize("rule", list(ContainerRule))
def test_random_problems_are_in_the_subset(rule: ContainerRule) -> None:
    for seed in range(30):
        problem = random_problem(seed, rule)
        check(replace(problem, kitchen=problem.kitchen - set(problem.goals)), "units")


def test_the_python_of_the_page_is_python() -> None:
    page = (ROOT / "docs" / "pddl.md").read_text(encoding="utf-8")
    section = page.partition("## PlanSys2\n")[2].partition("\n## ")[0]
    blocks = re.findall(r"\n\n((?:    .*\n|\n)+)", section)
    trees = [ast.parse(textwrap.dedent(block)) for block in blocks]
    named = [
        {node.name for node in tree.body if isinstance(node, ast.FunctionDef | ast.ClassDef)}
        for tree in trees
    ]
    assert named == [{"generate_launch_description"}, {"Performer", "main"}]


def test_a_plan_with_times_is_read_back(cli: Cli, tmp_path: Any) -> None:
    assert cli("export", "--goal", "ice", "-o", tmp_path).code == 0
    plan = tmp_path / "plan.txt"
    plan.write_text("0.000: (u26-twist) [5.000]\n5.001: (u27-crush)\t[5.000]\n")
    ran = cli("read-plan", plan, "--map", tmp_path / "map.json")
    assert (ran.code, "2 units" in ran.out) == (0, True)
