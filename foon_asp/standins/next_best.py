"""The next best stand-in: the node that would be used if the node used in a tree were not available."""

from collections.abc import Collection
from fractions import Fraction
from typing import NamedTuple

from foon_asp.network import STAND_IN
from foon_asp.problem import Problem
from foon_asp.standins.node_prices import NodePrices


class Used(NamedTuple):
    """A stand-in of a tree, by ids: the serving node is used in place of the served one.

    ``next_best`` is the cheapest other node that may serve, with its dissimilarity. It is chosen among the
    nodes that the kitchen has or that the tree makes without this stand-in; ``None`` if none of them may
    serve.
    """

    unit: int
    serving: int
    served: int
    next_best: tuple[int, Fraction] | None


def stand_ins_of(problem: Problem, tree: Collection[int]) -> list[Used]:
    """Return the stand-ins of a tree of unit ids, in order; empty for a problem without stand-ins."""
    network = problem.network
    units = [unit for unit in tree if network.motions[unit] == STAND_IN]
    if problem.stand_ins is None or not units:
        return []
    prices = NodePrices(network, problem.stand_ins.table)
    used: list[Used] = []
    for unit in units:
        (serving,), (served,) = network.inputs[unit], network.outputs[unit]
        available = _made(problem, [other for other in tree if other != unit])
        others = (
            (price, o) for o, price in prices.servers_of(served).items() if o in available and o != serving
        )
        cheapest = min(others, default=None)
        next_best = None if cheapest is None else (cheapest[1], Fraction(cheapest[0], prices.scale))
        used.append(Used(unit, serving, served, next_best))
    return used


def _made(problem: Problem, tree: Collection[int]) -> set[int]:
    """Return the nodes that units of a tree make from the kitchen, as far as they execute."""
    made, waiting = set(problem.kitchen), list(tree)
    while ready := [unit for unit in waiting if made.issuperset(problem.needs[unit])]:
        made.update(o for unit in ready for o in problem.gives[unit])
        waiting = [unit for unit in waiting if unit not in ready]
    return made
