"""Every objective is measured the same in all rooms, and one that a room does not know is refused by name."""

import math
from dataclasses import replace
from fractions import Fraction

import clingo
import pytest

from foon_asp.asp import Settings, Status, solve
from foon_asp.asp.ranking import Ranked
from foon_asp.encoding.cost_scales import Scales
from foon_asp.encoding.fact_writer import write_facts, write_objectives
from foon_asp.engines import ClaimedAnswer, DisagreementError, cross_check
from foon_asp.errors import BugError
from foon_asp.hypergraph import ALL, NONE, Reduction
from foon_asp.network import UnitPrices
from foon_asp.problem import (
    ContainerRule,
    Costs,
    Objective,
    OptionalData,
    Problem,
    Row,
    levels,
    multiplies,
)
from foon_asp.proof import unit_costs
from foon_asp.resources import encodings_folder
from tests.encoding.test_rate_scale import two_ways
from tests.oracle import task_trees
from tests.support.random_problems import random_problem
from tests.support.ways_problem import ways

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
        Row("tries", "cost", lambda unit: 1 / unit.rate, needs=OptionalData.RATES, is_fact=True, whole=False)
    ),
}


def known(objective: Objective, monkeypatch: pytest.MonkeyPatch) -> None:
    """Have trees measured by a made-up objective, too."""
    monkeypatch.setattr("foon_asp.problem.costs._BUILT_IN_OBJECTIVES", (*Objective, objective))


def best_by_hand(problem: Problem, objectives: tuple[Objective, ...]) -> tuple[Fraction | int, ...] | None:
    """Give what the best tree costs, found by looking at all."""
    keys = []
    for tree in task_trees.trees(problem):
        units = [unit for node in tree if (unit := problem.network.unit_id(node)) is not None]
        figures = [[objective.row.unit(problem.measured(unit)) for unit in units] for objective in objectives]
        signs = [
            (-math.prod(f) if o.row.multiplies else sum(f)) for o, f in zip(objectives, figures, strict=True)
        ]
        keys.append((*signs, len(units)))
    return min(keys, default=None)


@pytest.mark.parametrize("reductions", [ALL, NONE])
@pytest.mark.parametrize("new", NEW)
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.default_cases(
    "strict-to scale-reductions0", "implied-whole-reductions1", "strict-rounded-reductions1"
)
def test_a_row_is_all_that_a_new_objective_takes(
    new: str, reductions: frozenset[Reduction], rule: ContainerRule, monkeypatch: pytest.MonkeyPatch
) -> None:
    objective = NEW[new]
    known(objective, monkeypatch)
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
def test_other_engines_are_asked_about_a_new_objective(new: str, monkeypatch: pytest.MonkeyPatch) -> None:
    known(NEW[new], monkeypatch)
    outcome = solve(ways(["1/3", "1"], ["0.7"], ["1/2"]), (NEW[new],))
    clingo, *_ = cross_check(ClaimedAnswer(outcome))
    assert (clingo.reason, clingo.objectives) == (None, levels((NEW[new],)))
    worse = (0, 1)
    with pytest.raises(DisagreementError):
        list(cross_check(ClaimedAnswer(outcome._replace(units=worse, costs=outcome.problem.costs(worse)))))


@pytest.mark.parametrize("other", [(), (Objective.KITCHEN,)])
@pytest.mark.parametrize("first", [0, 1])
def test_equal_totals_of_different_costs_are_equal(
    first: int, other: tuple[Objective, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Rounded costs of two units weigh less than what they cost together, which is the cost of one unit."""
    objectives = (*other, NEW["rounded"])
    known(NEW["rounded"], monkeypatch)
    one, two, too_fine = 1 + Fraction(1, 1019), 1 + Fraction(1, 1013), 3 + Fraction(1, 1_000_003)
    pair, alone = [str(1 / one), str(1 / two)], [str(1 / (one + two))]
    chains = [pair, alone] if not first else [alone, pair]
    problem = ways(*chains, [str(1 / too_fine)])
    for settings in (Settings(), Settings(reductions=NONE)):
        outcome = solve(problem, objectives, settings)
        assert outcome.status is Status.OPTIMAL
        assert outcome.units == ((0,) if first else (2,))
    found = [units for units, _ in Ranked(problem, objectives, Settings())]
    assert [len(units) for units in found] == [1, 2, 1]


@pytest.mark.parametrize("reductions", [ALL, NONE])
def test_rooms_that_measure_different_things_give_no_answer(
    reductions: frozenset[Reduction], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Trees have twice their units by it; bounds take it for the inputs, and the encodings for those, too."""
    inputs = made_up(Objective.INPUTS.row._replace(term="inputs"))
    measure = Costs.measure
    monkeypatch.setattr(
        Costs, "measure", lambda costs, by: 2 * costs.units if by is inputs else measure(costs, by)
    )
    with pytest.raises(BugError, match=r"the reductions make it|weigh .* but cost"):
        solve(two_ways(["0.5", "0.5"], ["0.2"]), (inputs,), Settings(reductions=reductions))


def test_the_verifier_knows_all_objectives() -> None:
    assert set(unit_costs.OBJECTIVES) == set(map(str, Objective))


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


@pytest.mark.parametrize("objective", Objective)
def test_encodings_and_trees_measure_the_same(objective: Objective) -> None:
    """What ``objectives.lp`` adds up is what is counted by hand, exactly or below by the rounding."""
    measured = 0
    for seed in range(500, 524):
        problem = random_problem(seed, RULES[seed % 2])
        scales = Scales(problem, range(len(problem.network)), [objective])
        for tree in list(task_trees.trees(problem))[:6]:
            units = [u for node in tree if (u := problem.network.unit_id(node)) is not None]
            by_hand = abs(task_trees.measure(problem, tree, str(objective)))
            assert problem.costs(units).measure(objective) == by_hand
            [weight] = criteria(problem, units, [objective])
            assert (weight - scales.weight(objective, units)) % 2**32 == 0
            assert scales.allows(objective, scales.weight(objective, units), by_hand)
            assert not objective.row.whole or weight == by_hand
            measured += 1
    assert measured > 50


def test_rates_do_not_count_where_nothing_multiplies() -> None:
    problem = replace(two_ways(["0.5", "0.5"], ["0.2"]), rates=None)
    prices = UnitPrices(dict.fromkeys(problem.network.motions, Fraction(2)), {})
    problem = replace(problem, unit_prices=prices)
    assert [multiplies(objective) for objective in Objective].count(True) == 1
    for objective in Objective:
        if objective.row.needs is not OptionalData.RATES:
            assert solve(problem, (objective,)).units == (2,)
