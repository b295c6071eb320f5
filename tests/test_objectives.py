"""Every objective is measured the same in all rooms, and one that a room does not know is refused by name."""

import re
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import clingo
import pytest

from foon_asp.asp import Settings, solve
from foon_asp.asp.exact_success import problem_scale
from foon_asp.asp.facts import write_at_most, write_facts, write_objectives
from foon_asp.asp.ranking import Ranked
from foon_asp.asp.session import Session
from foon_asp.certificate import certify
from foon_asp.certificate.arrays import Arrays
from foon_asp.certificate.coverage import NOTHING
from foon_asp.cli.progress import Progress
from foon_asp.engines import engine, fast_downward, highs
from foon_asp.errors import BugError
from foon_asp.explain.alternatives import all_optimal
from foon_asp.explain.menu import menu
from foon_asp.explain.pareto import pareto_front
from foon_asp.problem import ContainerRule, Costs, Objective, Problem, levels, multiplies, unit_count
from foon_asp.proof import verify
from foon_asp.reduce import ALL, NONE, ExactCosts, Reduction, reduce
from foon_asp.reduce.exact_costs import CoarseCosts, TooFineError
from foon_asp.report.answer import bounds_json
from foon_asp.resources import encodings_folder
from tests import oracle
from tests.random_problems import random_problem
from tests.test_exact_success import two_ways

RULES = list(ContainerRule)


def unknown() -> Objective:
    """Make an objective that no room has heard of: what is added to the class, and nowhere else."""
    fake = str.__new__(Objective, "attempts")
    fake._name_, fake._value_ = "ATTEMPTS", "attempts"
    return fake


FAKE = unknown()
COSTS = Costs(1, 2, 3, 4, Fraction(1, 2))


def asked(*objectives: Objective, **how: Any) -> Callable[[Problem], object]:
    return lambda problem: solve(problem, objectives, Settings(**how))


ROOMS: dict[str, Callable[[Problem], object]] = {
    "multiplies": lambda _: multiplies(FAKE),
    "unit_count": lambda p: unit_count(p.network, FAKE, 0),
    "costs": lambda _: COSTS.measure(FAKE),
    "costs in order": lambda _: COSTS.key((FAKE,)),
    "exact costs": lambda p: ExactCosts(p, (FAKE, Objective.UNITS), range(3))(0),
    "exact costs, later": lambda p: ExactCosts(p, (Objective.UNITS, FAKE), range(3))(0),
    "coarse costs": lambda p: CoarseCosts(p, FAKE)(0),
    "certificate": lambda p: Arrays(p, (FAKE, Objective.UNITS), NOTHING),
    "certificate, later": lambda p: Arrays(p, (Objective.SUCCESS, FAKE), NOTHING),
    "certify": lambda p: certify(p, (Objective.UNITS, FAKE), (0, 1)),
    "engine": lambda p: engine.cost(p, FAKE, 0),
    "HiGHS": lambda p: highs.solve_with_highs(p, (FAKE, Objective.UNITS), frozenset(), 5.0),
    "Fast Downward": lambda p: list(fast_downward._task(p, FAKE, frozenset())),
    "facts": lambda _: write_objectives((FAKE,)),
    "bounds": lambda _: write_at_most(0, {FAKE: 1}),
    "ranked": lambda p: list(Ranked(p, (FAKE,), Settings())),
    "alternatives": lambda p: all_optimal(p, (Objective.UNITS, FAKE), Settings(), 9),
    "menu": lambda p: menu(p, (FAKE,)),
    "pareto": lambda p: pareto_front(p, (Objective.UNITS, FAKE)),
    "pareto, leading": lambda p: pareto_front(p, (FAKE, Objective.UNITS)),
    "solve": asked(FAKE),
    "solve, later": asked(Objective.INPUTS, FAKE),
    "solve, last": asked(Objective.SUCCESS, Objective.UNITS, FAKE),
    "solve without reductions": asked(FAKE, reductions=NONE),
    "solve by need": asked(FAKE, encodings=Path("by_need")),
    "solve with a constraint": asked(FAKE, constraints=(Path("forbid_motion"),)),
    "session": asked(FAKE, constraints=(Path("forbid_motion"),), session=Session()),
    "report": lambda p: bounds_json(solve(p)._replace(bounds={FAKE: 3})),
    "progress": lambda _: Progress.bound(Progress.__new__(Progress), FAKE, 3),
    **{
        f"reduce, {name}": lambda p, one=one: reduce(p, (FAKE, Objective.UNITS), {one})  # type: ignore[misc]
        for name, one in Reduction.__members__.items()
    },
}


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_refuses_an_objective_that_it_does_not_know(room: str) -> None:
    problem = two_ways(["0.5", "0.5"], ["0.2"])
    with pytest.raises((BugError, ValueError), match="attempts"):
        ROOMS[room](problem)


@pytest.mark.parametrize("room", ROOMS)
def test_knowing_how_it_adds_up_is_not_enough(room: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("foon_asp.problem.objective._ADDED_UP", frozenset({*Objective, FAKE}))
    if room in {"multiplies", "report", "progress"}:
        return  # that is all they have to know
    problem = two_ways(["0.5", "0.5"], ["0.2"])
    with pytest.raises((BugError, ValueError), match="attempts"):
        ROOMS[room](problem)


@pytest.mark.parametrize("reductions", [ALL, *(frozenset({one}) for one in Reduction), NONE])
def test_rooms_that_know_different_things_give_no_answer(
    reductions: frozenset[Reduction], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Trees have twice their units by it; bounds take it for the inputs, and the encodings for those, too."""
    measure = Costs.measure
    monkeypatch.setattr("foon_asp.problem.objective._ADDED_UP", frozenset({*Objective, FAKE}))
    monkeypatch.setattr(
        Costs, "measure", lambda costs, by: 2 * costs.units if by is FAKE else measure(costs, by)
    )
    monkeypatch.setattr(
        "foon_asp.reduce.exact_costs.unit_count",
        lambda network, by, unit: unit_count(network, Objective.INPUTS if by is FAKE else by, unit),
    )
    monkeypatch.setattr("foon_asp.asp.facts.OBJECTIVE_TERMS", dict.fromkeys([*Objective, FAKE], "inputs"))
    for ways in ((["0.5", "0.5"], ["0.2"]), (["0.2"], ["0.5", "0.5"])):
        with pytest.raises(BugError, match=r"the reductions make it|clingo reports the costs"):
            solve(two_ways(*ways), (FAKE,), Settings(reductions=reductions))


def test_a_certificate_by_an_unknown_objective_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = two_ways(["0.5", "0.5"], ["0.2"])
    certificate = certify(problem, (Objective.INPUTS,), (2,))
    assert certificate is not None
    given = problem.network, problem.kitchen, problem.rates, problem.utensils
    verify.verify(certificate.content, *given)
    content = {**certificate.content, "objective": ["attempts"]}
    content["seal"] = verify.seal(content)
    for known in (verify.OBJECTIVES, (*verify.OBJECTIVES, "attempts")):
        monkeypatch.setattr(verify, "OBJECTIVES", known)
        with pytest.raises(verify.RefusedError, match="an objective is unknown"):
            verify.verify(content, *given)


def test_the_verifier_knows_all_objectives() -> None:
    assert set(verify.OBJECTIVES) == set(map(str, Objective))


def criteria(problem: Problem, tree: list[int], objectives: list[Objective]) -> list[int]:
    """Have clingo measure a tree by ``objectives.lp`` alone."""
    scale = problem_scale(problem, range(len(problem.network)))
    control = clingo.Control(["--warn=none"])
    control.load(str(encodings_folder() / "objectives.lp"))
    facts = write_facts(problem, range(len(problem.network)), scale) + write_objectives(objectives)
    control.add("base", [], facts + "".join(f"use({unit}).\n" for unit in tree))
    control.ground([("base", [])])
    costs: list[int] = []
    control.solve(on_model=lambda model: costs.extend(model.cost))
    return costs


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("objective", Objective)
@pytest.mark.sampled(3)
def test_encodings_and_rooms_measure_the_same(objective: Objective, rule: ContainerRule) -> None:
    """What cuts go by where no solver runs is what ``objectives.lp`` says, and what is counted by hand."""
    measured = 0
    for seed in range(500, 580):
        problem = random_problem(seed, rule)
        scale = problem_scale(problem, range(len(problem.network)))
        for tree in list(oracle.trees(problem))[:12]:
            units = [u for node in tree if (u := problem.network.unit_id(node)) is not None]
            by_hand = oracle.measure(problem, tree, str(objective))
            costs = problem.costs(units)
            actions = list(units)
            if objective is Objective.KITCHEN:
                needed = {o for unit in units for o in problem.needs[unit]}
                actions += [len(problem.network) + o for o in needed & problem.kitchen]
            try:
                exact = ExactCosts(problem, levels((objective,)), actions)
            except TooFineError:  # then the reductions do not go by costs
                assert multiplies(objective)
                continue
            reduced = sum(dict(exact.figures(action))[objective] for action in actions)
            found = criteria(problem, units, [objective])
            if multiplies(objective):
                assert costs.measure(objective) == -by_hand
                assert exact.is_logarithm(reduced, -by_hand)
                assert found == [sum(scale.weights[problem.rate(unit)] for unit in units)]
            else:
                assert costs.measure(objective) == reduced == by_hand
                assert found == [by_hand]
            measured += 1
    assert measured > 100


@pytest.mark.parametrize("objective", Objective)
def test_every_objective_is_a_criterion_of_the_encodings(objective: Objective) -> None:
    text = (encodings_folder() / "objectives.lp").read_text()
    [name] = re.findall(r"optimize\((\w+),1\)", write_objectives([objective]))
    assert re.search(rf"optimize\({name},P\)", text)


def test_rates_do_not_count_where_nothing_multiplies() -> None:
    problem = replace(two_ways(["0.5", "0.5"], ["0.2"]), rates=None)
    assert [multiplies(objective) for objective in Objective].count(True) == 1
    for objective in Objective:
        if not multiplies(objective):
            assert solve(problem, (objective,)).units == (2,)
