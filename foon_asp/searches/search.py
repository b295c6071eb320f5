"""What a search is: a function from a problem to a tree, its name and what it promises."""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

from foon_asp.problem import Problem
from foon_asp.searches.retrieval import Count, Retrieval, Ties


@dataclass(frozen=True, slots=True)
class SearchSettings:
    """What can be set of the searches; each looks at what concerns it.

    ``published`` makes ``ids`` the published iterative deepening, which takes the first unit everywhere
    and so is breadth-first retrieval. ``time_limit`` is in seconds, ``memory_limit``
    in bytes.
    """

    ties: Ties = Ties.FIRST
    count: Count = Count.INGREDIENTS
    published: bool = False
    depth_limit: int | None = None
    time_limit: float | None = None
    memory_limit: int | None = None


class Retrieve(Protocol):
    """The function of a search, ours or that of another package (docs/entry-points.md)."""

    def __call__(self, problem: Problem, settings: SearchSettings, /) -> Retrieval:
        """Look for a tree that makes the goals of a problem.

        Nothing has to be right: the tree is simulated, and its costs are computed, by whoever asks.
        """


class Search(NamedTuple):
    """One search: what it promises, how to run it, and the package it is of if it is not ours."""

    name: str
    promise: str
    run: Retrieve
    package: str | None = None
