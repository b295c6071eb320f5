"""Comparisons as a chart: for each search, the sizes of its trees over the proved optima."""

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
_GOLDEN = 0.6180339887  # multiples of it spread evenly between two whole numbers
_ROOM = 0.32  # of the points on either side of the middle of their box
# By how a tree executes: the emptier its point looks, the less the tree is worth.
_POINTS = {Verdict.AS_LISTED: _BLUE, Verdict.REORDERED: "#BFDCEC", Verdict.NEVER: "#FFFFFF"}


def write_comparison_chart(comparisons: Sequence[Comparison], conditions: str, file: Path) -> None:
    """Draw a box for each search into a file, SVG or PNG by its suffix.

    The points of a box are the goals for which the search found a tree and the optimum is proved; all holds
    under the ``conditions``. Raises :class:`UserError` like :func:`foon_asp.pictures.chart.write_chart`.
    """
    title = (
        f"Functional units of retrieved task trees over the optimum: {counted(len(comparisons), 'goal')} "
        f"({conditions})"
    )
    write_chart(file, title, 4.2, lambda figure, axes: _draw(comparisons, figure, axes))


def _draw(comparisons: Sequence[Comparison], figure: "Figure", axes: "Axes") -> None:
    trees: dict[str, list[tuple[float, Verdict]]] = {}
    for comparison in comparisons:
        for judged in comparison.searches:
            found = trees.setdefault(judged.search, [])
            ratio = judged.ratios.get(Objective.UNITS)
            if ratio is not None and judged.verdict is not None:
                found.append((float(ratio), judged.verdict))
    labels = []
    for place, (name, found) in enumerate(trees.items()):
        if not found:
            labels.append(f"{name}\nno tree to compare")
            continue
        ratios, verdicts = zip(*found, strict=True)
        labels.append(
            f"{name}\n{counted(len(found), 'tree')}\n{len(found) - verdicts.count(Verdict.NEVER)} execute\n"
            f"mean {fmean(ratios):.3g}\nmedian {median(ratios):.3g}"
        )
        axes.boxplot(
            [ratios],
            positions=[place],
            widths=2.4 * _ROOM,
            showfliers=False,
            showmeans=True,
            meanprops={"marker": "D", "markerfacecolor": _ORANGE, "markeredgecolor": "white", "zorder": 4},
            medianprops={"color": _ORANGE, "linewidth": 2, "zorder": 3},
        )
        spots = [place + _ROOM * (2 * (number * _GOLDEN % 1) - 1) for number in range(len(found))]
        axes.scatter(
            spots, ratios, 14, [_POINTS[each] for each in verdicts], edgecolors=_BLUE, linewidths=0.7
        )
    figure.set_size_inches(max(figure.get_figwidth(), len(trees)), figure.get_figheight())
    axes.set_xlim(-0.6, len(trees) - 0.4)
    axes.set_xticks(range(len(trees)), labels)
    axes.grid(visible=False, axis="x")
    axes.axhline(1, color="black", linewidth=1, zorder=1)
    axes.set_ylabel("units / units of the optimum")
    for verdict, color in _POINTS.items():
        axes.scatter([], [], 14, color, edgecolors=_BLUE, linewidths=0.7, label=str(verdict))
    axes.plot([], [], color="black", linewidth=1, label="optimum")
    axes.plot([], [], color=_ORANGE, linewidth=2, label="median")
    axes.plot([], [], "D", color=_ORANGE, label="mean")
    figure.legend(loc="outside lower center", ncols=3)
