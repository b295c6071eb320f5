"""Greedy best-first retrieval by success rate (heuristic 1 of the literature)."""

from foon_asp.errors import UserError
from foon_asp.problem import Problem
from foon_asp.searches.retrieval import Retrieval, backward, least
from foon_asp.searches.search import SearchSettings


def greedy_success(problem: Problem, settings: SearchSettings) -> Retrieval:
    """Take for each object the unit whose motion has the highest success rate.

    Locally best, and no more: the product over the tree may be far from the greatest, and the tree may
    not execute. Raises :class:`UserError` where no rates are known.
    """
    if problem.rates is None:
        raise UserError("the search by success rate needs a rates file (--rates)")
    return backward(problem, least(settings.ties, lambda unit: -problem.rate(unit)))
