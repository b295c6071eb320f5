"""Chart of a Pareto front: one objective over another, with a step function through the points."""

from fractions import Fraction
from itertools import accumulate
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from foon_asp.pictures.chart import write_chart
from foon_asp.problem import Objective, multiplies
from foon_asp.results.figure_text import success_texts

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MARKERS = "osD^vPX"


class PlottedFront(NamedTuple):
    """A Pareto front to be drawn.

    ``goals``: the labels of the goals, as text.
    ``conditions``: container rule and level, as text.
    ``points``: for each tree, its cost by each of the ``objectives``.
    ``complete``: whether the front has no other points.
    """

    goals: str
    conditions: str
    objectives: tuple[Objective, ...]
    points: tuple[tuple[int | Fraction, ...], ...]
    complete: bool


def write_front_chart(front: PlottedFront, file: Path) -> None:
    """Write the chart of a front with at least one point, as SVG or PNG by the suffix of the file.

    Two objectives are the axes, ``success`` on the vertical one. The scale of ``success`` is logarithmic if
    all its values are above 0 and the greatest is more than 50 times the least. Each point shows its value on
    the vertical axis.

    A third objective divides the points into series, one for each of its values. Then points show no values,
    and a legend shows the value of each series. The third objective is the additive one with the fewest
    values. The line of a series is the front of all points with at most the value of the series. An
    incomplete front has no lines, since a line claims that no tree is beyond it.

    Raises :class:`UserError` as :func:`foon_asp.pictures.chart.write_chart` does.
    """
    columns = dict(zip(front.objectives, zip(*front.points, strict=True), strict=True))
    additive = [objective for objective in front.objectives if not multiplies(objective)]
    series = None
    if len(front.objectives) > 2:
        series = min(additive, key=lambda objective: len(set(columns[objective])))
        additive.remove(series)
    x, y = additive[0], Objective.SUCCESS if Objective.SUCCESS in front.objectives else additive[1]
    more_is_better = multiplies(y)
    series_of_points = columns[series] if series else [0] * len(front.points)
    y_texts = success_texts(columns[y]) if more_is_better else list(map(str, columns[y]))
    points = sorted(
        zip(map(float, columns[x]), map(float, columns[y]), series_of_points, y_texts, strict=True)
    )
    series_values = sorted(set(series_of_points))
    title = f"{front.goals}\n{y} over {x}{f' by {series}' if series else ''} ({front.conditions})"
    if not front.complete:
        title += "\nstopped at a limit: points may be missing"

    def draw(figure: "Figure", axes: "Axes") -> None:
        """Draw the axes, the points of all series, and a legend or the labels of points.

        Each series has a line if the front is complete. The legend is for a third objective; without one,
        points have labels. The vertical axis is logarithmic as :func:`write_front_chart` says.
        """
        from matplotlib.ticker import MaxNLocator  # noqa: PLC0415 (slow to import, and not installed by everyone)

        axes.set_xlabel(x.row.words)
        axes.set_ylabel(y.row.words)
        axes.margins(0.1, 0.15)
        axes.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
        if not more_is_better:
            axes.yaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
        elif 0 < 50 * min(columns[y]) < max(columns[y]):  # a linear scale would hide the smallest success
            axes.set_yscale("log")
        for number, value in enumerate(series_values):
            style: dict[str, Any] = {"color": f"C{number}", "zorder": 2 - number / len(series_values)}
            if front.complete:
                # where lines overlap, all are visible: the greater the value, the wider, and further back
                xs, ys, *_ = zip(*(point for point in points if point[2] <= value), strict=True)
                best = list(accumulate(ys, max if more_is_better else min))
                width = 1.2 + 1.8 * number / len(series_values)
                axes.step(
                    [*xs, points[-1][0] + 0.7], [*best, best[-1]], where="post", linewidth=width, **style
                )
            xs, ys, *_ = zip(*(point for point in points if point[2] == value), strict=True)
            axes.plot(xs, ys, _MARKERS[number % len(_MARKERS)], label=str(value), **style)
        if series:
            name = series.row.words
            name += "\n(lines: at most this value)" if front.complete else ""
            figure.legend(loc="outside right upper", title=name)
            return
        alignment = "right" if more_is_better else "left"
        for x_value, y_value, _, text in points:  # the value on the x axis can be read off it
            axes.annotate(
                text.removeprefix("≈ "), (x_value, y_value), (0, 4), textcoords="offset points", ha=alignment
            )

    write_chart(file, title, max(3.2, 0.19 * len(series_values) + 1), draw)
