"""The best tree with stand-ins by hand: shortest paths over all sets of object nodes that may be at hand."""

from collections.abc import Collection, Iterator
from fractions import Fraction
from heapq import heappop, heappush
from itertools import count

from foon_asp.network import StandInTable
from foon_asp.problem import Problem

Cost = tuple[Fraction | int, ...]
State = tuple[frozenset[int], frozenset[int]]  # what is at hand, and which steps are still to be done


def best(
    problem: Problem, table: StandInTable, objectives: tuple[str, ...], steps: Collection[int] = ()
) -> Cost | None:
    """Give the least cost of a tree of a problem without stand-ins, if what it lacks may be stood in for.

    A node that can be made has no stand-in. ``objectives`` are dissimilarity, units and inputs, in any order.
    The units ``steps`` have to be executed.
    """
    moves = list(_moves(problem, table, objectives))
    goals = frozenset(problem.goals)
    numbers = count()
    start = problem.kitchen, frozenset(steps)
    heap: list[tuple[Cost, int, State]] = [((0,) * len(objectives), 0, start)]
    settled: set[State] = set()
    while heap:
        cost, _, here = heappop(heap)
        if here in settled:
            continue
        settled.add(here)
        made, waiting = here
        if goals <= made and not waiting:
            return cost
        for move, (needs, gives, price) in enumerate(moves):
            if needs <= made and (not gives <= made or move in waiting):
                total = tuple(a + b for a, b in zip(cost, price, strict=True))
                heappush(heap, (total, next(numbers), (made | gives, waiting - {move})))
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
