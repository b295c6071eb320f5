"""Problems for unified-planning, plans back, and the engine there."""

import importlib.util

import pytest

import foon_asp
from foon_asp.planning import translator

if importlib.util.find_spec("unified_planning") is None:
    pytest.skip("unified-planning is not installed (foon-asp[planning])", allow_module_level=True)

import unified_planning.shortcuts as up
from unified_planning.engines import PlanGenerationResultStatus as Ended
from unified_planning.engines import ValidationResultStatus
from unified_planning.plans import ActionInstance, SequentialPlan

up.get_environment().credits_stream = None


@pytest.fixture
def engine() -> str:
    if not translator.is_installed():
        pytest.skip("Fast Downward's translator is not installed (foon-asp[pddl])")
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


def lamps(deleting: str = "") -> "up.Problem":
    """Make a problem with parameters, names that PDDL does not take, and perhaps a delete."""
    lamp = up.UserType("Lamp")
    lit, power, quiet = (
        up.Fluent("is lit", up.BoolType(), l=lamp),
        up.Fluent("power", up.BoolType()),
        up.Fluent("quiet", up.BoolType()),
    )
    light = up.InstantaneousAction("Light It", l=lamp)
    light.add_precondition(power)
    light.add_effect(lit(light.l), True)
    if deleting:
        light.add_effect({"power": power, "quiet": quiet}[deleting], False)
    problem = up.Problem("lamps")
    problem.add_fluents([lit, power, quiet])
    for fluent, value in ((lit, False), (power, True), (quiet, True)):
        problem.fluents_defaults[fluent] = problem.environment.expression_manager.auto_promote(value)[0]
    problem.add_action(light)
    objects = [up.Object(name, lamp) for name in ("A 1", "a-2")]
    problem.add_objects(objects)
    for each in objects:
        problem.add_goal(lit(each))
    return problem


def test_problems_of_others(engine: str) -> None:
    with up.OneshotPlanner(name=engine) as planner:
        for harmless in ("", "quiet"):
            found = planner.solve(lamps(harmless))
            assert found.status is Ended.SOLVED_OPTIMALLY
            assert {str(step) for step in found.plan.actions} == {"Light It(A 1)", "Light It(a-2)"}
        found = planner.solve(lamps("power"))
        assert found.status is Ended.UNSUPPORTED_PROBLEM
        assert "without deletes" in found.log_messages[0].message


@pytest.mark.slow
def test_every_example_there_is_solved_or_unsupported(engine: str) -> None:
    """What is supported and has no deletes in its way is solved; nothing is raised, whatever is asked."""
    from unified_planning.test.examples import get_example_problems  # noqa: PLC0415 (slow to import)

    solved = set()
    for name, example in get_example_problems().items():
        problem = example.problem
        if not isinstance(problem, up.Problem):
            continue
        with up.OneshotPlanner(name=engine) as planner:
            planner.skip_checks = True
            found = planner.solve(problem)
            supported = planner.supports(problem.kind)
        if found.status is Ended.UNSUPPORTED_PROBLEM:
            assert not supported or "without deletes" in found.log_messages[0].message, name
            continue
        assert supported, name
        assert found.status is Ended.SOLVED_OPTIMALLY, name
        with up.PlanValidator(problem_kind=problem.kind) as validator:
            assert validator.validate(problem, found.plan).status is ValidationResultStatus.VALID
        assert len(found.plan.actions) <= len(example.valid_plans[0].actions), name
        solved.add(name)
    assert {"basic", "basic_conditional", "basic_exists", "basic_with_costs"} <= solved


@pytest.mark.parametrize("feature", ["oversubscription", "real costs", "cost that is computed"])
def test_what_is_beyond_is_unsupported(engine: str, feature: str) -> None:
    problem = lamps()
    light, power = problem.action("Light It"), problem.fluent("power")
    if feature == "oversubscription":
        problem.add_quality_metric(up.Oversubscription({power(): 2}))
    else:
        cost = up.Fraction(1, 3) if feature == "real costs" else up.Times(2, up.Plus(1, 3))
        problem.add_quality_metric(up.MinimizeActionCosts({light: cost}))
    with up.OneshotPlanner(name=engine) as planner:
        planner.skip_checks = True
        found, supported = planner.solve(problem), planner.supports(problem.kind)
    assert (found.status is Ended.SOLVED_OPTIMALLY) == supported == (feature == "cost that is computed")


def test_without_the_translator_the_engine_is_not_offered(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    with pytest.raises(foon_asp.UserError, match=r"pip install 'foon-asp\[pddl\]'"):
        foon_asp.register_engine()


@pytest.mark.parametrize(("goal", "steps"), [("ice", 2), ("greek salad", 33)])
def test_a_validator_runs_our_plans_where_items_are_used_up(goal: str, steps: int) -> None:
    problem = foon_asp.load().problem(goal, items="used-up")
    unified = foon_asp.to_unified_planning(problem)
    names = {action.unit: action.name for action in foon_asp.export(problem).task.actions}
    units = foon_asp.solve(problem).ids
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
