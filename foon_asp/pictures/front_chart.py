"""The Pareto front as a chart: one objective over another, and steps between the points."""

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
_LONG = 50  # the last success is so much greater than the first that only a logarithmic scale shows both


class Plotted(NamedTuple):
    """A front: the labels of the goals, what it holds under, and its points by each objective.

    ``complete`` says that there are no other points.
    """

    goals: str
    conditions: str
    objectives: tuple[Objective, ...]
    points: tuple[tuple[int | Fraction, ...], ...]
    complete: bool


def write_front_chart(front: Plotted, file: Path) -> None:
    """Draw a front that has a point into a file, SVG or PNG by its suffix.

    Two objectives are the axes, ``success`` upwards if it is one of them. Of three, the one with the fewest
    values of those that count makes series: the points of a series have its value, and its line leads along
    the best of all points that have so much at most. Where the front is not complete there are no lines, for
    they say that there is no tree beyond them. Raises :class:`UserError` like
    :func:`foon_asp.pictures.chart.write_chart`.
    """
    columns = dict(zip(front.objectives, zip(*front.points, strict=True), strict=True))
    counts = [objective for objective in front.objectives if not multiplies(objective)]
    series = None
    if len(front.objectives) > 2:
        series = min(counts, key=lambda objective: len(set(columns[objective])))
        counts.remove(series)
    x, y = counts[0], Objective.SUCCESS if Objective.SUCCESS in front.objectives else counts[1]
    upwards = multiplies(y)
    values = columns[series] if series else [0] * len(front.points)
    texts = success_texts(columns[y]) if upwards else list(map(str, columns[y]))
    points = sorted(zip(map(float, columns[x]), map(float, columns[y]), values, texts, strict=True))
    several = sorted(set(values))
    title = f"{front.goals}\n{y} over {x}{f' by {series}' if series else ''} ({front.conditions})"
    if not front.complete:
        title += "\nstopped at a limit: points may be missing"

    def draw(figure: "Figure", axes: "Axes") -> None:
        from matplotlib.ticker import MaxNLocator  # noqa: PLC0415 (slow to import, and not installed by everyone)

        axes.set_xlabel(x.row.words)
        axes.set_ylabel(y.row.words)
        axes.margins(0.1, 0.15)
        axes.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
        if not upwards:
            axes.yaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
        elif 0 < min(columns[y]) * _LONG < max(columns[y]):
            axes.set_yscale("log")
        for number, value in enumerate(several):
            look: dict[str, Any] = {"color": f"C{number}", "zorder": 2 - number / len(several)}
            if front.complete:
                # where lines run together, all are seen: the greater the value, the broader, and further back
                xs, ys, *_ = zip(*(point for point in points if point[2] <= value), strict=True)
                best = list(accumulate(ys, max if upwards else min))
                width = 1.2 + 1.8 * number / len(several)
                axes.step(
                    [*xs, points[-1][0] + 0.7], [*best, best[-1]], where="post", linewidth=width, **look
                )
            xs, ys, *_ = zip(*(point for point in points if point[2] == value), strict=True)
            axes.plot(xs, ys, _MARKERS[number % len(_MARKERS)], label=str(value), **look)
        if series:
            name = series.row.words
            name += "\n(lines: at most this value)" if front.complete else ""
            figure.legend(loc="outside right upper", title=name)
            return
        side = "right" if upwards else "left"
        for place, height, _, text in points:  # what a point has of x can be read off the axis
            name, spot = text.removeprefix("≈ "), (place, height)
            axes.annotate(name, spot, (0, 4), textcoords="offset points", ha=side)

    write_chart(file, title, max(3.2, 0.19 * len(several) + 1), draw)
