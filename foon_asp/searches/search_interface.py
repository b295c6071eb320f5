"""The interface of searches: a function from a problem and settings to a tree, with a name and guarantees."""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

from foon_asp.problem import Problem
from foon_asp.searches.retrieval import Count, Retrieval
from foon_asp.searches.ties import Ties


@dataclass(frozen=True, slots=True)
class SearchSettings:
    """The settings of searches; each search uses some of them.

    ``ties``: which of equally good units all searches but ``ids`` choose.
    ``count``: what ``greedy-inputs`` counts.
    ``published``: whether ``ids`` is the published iterative deepening, which is breadth-first retrieval
    with its ``ties``.
    ``depth_limit``: the greatest depth of trees that ``ids`` tries; ``None`` for no limit.
    ``time_limit``: the limit in seconds; ``None`` for no limit.
    ``memory_limit``: the limit in bytes; ``None`` for no limit.
    """

    ties: Ties = Ties.FIRST
    count: Count = Count.INGREDIENTS
    published: bool = False
    depth_limit: int | None = None
    time_limit: float | None = None
    memory_limit: int | None = None


class Retrieve(Protocol):
    """The function of a search, built-in or of another package (docs/entry-points.md)."""

    def __call__(self, problem: Problem, settings: SearchSettings, /) -> Retrieval:
        """Return a tree that makes the goals of a problem, or how the search ended without one.

        The tree may be wrong: the caller simulates it, and computes its costs.
        """


class Search(NamedTuple):
    """A search: its name, its guarantees in words (``promise``), and the function that runs it.

    ``package`` is the distribution that offers it; ``None`` for a built-in search.
    """

    name: str
    promise: str
    run: Retrieve
    package: str | None = None
