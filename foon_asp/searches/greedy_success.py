"""Greedy best-first retrieval by success rate (the published heuristic 1)."""

from foon_asp.errors import UserError
from foon_asp.problem import Problem
from foon_asp.searches.retrieval import Retrieval, retrieve_backward
from foon_asp.searches.search_interface import SearchSettings
from foon_asp.searches.ties import least_chooser


def greedy_success(problem: Problem, settings: SearchSettings) -> Retrieval:
    """Retrieve a tree that has, for each object, the achiever with the highest success rate.

    The choice is locally optimal only. The success rate of the tree may be far below the optimum, and the
    tree may not execute.

    Raises :class:`UserError` where no rates are known.
    """
    if problem.rates is None:
        raise UserError("the search by success rate needs a rates file (--rates)")
    return retrieve_backward(problem, least_chooser(settings.ties, lambda unit: -problem.rate(unit)))
