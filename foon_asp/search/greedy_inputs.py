"""Greedy best-first retrieval by number of inputs (heuristic 2 of the literature)."""

from enum import StrEnum

from foon_asp.problem import Problem
from foon_asp.search.retrieval import Retrieval, Ties, backward, least


class Count(StrEnum):
    """What counts as inputs: input object nodes and their ingredients, or the nodes alone."""

    INGREDIENTS = "ingredients"
    NODES = "nodes"


def greedy_inputs(problem: Problem, ties: Ties = Ties.FIRST, count: Count = Count.INGREDIENTS) -> Retrieval:
    """Take for each object the unit with the fewest inputs.

    Locally best, and no more: the sum over the tree may be far from the least, and the tree may not
    execute.
    """
    network = problem.network

    def size(unit: int) -> int:
        inputs = network.inputs[unit]
        if count is Count.NODES:
            return len(inputs)
        return len(inputs) + sum(len(network.objects[o].ingredients) for o in inputs)

    return backward(problem, least(ties, size))
