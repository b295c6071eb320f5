"""A question as a STRIPS planning task: initial state, actions and goals over object nodes."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.planning.action_costs import ActionCosts, action_costs
from foon_asp.planning.pddl_name import pddl_name
from foon_asp.problem import (
    Flow,
    Objective,
    Problem,
    first_tree,
    reach,
    relevant_units,
    units_relevant_to_plans,
)


class Action(NamedTuple):
    """An action, which executes a ``unit`` or takes an ``item`` from the kitchen.

    ``unit`` and ``item`` are ids; one of them is ``None``. ``preconditions``, ``add_effects`` and
    ``consumption`` (delete effects) are object nodes, by id.
    """

    name: str
    unit: int | None
    item: int | None
    preconditions: tuple[int, ...]
    add_effects: tuple[int, ...]
    cost: int
    consumption: tuple[int, ...] = ()


@dataclass(frozen=True)
class PlanningTask:
    """A planning task for the goals of a problem; all nodes are given by id.

    ``names``: the name of every object node in the task.
    ``start``: the initial state.
    ``goals``: the goals of the problem, without kitchen items that have a cost.
    ``costs``: the integer costs of actions.
    ``merged``: whether copies of consumable nodes are not counted, although items are used up. All copies of
    a node are then merged into one.
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
        """The initial number of copies of each node whose copies are counted, by node id.

        Empty if no copies are counted.
        """
        problem = self.problem
        if problem.items is None or self.merged:
            return {}
        stock = {o: problem.stock_of(o) or 0 for o in problem.kitchen}
        return {o: stock.get(o, 0) for o in self.names if o not in problem.endless}

    def flow(self, action: Action) -> Flow:
        """Return how many copies of each node an action asks for, uses up and adds.

        If the task counts no copies, all numbers are 1.
        """
        if action.unit is None or not self.counted:
            sides = (action.preconditions, action.consumption, action.add_effects)
            return Flow(*(dict.fromkeys(side, 1) for side in sides))
        asks, uses, adds = self.problem.flows[action.unit]
        return Flow(
            {o: asks[o] for o in action.preconditions},
            {o: uses[o] for o in action.consumption},
            {o: adds[o] for o in action.add_effects},
        )

    @property
    def wanted(self) -> dict[int, int]:
        """The number of copies wanted of each goal, by node id."""
        return {goal: self.problem.wanted(goal) for goal in self.goals}


def taking_action_name(name: str) -> str:
    """Return the name of the action that takes the kitchen item ``name``: ``take-o43-ice``."""
    return f"take-{name}"


def planning_task(
    problem: Problem,
    objectives: Sequence[Objective] = (Objective.UNITS,),
    whole: bool = False,
    merged: bool = False,
) -> PlanningTask:
    """Return the planning task of a problem, over the units relevant to its goals or the ``whole`` network.

    Units that add nothing are left out. With ``merged``, copies are not counted: a node is available or not.
    If kitchen items have a cost, the task has an action that takes the item, for each item that some unit
    needs.

    Raises :class:`UserError` if the costs of an objective are not known, or if planners cannot add them up.
    If items are used up, it is also raised in three cases: for several objectives; for an objective by which
    kitchen items cost something, if the kitchen has a stock; and for ``merged``, if amounts count.
    """
    network, endless = problem.network, problem.endless
    problem.require_known_for(objectives)
    by_items = any(objective.row.item for objective in objectives)
    if problem.items is not None and len(objectives) > 1:
        raise UserError("where items are used up, actions cost something by one objective: name one")
    if merged and problem.counts_amounts:
        raise UserError(
            "amounts are counted, and copies merged into one are not: --items used-up exports numbers"
        )
    if by_items and problem.kitchen != endless:
        raise UserError("copies of a stock have no costs in planning tasks: name another objective")
    items_with_cost = endless if by_items else frozenset[int]()  # no unit adds one, or it would be free
    available = frozenset(o for o in problem.kitchen if problem.stock_of(o) != 0)
    reached = reach(replace(problem, kitchen=available))
    allowed: Iterable[int] = range(len(network))
    if not whole:
        allowed = (
            relevant_units(problem, reached)
            if problem.items is None
            else units_relevant_to_plans(problem, reached)
        )
    not_added = items_with_cost if problem.items is None else endless
    flows = {unit: problem.flows[unit] for unit in sorted(allowed)}
    add_effects = {unit: tuple(o for o in flow.adds if o not in not_added) for unit, flow in flows.items()}
    units = [unit for unit, added in add_effects.items() if added]
    needed = {o for unit in units for o in problem.needs[unit]}
    items = sorted(needed & items_with_cost)
    tree = first_tree(problem, reached) or units
    # a plan with items used up may cost 50 times as much as a tree; a larger ratio would round costs more
    repeats = 1 if problem.items is None else 50
    costs = action_costs(problem, objectives, units, len(items), {*tree} & {*units}, repeats)
    goals = tuple(goal for goal in problem.goals if goal not in items_with_cost)
    nodes = {*goals, *needed, *(o for unit in units for o in add_effects[unit])}
    names = {o: pddl_name("o", network.object_number(o), str(network.objects[o])) for o in sorted(nodes)}
    actions = [
        Action(
            pddl_name("u", network.unit_number(unit), network.motions[unit]),
            unit,
            None,
            problem.needs[unit],
            add_effects[unit],
            costs.units[unit],
            tuple(o for o in flows[unit].uses if o not in endless),
        )
        for unit in units
    ]
    actions += [Action(taking_action_name(names[o]), None, o, (), (o,), costs.item) for o in items]
    start = tuple(sorted((nodes & available) - items_with_cost))
    return PlanningTask(problem, tuple(objectives), tuple(actions), names, start, goals, costs, merged)
