"""What a paper would say of many comparisons: how many trees execute, how far the others are off."""

from collections.abc import Iterable
from fractions import Fraction
from typing import NamedTuple

from foon_asp.asp import Status
from foon_asp.compare.comparison import MEASURED, Comparison
from foon_asp.problem import Objective, multiplies
from foon_asp.proof.simulation import Verdict
from foon_asp.search import Ending


class Distance(NamedTuple):
    """How many times worse than the optimum the trees are that execute and keep to rules; 1 is optimal.

    For ``success`` it is the optimum over the tree's product, so that more is worse here too. ``share`` is
    the share of trees that are optimal, ``worst_goal`` the goal of the worst. The 90th percentile is the
    least value that at least nine tenths of the trees do not exceed.
    """

    trees: int
    share: Fraction
    median: Fraction
    percentile_90: Fraction
    worst: Fraction
    worst_goal: str


class Summary(NamedTuple):
    """One search over many goals that can all be made.

    ``endings`` counts trees that execute as listed, when reordered and never, and searches that ended
    without a tree; ``smaller`` counts trees with fewer units than the optimum, none of which execute and
    keep to the rules, and ``breaking`` those that execute and break a rule.
    """

    search: str
    goals: int
    as_listed: int
    reordered: int
    never: int
    cycles: int
    without: int
    smaller: int
    breaking: int
    distances: dict[Objective, Distance]


def summarize_comparisons(comparisons: Iterable[Comparison]) -> list[Summary]:
    """Sum up comparisons, one summary for each search, in the order of the searches."""
    rows = list(comparisons)
    names = dict.fromkeys(judgement.search for row in rows for judgement in row.judgements)
    return [_summary(name, rows) for name in names]


def _summary(name: str, rows: list[Comparison]) -> Summary:
    found = [(row, judgement) for row in rows for judgement in row.judgements if judgement.search == name]
    verdicts = [judgement.executes for _, judgement in found]
    distances: dict[Objective, Distance] = {}
    for objective in MEASURED:
        ratios: list[tuple[Fraction, str]] = []
        for row, judgement in found:
            ratio = row.ratio(judgement, objective)
            if ratio and judgement.counts:
                ratios.append((1 / ratio if multiplies(objective) else ratio, row.goal))
        if ratios:
            distances[objective] = _distance(sorted(ratios))
    return Summary(
        name,
        len(found),
        verdicts.count(Verdict.AS_LISTED),
        verdicts.count(Verdict.REORDERED),
        verdicts.count(Verdict.NEVER),
        sum(judgement.obstacle is not None and judgement.obstacle[2] for _, judgement in found),
        sum(judgement.ending != Ending.TREE for _, judgement in found),
        sum(row.beats_the_optimum(judgement, Objective.UNITS) for row, judgement in found),
        sum(bool(judgement.breaks) for _, judgement in found),
        distances,
    )


def _distance(ratios: list[tuple[Fraction, str]]) -> Distance:
    """Measure sorted ratios; the median of an even number is the mean of the middle two."""
    values = [value for value, _ in ratios]
    number = len(values)
    return Distance(
        number,
        Fraction(sum(value == 1 for value in values), number),
        (values[(number - 1) // 2] + values[number // 2]) / 2,
        values[-(-9 * number // 10) - 1],
        *ratios[-1],
    )


def all_proved(comparisons: Iterable[Comparison]) -> bool:
    """Whether every optimum of every comparison is proved, or proved not to exist."""
    return all(
        optimum.status in {Status.OPTIMAL, Status.INFEASIBLE}
        for comparison in comparisons
        for optimum in comparison.optima.values()
    )
