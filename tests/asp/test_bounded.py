"""Optimal trees within bounds, held against brute force."""

import random
from pathlib import Path

import pytest

from foon_asp.asp import Settings
from foon_asp.asp.ranking import Ranked
from foon_asp.asp.settings import Bounded
from foon_asp.asp.soft import solve_soft
from foon_asp.encoding.fact_writer import write_at_most
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit
from foon_asp.problem import ContainerRule, Objective, Problem
from tests.oracle import task_trees
from tests.oracle.test_optimum import assert_agrees
from tests.questions.test_alternatives import choosing
from tests.support.random_problems import MOTIONS, SERIES, random_objectives, random_problem

RULES = list(ContainerRule)
COUNTS = [objective for objective in Objective if objective.row.whole]
Bounds = dict[Objective, int]


def drawn(seed: int, problem: Problem) -> Bounds:
    """Bound one or two objectives near the least they can be, or anywhere where there is no tree."""
    rng = random.Random(seed)
    found = list(task_trees.trees(problem))
    bounds: Bounds = {}
    for objective in rng.sample(COUNTS, rng.choice((1, 1, 2))):
        figures = sorted({int(task_trees.measure(problem, tree, objective)) for tree in found}) or [3]
        bounds[objective] = rng.choice(figures[:3]) - rng.choice((0, 0, 0, 1))
    return bounds


def at_most(bounds: Bounds) -> Bounded:
    """Ask for trees that cost no more than so much by each of some objectives."""
    rules = (write_at_most(number, {o: bounds[o]}) for number, o in enumerate(bounds))
    return Bounded("".join(rules), (question_encoding("at_most.lp"),))


def within(problem: Problem, bounds: Bounds) -> task_trees.Allowed:
    def allowed(tree: tuple[FunctionalUnit, ...]) -> bool:
        return all(task_trees.measure(problem, tree, o) <= bound for o, bound in bounds.items())

    return allowed


@SERIES
@pytest.mark.parametrize("rule", RULES)
def test_the_best_tree_within_bounds(part: int, rule: ContainerRule) -> None:
    """Without rules, and beside a constraint that asks for units."""
    infeasible = 0
    for seed in range(9100, 9100 + 50 // part):
        problem = choosing(seed, rule) if seed % 2 else random_problem(seed, rule)
        bounds = drawn(seed, problem)
        motion = random.Random(seed).choice(MOTIONS)
        near = within(problem, bounds)

        def allowed(
            tree: tuple[FunctionalUnit, ...], near: task_trees.Allowed = near, word: str = motion
        ) -> bool:
            return near(tree) and any(unit.motion == word for unit in tree)

        settings = Settings(
            constraints=(Path("require_motion"),),
            constants=(f"required_motion={motion}",),
            bounded=at_most(bounds),
        )
        assert_agrees(problem, ["success"], list(task_trees.trees(problem, allowed)), settings)
        left = list(task_trees.trees(problem, near))
        infeasible += not left and any(task_trees.trees(problem))
        names = list(map(str, random_objectives(random.Random(seed), 2)))
        assert_agrees(problem, names, left, Settings(bounded=at_most(bounds)))
    assert infeasible


@pytest.mark.parametrize("rule", RULES)
def test_trees_in_order_and_soft_constraints_keep_to_bounds_too(rule: ContainerRule, tmp_path: Path) -> None:
    soft = tmp_path / "soft.lp"
    for seed in range(9200, 9208):
        problem = choosing(seed, rule)
        bounds = drawn(seed, problem)
        left = list(task_trees.trees(problem, within(problem, bounds)))
        settings = Settings(bounded=at_most(bounds))
        minimal = {frozenset(t) for t in left if not any(set(other) < set(t) for other in left)}
        ranked = Ranked(problem, [Objective.SUCCESS], settings)
        assert {frozenset(map(problem.network.unit, units)) for units, _ in ranked} == minimal
        motion = random.Random(seed).choice(MOTIONS)
        soft.write_text(f':- use(U), motion(U,"{motion}").\n', encoding="utf-8")
        found = solve_soft(problem, [Objective.SUCCESS], settings, {soft: 2})
        penalties = [2 * sum(unit.motion == motion for unit in tree) for tree in left]
        assert found.penalty == min(penalties, default=None)


def test_bounds_are_numbers_of_clingo() -> None:
    with pytest.raises(UserError, match="too large"):
        at_most({Objective.UNITS: 2**31})
