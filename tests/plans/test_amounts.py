"""Plans with amounts: against brute force, by hand, of great numbers, and what is not built for them."""

from collections import Counter
from collections.abc import Iterator
from fractions import Fraction
from itertools import permutations, product
from pathlib import Path
from random import Random

import pytest

import foon_asp
from foon_asp.asp import Settings, Status
from foon_asp.asp.bare_program import bare_program
from foon_asp.asp.optimum import solve
from foon_asp.certificate import certify_outcome
from foon_asp.plans.execution_order import bulk_order, least_copies
from foon_asp.plans.flows import Flows
from foon_asp.problem import Objective
from tests.oracle import amounts
from tests.plans.test_count_bound import random_flows

WOOD = [
    ("saw", ["log"], ["plank"] * 4),
    ("craft", ["plank"] * 2, ["stick"] * 4),
    ("light", ["stick", "coal"], ["torch"] * 4),
]
URANIUM = [
    ("enrich", ["u235"] * 40 + ["u238"] * 5, ["u235"] * 41 + ["u238"] * 2),
    ("load", ["u235"], ["fuel"]),
]


def never() -> bool:
    return False


@pytest.mark.parametrize("seed", [*range(160), 3083])
def test_small_problems_are_as_brute_force_has_them(seed: int) -> None:
    assert amounts.outcome(seed, amounts.OBJECTIVES[seed % 4]) in {"right", "open"}


@pytest.mark.slow
def test_five_thousand_small_problems() -> None:
    counts = amounts.main(0, 5000)
    assert not counts["wrong"]
    assert counts["unknown"] <= 50


@pytest.mark.parametrize("seed", range(60))
def test_what_is_proved_has_a_certificate(seed: int) -> None:
    problem = amounts.random_amounts(seed)
    objective = (Objective.UNITS, Objective.PRICE, Objective.INPUTS, Objective.SUCCESS)[seed % 4]
    outcome = solve(problem, (objective,))
    if outcome.status in {Status.OPTIMAL, Status.INFEASIBLE}:
        _, certificate = certify_outcome(outcome, Settings())  # verified where it is written
        assert certificate is None or certificate.claim in {"optimal", "infeasible", "bound"}
        assert certificate is not None or objective is not Objective.UNITS


@pytest.mark.parametrize(
    ("torches", "units"), [(1, 3), (4, 3), (5, 4), (64, 22), (1_000_000, 250_000 + 62_500 + 31_250)]
)
def test_torches(torches: int, units: int) -> None:
    foon = foon_asp.build(WOOD, kitchen=["log", "coal"])
    answer = foon_asp.solve(foon.problem("torch", amounts=torches))
    assert answer.status is Status.OPTIMAL
    assert answer.costs is not None
    assert answer.costs.units == units
    assert answer.units is not None
    assert len(answer.units) == 3
    if torches > 1:
        assert sum(step.times for step in answer.units if isinstance(step.times, int)) == units


def test_a_catalyst_has_to_be_there_first() -> None:
    for u235, units in ((40, 8), (39, None)):
        foon = foon_asp.build(URANIUM, kitchen=["u235", "u238"])
        stock: dict[str | foon_asp.ObjectNode, int] = {"u235": u235, "u238": 20}
        answer = foon_asp.solve(foon.problem("fuel", amounts=4, stock=stock, items="used-up"))
        # four are there to be loaded at once, as nothing has to be left
        assert answer.costs is not None
        assert answer.costs.units == 4
        answer = foon_asp.solve(foon.problem("fuel", "u235", amounts=[4, 40], stock=stock))
        assert (answer.costs and answer.costs.units) == units


def test_inputs_that_stay_are_needed_all_at_once() -> None:
    foon = foon_asp.build(
        [("forge", ["iron"], ["hammer"]), ("strike", ["hammer"] * 2 + ["ore"], ["plate"])],
        kitchen=["iron", "ore"],
    )
    answer = foon_asp.solve(foon.problem("plate", amounts=3, stays={"hammer": True}))
    assert answer.costs is not None
    assert answer.costs.units == 5
    answer = foon_asp.solve(foon.problem("plate", amounts=3))
    assert answer.costs is not None
    assert answer.costs.units == 9


def test_objectives_count_executions(tmp_path: Path) -> None:
    foon = foon_asp.build(
        WOOD,
        kitchen=["log", "coal"],
        rates={"saw": 0.9, "craft": 1, "light": 0.5},
        unit_prices={"saw": 3, "craft": 1, "light": 0},
    )
    problem = foon.problem("torch", amounts=9)  # three times light, once craft, once saw
    costs = foon_asp.solve(problem, "price").costs
    assert costs is not None
    assert [costs.measure(o) for o in (Objective.UNITS, Objective.INPUTS, Objective.PRICE)] == [5, 8, 4]
    assert (costs.success, costs.measure(Objective.ATTEMPTS)) == (Fraction(9, 80), Fraction(73, 9) - 0)
    stock: dict[str | foon_asp.ObjectNode, int] = {"log": 2, "coal": 9}
    stocked = foon.problem("torch", amounts=9, stock=stock)
    kitchen = foon_asp.solve(stocked, "kitchen", certificate=tmp_path / "proof.json")
    assert kitchen.costs is not None
    assert kitchen.costs.kitchen == 4
    verified = foon_asp.verify(foon, tmp_path / "proof.json")
    assert "wanted: 9 x torch" in str(verified)
    with pytest.raises(foon_asp.RefusedError):
        foon_asp.verify(foon_asp.build(WOOD[:2], kitchen=["log"]), tmp_path / "proof.json")


def test_rules_are_kept_to() -> None:
    problem = foon_asp.build(WOOD, kitchen=["log", "coal"]).problem("torch", amounts=9)
    most = foon_asp.solve(problem, constraints=':- times(U,N), N > 2, motion(U,"light").')
    assert most.status is not Status.OPTIMAL
    least = foon_asp.solve(problem, constraints=':- times(U,N), N < 2, motion(U,"craft").')
    assert least.costs is not None
    assert least.costs.units == 6
    limited = foon_asp.solve(problem, constraints=["at_most_units"], constants={"max_units": 4})
    assert limited.status is Status.INFEASIBLE


def test_a_plan_is_replayed_traced_and_scheduled_copy_by_copy() -> None:
    problem = foon_asp.build(WOOD, kitchen=["log", "coal"]).problem("torch", amounts=8)
    plan = foon_asp.solve(problem).tree
    assert plan is not None
    traced = foon_asp.trace(problem, plan)
    assert {str(node): n for node, n in traced.copies(len(plan)).items()} == {
        "plank": 2,
        "stick": 2,
        "torch": 8,
    }
    assert len(traced.executed[0].came) == 4
    assert "     + 4 x plank" in traced.text().splitlines()
    kitchen = "O\tcoal\nO\tlog\n" if traced.kitchen_text(1)[2] == "c" else "O\tlog\nO\tcoal\n"
    assert traced.kitchen_text(1) == f"{kitchen}O\tplank\n# Amount:\t4\n"
    again = foon_asp.trace(problem, plan, failed=4).answer
    assert again is not None
    assert [goal.wanted for goal in again.goals] == [8]
    assert foon_asp.check(problem, plan).executes
    fewer = foon_asp.check(problem, list(plan)[1:])
    assert not fewer.executes
    pytest.importorskip("ortools")
    durations = {"saw": 10, "craft": 10, "light": 10}
    found = foon_asp.schedule(problem, plan, durations=durations, agents=2)
    assert found.makespan == 30
    assert "light (4 x torch)" in found.text()
    assert [step.amount for step in found.timetable] == [4, 4, 4, 4]


def test_planners_get_numbers_and_no_merged_copies(tmp_path: Path) -> None:
    problem = foon_asp.build(WOOD, kitchen=["log", "coal"]).problem("torch", amounts=8)
    exported = foon_asp.export(problem)
    assert "(decrease (copies" in exported.domain()
    assert "(increase (copies" in exported.domain()
    assert " 4)" in exported.domain()
    assert " 8)" in exported.text()
    with pytest.raises(foon_asp.UserError, match="amounts are counted"):
        foon_asp.export(problem, items="set")
    with pytest.raises(foon_asp.UserError, match="amounts are not built for bare clingo"):
        bare_program(problem, (Objective.UNITS,), Settings(), {})


def test_amounts_of_goals_are_one_for_each_goal_and_count_copies() -> None:
    foon = foon_asp.build(WOOD, kitchen=["log", "coal"])
    with pytest.raises(foon_asp.UserError, match="found 2 amounts for 1 goal"):
        foon.problem("torch", amounts=[1, 2])
    with pytest.raises(foon_asp.UserError, match="from 1 to 1000000"):
        foon.problem("torch", amounts=0)
    with pytest.raises(foon_asp.UserError, match="leave --items lasting out"):
        foon.problem("torch", items="lasting", amounts=2)
    assert foon.problem("torch", amounts=1).items is not None
    both = foon_asp.solve(foon.problem("torch", "stick", amounts=[4, 4]))
    assert both.costs is not None
    assert both.costs.units == 4


def sequences(flows: Flows, counts: dict[int, int], start: dict[int, int]) -> Iterator[tuple[int, ...]]:
    """Return every order of executions that runs, one execution at a time."""
    executions = [a for a, n in counts.items() for _ in range(n)]
    for order in set(permutations(executions)):
        copies = Counter(start)
        runs = True
        for a in order:
            runs = runs and all(copies[o] >= n for o, n in flows.asks[a].items())
            copies.subtract(flows.uses[a])
            copies.update(flows.adds[a])
        if runs and all(copies[o] >= n for o, n in flows.targets.items()):
            yield order


def test_orders_of_counts_are_found_where_there_are_any() -> None:
    choose, found = Random(7), Counter[bool]()
    for _ in range(150):
        flows = random_flows(choose)
        counts = {a: n for a in range(len(flows.asks)) if (n := choose.randint(0, 2))}
        start = dict(flows.start)
        runs = bulk_order(flows, counts, start, never)
        order = () if runs is None else tuple(a for a, n in runs for _ in range(n))
        orders = set(sequences(flows, counts, start))
        assert (runs is None) == (not orders)
        assert runs is None or order in orders
        found[bool(orders)] += 1
        for taken in product(*(range(n + 1) for n in start.values())):
            less = dict(zip(start, taken, strict=True))
            if any(sequences(flows, counts, less)):
                assert all(less[o] >= n for o, n in least_copies(flows, counts).items())
    assert min(found.values()) > 20
