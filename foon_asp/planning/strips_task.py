"""A planning task without deletes: facts, and actions that need some and give others."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import NamedTuple

from foon_asp.network import NetworkBuilder, ObjectNode, Source, UnitPrices
from foon_asp.problem import Objective, Problem

DERIVED = "axiom"
"""The name of actions of no cost that derive a fact from others; names of actions are in parentheses."""


class StripsAction(NamedTuple):
    """An action by name, the facts that it needs and gives, by number, its cost, and its place."""

    name: str
    needs: Sequence[int]
    gives: Sequence[int]
    cost: Fraction
    place: Source


@dataclass(frozen=True)
class StripsTask:
    """Facts by name, the actions, what holds at the start, and what has to hold in the end.

    ``name`` says what the task is called, and ``loses`` whether actions of the planning task that this is the
    delete relaxation of take away what is needed.
    """

    name: str
    facts: Sequence[str]
    actions: Sequence[StripsAction]
    start: frozenset[int]
    goals: tuple[int, ...]
    loses: bool = False

    @property
    def objective(self) -> Objective:
        """The objective by which the cheapest plan is the best tree."""
        same = all(action.cost == 1 for action in self.actions)
        return Objective.UNITS if same else Objective.PRICE

    @property
    def action_count(self) -> int:
        """The number of actions without those that derive facts."""
        return sum(action.name != DERIVED for action in self.actions)

    @property
    def unit_cost(self) -> bool:
        """Whether each action of the planning task costs 1."""
        return all(action.cost == 1 for action in self.actions if action.name != DERIVED)

    def problem(self) -> Problem:
        """Give the task as a problem: facts are object nodes, actions are units, the start is the kitchen.

        An action that gives nothing is no unit, and two of one name that are the same are one.
        """
        nodes = [ObjectNode(fact) for fact in self.facts]
        builder = NetworkBuilder()
        # every fact that the start or the goal has is in the network, whether an action has it or not
        marked = builder.add("", [nodes[o] for o in sorted(self.start)], [nodes[o] for o in self.goals])
        prices: dict[str, Fraction] = {"": Fraction(0)}
        for action in self.actions:
            if action.gives:
                builder.add(
                    action.name,
                    [nodes[o] for o in action.needs],
                    [nodes[o] for o in action.gives],
                    action.place,
                )
                prices[action.name] = action.cost
        network = replace(builder.build().without([marked]), unit_numbers=())  # it is the whole of the task
        ids = {o: network.object_id(nodes[o]) for o in (*self.start, *self.goals)}
        return Problem(
            network,
            frozenset(found for o in self.start if (found := ids[o]) is not None),
            tuple(found for o in self.goals if (found := ids[o]) is not None),
            None,
            frozenset(),
            unit_prices=UnitPrices(prices, {}) if self.objective is Objective.PRICE else None,
        )
