"""What a paper would say of many comparisons: how many trees execute, how far the others are off."""

import statistics
from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.asp import Status
from foon_asp.comparison.comparison import MEASURED, Comparison, SearchResult
from foon_asp.problem import Objective, multiplies


class Distance(NamedTuple):
    """How many times worse than the optimum the trees are that execute and keep to rules; 1 is optimal.

    For ``success`` it is the optimum over the tree's product, so that more is worse here too. ``share`` is
    the share of trees that are optimal, ``worst_goal`` the goal of the worst. The 90th percentile is the
    least value that at least nine tenths of the trees do not exceed.
    """

    share: Fraction
    mean: Fraction
    median: Fraction
    percentile_90: Fraction
    worst: Fraction
    worst_goal: str


class Summary(NamedTuple):
    """One search over many goals that can all be made.

    ``results`` are what it returned, goal by goal. ``distances`` are by objective.
    """

    search: str
    results: tuple[SearchResult, ...]
    distances: dict[Objective, Distance]


def summarize_comparisons(comparisons: Sequence[Comparison]) -> list[Summary]:
    """Sum up comparisons, one summary for each search, in the order of the searches."""
    names = dict.fromkeys(result.search for row in comparisons for result in row.searches)
    return [_summary(name, comparisons) for name in names]


def _summary(name: str, comparisons: Sequence[Comparison]) -> Summary:
    found = [(row.goal, result) for row in comparisons for result in row.searches if result.search == name]
    distances: dict[Objective, Distance] = {}
    for objective in MEASURED:
        ratios = [
            (1 / ratio if multiplies(objective) else ratio, str(goal))
            for goal, result in found
            if result.counts and (ratio := result.ratios.get(objective))
        ]
        if ratios:
            distances[objective] = _distance(sorted(ratios))
    return Summary(name, tuple(result for _, result in found), distances)


def _distance(ratios: list[tuple[Fraction, str]]) -> Distance:
    values = [value for value, _ in ratios]
    share, median = Fraction(values.count(Fraction(1)), len(values)), statistics.median(values)
    mean, most = statistics.mean(values), values[-(-9 * len(values) // 10) - 1]
    return Distance(share, mean, median, most, *ratios[-1])


def all_proved(comparisons: Iterable[Comparison]) -> bool:
    """Whether every optimum of every comparison is proved, or proved not to exist."""
    return all(
        optimum.status in {Status.OPTIMAL, Status.INFEASIBLE}
        for comparison in comparisons
        for optimum in comparison.optimum.values()
    )
