"""The searches by name: ours, and those that other packages offer."""

from collections.abc import Mapping
from typing import Final

from foon_asp.offered.offer import find_offers, offers_by_name
from foon_asp.searches.breadth_first import breadth_first
from foon_asp.searches.depth_first import depth_first
from foon_asp.searches.greedy_inputs import greedy_inputs
from foon_asp.searches.greedy_success import greedy_success
from foon_asp.searches.iterative_deepening import iterative_deepening
from foon_asp.searches.offered_search import offered_search
from foon_asp.searches.search import Search

ENTRY_POINTS: Final = "foon_asp.searches"
_OPTIMUM = "optimum"  # what tables have in the place of a search
_LEAST_DEPTH = "a tree that executes, of least depth, or the proof that none does"
_NOTHING = "only that each input it needs is in the kitchen or an output of a unit of the tree"

SEARCHES: Final[Mapping[str, Search]] = {
    search.name: search
    for search in (
        Search("bfs", _NOTHING, breadth_first),
        Search("dfs", _NOTHING, depth_first),
        Search("ids", _LEAST_DEPTH, iterative_deepening),
        Search("greedy-success", _NOTHING, greedy_success),
        Search("greedy-inputs", _NOTHING, greedy_inputs),
    )
}
"""The searches of the literature."""


def search_names() -> tuple[str, ...]:
    """List the names of all searches, those of other packages after ours; for help, not to go by."""
    return tuple(dict.fromkeys([*SEARCHES, *(offer.name for offer in find_offers(ENTRY_POINTS))]))


def find_searches() -> dict[str, Search]:
    """Give all searches, those of other packages after ours; none of these is imported.

    Raises :class:`UserError` where a package offers one by a name that is taken.
    """
    offers = offers_by_name(find_offers(ENTRY_POINTS), [*SEARCHES, _OPTIMUM])
    return {**SEARCHES, **{name: offered_search(offer) for name, offer in offers.items()}}
