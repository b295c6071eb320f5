"""What is claimed of rules holds for all trees of small problems: each claim is looked at by brute force."""

from collections.abc import Iterable, Iterator
from functools import cache

import pytest
from clingo import Control

from foon_asp.asp.encoding import read_encoding
from foon_asp.asp.facts import write_facts
from foon_asp.asp.lifted_program import stands_alone
from foon_asp.asp.rule_kind import Kind
from foon_asp.asp.rules import Contradiction, Rules
from foon_asp.asp.scales import Scales
from foon_asp.deadline import Deadline
from foon_asp.grounding.stated import Stated
from foon_asp.problem import ContainerRule, Problem, reach
from foon_asp.resources import encodings_folder
from tests.random_problems import random_problem, random_steps
from tests.random_rules import RandomRules

Tree = frozenset[int]


@cache
def _task_tree() -> str:
    return (encodings_folder() / "task_tree.lp").read_text()


def kept(problem: Problem, rules: str, units: Iterable[int]) -> set[Tree] | None:
    """Give all trees that keep to rules, with only some units in the facts; ``None`` for faulty rules."""
    chosen = sorted(units)
    facts = write_facts(problem, chosen, Scales(problem, chosen), ())
    control = Control(["0", "--project=show"], logger=lambda *_: None)
    try:
        control.add("base", [], f"{_task_tree()}{facts}{rules}#show use/1.\n")
        control.ground([("base", [])])
    except RuntimeError:
        return None
    found: set[Tree] = set()
    control.solve(
        on_model=lambda model: found.add(
            frozenset(atom.arguments[0].number for atom in model.symbols(shown=True))
        )
    )
    return found


def understood(text: str) -> Rules:
    return Rules([read_encoding(Stated("rule 1", text))], (), endless=False)


def parts(text: str) -> Iterator[str]:
    """Give each constraint with all the rules for helpers."""
    lines = text.splitlines()
    helpers = [line for line in lines if not line.startswith(":-")]
    for line in lines:
        if line.startswith(":-"):
            yield "\n".join([*helpers, line]) + "\n"
    yield text


def check(problem: Problem, text: str) -> None:
    """Hold what is claimed of rules against all trees."""
    everything = frozenset(reach(problem).units)
    trees = kept(problem, text, everything)
    if trees is None:
        return
    rules = understood(text)
    kinds = {rule.kind for rule in rules.rules}
    free = kept(problem, "", everything)
    assert free is not None
    if kinds <= {Kind.HELPER, Kind.FACT}:
        assert trees in (free, set())
    if rules.shrinking:
        assert all(tree in trees for larger in trees for tree in free if tree <= larger)
    if kinds <= {Kind.HELPER, Kind.FACT, Kind.REQUIRING}:
        assert all(tree in trees for smaller in trees for tree in free if tree >= smaller)
    if rules.all_deleting:
        assert not rules.rest
    left = rules.applied(problem)
    assert left is not None
    if isinstance(left, Contradiction):
        assert not trees
    else:
        keeping = {
            tree
            for tree in free
            if not any(map(left.removed, tree)) and all(tree & units for units in left.required)
        }
        assert trees <= keeping
        assert rules.rest or trees == keeping
    check_both_ways(problem, rules)
    if rules.local:
        for part in {frozenset(), *sorted(free, key=sorted)[:4], *(everything - {u} for u in everything)}:
            assert kept(problem, text, part) == {tree for tree in trees if tree <= part}


def check_both_ways(problem: Problem, rules: Rules) -> None:
    """Hold what is answered without clingo against clingo, unit by unit."""
    live = rules._live
    both = [n for n in rules._flat if not rules.rules[n].one_of or all(map(stands_alone, live[n]))]
    for number in both:
        flat, clingo = rules._by_hand([number], problem), rules._by_clingo([number], problem, Deadline())
        if isinstance(flat, Contradiction) or isinstance(clingo, Contradiction):
            assert flat == clingo
            continue
        assert clingo is not None
        units = reach(problem).units
        assert list(map(flat.removed, units)) == list(map(clingo.removed, units))
        there = frozenset(units)
        assert {each & there for each in flat.required} == set(clingo.required)


def problem_of(seed: int) -> Problem:
    rule = ContainerRule.IMPLIED if seed % 2 else ContainerRule.STRICT
    return random_steps(seed, rule, 6) if seed % 3 else random_problem(seed, rule, units=6)


@pytest.mark.parametrize("seeds", [range(12), pytest.param(range(12, 400), marks=pytest.mark.slow)])
def test_claims_hold(seeds: range) -> None:
    for seed in seeds:
        problem = problem_of(seed)
        for text in parts(RandomRules(seed, problem, odd=seed % 2 == 0).text()):
            check(problem, text)
