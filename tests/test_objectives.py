"""Every objective is measured the same in all rooms, and one that a room does not know is refused by name."""

import math
import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import clingo
import pytest

from foon_asp.asp import Settings, Status, solve
from foon_asp.asp.ranking import Ranked
from foon_asp.asp.session import Session
from foon_asp.certificate import certify
from foon_asp.encoding.exact_success import problem_scale
from foon_asp.encoding.facts import write_facts, write_objectives
from foon_asp.encoding.scales import Scales
from foon_asp.engines import Asked, DisagreementError, cross_check
from foon_asp.errors import BugError, UserError
from foon_asp.network import UnitPrices
from foon_asp.problem import (
    ContainerRule,
    Costs,
    Known,
    Objective,
    Problem,
    Row,
    executable_order,
    levels,
    multiplies,
)
from foon_asp.proof import verify
from foon_asp.questions.pareto import pareto
from foon_asp.reduce import ALL, NONE, ExactCosts, Reduction
from foon_asp.reduce.exact_costs import TooFineError
from foon_asp.resources import encodings_folder
from tests import oracle
from tests.random_problems import random_problem
from tests.test_exact_success import two_ways
from tests.ways_problem import ways

RULES = list(ContainerRule)


def made_up(row: Row) -> Objective:
    """Make an objective that is a row, and nothing else: no room has heard of its name."""
    return Objective.of_row(row.term, row)


NEW = {
    "whole": made_up(Row("dear", "cost", lambda unit: 3 * len(list(unit.inputs)) % 7, is_fact=True)),
    "to scale": made_up(
        Row(
            "cents", "cost", lambda unit: Fraction(len(list(unit.inputs)) % 3, 100), is_fact=True, whole=False
        )
    ),
    "rounded": made_up(
        Row("tries", "cost", lambda unit: 1 / unit.rate, needs=Known.RATES, is_fact=True, whole=False)
    ),
}


def best_by_hand(problem: Problem, objectives: tuple[Objective, ...]) -> tuple[Fraction | int, ...] | None:
    """Give what the best tree costs, found by looking at all."""
    keys = []
    for tree in oracle.trees(problem):
        units = [unit for node in tree if (unit := problem.network.unit_id(node)) is not None]
        figures = [[objective.row.unit(problem.measured(unit)) for unit in units] for objective in objectives]
        signs = [
            (-math.prod(f) if o.row.multiplies else sum(f)) for o, f in zip(objectives, figures, strict=True)
        ]
        keys.append((*signs, len(units)))
    return min(keys, default=None)


@pytest.mark.parametrize("reductions", [ALL, *(frozenset({one}) for one in Reduction), NONE])
@pytest.mark.parametrize("new", NEW)
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.sampled(4)
def test_a_row_is_all_that_a_new_objective_takes(
    new: str, reductions: frozenset[Reduction], rule: ContainerRule, monkeypatch: pytest.MonkeyPatch
) -> None:
    objective = NEW[new]
    monkeypatch.setattr("foon_asp.problem.costs._MEASURED", (*Objective, objective))
    solved = 0
    for seed in range(40):
        problem = random_problem(seed, rule)
        asked = [(objective,), (Objective.INPUTS, objective), (objective, Objective.SUCCESS)][seed % 3]
        if new == "rounded" and len(asked) > 1:
            asked = asked[:1] if asked[0] is objective else asked
        best = best_by_hand(problem, asked)
        found = solve(problem, asked, Settings(reductions=reductions))
        assert (found.costs is None) == (best is None)
        if found.costs is not None:
            assert found.status is Status.OPTIMAL
            assert found.costs.key((*asked, Objective.UNITS)) == best
            solved += 1
    assert solved > 10


@pytest.mark.parametrize("new", NEW)
def test_trees_in_order_of_a_new_objective(new: str, monkeypatch: pytest.MonkeyPatch) -> None:
    objective = NEW[new]
    monkeypatch.setattr("foon_asp.problem.costs._MEASURED", (*Objective, objective))
    for seed in range(30):
        problem = random_problem(seed, ContainerRule.STRICT)
        best = best_by_hand(problem, (objective,))
        keys = [
            costs.key((objective, Objective.UNITS)) for _, costs in Ranked(problem, (objective,), Settings())
        ]
        assert keys == sorted(keys)
        assert keys[:1] == ([] if best is None else [best])


@pytest.mark.slow
@pytest.mark.parametrize("new", NEW)
@pytest.mark.sampled(3)
def test_other_engines_are_asked_about_a_new_objective(new: str, monkeypatch: pytest.MonkeyPatch) -> None:
    objective = NEW[new]
    monkeypatch.setattr("foon_asp.problem.costs._MEASURED", (*Objective, objective))
    agreed = 0
    for seed in range(12):
        problem = random_problem(seed, ContainerRule.STRICT)
        outcome = solve(problem, (objective,))
        checks = list(cross_check(Asked(outcome)))
        agreed += sum(check.reason is None for check in checks)
        assert {check.engine: check.reason for check in checks}["clingo"] is None
        if outcome.units:
            trees = [
                [u for n in tree if (u := problem.network.unit_id(n)) is not None]
                for tree in oracle.trees(problem)
            ]
            worse = max(trees, key=lambda tree: problem.costs(tree).key((objective,)))
            costs = problem.costs(worse)
            if costs.measure(objective) == outcome.costs.measure(objective):  # type: ignore[union-attr]
                continue
            order = executable_order(problem, worse)
            with pytest.raises(DisagreementError):
                list(cross_check(Asked(outcome._replace(units=order, costs=costs))))
    assert agreed > 12


@pytest.mark.parametrize("new", NEW)
@pytest.mark.sampled(3)
def test_the_front_of_a_new_objective(new: str, monkeypatch: pytest.MonkeyPatch) -> None:
    objective = NEW[new]
    monkeypatch.setattr("foon_asp.problem.costs._MEASURED", (*Objective, objective))
    asked = (Objective.INPUTS, objective)
    monkeypatch.setattr("foon_asp.questions.pareto.chosen_objectives", lambda *_: asked)
    points = 0
    for seed in range(120):
        problem = random_problem(seed, ContainerRule.STRICT)
        trees = [
            [u for n in tree if (u := problem.network.unit_id(n)) is not None]
            for tree in oracle.trees(problem)
        ]
        keys = {problem.costs(tree).key(asked) for tree in trees}
        front = sorted(
            key for key in keys if not any(o != key and o[0] <= key[0] and o[1] <= key[1] for o in keys)
        )
        if any(rate < Fraction(1, 10**9) for rate in (problem.rates or {}).values()):
            continue  # 1/rate does not fit clingo
        found = pareto(problem)
        assert found.complete
        assert [point.costs.key(asked) for point in found.points] == front
        points += len(front) > 1
        found.text(), found.json()
    assert points > 1


def test_two_objectives_that_have_to_be_rounded_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    objective = NEW["rounded"]
    monkeypatch.setattr("foon_asp.problem.costs._MEASURED", (*Objective, objective))
    problem = two_ways(["1/1009", "1/1013"], ["1/1000003"])
    problem = replace(problem, rates={m: 1 - r / 7 for m, r in (problem.rates or {}).items()})
    with pytest.raises(UserError, match="tries and success have to be rounded for the solver"):
        solve(problem, (objective, Objective.SUCCESS), Settings(reductions=NONE))


@pytest.mark.parametrize("other", [(), (Objective.KITCHEN,)])
@pytest.mark.parametrize("reversed_", [False, True])
def test_equal_totals_of_different_costs_are_equal(
    reversed_: bool, other: tuple[Objective, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Rounded costs of two units weigh less than what they cost together, which is the cost of one unit."""
    objective = NEW["rounded"]
    monkeypatch.setattr("foon_asp.problem.costs._MEASURED", (*Objective, objective))
    one, two, too_fine = 1 + Fraction(1, 1019), 1 + Fraction(1, 1013), 3 + Fraction(1, 1_000_003)
    chains = [[one, two], [one + two], [1 + Fraction(1, 1021), one + two - 1 - Fraction(1, 1021)], [too_fine]]
    if reversed_:
        chains = chains[::-1]
    problem = ways(*([str(1 / cost) for cost in chain] for chain in chains))
    best = (2,) if not reversed_ else (3,)
    for settings in (Settings(), Settings(reductions=NONE)):
        outcome = solve(problem, (*other, objective), settings)
        assert (outcome.status, outcome.units) == (Status.OPTIMAL, best)
    first, second, third, _ = Ranked(problem, (*other, objective), Settings())
    assert first[0] == best
    assert {len(second[0]), len(third[0])} == {2}


def test_programs_are_kept_for_objectives_that_are_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[object] = []
    program = Session.program

    def counted(session: Session, *given: Any) -> Any:
        asked.append(given)
        return program(session, *given)

    monkeypatch.setattr(Session, "program", counted)
    file = tmp_path / "other.lp"  # of no kind that is applied before the search
    file.write_text("{ free }.\n:- free, use(U), not unit(U).\n", encoding="utf-8")
    rule = Settings((file,), reductions=NONE, session=Session())
    problem = two_ways(["0.5", "0.5"], ["0.2"])
    for new, objective in NEW.items():
        asked.clear()
        monkeypatch.setattr("foon_asp.problem.costs._MEASURED", (*Objective, objective))
        outcome = solve(problem, (objective,), rule)
        assert outcome.status is Status.OPTIMAL
        assert bool(asked) == (new == "whole")


@pytest.mark.parametrize("reductions", [ALL, *(frozenset({one}) for one in Reduction), NONE])
def test_rooms_that_measure_different_things_give_no_answer(
    reductions: frozenset[Reduction], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Trees have twice their units by it; bounds take it for the inputs, and the encodings for those, too."""
    inputs = made_up(Objective.INPUTS.row._replace(term="inputs"))
    measure = Costs.measure
    monkeypatch.setattr(
        Costs, "measure", lambda costs, by: 2 * costs.units if by is inputs else measure(costs, by)
    )
    for chains in ((["0.5", "0.5"], ["0.2"]), (["0.2"], ["0.5", "0.5"])):
        with pytest.raises(BugError, match=r"the reductions make it|weigh .* but cost"):
            solve(two_ways(*chains), (inputs,), Settings(reductions=reductions))


def test_a_certificate_by_an_unknown_objective_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = two_ways(["0.5", "0.5"], ["0.2"])
    certificate = certify(problem, (Objective.INPUTS,), (2,))
    assert certificate is not None
    given = problem.network, problem.kitchen, problem.rates, problem.utensils, problem.unit_prices
    verify.verify(certificate.content, *given)
    content = {**certificate.content, "objective": ["nonsense"]}
    content["seal"] = verify.seal(content)
    for known in (verify.OBJECTIVES, (*verify.OBJECTIVES, "nonsense")):
        monkeypatch.setattr(verify, "OBJECTIVES", known)
        with pytest.raises(verify.RefusedError, match="an objective is unknown"):
            verify.verify(content, *given)


def test_the_verifier_knows_all_objectives() -> None:
    assert set(verify.OBJECTIVES) == set(map(str, Objective))


def criteria(problem: Problem, tree: list[int], objectives: list[Objective]) -> list[int]:
    """Have clingo measure a tree by ``objectives.lp`` alone."""
    scales = Scales(problem, range(len(problem.network)), objectives)
    control = clingo.Control(["--warn=none"])
    control.load(str(encodings_folder() / "objectives.lp"))
    facts = write_facts(problem, range(len(problem.network)), scales) + write_objectives(objectives)
    control.add("base", [], facts + "".join(f"use({unit}).\n" for unit in tree))
    control.ground([("base", [])])
    costs: list[int] = []
    control.solve(on_model=lambda model: costs.extend(model.cost))
    return costs


@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("objective", Objective)
@pytest.mark.sampled(18)
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
                assert costs.measure(objective) == exact.total(objective, reduced) == by_hand
                scales = Scales(problem, range(len(problem.network)), [objective])
                [weight] = found
                assert weight % 2**32 == scales.weight(objective, units) % 2**32
                assert scales.allows(objective, scales.weight(objective, units), by_hand)
                assert not objective.row.whole or found == [by_hand]
            measured += 1
    assert measured > 100


@pytest.mark.parametrize("objective", Objective)
def test_every_objective_is_a_criterion_of_the_encodings(objective: Objective) -> None:
    text = (encodings_folder() / "objectives.lp").read_text()
    if objective.row.is_fact:
        assert "cost(Objective,U,N), optimize(Objective,P)" in text
        return
    [name] = re.findall(r"optimize\((\w+),1\)", write_objectives([objective]))
    assert re.search(rf"optimize\({name},P\)", text)


def test_rates_do_not_count_where_nothing_multiplies() -> None:
    problem = replace(two_ways(["0.5", "0.5"], ["0.2"]), rates=None)
    prices = UnitPrices(dict.fromkeys(problem.network.motions, Fraction(2)), {})
    problem = replace(problem, unit_prices=prices)
    assert [multiplies(objective) for objective in Objective].count(True) == 1
    for objective in Objective:
        if objective.row.needs is not Known.RATES:
            assert solve(problem, (objective,)).units == (2,)
