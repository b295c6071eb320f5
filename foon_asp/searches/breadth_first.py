"""Breadth-first retrieval: the first achiever of each object, objects from a queue."""

from foon_asp.problem import Problem
from foon_asp.searches.retrieval import Retrieval, backward
from foon_asp.searches.search_interface import SearchSettings
from foon_asp.searches.ties import least


def breadth_first(problem: Problem, settings: SearchSettings) -> Retrieval:
    """Retrieve a tree breadth-first.

    The first achiever in file order is chosen for each object, even if it can never execute. So the tree has
    only the guarantees of :func:`~foon_asp.searches.retrieval.backward`.
    """
    return backward(problem, least(settings.ties))
