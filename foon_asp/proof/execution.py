"""Executions of units where items are used up: copies needed, consumed and added (docs/plans.md)."""

from collections import Counter
from collections.abc import Callable, Mapping
from functools import cache, lru_cache, partial
from typing import NamedTuple

from foon_asp.network import Amounts, FunctionalUnit, Network, ObjectNode, UnitAmounts
from foon_asp.problem import ContainerRule, Fate, Problem, UsedUp, given_outputs, needed_inputs

_NO_AMOUNTS = UnitAmounts()


class Execution(NamedTuple):
    """One execution of a unit: numbers of copies by object node.

    ``preconditions``: the copies that have to exist.
    ``consumes``: the copies that are used up; only nodes of ``preconditions`` occur.
    ``adds``: the copies that are made. Of an output that is also an input, only the surplus over the input
    counts.
    """

    preconditions: Mapping[ObjectNode, int]
    consumes: Mapping[ObjectNode, int]
    adds: Mapping[ObjectNode, int]


class Executions:
    """Executions of units from the kitchen of a problem.

    ``of(unit)`` returns the :class:`Execution` of a unit; results are cached. If items are used up, the
    problem says which inputs of a unit stay. If items last, the rule of docs/plans.md says which inputs stay,
    and every amount is 1.
    """

    def __init__(self, problem: Problem) -> None:
        """Make the function ``of`` for the items, amounts and container rule of the problem."""
        self._problem, self._items = problem, problem.items or UsedUp()
        network = None if problem.network.level == 3 else problem.network
        amounts = {} if problem.items is None else problem.amounts
        self.of = _execution_of(problem.items, problem.containers, problem.utensils, network, amounts)

    def wanted_copies(self) -> dict[ObjectNode, int]:
        """Return for each goal how many copies have to exist in the end."""
        return {node: self._items.wanted.get(node, 1) for node in self._problem.goal_nodes}

    def is_endless(self, node: ObjectNode) -> bool:
        """Return whether a node never runs out: the kitchen has it, and the stock does not count it."""
        return self._problem.at_hand(node) and node not in self._items.stock

    def initial_copies(self) -> Counter[ObjectNode]:
        """Return the initial number of copies of each kitchen node that the stock counts."""
        return Counter({n: count for n, count in self._items.stock.items() if self._problem.at_hand(n)})


def _execution_of(
    items: UsedUp | None,
    rule: ContainerRule,
    utensils: frozenset[str],
    network: Network | None,
    amounts: Amounts,
) -> Callable[[FunctionalUnit], Execution]:
    """Return a cached function from a unit to its execution.

    ``items`` says how items are used up; ``None`` if they last. ``network`` is the network of the units if
    its level is below 3, and ``None`` otherwise.
    """
    if items is None and network is None:
        return _shared_execution_of(rule, utensils)
    return cache(partial(_execution, items or UsedUp(), rule, utensils, network, amounts))


@lru_cache(maxsize=4)
def _shared_execution_of(
    rule: ContainerRule, utensils: frozenset[str]
) -> Callable[[FunctionalUnit], Execution]:
    """Return the function from a unit to its execution where items last, at level 3.

    All problems with this container rule and these utensils share the function and its cache, which keeps
    10,000 executions.
    """
    return lru_cache(maxsize=10_000)(partial(_execution, UsedUp(), rule, utensils, None, {}))


def _execution(
    items: UsedUp,
    rule: ContainerRule,
    utensils: frozenset[str],
    network: Network | None,
    amounts: Amounts,
    unit: FunctionalUnit,
) -> Execution:
    """Return the execution of a unit.

    ``network`` is as in :func:`_execution_of`. An amount that ``amounts`` does not state is 1. An input that
    stays because it is also an output is consumed as far as its amount exceeds that of the output.
    """
    input_amounts, output_amounts = amounts.get(unit, _NO_AMOUNTS)
    preconditions = {
        node: input_amounts.get(node, 1) for node in needed_inputs(unit, rule, utensils, network)
    }
    consumed: dict[ObjectNode, int] = {}
    for node, amount in preconditions.items():
        fate = items.fate(unit, node, utensils)
        if not fate.stays:
            consumed[node] = amount
        elif fate is Fate.OUTPUT and amount > output_amounts.get(node, 1):
            consumed[node] = amount - output_amounts.get(node, 1)
    added: dict[ObjectNode, int] = {}
    for node in given_outputs(unit, rule, utensils, network):
        surplus = output_amounts.get(node, 1) - (input_amounts.get(node, 1) if node in unit.inputs else 0)
        if surplus > 0:
            added[node] = surplus
    return Execution(preconditions, consumed, added)
