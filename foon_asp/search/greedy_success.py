"""Greedy best-first retrieval by success rate (heuristic 1 of the literature)."""

from collections.abc import Sequence

from foon_asp.errors import UserError
from foon_asp.problem import Problem
from foon_asp.search.retrieval import Retrieval, Ties, backward


def greedy_success(problem: Problem, ties: Ties = Ties.FIRST) -> Retrieval:
    """Take for each object the unit whose motion has the highest success rate.

    Locally best, and no more: the product over the tree may be far from the greatest, and the tree may
    not execute. Raises :class:`UserError` where no rates are known.
    """
    if problem.rates is None:
        raise UserError("the search by success rate needs a rates file (--rates)")

    def choose(candidates: Sequence[int]) -> int:
        best = max(map(problem.rate, candidates))
        equal = [unit for unit in candidates if problem.rate(unit) == best]
        return equal[0 if ties is Ties.FIRST else -1]

    return backward(problem, choose)
