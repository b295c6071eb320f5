"""STRIPS tasks without delete effects: facts, and actions with preconditions, add effects and costs."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import NamedTuple

from foon_asp.network import NetworkBuilder, ObjectNode, Source, UnitPrices
from foon_asp.problem import Objective, Problem

DERIVED = "axiom"
"""The name of actions of no cost that derive a fact from others; names of actions are in parentheses."""


class StripsAction(NamedTuple):
    """An action: its name, its preconditions and add effects as numbers of facts, its cost and its source."""

    name: str
    preconditions: Sequence[int]
    add_effects: Sequence[int]
    cost: Fraction
    source: Source


@dataclass(frozen=True)
class StripsTask:
    """A STRIPS task without delete effects, the delete relaxation of a planning task.

    ``name``: the name of the task.
    ``facts``: the names of the facts. Everywhere else, a fact is its position in this list.
    ``start``, ``goals``: the facts of the initial state and of the goal.
    ``has_deletes``: whether actions of the original planning task delete relevant facts.
    """

    name: str
    facts: Sequence[str]
    actions: Sequence[StripsAction]
    start: frozenset[int]
    goals: tuple[int, ...]
    has_deletes: bool = False

    @property
    def objective(self) -> Objective:
        """The objective by which a tree of :meth:`problem` costs as much as its actions.

        It is ``units`` if all actions cost 1, else ``price``.
        """
        unit_cost = all(action.cost == 1 for action in self.actions)
        return Objective.UNITS if unit_cost else Objective.PRICE

    @property
    def action_count(self) -> int:
        """The number of actions, without actions that derive facts."""
        return sum(action.name != DERIVED for action in self.actions)

    @property
    def unit_cost(self) -> bool:
        """Whether each action costs 1, except actions that derive facts."""
        return all(action.cost == 1 for action in self.actions if action.name != DERIVED)

    def problem(self) -> Problem:
        """Return the task as a problem: facts are object nodes, actions units, the initial state the kitchen.

        Actions without add effects are left out. Equal actions of the same name become one unit. Facts are
        left out if they occur in no action, nor in the initial state or the goal. The problem has prices
        unless all actions cost 1.
        """
        nodes = [ObjectNode(fact) for fact in self.facts]
        builder = NetworkBuilder()
        # every fact that the start or the goal has is in the network, whether an action has it or not
        initial_and_goal = builder.add(
            "", [nodes[o] for o in sorted(self.start)], [nodes[o] for o in self.goals]
        )
        prices: dict[str, Fraction] = {"": Fraction(0)}
        for action in self.actions:
            if action.add_effects:
                builder.add(
                    action.name,
                    [nodes[o] for o in action.preconditions],
                    [nodes[o] for o in action.add_effects],
                    action.source,
                )
                prices[action.name] = action.cost
        network = replace(
            builder.build().without([initial_and_goal]), unit_numbers=()
        )  # it is the whole of the task
        ids = {o: network.object_id(nodes[o]) for o in (*self.start, *self.goals)}
        return Problem(
            network,
            frozenset(node for o in self.start if (node := ids[o]) is not None),
            tuple(node for o in self.goals if (node := ids[o]) is not None),
            None,
            frozenset(),
            unit_prices=UnitPrices(prices, {}) if self.objective is Objective.PRICE else None,
        )
