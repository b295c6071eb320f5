"""The best tree with stand-ins by hand: shortest paths over all sets of object nodes that may be at hand."""

from collections.abc import Iterator
from fractions import Fraction
from heapq import heappop, heappush
from itertools import count

from foon_asp.network import StandInTable
from foon_asp.problem import Problem

Cost = tuple[Fraction | int, ...]


def best(problem: Problem, table: StandInTable, objectives: tuple[str, ...]) -> Cost | None:
    """Give the least cost of a tree of a problem without stand-ins, if what it lacks may be stood in for.

    A node that can be made has no stand-in. ``objectives`` are dissimilarity, units and inputs, in any order.
    """
    moves = list(_moves(problem, table, objectives))
    goals = frozenset(problem.goals)
    numbers = count()
    heap: list[tuple[Cost, int, frozenset[int]]] = [((0,) * len(objectives), 0, problem.kitchen)]
    settled: set[frozenset[int]] = set()
    while heap:
        cost, _, here = heappop(heap)
        if here in settled:
            continue
        settled.add(here)
        if goals <= here:
            return cost
        for needs, gives, price in moves:
            if needs <= here and not gives <= here:
                total = tuple(a + b for a, b in zip(cost, price, strict=True))
                heappush(heap, (total, next(numbers), here | gives))
    return None


def _moves(
    problem: Problem, table: StandInTable, objectives: tuple[str, ...]
) -> Iterator[tuple[frozenset[int], frozenset[int], Cost]]:
    def cost(dissimilarity: Fraction, inputs: int) -> Cost:
        figures: dict[str, Fraction | int] = {"dissimilarity": dissimilarity, "units": 1, "inputs": inputs}
        return tuple(figures[objective] for objective in objectives)

    units = [(frozenset(problem.needs[u]), frozenset(problem.gives[u])) for u in range(len(problem.network))]
    for (needs, gives), inputs in zip(units, problem.network.inputs, strict=True):
        yield needs, gives, cost(Fraction(0), len(inputs))
    made = set(problem.kitchen)
    while any(needs <= made and not gives <= made for needs, gives in units):
        for needs, gives in units:
            if needs <= made:
                made |= gives
    objects = problem.network.objects
    for served, node in enumerate(objects):
        for serving, other in enumerate(objects):
            if served not in made and served != serving:
                price = table.dissimilarity(other, node)
                if price is not None:
                    yield frozenset((serving,)), frozenset((served,)), cost(price, 1)
