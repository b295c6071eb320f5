"""Depth-first retrieval: the first achiever of each object, objects from a stack."""

from foon_asp.problem import Problem
from foon_asp.searches.retrieval import Retrieval, backward
from foon_asp.searches.search_interface import SearchSettings
from foon_asp.searches.ties import least


def depth_first(problem: Problem, settings: SearchSettings) -> Retrieval:
    """Retrieve a tree depth-first.

    The units are those of breadth-first retrieval, since the achiever of an object is chosen independently of
    the order; only the order of the units differs.
    """
    return backward(problem, least(settings.ties), stack=True)
