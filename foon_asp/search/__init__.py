"""Searches, of the literature and of other packages, over the same problem as the solver and without it."""

from foon_asp.search.breadth_first import breadth_first
from foon_asp.search.catalog import SEARCHES, find_searches, search_names
from foon_asp.search.depth_first import depth_first
from foon_asp.search.greedy_inputs import Count, greedy_inputs
from foon_asp.search.greedy_success import greedy_success
from foon_asp.search.iterative_deepening import iterative_deepening
from foon_asp.search.retrieval import Ending, Retrieval, Ties
from foon_asp.search.search import Retrieve, Search, SearchSettings

__all__ = [
    "SEARCHES",
    "Count",
    "Ending",
    "Retrieval",
    "Retrieve",
    "Search",
    "SearchSettings",
    "Ties",
    "breadth_first",
    "depth_first",
    "find_searches",
    "greedy_inputs",
    "greedy_success",
    "iterative_deepening",
    "search_names",
]
