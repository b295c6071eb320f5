"""Rules that reductions do not know of: the search near the goals finds what brute force finds."""

import random
from collections import Counter
from dataclasses import replace

import pytest

from foon_asp.asp import Outcome, Settings, Status, solve
from foon_asp.asp import solver as solver_module
from foon_asp.asp.assembly import assemble
from foon_asp.asp.prepared import prepare
from foon_asp.asp.solver import Reporter, _Heard, _Solver
from foon_asp.problem import ContainerRule, Objective
from foon_asp.rules.constraint import given_constraint
from tests import oracle
from tests.random_problems import MOTIONS, random_problem
from tests.test_constraint_meanings import small

OBJECTIVES = (Objective.UNITS, Objective.INPUTS, Objective.SUCCESS, Objective.KITCHEN)


@pytest.mark.parametrize("part", range(4))
def test_what_is_found_near_the_goals_is_the_best_of_all(part: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(solver_module, "_NEAR", 1)
    monkeypatch.setattr(solver_module, "_MORE", 2)
    met: Counter[str] = Counter()
    for seed in range(10 * part, 10 * part + 10):
        rng = random.Random(seed)
        problem = random_problem(seed, list(ContainerRule)[seed % 2], units=7)
        objective, (one, other) = OBJECTIVES[seed % 4], rng.sample(MOTIONS, 2)
        spare = rng.random() < 0.5
        text = (
            f':- use(U), motion(U,"{one}"), not use(V) : motion(V,"{other}").'
            if spare
            else f':- use(U), motion(U,"{one}"), use(V), motion(V,"{other}").'
        )
        kept = [
            tree
            for tree in oracle.trees(problem)
            if (motions := {unit.motion for unit in tree})
            and (one not in motions or (other in motions) == spare)
        ]
        if oracle.makes(problem, ()):
            kept.append(())
        best = oracle.best(kept, problem, [str(objective)])
        outcome = solve(problem, (objective,), Settings((given_constraint(text),)))
        met[outcome.status] += 1
        if best is None:
            assert outcome.status is Status.INFEASIBLE, seed
            continue
        assert outcome.status is Status.OPTIMAL, seed
        assert outcome.units is not None
        tree = tuple(map(problem.network.unit, outcome.units))
        assert {*tree} in map(set, kept), seed
        assert oracle.key(problem, tree, [str(objective)]) == best, seed
    assert met[Status.OPTIMAL] > 2


def test_what_was_found_among_few_units_is_held_against_all_that_may_be_better(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    problem = small("cut: start > a", "mix: a > b", "fry: b > end", "boil: start > end", "junk: start > x")
    settings = Settings((given_constraint(':- use(U), motion(U,"boil"), not use(4).'),))

    def begun() -> _Solver:
        heard = _Heard(problem, (Objective.UNITS,), Reporter())
        first = prepare(problem, (Objective.UNITS,), settings, assemble(settings, print), heard)
        assert first.rest
        return _Solver(first, (Objective.UNITS,), heard, {})

    def found(solver: _Solver, among: set[int]) -> Outcome:
        reduced = solver.first.reduced
        assert reduced is not None
        wide = reduced.wide
        assert wide is not None
        solver.first = replace(solver.first, reduced=reduced._replace(settled=False))
        solver._look_at(among)
        ended = solver._run(solver.levels)
        assert ended.units is not None
        solver.heard.tree(ended.units)
        return solver._up_to(wide, solver._in_hand(ended.units), ended)

    few = found(begun(), {0, 1, 2})
    assert (few.status, few.units) == (Status.OPTIMAL, (3, 4))
    monkeypatch.setattr(_Solver, "_search", None)  # what was found among all of them is the best
    every = found(begun(), {0, 1, 2, 3, 4})
    assert (every.status, every.units) == (Status.OPTIMAL, (3, 4))
