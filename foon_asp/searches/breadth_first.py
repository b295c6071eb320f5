"""Breadth-first retrieval: the first unit that makes each object, objects from a queue."""

from foon_asp.problem import Problem
from foon_asp.searches.retrieval import Retrieval, backward, least
from foon_asp.searches.search import SearchSettings


def breadth_first(problem: Problem, settings: SearchSettings) -> Retrieval:
    """Retrieve a tree breadth first.

    Promises nothing about the tree but what :func:`~foon_asp.searches.retrieval.backward` does: the first
    unit in file order is taken for each object, whether or not it can ever run.
    """
    return backward(problem, least(settings.ties))
