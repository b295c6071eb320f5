"""The next best stand-in: the node to use if the serving node of a stand-in of a tree were not available."""

from collections.abc import Collection
from fractions import Fraction
from typing import NamedTuple

from foon_asp.network import STAND_IN
from foon_asp.problem import Problem
from foon_asp.standins.pair_prices import NodePrices


class UsedStandIn(NamedTuple):
    """A stand-in of a tree, by ids: the serving node is used in place of the served one.

    ``unit``: the unit of the stand-in.
    ``next_best``: the cheapest other node that may serve, by id, and its dissimilarity. It has to be in the
    kitchen, or made by the tree without this stand-in. Among equally cheap nodes, the smallest id is chosen.
    ``None`` if no such node may serve.
    """

    unit: int
    serving: int
    served: int
    next_best: tuple[int, Fraction] | None


def stand_ins_of(problem: Problem, tree: Collection[int]) -> list[UsedStandIn]:
    """Return the stand-ins among the units of a tree, in their order, each with the next best serving node.

    The list is empty if the problem has no stand-ins.
    """
    network = problem.network
    units = [unit for unit in tree if network.motions[unit] == STAND_IN]
    if problem.stand_ins is None or not units:
        return []
    prices = NodePrices(network, problem.stand_ins.table)
    used: list[UsedStandIn] = []
    for unit in units:
        (serving,), (served,) = network.inputs[unit], network.outputs[unit]
        available = _nodes_made(problem, [tree_unit for tree_unit in tree if tree_unit != unit])
        others = (
            (price, o) for o, price in prices.servers_of(served).items() if o in available and o != serving
        )
        cheapest = min(others, default=None)
        next_best = None if cheapest is None else (cheapest[1], Fraction(cheapest[0], prices.scale))
        used.append(UsedStandIn(unit, serving, served, next_best))
    return used


def _nodes_made(problem: Problem, units: Collection[int]) -> set[int]:
    """Return the nodes, by id, that are in the kitchen or that units make from it.

    Units that cannot run are ignored.
    """
    made, waiting = set(problem.kitchen), list(units)
    while ready := [unit for unit in waiting if made.issuperset(problem.needs[unit])]:
        made.update(o for unit in ready for o in problem.gives[unit])
        waiting = [unit for unit in waiting if unit not in ready]
    return made
