"""Summary statistics of many comparisons, as papers report them: the distance of trees to the optimum."""

import statistics
from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.asp import Status
from foon_asp.comparison.comparison import MEASURED, Comparison, SearchResult
from foon_asp.problem import Objective, multiplies


class Distance(NamedTuple):
    """Statistics of the ratios of the costs of trees to the optimum; 1 is optimal, and more is worse.

    Only trees that execute and break no rule count. The ratio is the cost divided by the optimum; for
    ``success``, it is the optimum divided by the rate.

    ``share``: the fraction of trees that are optimal.
    ``percentile_90``: the least ratio that at least nine tenths of the trees do not exceed.
    ``worst_goal``: the goal with the ratio ``worst``.
    """

    share: Fraction
    mean: Fraction
    median: Fraction
    percentile_90: Fraction
    worst: Fraction
    worst_goal: str


class Summary(NamedTuple):
    """The summary of one search over many goals.

    ``results`` are the results of the search, goal by goal. ``distances`` are by objective; an objective
    without any ratio is absent.
    """

    search: str
    results: tuple[SearchResult, ...]
    distances: dict[Objective, Distance]


def summarize_comparisons(comparisons: Sequence[Comparison]) -> list[Summary]:
    """Return a summary of the comparisons for each search, in the order of the searches."""
    names = dict.fromkeys(result.search for row in comparisons for result in row.searches)
    return [_summarize_search(name, comparisons) for name in names]


def _summarize_search(name: str, comparisons: Sequence[Comparison]) -> Summary:
    """Return the summary of the results of one search, by its name.

    A result without a ratio to the optimum, or with the ratio 0, does not count in the distances.
    """
    results = [(row.goal, result) for row in comparisons for result in row.searches if result.search == name]
    distances: dict[Objective, Distance] = {}
    for objective in MEASURED:
        ratios = [
            (1 / ratio if multiplies(objective) else ratio, str(goal))
            for goal, result in results
            if result.is_valid and (ratio := result.ratios.get(objective))
        ]
        if ratios:
            distances[objective] = _distance_of(sorted(ratios))
    return Summary(name, tuple(result for _, result in results), distances)


def _distance_of(ratios: list[tuple[Fraction, str]]) -> Distance:
    """Return the statistics of ratios with their goals; the pairs are in ascending order."""
    values = [value for value, _ in ratios]
    share, median = Fraction(values.count(Fraction(1)), len(values)), statistics.median(values)
    mean, percentile_90 = statistics.mean(values), values[-(-9 * len(values) // 10) - 1]
    return Distance(share, mean, median, percentile_90, *ratios[-1])


def all_proved(comparisons: Iterable[Comparison]) -> bool:
    """Return whether each optimum of the comparisons is proved, or is proved not to exist."""
    return all(
        optimum.status in {Status.OPTIMAL, Status.INFEASIBLE}
        for comparison in comparisons
        for optimum in comparison.optimum.values()
    )
