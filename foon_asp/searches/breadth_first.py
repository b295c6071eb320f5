"""Breadth-first retrieval: the first achiever of each object, objects from a queue."""

from foon_asp.problem import Problem
from foon_asp.searches.retrieval import Retrieval, retrieve_backward
from foon_asp.searches.search_interface import SearchSettings
from foon_asp.searches.ties import least_chooser


def breadth_first(problem: Problem, settings: SearchSettings) -> Retrieval:
    """Retrieve a tree breadth-first.

    For each object, the first achiever in file order is chosen, even if it can never execute. If ``ties`` of
    the settings is ``last``, the last achiever is chosen instead. The tree has only the guarantees of
    :func:`~foon_asp.searches.retrieval.retrieve_backward`.
    """
    return retrieve_backward(problem, least_chooser(settings.ties))
