"""A question as a planning task: what is at hand, actions that put more there, and what has to be there."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.planning.action_costs import ActionCosts, action_costs
from foon_asp.planning.pddl_name import pddl_name
from foon_asp.problem import Objective, Problem, first_tree, reach, relevant


class Action(NamedTuple):
    """An action: to execute a ``unit``, or to take an ``item`` from the kitchen; the other is ``None``.

    ``needs`` and ``gives`` are object nodes, by id.
    """

    name: str
    unit: int | None
    item: int | None
    needs: tuple[int, ...]
    gives: tuple[int, ...]
    cost: int


@dataclass(frozen=True)
class PlanningTask:
    """A planning task for the goals of a problem.

    ``names`` has the name of every object node in it, by id. ``start`` is at hand at the beginning,
    ``goals`` has to be in the end, and ``costs`` says how costs became whole numbers.
    """

    problem: Problem
    objectives: tuple[Objective, ...]
    actions: tuple[Action, ...]
    names: dict[int, str]
    start: tuple[int, ...]
    goals: tuple[int, ...]
    costs: ActionCosts


def taking(name: str) -> str:
    """Name the action that takes a kitchen item."""
    return f"take-{name}"


def planning_task(
    problem: Problem, objectives: Sequence[Objective] = (Objective.UNITS,), whole: bool = False
) -> PlanningTask:
    """Make a planning task of a problem: of the units that its goals can need, or of the ``whole`` network.

    Where kitchen items cost something, there is an action that takes each of them. Raises
    :class:`UserError` where an objective has no costs that planners can add up, and where items are used
    up.
    """
    if problem.items is not None:
        raise UserError(
            "items are used up in this problem, and planning tasks are written for items that last: pose it "
            "without items=..."
        )
    network = problem.network
    problem.require_known_for(objectives)
    by_items = any(objective.row.item for objective in objectives)
    bought = problem.kitchen if by_items else frozenset[int]()  # what one of these costs, no unit gives
    reached = reach(problem)
    allowed: Iterable[int] = range(len(network)) if whole else relevant(problem, reached)
    gives = {unit: tuple(o for o in problem.gives[unit] if o not in bought) for unit in sorted(allowed)}
    units = [unit for unit, given in gives.items() if given]
    needed = {o for unit in units for o in problem.needs[unit]}
    items = sorted(needed & bought)
    tree = first_tree(problem, reached) or units
    costs = action_costs(problem, objectives, units, len(items), {*tree} & {*units})
    goals = tuple(goal for goal in problem.goals if goal not in bought)
    met = {*goals, *needed, *(o for unit in units for o in gives[unit])}
    names = {o: pddl_name("o", network.object_number(o), str(network.objects[o])) for o in sorted(met)}
    actions = [
        Action(
            pddl_name("u", network.unit_number(unit), network.motions[unit]),
            unit,
            None,
            problem.needs[unit],
            gives[unit],
            costs.units[unit],
        )
        for unit in units
    ]
    actions += [Action(taking(names[o]), None, o, (), (o,), costs.item) for o in items]
    start = tuple(sorted((met & problem.kitchen) - bought))
    return PlanningTask(problem, tuple(objectives), tuple(actions), names, start, goals, costs)
