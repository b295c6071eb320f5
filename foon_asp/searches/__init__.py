"""Searches that do not use the solver: published searches, and searches that other packages offer."""

from foon_asp.searches.breadth_first import breadth_first as breadth_first
from foon_asp.searches.depth_first import depth_first as depth_first
from foon_asp.searches.greedy_inputs import greedy_inputs as greedy_inputs
from foon_asp.searches.greedy_success import greedy_success as greedy_success
from foon_asp.searches.iterative_deepening import iterative_deepening as iterative_deepening
from foon_asp.searches.retrieval import Count as Count
from foon_asp.searches.retrieval import Ending as Ending
from foon_asp.searches.retrieval import Retrieval as Retrieval
from foon_asp.searches.search_catalog import SEARCHES as SEARCHES
from foon_asp.searches.search_catalog import find_searches as find_searches
from foon_asp.searches.search_catalog import search_names as search_names
from foon_asp.searches.search_interface import Retrieve as Retrieve
from foon_asp.searches.search_interface import Search as Search
from foon_asp.searches.search_interface import SearchSettings as SearchSettings
from foon_asp.searches.ties import Ties as Ties
