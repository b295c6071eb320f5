"""The searches by name, with what each aims at and promises."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from foon_asp.problem import Objective, Problem
from foon_asp.search.breadth_first import breadth_first
from foon_asp.search.depth_first import depth_first
from foon_asp.search.greedy_inputs import Count, greedy_inputs
from foon_asp.search.greedy_success import greedy_success
from foon_asp.search.iterative_deepening import iterative_deepening
from foon_asp.search.retrieval import Retrieval, Ties


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


class Search(NamedTuple):
    """One search: the objective it aims at, what it promises, and how to run it."""

    name: str
    aims_at: Objective
    promise: str
    run: Callable[[Problem, SearchSettings], Retrieval]


def _deepen(problem: Problem, settings: SearchSettings) -> Retrieval:
    if settings.published:
        return breadth_first(problem, settings.ties)
    return iterative_deepening(problem, settings.depth_limit, settings.time_limit, settings.memory_limit)


_NOTHING = (
    "nothing of the tree but that each input it needs is in the kitchen or an output of one of its units"
)

SEARCHES = {
    search.name: search
    for search in (
        Search("bfs", Objective.UNITS, _NOTHING, lambda p, s: breadth_first(p, s.ties)),
        Search("dfs", Objective.UNITS, _NOTHING, lambda p, s: depth_first(p, s.ties)),
        Search(
            "ids",
            Objective.UNITS,
            "a tree that executes, of least depth, or the proof that none does",
            _deepen,
        ),
        Search("greedy-success", Objective.SUCCESS, _NOTHING, lambda p, s: greedy_success(p, s.ties)),
        Search("greedy-inputs", Objective.INPUTS, _NOTHING, lambda p, s: greedy_inputs(p, s.ties, s.count)),
    )
}
