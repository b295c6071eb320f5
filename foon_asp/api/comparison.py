"""The searches of the literature, held against the optimum."""

import json
from collections.abc import Iterable
from typing import NamedTuple

from foon_asp.compare import Comparison, all_proved, compare_goals, comparison_json
from foon_asp.problem import Problem
from foon_asp.questions.arguments import settings
from foon_asp.questions.result import Result
from foon_asp.questions.searching import search_settings, searched
from foon_asp.report.comparison_table import comparisons_markdown
from foon_asp.search import SEARCHES


class _Compared(NamedTuple):
    comparisons: tuple[Comparison, ...]


class Compared(Result, _Compared):
    """One comparison for each goal: ``optima`` by objective, and a judgement for each search.

    ``comparison.ratio(judgement, objective)`` is a tree's measure over the optimum.
    """

    __slots__ = ()

    @property
    def proved(self) -> bool:
        """Whether all optima are proved."""
        return all_proved(self.comparisons)

    def text(self) -> str:
        """Give the table in Markdown, as ``foon-asp compare --format markdown`` does."""
        return comparisons_markdown(self.comparisons)

    def json_text(self) -> str:
        """Give the comparisons as ``foon-asp compare --format json`` does."""
        rows = [comparison_json(comparison) for comparison in self.comparisons]
        return json.dumps(rows, indent=2, ensure_ascii=False) + "\n"

    def __repr__(self) -> str:
        return f"<Compared: {', '.join(comparison.goal for comparison in self.comparisons)}>"

    def _repr_mimebundle_(
        self, include: Iterable[str] | None = None, exclude: Iterable[str] | None = None
    ) -> dict[str, str]:
        """Give what a notebook shows: the table."""
        return {"text/plain": repr(self), "text/markdown": str(self)}


def compare_searches(
    problem: Problem,
    searches: Iterable[str] = tuple(SEARCHES),
    *,
    ties: str = "first",
    count: str = "ingredients",
    depth_limit: int | None = None,
    published: bool = False,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
) -> Compared:
    """Run searches for each goal of a problem, a question of its own each, and prove the optima beside them.

    The limits are for each optimum and each search. Otherwise as :func:`foon_asp.retrieve`.
    """
    names = [search.name for search in searched(list(searches))]
    limits = settings(time_limit=time_limit, memory_limit=memory_limit)
    how = search_settings(ties, count, depth_limit, published, limits.time_limit, limits.memory_limit)
    return Compared(tuple(compare_goals(problem, problem.goals, names, how, how.time_limit)))
