"""A problem with stand-ins: units that use an available object node in place of one that nothing makes."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from heapq import heappop, heappush
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.network import STAND_IN, Network, Source, StandInTable, UnitPrices
from foon_asp.problem import Problem, StandIns, reach
from foon_asp.standins.pair_prices import NodePrices

_SOURCE = Source("stand-ins", 1)

Pair = tuple[int, int]  # a served and a serving node, by id


def with_stand_ins(problem: Problem, table: StandInTable, everything: bool = False) -> Problem:
    """Return a problem whose network also has stand-ins, each a unit with one input and one output.

    A stand-in uses a *serving* node in place of a *served* node that cannot be made from the kitchen. With
    ``everything``, there is a stand-in for each such pair with a price in the table. Otherwise, there are
    only stand-ins that a tree of least dissimilarity can have (proof in docs/stand-ins.md). If the problem
    has success rates, the rate of stand-ins is 1. If units have prices, the price of stand-ins is 0.

    Raises:
        UserError: below level 3, if items are used up, or if a unit has the motion of stand-ins.
    """
    network = problem.network
    if network.level < 3:
        raise UserError(f"found level {network.level}, expected level 3: stand-ins compare whole nodes")
    if problem.items is not None:
        raise UserError("stand-ins are not built for items that are used up (--items used-up)")
    if STAND_IN in network.different_motions:
        raise UserError(f"a unit has the motion {STAND_IN!r}, which is that of stand-ins: rename it")
    prices, available = NodePrices(network, table), reach(problem).available
    if everything:
        unavailable_nodes = (o for o in range(len(network.objects)) if not available[o])
        pairs = [(served, serving) for served in unavailable_nodes for serving in prices.servers_of(served)]
    else:
        pairs = _NearestStandIns(problem, prices, available).pairs()
    unit_prices = problem.unit_prices
    if unit_prices is not None:
        unit_prices = UnitPrices({**unit_prices.motions, STAND_IN: Fraction(0)}, unit_prices.units)
    return replace(
        problem,
        network=_append_stand_ins(network, sorted(pairs)),
        rates=None if problem.rates is None else {**problem.rates, STAND_IN: Fraction(1)},
        unit_prices=unit_prices,
        stand_ins=StandIns(table, nearest=not everything),
    )


def _append_stand_ins(network: Network, pairs: Sequence[Pair]) -> Network:
    """Return a copy of a network with a new unit for each pair of a served and a serving node.

    The unit makes the served node from the serving node. Its id is the number of units of ``network`` plus
    the position of the pair.
    """
    keys = {
        (STAND_IN, frozenset((serving,)), frozenset((served,))): unit
        for unit, (served, serving) in enumerate(pairs, len(network))
    }
    return replace(
        network,
        motions=(*network.motions, *(STAND_IN for _ in pairs)),
        inputs=(*network.inputs, *((serving,) for _, serving in pairs)),
        outputs=(*network.outputs, *((served,) for served, _ in pairs)),
        sources=(*network.sources, *((_SOURCE,) for _ in pairs)),
        _unit_ids={**network._unit_ids, **keys},
    )


class _NearestStandIns:
    """Search for the stand-ins that a tree of least dissimilarity can have.

    In a stand-in, the *serving* node is used in place of the *served* one. Prices are whole numbers
    (:class:`NodePrices`). ``available`` has an entry for each node, by id: 1 if the node can be made without
    stand-ins, else 0.
    """

    def __init__(self, problem: Problem, prices: NodePrices, available: bytearray) -> None:
        """Keep problem, prices and available nodes; nothing is searched yet."""
        self._problem, self._prices, self._available = problem, prices, available
        self._servers: dict[int, dict[int, int]] = {}

    def pairs(self) -> list[Pair]:
        """Return the pairs of a served and a serving node, by id, that need a stand-in, in any order.

        They are the pairs of all stand-ins that a tree of least dissimilarity can have. If no tree exists,
        they are enough to prove that.
        """
        goals = [goal for goal in self._problem.goals if not self._available[goal]]
        needed = self._needed_nodes(goals)
        steps = self._cheapest_steps(needed, sum)
        if steps.keys() >= {*goals}:
            bound, least = self._dissimilarity(goals, steps), self._cheapest_steps(needed, max)
            for served in needed:
                self._servers[served] = {
                    serving: price
                    for serving, price in self._servers[served].items()
                    if self._available[serving] or (serving in least and least[serving].cost + price <= bound)
                }
            needed = self._needed_nodes(goals)
        return [(served, serving) for served in needed for serving in self._servers[served]]

    def _servers_of(self, served: int) -> dict[int, int]:
        """Return the price of each node, by id, that may serve in place of the node ``served``; cached.

        Nodes that cost more than the cheapest available one are omitted. :meth:`pairs` removes further nodes
        from the cache later.
        """
        servers = self._servers.get(served)
        if servers is None:
            priced = self._prices.servers_of(served)
            least = min((price for o, price in priced.items() if self._available[o]), default=None)
            servers = {o: price for o, price in priced.items() if least is None or price <= least}
            self._servers[served] = servers
        return servers

    def _unavailable_preconditions(self, served: int) -> Iterator[tuple[int, ...]]:
        """Yield, for each achiever of the node ``served``, the preconditions that are not available."""
        problem, available = self._problem, self._available
        for unit in problem.makers[served]:
            yield tuple([o for o in problem.needs[unit] if not available[o]])

    def _needed_nodes(self, goals: Iterable[int]) -> set[int]:
        """Return the nodes that are not available and that a tree can need, by id.

        They are ``goals`` and, recursively, the preconditions of achievers and the nodes that may serve.
        """
        needed = set(goals)
        stack = list(needed)
        while stack:
            served = stack.pop()
            newly_needed = {o for o in self._servers_of(served) if not self._available[o]}
            newly_needed.update(o for nodes in self._unavailable_preconditions(served) for o in nodes)
            newly_needed -= needed
            needed |= newly_needed
            stack.extend(newly_needed)
        return needed

    def _cheapest_steps(
        self, needed: Iterable[int], combine: Callable[[Iterable[int]], int]
    ) -> "dict[int, _Step]":
        """Return the cheapest last step to each node of ``needed`` that can be made, by id.

        The cost of a unit is computed by ``combine`` from the costs of its inputs. With ``max``, the cost of
        a node is a lower bound on the dissimilarity of making it (h_max; Bonet and Geffner 2001). With
        ``sum``, the steps lead to a good tree (h_add). The algorithm is Knuth's generalization of Dijkstra's
        (Information Processing Letters 6, 1977).
        """
        served_by: defaultdict[int, list[tuple[int, int]]] = defaultdict(list)
        consumers: defaultdict[int, list[int]] = defaultdict(list)
        achievers: list[tuple[int, tuple[int, ...]]] = []  # the made node and the unavailable preconditions
        heap: list[tuple[int, int, tuple[int, ...], int]] = []
        for served in needed:
            for serving, price in self._servers_of(served).items():
                if self._available[serving]:
                    heappush(heap, (price, served, (), price))
                else:
                    served_by[serving].append((served, price))
            for preconditions in self._unavailable_preconditions(served):
                for o in preconditions:
                    consumers[o].append(len(achievers))
                achievers.append((served, preconditions))
        missing = [len(preconditions) for _, preconditions in achievers]
        steps: dict[int, _Step] = {}
        while heap:
            cost, made, made_of, price = heappop(heap)
            if made in steps:
                continue
            steps[made] = _Step(cost, made_of, price)
            for served, price in served_by[made]:
                heappush(heap, (cost + price, served, (made,), price))
            for number in consumers[made]:
                missing[number] -= 1
                if not missing[number]:
                    served, preconditions = achievers[number]
                    heappush(heap, (combine(steps[o].cost for o in preconditions), served, preconditions, 0))
        return steps

    def _dissimilarity(self, goals: Iterable[int], steps: "Mapping[int, _Step]") -> int:
        """Return the dissimilarity of the tree that follows ``steps`` back from the goals.

        Each stand-in counts once. ``goals`` are nodes that are not available.
        """
        total, visited = 0, set(goals)
        stack = list(visited)
        while stack:
            step = steps[stack.pop()]
            total += step.price
            stack.extend(o for o in step.made_of if o not in visited)
            visited.update(step.made_of)
        return total


class _Step(NamedTuple):
    """The last step to a node: a unit or a stand-in.

    ``cost``: the cost of this step and of all steps before it.
    ``made_of``: the nodes that the step needs and that are not available.
    ``price``: the price of a stand-in; 0 for a unit.
    """

    cost: int
    made_of: tuple[int, ...]
    price: int
