"""The searches of the literature: the tree that one of them returns, and whether it executes."""

from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.problem import Costs, Problem
from foon_asp.proof import Simulation, Verdict, simulate_for
from foon_asp.questions.arguments import at_least, settings
from foon_asp.questions.result import Result
from foon_asp.questions.tree import Tree
from foon_asp.report.drawing import Drawing
from foon_asp.report.retrieval import retrieval_json, retrieval_text
from foon_asp.search import SEARCHES, Count, Ending, Retrieval, Search, SearchSettings, Ties


class _Retrieved(NamedTuple):
    problem: Problem
    search: Search
    retrieval: Retrieval
    simulation: Simulation | None


class Retrieved(Result, _Retrieved):
    """What a search returned: ``retrieval`` has its ``ending`` and its ``units`` by id in the order listed.

    ``simulation`` says whether the tree executes and what stops it, ``None`` without a tree; ``search`` says
    what the search promises.
    """

    __slots__ = ()

    @property
    def tree(self) -> Tree | None:
        """The tree in the order listed, ``None`` where the search has none."""
        if self.retrieval.ending is not Ending.TREE:
            return None
        return Tree.of(self.problem, self.retrieval.units)

    @property
    def executes(self) -> bool:
        """Whether there is a tree that executes, as listed or in another order."""
        return self.simulation is not None and self.simulation.verdict is not Verdict.NEVER

    @property
    def costs(self) -> Costs | None:
        """What the tree costs, ``None`` without a tree."""
        return None if self.simulation is None else self.problem.costs(self.retrieval.units)

    def text(self) -> str:
        """Give the tree as ``foon-asp search`` does."""
        return retrieval_text(*self)

    def json_text(self) -> str:
        """Give the tree as ``foon-asp search --format json`` does."""
        return retrieval_json(*self)

    def drawing(self) -> Drawing | None:
        """Give what the picture shows."""
        return None if self.tree is None else self.tree.drawing()

    def __repr__(self) -> str:
        ended = self.retrieval.ending if self.simulation is None else self.simulation.verdict
        return f"<Retrieved: {self.search.name}, {ended}>"


def retrieve(
    problem: Problem,
    search: str,
    *,
    ties: str = "first",
    count: str = "ingredients",
    depth_limit: int | None = None,
    published: bool = False,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
) -> Retrieved:
    """Retrieve a tree as the literature does, and say whether it executes.

    ``search`` is ``bfs``, ``dfs``, ``ids``, ``greedy-success`` or ``greedy-inputs``. ``ties`` says which of
    equally good units is taken, the ``first`` or the ``last``; ``count`` what greedy-inputs counts,
    ``ingredients`` or ``nodes``; ``depth_limit`` how deep ids looks; ``published`` makes ids the published
    one. The limits are as for :func:`foon_asp.solve`. Raises :class:`UserError` for other names.
    """
    searches = searched([search])
    how = search_settings(ties, count, depth_limit, published, time_limit, memory_limit)
    found = searches[0].run(problem, how)
    simulation = None
    if found.ending is Ending.TREE:
        simulation = simulate_for(problem, problem.tree(found.units))
    return Retrieved(problem, searches[0], found, simulation)


def searched(names: list[str]) -> list[Search]:
    """Find searches by name."""
    unknown = [name for name in names if name not in SEARCHES]
    if unknown:
        raise UserError(f"found the search {unknown[0]!r}, expected one of {', '.join(SEARCHES)}")
    return [SEARCHES[name] for name in names]


def search_settings(
    ties: str,
    count: str,
    depth_limit: int | None,
    published: bool,
    time_limit: float | None,
    memory_limit: int | str | None,
) -> SearchSettings:
    """Put together how to search."""
    for name, given, known in (("ties", ties, [*map(str, Ties)]), ("count", count, [*map(str, Count)])):
        if given not in known:
            raise UserError(f"found {name}={given!r}, expected one of {', '.join(known)}")
    if depth_limit is not None:
        at_least(depth_limit, 0, "depth_limit")
    limits = settings(time_limit=time_limit, memory_limit=memory_limit)
    return SearchSettings(
        Ties(ties), Count(count), published, depth_limit, limits.time_limit, limits.memory_limit
    )
