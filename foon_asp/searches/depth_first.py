"""Depth-first retrieval: the first unit that makes each object, objects from a stack."""

from foon_asp.problem import Problem
from foon_asp.searches.retrieval import Retrieval, backward, least
from foon_asp.searches.search import SearchSettings


def depth_first(problem: Problem, settings: SearchSettings) -> Retrieval:
    """Retrieve a tree depth first.

    The units are those of breadth-first retrieval, since the choice for an object does not depend on when
    it is made; only the order in which they are listed differs.
    """
    return backward(problem, least(settings.ties), stack=True)
