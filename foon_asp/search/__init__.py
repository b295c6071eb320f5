"""The searches of the literature, over the same problem as the solver and without it."""

from foon_asp.search.breadth_first import breadth_first
from foon_asp.search.catalog import SEARCHES, Search, SearchSettings
from foon_asp.search.depth_first import depth_first
from foon_asp.search.greedy_inputs import Count, greedy_inputs
from foon_asp.search.greedy_success import greedy_success
from foon_asp.search.iterative_deepening import iterative_deepening
from foon_asp.search.retrieval import Ending, Retrieval, Ties

__all__ = [
    "SEARCHES",
    "Count",
    "Ending",
    "Retrieval",
    "Search",
    "SearchSettings",
    "Ties",
    "breadth_first",
    "depth_first",
    "greedy_inputs",
    "greedy_success",
    "iterative_deepening",
]
