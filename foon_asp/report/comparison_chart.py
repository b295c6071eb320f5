"""Comparisons as a bar chart: units per goal and search, the optimum beside them."""

from collections.abc import Sequence

from foon_asp.compare.comparison import Comparison, Judgement
from foon_asp.problem import Objective
from foon_asp.proof.simulation import Verdict
from foon_asp.report.bar_chart import Bar, BarChart, BarGroup

_EXECUTES = {Verdict.AS_LISTED: "as listed", Verdict.REORDERED: "reordered", Verdict.NEVER: "never"}
_OPTIMUM = "optimum"


def comparison_chart(labels: Sequence[str], comparisons: Sequence[Comparison]) -> BarChart:
    """Lay out a chart; ``labels`` name the goals of the comparisons, in the same order."""
    groups = tuple(
        BarGroup(label, (*map(_bar, comparison.judgements), _optimum(comparison)))
        for label, comparison in zip(labels, comparisons, strict=True)
    )
    title = f"Functional units of retrieved task trees ({comparisons[0].conditions})"
    return BarChart(title, groups, _OPTIMUM)


def _bar(judgement: Judgement) -> Bar:
    if judgement.executes is None:
        return Bar(judgement.search, None, "none")
    units = judgement.measures[Objective.UNITS]
    return Bar(judgement.search, int(units), _EXECUTES[Verdict(judgement.executes)])


def _optimum(comparison: Comparison) -> Bar:
    optimum = comparison.optima[Objective.UNITS]
    if optimum.value is None:
        return Bar(_OPTIMUM, None, "none")
    return Bar(_OPTIMUM, int(optimum.value), "as listed")
