"""Greedy best-first retrieval by success rate (the published heuristic 1)."""

from foon_asp.errors import UserError
from foon_asp.problem import Problem
from foon_asp.searches.retrieval import Retrieval, backward
from foon_asp.searches.search_interface import SearchSettings
from foon_asp.searches.ties import least


def greedy_success(problem: Problem, settings: SearchSettings) -> Retrieval:
    """Retrieve a tree with the achiever of the highest success rate for each object.

    The choice is locally optimal only: the product of the tree may be far from the optimum, and the tree may
    not execute.

    Raises :class:`UserError` where no rates are known.
    """
    if problem.rates is None:
        raise UserError("the search by success rate needs a rates file (--rates)")
    return backward(problem, least(settings.ties, lambda unit: -problem.rate(unit)))
