"""Problems of unified-planning, which the extra ``foon-asp[planning]`` installs."""

from collections.abc import Sequence
from typing import Any

from foon_asp.errors import UserError
from foon_asp.planning.pddl_writer import AT_HAND, COPIES, DOMAIN
from foon_asp.planning.planning_task import planning_task
from foon_asp.planning.translator import require_translator
from foon_asp.problem import Objective, Problem

ENGINE = "foon-asp"


def require_unified_planning() -> Any:
    """Return the module ``unified_planning.shortcuts``; raises :class:`UserError` if it is not installed."""
    try:
        import unified_planning.shortcuts as up  # noqa: PLC0415 (optional)
    except ImportError:
        raise UserError(
            "unified-planning is not installed: pip install 'foon-asp[planning]' brings it along"
        ) from None
    return up


def unified_problem(
    problem: Problem, objectives: Sequence[Objective], whole: bool = False, merged: bool = False
) -> Any:
    """Return a problem of unified-planning: the task of :func:`planning_task`, with the names of its PDDL.

    The parameters are those of :func:`planning_task`. The problem minimizes the sum of the costs of actions.
    Raises the errors of :func:`planning_task`. Also raises :class:`UserError` if unified-planning is not
    installed.
    """
    up = require_unified_planning()
    task = planning_task(problem, objectives, whole, merged)
    counted = task.counted
    item = up.UserType("item")
    at_hand = up.Fluent(AT_HAND, up.BoolType(), o=item)
    unified = up.Problem(DOMAIN)
    unified.add_fluent(at_hand, default_initial_value=False)
    copies = up.Fluent(COPIES, up.IntType(), o=item)
    if counted:
        unified.add_fluent(copies, default_initial_value=0)
    objects = {o: up.Object(name, item) for o, name in task.names.items()}
    unified.add_objects(objects.values())
    costs: dict[Any, Any] = {}

    def available(o: int, number: int) -> Any:
        """Return the condition that ``number`` copies of a node are available."""
        return up.GE(copies(objects[o]), number) if o in counted else at_hand(objects[o])

    for action in task.actions:
        up_action = up.InstantaneousAction(action.name)
        asks, uses, adds = task.flow(action)
        for o, number in asks.items():
            up_action.add_precondition(available(o, number))
        for o, number in adds.items():
            if o in counted:
                up_action.add_increase_effect(copies(objects[o]), number)
            else:
                up_action.add_effect(at_hand(objects[o]), True)
        for o, number in uses.items():
            if o in counted:
                up_action.add_decrease_effect(copies(objects[o]), number)
            else:
                up_action.add_effect(at_hand(objects[o]), False)
        unified.add_action(up_action)
        costs[up_action] = up.Int(action.cost)
    for o in {*task.start}.difference(counted):
        unified.set_initial_value(at_hand(objects[o]), True)
    for o, count in counted.items():
        unified.set_initial_value(copies(objects[o]), count)
    for o, number in task.wanted.items():
        unified.add_goal(available(o, number))
    unified.add_quality_metric(up.MinimizeActionCosts(costs))
    return unified


def register_engine() -> str:
    """Register the engine in unified-planning, for this process.

    Returns:
        The name of the engine there: ``foon-asp``.

    Raises:
        UserError: if unified-planning or Fast Downward's translator is not installed.

    Example:
        >>> try:
        ...     foon_asp.register_engine()
        ... except foon_asp.UserError:
        ...     "foon-asp"
        'foon-asp'
    """
    factory = require_unified_planning().get_environment().factory
    require_translator("the engine of unified-planning")
    if ENGINE not in factory.engines:
        factory.add_engine(ENGINE, "foon_asp.planning.unified_engine", "FoonAspPlanner")
    return ENGINE
