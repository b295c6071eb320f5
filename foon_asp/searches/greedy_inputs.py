"""Greedy best-first retrieval by number of inputs (heuristic 2 of the literature)."""

from foon_asp.problem import Problem
from foon_asp.searches.retrieval import Count, Retrieval, backward, least
from foon_asp.searches.search import SearchSettings


def greedy_inputs(problem: Problem, settings: SearchSettings) -> Retrieval:
    """Take for each object the unit with the fewest inputs.

    Locally best, and no more: the sum over the tree may be far from the least, and the tree may not
    execute.
    """
    network = problem.network

    def size(unit: int) -> int:
        inputs = network.inputs[unit]
        if settings.count is Count.NODES:
            return len(inputs)
        return len(inputs) + sum(len(network.objects[o].ingredients) for o in inputs)

    return backward(problem, least(settings.ties, size))
