"""What happens to copies of object nodes when a unit runs and items are used up, by docs/plans.md."""

from collections import Counter
from functools import cache
from typing import NamedTuple

from foon_asp.network import FunctionalUnit, ObjectNode
from foon_asp.problem import Problem, UsedUp, given_outputs, needed_inputs


class Execution(NamedTuple):
    """What running a unit once does with copies of object nodes, one copy of each.

    It needs ``preconditions``, uses up those of them that it ``consumes``, and ``adds`` outputs, none of
    which is an input.
    """

    preconditions: tuple[ObjectNode, ...]
    consumes: tuple[ObjectNode, ...]
    adds: tuple[ObjectNode, ...]


class Executions:
    """How units run from the kitchen of a problem.

    Items are used up as the problem says, or, where they last in it, by the rule of docs/plans.md.
    """

    def __init__(self, problem: Problem) -> None:
        self._problem, self._items = problem, problem.items or UsedUp()
        self.of = cache(self._of)

    def _of(self, unit: FunctionalUnit) -> Execution:
        """Return preconditions, consumption and add effects of one execution of a unit."""
        problem = self._problem
        rules = problem.containers, problem.utensils, problem.network
        preconditions = tuple(dict.fromkeys(needed_inputs(unit, *rules)))
        stays = {node: self._items.fate(unit, node, problem.utensils).stays for node in preconditions}
        made = dict.fromkeys(given_outputs(unit, *rules))
        return Execution(
            preconditions,
            tuple(node for node in preconditions if not stays[node]),
            tuple(node for node in made if node not in unit.inputs),
        )

    def is_endless(self, node: ObjectNode) -> bool:
        """Return whether a node is not consumable: it is in the kitchen, and the stock does not count it."""
        return self._problem.at_hand(node) and node not in self._items.stock

    def stock(self) -> Counter[ObjectNode]:
        """Return the initial number of copies of each consumable node."""
        return Counter({n: count for n, count in self._items.stock.items() if self._problem.at_hand(n)})
