"""Greedy best-first retrieval by the number of inputs (the published heuristic 2)."""

from foon_asp.problem import Problem
from foon_asp.searches.retrieval import Count, Retrieval, retrieve_backward
from foon_asp.searches.search_interface import SearchSettings
from foon_asp.searches.ties import least_chooser


def greedy_inputs(problem: Problem, settings: SearchSettings) -> Retrieval:
    """Retrieve a tree that has, for each object, the achiever with the fewest inputs.

    Ingredients of inputs also count, unless ``count`` of the settings is ``nodes``.

    The choice is locally optimal only. The tree may have far more inputs than the optimum, and may not
    execute.
    """
    network = problem.network

    def size(unit: int) -> int:
        """Return the number of inputs of a unit, and of their ingredients if these count."""
        inputs = network.inputs[unit]
        if settings.count is Count.NODES:
            return len(inputs)
        return len(inputs) + sum(len(network.objects[o].ingredients) for o in inputs)

    return retrieve_backward(problem, least_chooser(settings.ties, size))
