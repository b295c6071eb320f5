"""No wrong certificate passes: every change is refused, by the seal and, sealed anew, by what it says."""

import copy
import random
from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from foon_asp.asp import Settings, solve
from foon_asp.certificate import Certificate, Coverage, certify, certify_outcome
from foon_asp.network import FunctionalUnit
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.proof.certificate_header import seal
from foon_asp.proof.refusal import RefusedError
from foon_asp.proof.verified_claim import Verified
from tests.oracle import task_trees
from tests.oracle.constraints import keeps, random_rule, settings_of
from tests.support.gap_problem import gap_problem
from tests.support.handmade_certificate import Content, check
from tests.support.random_problems import MOTIONS, random_problem


def certificate(problem: Problem, *objectives: Objective) -> Certificate:
    _, found = certify_outcome(solve(problem, objectives), Settings())
    assert found is not None
    return found


def accepted(content: Content, problem: Problem) -> Verified | None:
    """Seal a changed certificate anew; give what it proves, or ``None`` where it is refused."""
    content["seal"] = seal(content)
    try:
        return check(content, problem)
    except RefusedError:
        return None


# --- changes


def paths(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Give the way to everything in a JSON value."""
    yield path
    if isinstance(value, dict):
        for key in value:
            yield from paths(value[key], (*path, key))
    elif isinstance(value, list):
        for place in range(len(value)):
            yield from paths(value[place], (*path, place))


def at(value: Any, path: tuple[Any, ...]) -> Any:
    for key in path:
        value = value[key]
    return value


def changes(value: Any) -> list[Any]:
    """Give other values of the same kind and of others."""
    if isinstance(value, bool) or value is None:
        return [0, [], {}]
    if isinstance(value, int):
        return [value + 1, value - 1, -value - 1, str(value), value + 0.5, None]
    if isinstance(value, str):
        found: list[Any] = [value + " ", value[:-1], value[::-1], "", "0", "1", "-1", "1/2", "2", None, 1]
        try:
            number = Fraction(value)
            found += [
                str(number + 1),
                str(number / 2),
                str(number * 2),
                str(-number),
                str(number + Fraction(1, 97)),
            ]
        except (ValueError, ZeroDivisionError):
            found += [("0" if value[:1] != "0" else "1") + value[1:]]
        return found
    if isinstance(value, list):
        found = [[], [*value, *value[:1]], value[::-1], value[1:], value[:-1], [*value, 0], None, {}]
        return [*found, *([*value[:i], *value[i + 1 :]] for i in range(len(value)))]
    assert isinstance(value, dict)
    found = [{}, None, [], {**value, "more": 1}]
    return [*found, *({k: v for k, v in value.items() if k != key} for key in value)]


def mutants(content: Content) -> Iterator[tuple[tuple[Any, ...], Content]]:
    """Give every certificate in which one value is another."""
    for path in paths(content):
        if not path:
            continue
        old = at(content, path)
        for new in changes(old):
            if type(new) is type(old) and new == old:
                continue
            mutant = copy.deepcopy(content)
            at(mutant, path[:-1])[path[-1]] = new
            yield path, mutant


@cache
def subjects() -> list[tuple[Problem, Content]]:
    """Give certificates of all kinds, on networks small enough for brute force."""
    found: list[tuple[Problem, Content]] = []
    kinds: dict[tuple[str, ...], int] = {}
    for seed in range(400):
        problem = random_problem(seed, list(ContainerRule)[seed % 2])
        objective = list(Objective)[seed % 5]
        content = certificate(problem, objective).content
        size = len(content["tree"] or []) + len(content["cuts"])
        kind = (content["claim"], str(objective), str(problem.containers))
        if content["claim"] == "infeasible":
            kind = ("infeasible", "", str(problem.containers))
        if kinds.get(kind, 0) < 2 and (size > 2 or kind[0] == "infeasible"):
            kinds[kind] = kinds.get(kind, 0) + 1
            found.append((problem, content))
    gaps = Objective.UNITS, Objective.SUCCESS, Objective.KITCHEN, Objective.ATTEMPTS
    for seed, objective in enumerate(gaps):
        problem = gap_problem(seed, 3)
        found.append((problem, certificate(problem, objective).content))
    bounds = 0
    for seed in range(100):
        problem = random_problem(seed, ContainerRule.STRICT)
        covered = Coverage(not_covered=("mine.lp",))
        settings = Settings((Path("require_motion"),), constants=(f"required_motion={MOTIONS[seed % 6]}",))
        units = solve(problem, (), settings).units
        bound = None if units is None else certify(problem, (Objective.UNITS,), units, covered)
        if bound is not None and bound.claim == "bound" and bounds < 3:
            bounds += 1
            found.append((problem, bound.content))
    return found


@pytest.mark.slow
def test_the_subjects_are_of_all_kinds() -> None:
    claims = [content["claim"] for _, content in subjects()]
    assert claims.count("infeasible") == 4
    assert claims.count("optimal") > 15
    assert claims.count("bound") == 3
    assert sum("branch" in content["proof"] for _, content in subjects()) >= 2
    assert any("multiples" in content["proof"] for _, content in subjects())


class Judge:
    """Knows all trees of a problem by brute force."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self._trees: list[tuple[FunctionalUnit, ...]] | None = None

    def is_true(self, claim: Verified, content: Content) -> bool:
        """Whether what was verified holds."""
        problem = self.problem
        if claim.goals != problem.goals or claim.containers != problem.containers:
            problem = replace(problem, goals=claim.goals, containers=ContainerRule(claim.containers))
            trees = list(task_trees.trees(problem))
        else:
            self._trees = list(task_trees.trees(problem)) if self._trees is None else self._trees
            trees = self._trees
        trees = [tree for tree in trees if all(keeps(problem, tree, rule) for rule in claim.rules)]
        if claim.claim == "infeasible":
            return not trees
        if claim.claim == "bound":
            assert claim.objectives[0] == "units"
            return all(len(tree) >= Fraction(content["bound"][0]) for tree in trees)
        assert claim.claim == "optimal"
        assert claim.tree is not None
        tree = tuple(map(problem.network.unit, claim.tree))
        objectives = list(claim.objectives)
        keys = {tuple(task_trees.measure(problem, other, o) for o in objectives) for other in trees}
        return {*tree} in map(set, trees) and min(keys) == tuple(
            task_trees.measure(problem, tree, o) for o in objectives
        )


def ruled_subjects() -> list[tuple[Problem, Content]]:
    """Give certificates under each ready-made constraint that can be drawn, of trees and of none."""
    found: dict[tuple[str, str], tuple[Problem, Content]] = {}
    for seed in range(300):
        problem = random_problem(seed, list(ContainerRule)[seed % 2])
        rule = random_rule(random.Random(seed), problem)
        settings = settings_of([rule])
        _, ruled = certify_outcome(solve(problem, (), settings), settings)
        if ruled is not None:
            found.setdefault((rule["rule"], ruled.claim), (problem, ruled.content))
    return [*found.values()]


@pytest.mark.slow
@pytest.mark.parametrize("given", [subjects, ruled_subjects])
def test_a_mutant_that_is_sealed_anew_passes_only_if_it_is_a_proof(
    given: Callable[[], list[tuple[Problem, Content]]],
) -> None:
    """Such as one with a node in a cut that makes no difference, or with another tree that is as good."""
    passed = refused = 0
    for problem, content in given():
        judge = Judge(problem)
        for path, mutant in mutants(content):
            if path[0] == "seal":
                continue
            with pytest.raises(RefusedError):
                check(mutant, problem)
            claim = accepted(mutant, problem)
            if claim is None:
                refused += 1
            else:
                passed += 1
                assert judge.is_true(claim, mutant), (path, at(mutant, path))
    assert refused > (40 if given is subjects else 4) * passed
    assert passed > 0
