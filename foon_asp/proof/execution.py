"""What happens to copies of object nodes when a unit runs and items are used up, by docs/plans.md."""

from collections import Counter
from collections.abc import Callable
from functools import cache, lru_cache, partial
from typing import NamedTuple

from foon_asp.network import FunctionalUnit, Network, ObjectNode
from foon_asp.problem import ContainerRule, Problem, UsedUp, given_outputs, needed_inputs


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
        network = None if problem.network.level == 3 else problem.network
        self.of = _execution_of(problem.items, problem.containers, problem.utensils, network)

    def is_endless(self, node: ObjectNode) -> bool:
        """Return whether a node is not consumable: it is in the kitchen, and the stock does not count it."""
        return self._problem.at_hand(node) and node not in self._items.stock

    def stock(self) -> Counter[ObjectNode]:
        """Return the initial number of copies of each consumable node."""
        return Counter({n: count for n, count in self._items.stock.items() if self._problem.at_hand(n)})


def _execution_of(
    items: UsedUp | None, rule: ContainerRule, utensils: frozenset[str], network: Network | None
) -> Callable[[FunctionalUnit], Execution]:
    """Return a cached function from a unit to its execution.

    ``network`` is that of the units, where its level is below 3.
    """
    if items is None and network is None:
        return _by_the_rule(rule, utensils)
    return cache(partial(_execution, items or UsedUp(), rule, utensils, network))


@lru_cache(maxsize=4)
def _by_the_rule(rule: ContainerRule, utensils: frozenset[str]) -> Callable[[FunctionalUnit], Execution]:
    """Return the execution function under the plain rule of docs/plans.md, one for all checked trees."""
    return lru_cache(maxsize=10_000)(partial(_execution, UsedUp(), rule, utensils, None))


def _execution(
    items: UsedUp,
    rule: ContainerRule,
    utensils: frozenset[str],
    network: Network | None,
    unit: FunctionalUnit,
) -> Execution:
    """Return preconditions, consumption and add effects of one execution of a unit."""
    preconditions = tuple(dict.fromkeys(needed_inputs(unit, rule, utensils, network)))
    made = dict.fromkeys(given_outputs(unit, rule, utensils, network))
    return Execution(
        preconditions,
        tuple(node for node in preconditions if not items.fate(unit, node, utensils).stays),
        tuple(node for node in made if node not in unit.inputs),
    )
