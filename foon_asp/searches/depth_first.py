"""Depth-first retrieval: the first achiever of each object, objects from a stack."""

from foon_asp.problem import Problem
from foon_asp.searches.retrieval import Retrieval, retrieve_backward
from foon_asp.searches.search_interface import SearchSettings
from foon_asp.searches.ties import least_chooser


def depth_first(problem: Problem, settings: SearchSettings) -> Retrieval:
    """Retrieve a tree depth-first, with the guarantees of breadth-first retrieval.

    The units are the same as those of breadth-first retrieval, since the choice of an achiever does not
    depend on the order of the objects. Only the order of the units differs.
    """
    return retrieve_backward(problem, least_chooser(settings.ties), stack=True)
