"""Questions that differ in their goal alone, answered one after the other with what they share."""

from dataclasses import replace

import pytest

from foon_asp.asp import Outcome, Settings, Status, solve
from foon_asp.certificate import certify_outcome
from foon_asp.certificate.certificate import subject_of
from foon_asp.deadline import Deadline
from foon_asp.hypergraph import SolvedGoals, tuning
from foon_asp.problem import Objective, Problem, Restriction
from foon_asp.proof.certificate_json import read_certificate
from foon_asp.proof.verifier import verify
from tests.support.gap_problem import gap_problem
from tests.support.hard_problem import hard_problem

EXACT = (Objective.UNITS, Objective.INPUTS, Objective.PRICE)


@pytest.fixture(autouse=True)
def relaxed_early(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have even small questions take linear programs, after which landmarks are shared."""
    early = tuning.PresolveTuning(easy_actions=0, relaxed_actions=0, neighbourhood_actions=1)
    monkeypatch.setattr(tuning, "PRESOLVE", early)


def every_goal(problem: Problem) -> list[Problem]:
    """Return a problem for each goal, and then one for each object node, whether it can be made or not."""
    objects = [o for o in range(len(problem.network.objects)) if o not in problem.kitchen]
    return [replace(problem, goals=(o,)) for o in (*problem.goals, *objects)]


def together(problems: list[Problem], objective: Objective) -> tuple[list[Outcome], SolvedGoals]:
    """Answer problems one after the other with what they share."""
    solved = SolvedGoals()
    return [solve(problem, (objective,), solved=solved) for problem in problems], solved


def costs_agree(problems: list[Problem], objective: Objective) -> bool:
    """Hold answers against those found alone; return whether anything was shared."""
    outcomes, solved = together(problems, objective)
    for problem, outcome in zip(problems, outcomes, strict=True):
        alone = solve(problem, (objective,))
        assert outcome.status is alone.status
        if alone.costs is not None:
            assert outcome.costs is not None
            assert outcome.costs.measure(objective) == alone.costs.measure(objective)
    return solved.sharing


@pytest.mark.parametrize("objective", EXACT[:2])
@pytest.mark.parametrize("width", [4, 6])
def test_goals_of_layered_networks_have_the_costs_that_they_have_alone(
    objective: Objective, width: int
) -> None:
    assert costs_agree(every_goal(hard_problem(width, depth=4, producers=3, inputs=2)), objective)


@pytest.mark.parametrize("objective", EXACT)
def test_goals_whose_relaxation_leaves_a_gap_are_proved_too(objective: Objective) -> None:
    assert sum(costs_agree(every_goal(gap_problem(seed)), objective) for seed in range(3)) == 3


def without_each_unit(problem: Problem, tree: tuple[int, ...]) -> list[Problem]:
    """Return a problem without each unit of a tree, and one without two of them."""
    removed = [*({unit} for unit in tree), {*tree[:2]}]
    return [replace(problem, restriction=Restriction(units.__contains__)) for units in removed]


@pytest.mark.parametrize("objective", EXACT[:2])
def test_trees_without_units_have_the_costs_that_they_have_alone(objective: Objective) -> None:
    problem = hard_problem(width=5, depth=3, producers=3, inputs=2)
    last = len(problem.network.objects)
    problem = replace(problem, goals=(last - 1, last - 2, *problem.goals))
    tree = solve(problem, (objective,)).units
    assert tree
    assert costs_agree([problem, *without_each_unit(problem, tree)], objective)


def test_each_answer_has_a_certificate_of_its_own() -> None:
    problems = every_goal(hard_problem(width=4, depth=4, producers=3))
    outcomes, solved = together(problems, Objective.UNITS)
    assert solved.sharing
    for problem, outcome in zip(problems, outcomes, strict=True):
        found, certificate = certify_outcome(outcome, Settings(), lambda: False)
        assert found.certified == (Objective.UNITS,)
        assert certificate is not None
        verify(read_certificate(certificate.text()), subject_of(problem))


def test_rates_are_rounded_so_that_nothing_is_shared() -> None:
    outcomes, solved = together(every_goal(hard_problem(width=6, depth=3)), Objective.SUCCESS)
    assert not solved.sharing
    assert {outcome.status for outcome in outcomes} == {Status.OPTIMAL}


def test_at_a_limit_an_answer_has_what_was_found() -> None:
    solved = SolvedGoals()
    problems = every_goal(hard_problem(width=4, depth=4, producers=3))
    for problem in problems[:-1]:
        solve(problem, solved=solved)
    assert solved.sharing
    outcome = solve(problems[-1], settings=Settings(deadline=Deadline(0)), solved=solved)
    assert outcome.status in {Status.UNKNOWN, Status.FEASIBLE}
    assert outcome.stopped
