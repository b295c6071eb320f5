"""Problems for unified-planning, plans back, and the engine there."""

import importlib.util

import pytest

import foon_asp
from foon_asp.engines import fast_downward

if importlib.util.find_spec("unified_planning") is None:
    pytest.skip("unified-planning is not installed (foon-asp[planning])", allow_module_level=True)

import unified_planning.shortcuts as up
from unified_planning.engines import PlanGenerationResultStatus as Ended
from unified_planning.engines import ValidationResultStatus
from unified_planning.plans import ActionInstance, SequentialPlan

up.get_environment().credits_stream = None


@pytest.fixture
def engine() -> str:
    foon_asp.register_engine()
    foon_asp.register_engine()  # once is enough
    return "foon-asp"


@pytest.mark.parametrize("objective", ["units", "inputs", "kitchen"])
@pytest.mark.parametrize("goal", ["ice", "macaroni"])
def test_the_engine_finds_our_costs(engine: str, goal: str, objective: str) -> None:
    problem = foon_asp.load().problem(goal, containers="implied")
    unified = foon_asp.to_unified_planning(problem, objective)
    with up.OneshotPlanner(name=engine) as planner:
        found = planner.solve(unified)
    assert found.status is Ended.SOLVED_OPTIMALLY
    with up.PlanValidator(problem_kind=unified.kind) as validator:
        assert validator.validate(unified, found.plan).status is ValidationResultStatus.VALID
    read = foon_asp.read_plan(problem, found.plan)
    assert read.sound
    ours = foon_asp.solve(problem, objective).costs
    costs = problem.costs(unit for unit in map(problem.network.unit_id, read.tree) if unit is not None)
    assert ours is not None
    assert costs.measure(foon_asp.Objective(objective)) == ours.measure(foon_asp.Objective(objective))


def test_no_plan_is_proved(engine: str) -> None:
    unified = foon_asp.to_unified_planning(foon_asp.load().problem("apple pie"))
    with up.OneshotPlanner(name=engine) as planner:
        assert planner.solve(unified).status is Ended.UNSOLVABLE_PROVEN


def lamps(deleting: bool) -> "up.Problem":
    """Make a problem with parameters, names that PDDL does not take, and perhaps a delete that matters."""
    lamp = up.UserType("Lamp")
    lit, power = up.Fluent("is lit", up.BoolType(), l=lamp), up.Fluent("power", up.BoolType())
    light = up.InstantaneousAction("Light It", l=lamp)
    light.add_precondition(power)
    light.add_effect(lit(light.l), True)
    light.add_effect(power, False) if deleting else None
    problem = up.Problem("lamps")
    problem.add_fluent(lit, default_initial_value=False)
    problem.add_fluent(power, default_initial_value=True)
    problem.add_action(light)
    objects = [up.Object(name, lamp) for name in ("A 1", "a-2")]
    problem.add_objects(objects)
    for each in objects:
        problem.add_goal(lit(each))
    return problem


def test_problems_of_others(engine: str) -> None:
    with up.OneshotPlanner(name=engine) as planner:
        found = planner.solve(lamps(deleting=False))
        assert found.status is Ended.SOLVED_OPTIMALLY
        assert {str(step) for step in found.plan.actions} == {"Light It(A 1)", "Light It(a-2)"}
        assert planner.solve(lamps(deleting=True)).status is Ended.UNSUPPORTED_PROBLEM


@pytest.mark.skipif(not fast_downward.installed(), reason="Fast Downward is not installed")
def test_fast_downward_there_finds_our_costs() -> None:
    problem = foon_asp.load().problem("ice")
    unified = foon_asp.to_unified_planning(problem)
    with up.OneshotPlanner(name="fast-downward-opt") as planner:
        read = foon_asp.read_plan(problem, planner.solve(unified).plan)
    assert read.sound
    assert len(read.tree) == 2


@pytest.mark.parametrize(("goal", "steps"), [("ice", 2), ("greek salad", 33)])
def test_a_validator_runs_our_plans_where_items_are_used_up(goal: str, steps: int) -> None:
    problem = foon_asp.load().problem(goal, items="used-up")
    unified = foon_asp.to_unified_planning(problem)
    names = {action.unit: action.name for action in foon_asp.export(problem).task.actions}
    units = foon_asp.solve(problem).units
    assert units is not None
    assert len(units) == steps
    plan = SequentialPlan([ActionInstance(unified.action(names[unit])) for unit in units])
    broken = SequentialPlan([ActionInstance(unified.action(names[unit])) for unit in units[1:]])
    with up.PlanValidator(problem_kind=unified.kind) as validator:
        assert validator.validate(unified, plan).status is ValidationResultStatus.VALID
        assert validator.validate(unified, broken).status is ValidationResultStatus.INVALID
    read = foon_asp.read_plan(problem, plan)
    assert read.sound
    assert len(read.tree) == steps
    assert not foon_asp.read_plan(problem, broken).sound


def test_merged_copies_are_deleted_there_too() -> None:
    problem = foon_asp.load().problem("ice", items="used-up")
    unified = foon_asp.to_unified_planning(problem, items="set")
    assert "copies" not in {fluent.name for fluent in unified.fluents}
    assert any(effect.value.is_false() for action in unified.actions for effect in action.effects)
