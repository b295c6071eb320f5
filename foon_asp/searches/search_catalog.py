"""Catalog of the searches by name: built-in ones, and those that other packages offer."""

from collections.abc import Mapping
from typing import Final

from foon_asp.offered.offer import find_offers, offers_by_name
from foon_asp.searches.breadth_first import breadth_first
from foon_asp.searches.depth_first import depth_first
from foon_asp.searches.greedy_inputs import greedy_inputs
from foon_asp.searches.greedy_success import greedy_success
from foon_asp.searches.iterative_deepening import iterative_deepening
from foon_asp.searches.offered_search import offered_search
from foon_asp.searches.search_interface import Search

ENTRY_POINTS: Final = "foon_asp.searches"
_OPTIMUM = "optimum"  # the row of the optimum in tables of searches
_LEAST_DEPTH = "a tree that executes, of least depth, or the proof that none does"
_INPUTS_MADE = "only that each input it needs is in the kitchen or an output of a unit of the tree"

SEARCHES: Final[Mapping[str, Search]] = {
    search.name: search
    for search in (
        Search("bfs", _INPUTS_MADE, breadth_first),
        Search("dfs", _INPUTS_MADE, depth_first),
        Search("ids", _LEAST_DEPTH, iterative_deepening),
        Search("greedy-success", _INPUTS_MADE, greedy_success),
        Search("greedy-inputs", _INPUTS_MADE, greedy_inputs),
    )
}
"""The published searches, by name."""


def search_names() -> tuple[str, ...]:
    """Return the names of all searches, those of other packages last, each name once.

    A name that two searches share raises no error here.
    """
    return tuple(dict.fromkeys([*SEARCHES, *(offer.name for offer in find_offers(ENTRY_POINTS))]))


def find_searches() -> dict[str, Search]:
    """Return all searches by name, those of other packages last; the packages are not imported.

    Raises :class:`UserError` if a package offers a search under a name that another search has. The name
    ``optimum`` is taken as well.
    """
    offers = offers_by_name(find_offers(ENTRY_POINTS), [*SEARCHES, _OPTIMUM])
    return {**SEARCHES, **{name: offered_search(offer) for name, offer in offers.items()}}
