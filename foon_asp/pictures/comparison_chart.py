"""Box plot of a comparison of searches: the sizes of their trees, relative to the size of the optimum."""

from collections.abc import Sequence
from pathlib import Path
from statistics import fmean, median
from typing import TYPE_CHECKING

from foon_asp.comparison.comparison import Comparison
from foon_asp.network import counted
from foon_asp.pictures.chart import COLORS, write_chart
from foon_asp.problem import Objective
from foon_asp.proof.simulation import Verdict

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_BLUE, _ORANGE = COLORS[:2]
# By how a tree executes: the emptier its point looks, the less the tree is worth.
_POINT_COLORS = {Verdict.AS_LISTED: _BLUE, Verdict.REORDERED: "#BFDCEC", Verdict.NEVER: "#FFFFFF"}


def write_comparison_chart(comparisons: Sequence[Comparison], conditions: str, file: Path) -> None:
    """Write the chart, with a box for each search, as SVG or PNG by the suffix of the file.

    The points of a box are the goals for which the search found a tree and the optimum is proved.
    ``conditions`` (container rule and level) are part of the title. Raises :class:`UserError` as
    :func:`foon_asp.pictures.chart.write_chart` does.
    """
    title = (
        f"Functional units of retrieved task trees over the optimum: {counted(len(comparisons), 'goal')} "
        f"({conditions})"
    )
    write_chart(file, title, 4.2, lambda figure, axes: _draw_chart(comparisons, figure, axes))


def _draw_chart(comparisons: Sequence[Comparison], figure: "Figure", axes: "Axes") -> None:
    """Draw the whole chart: for each search a box and its points, a line at the optimum, and a legend.

    The name and the statistics of a search stand below its box. The color of a point says how its tree
    executes. A search without points has only its name and a remark. The figure gets wider for many searches.
    """
    points_by_search: dict[str, list[tuple[float, Verdict]]] = {}
    for comparison in comparisons:
        for judged in comparison.searches:
            points = points_by_search.setdefault(judged.search, [])
            ratio = judged.ratios.get(Objective.UNITS)
            if ratio is not None and judged.verdict is not None:
                points.append((float(ratio), judged.verdict))
    labels = []
    for position, (name, points) in enumerate(points_by_search.items()):
        if not points:
            labels.append(f"{name}\nno tree to compare")
            continue
        ratios, verdicts = zip(*points, strict=True)
        labels.append(
            f"{name}\n{counted(len(points), 'tree')}\n{len(points) - verdicts.count(Verdict.NEVER)} execute\n"
            f"mean {fmean(ratios):.3g}\nmedian {median(ratios):.3g}"
        )
        axes.boxplot(
            [ratios],
            positions=[position],
            widths=0.768,  # boxes are 1 apart, and their points lie within
            showfliers=False,
            showmeans=True,
            meanprops={"marker": "D", "markerfacecolor": _ORANGE, "markeredgecolor": "white", "zorder": 4},
            medianprops={"color": _ORANGE, "linewidth": 2, "zorder": 3},
        )
        # fractional parts of multiples of the golden ratio spread evenly from 0 to 1
        offsets = [2 * (number * 0.6180339887 % 1) - 1 for number in range(len(points))]
        xs = [position + 0.32 * offset for offset in offsets]
        colors = [_POINT_COLORS[verdict] for verdict in verdicts]
        _draw_points(axes, xs, ratios, colors)
    figure.set_size_inches(max(figure.get_figwidth(), len(points_by_search)), figure.get_figheight())
    axes.set_xlim(-0.6, len(points_by_search) - 0.4)
    axes.set_xticks(range(len(points_by_search)), labels)
    axes.grid(visible=False, axis="x")
    axes.axhline(1, color="black", linewidth=1, zorder=1)
    axes.set_ylabel("units / units of the optimum")
    for verdict, color in _POINT_COLORS.items():
        _draw_points(axes, [], [], [color], str(verdict))
    axes.plot([], [], color="black", linewidth=1, label="optimum")
    axes.plot([], [], color=_ORANGE, linewidth=2, label="median")
    axes.plot([], [], "D", color=_ORANGE, label="mean")
    figure.legend(loc="outside lower center", ncols=3)


def _draw_points(
    axes: "Axes", xs: Sequence[float], ys: Sequence[float], colors: Sequence[str], label: str | None = None
) -> None:
    """Draw points with an outline, in their colors.

    ``label`` is their name in the legend; ``None`` for no entry there.
    """
    axes.scatter(xs, ys, 14, colors, edgecolors=_BLUE, linewidths=0.7, label=label)
