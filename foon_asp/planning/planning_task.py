"""A question as a planning task: what is at hand, actions that put more there, and what has to be there."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.planning.action_costs import ActionCosts, action_costs
from foon_asp.planning.pddl_name import pddl_name
from foon_asp.problem import Objective, Problem, first_tree, reach, relevant, relevant_to_plans

_REPEATS = 50  # times what a tree costs, that a plan in which items are used up may cost


class Action(NamedTuple):
    """An action: to execute a ``unit``, or to take an ``item`` from the kitchen; the other is ``None``.

    ``needs``, ``gives`` and what it ``uses`` up are object nodes, by id.
    """

    name: str
    unit: int | None
    item: int | None
    needs: tuple[int, ...]
    gives: tuple[int, ...]
    cost: int
    uses: tuple[int, ...] = ()


@dataclass(frozen=True)
class PlanningTask:
    """A planning task for the goals of a problem.

    ``names`` has the name of every object node in it, by id. ``start`` is at hand at the beginning,
    ``goals`` has to be in the end, and ``costs`` says how costs became whole numbers. Where items are used
    up, the copies of what may run out are counted, or all copies of a node are ``merged`` into one.
    """

    problem: Problem
    objectives: tuple[Objective, ...]
    actions: tuple[Action, ...]
    names: dict[int, str]
    start: tuple[int, ...]
    goals: tuple[int, ...]
    costs: ActionCosts
    merged: bool = False

    @cached_property
    def counted(self) -> dict[int, int]:
        """The nodes whose copies are counted, by id, and how many there are at the beginning."""
        problem = self.problem
        if problem.items is None or self.merged:
            return {}
        stock = {o: problem.stock_of(o) or 0 for o in problem.kitchen}
        return {o: stock.get(o, 0) for o in self.names if o not in problem.endless}


def taking(name: str) -> str:
    """Name the action that takes a kitchen item."""
    return f"take-{name}"


def planning_task(
    problem: Problem,
    objectives: Sequence[Objective] = (Objective.UNITS,),
    whole: bool = False,
    merged: bool = False,
) -> PlanningTask:
    """Make a planning task of a problem: of the units that its goals can need, or of the ``whole`` network.

    Where kitchen items cost something, there is an action that takes each of them. Raises
    :class:`UserError` where an objective has no costs that planners can add up.
    """
    network, endless = problem.network, problem.endless
    problem.require_known_for(objectives)
    by_items = any(objective.row.item for objective in objectives)
    if problem.items is not None and len(objectives) > 1:
        raise UserError("where items are used up, actions cost something by one objective: name one")
    if by_items and problem.kitchen != endless:
        raise UserError("copies of a stock have no costs in planning tasks: name another objective")
    bought = endless if by_items else frozenset[int]()  # what one of these costs, no unit gives
    there = frozenset(o for o in problem.kitchen if problem.stock_of(o) != 0)
    reached = reach(replace(problem, kitchen=there))
    allowed: Iterable[int] = range(len(network))
    if not whole:
        allowed = relevant(problem, reached) if problem.items is None else relevant_to_plans(problem, reached)
    no_gift = bought if problem.items is None else endless
    flows = {unit: problem.flows[unit] for unit in sorted(allowed)}
    gives = {unit: tuple(o for o in flow.adds if o not in no_gift) for unit, flow in flows.items()}
    units = [unit for unit, given in gives.items() if given]
    needed = {o for unit in units for o in problem.needs[unit]}
    items = sorted(needed & bought)
    tree = first_tree(problem, reached) or units
    repeats = 1 if problem.items is None else _REPEATS
    costs = action_costs(problem, objectives, units, len(items), {*tree} & {*units}, repeats)
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
            tuple(o for o in flows[unit].uses if o not in endless),
        )
        for unit in units
    ]
    actions += [Action(taking(names[o]), None, o, (), (o,), costs.item) for o in items]
    start = tuple(sorted((met & there) - bought))
    return PlanningTask(problem, tuple(objectives), tuple(actions), names, start, goals, costs, merged)
