"""The Pareto front as a chart: one objective over another, and steps between the points."""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import ceil
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Any, NamedTuple

from foon_asp.problem import Objective, multiplies
from foon_asp.report.answer import success_texts
from foon_asp.report.chart_file import TEXT, write_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_BLUE = "#0072B2"  # the first color of the other charts
_MARKERS = "osD^vPX"
_LIGHTEST = 0.88  # of matplotlib's viridis, of which the lightest part is lost on white
_BEYOND = 0.7  # how far lines go on to the right of the last point, in steps of what is counted
_LONG = 50  # the last success is so much greater than the first that only a logarithmic scale shows both

# In inches.
_LEAST_WIDTH, _MOST_WIDTH = 3.45, 7.15  # a column, and both columns of a page
_STEP = 0.45  # from one point to the next, at least, where there is room
_HEIGHT = 2.5

_VALUE = 7.0  # the size of numbers beside points, in points of print
_LINE = 1.2  # the width of a line, likewise
_LETTER = TEXT * 0.58 / 72  # the mean width of a letter, in inches
_ENTRY = 0.42  # the width of an entry of the legend, without its number, in inches


class Plotted(NamedTuple):
    """A front: the labels of the goals, what it holds under, and where its points stand by each objective.

    ``complete`` says that there are no other points.
    """

    goals: str
    conditions: str
    objectives: tuple[Objective, ...]
    points: tuple[tuple[int | Fraction, ...], ...]
    complete: bool


class _Place(NamedTuple):
    """Where a point is drawn, and the number that puts it into a series, if there are three objectives."""

    x: int | Fraction
    y: int | Fraction
    series: int = 0


class _Axes(NamedTuple):
    """What is drawn to the right, what upwards, and what makes series, if there are three objectives."""

    x: Objective
    y: Objective
    series: Objective | None


def write_front_chart(front: Plotted, file: Path) -> None:
    """Draw a front that has a point into a file, SVG or PNG by its suffix.

    Two objectives are the axes, ``success`` upwards if it is one of them. Of three, the one with the fewest
    values of those that count makes series: the points of a series have its value, and its line leads along
    the best of all points that have so much at most. Where the front is not complete there are no lines, for
    they say that there is no tree beyond them. Raises :class:`UserError` like
    :func:`foon_asp.report.chart_file.write_figure`.
    """
    write_figure(lambda figure: _draw(front, figure), file)


def _axes(front: Plotted) -> _Axes:
    """Choose what is drawn where."""
    upwards = Objective.SUCCESS in front.objectives
    counts = [objective for objective in front.objectives if not multiplies(objective)]
    series = None
    if len(front.objectives) > 2:
        columns = dict(zip(front.objectives, zip(*front.points, strict=True), strict=True))
        series = min(counts, key=lambda objective: len(set(columns[objective])))
        counts.remove(series)
    return _Axes(counts[0], Objective.SUCCESS if upwards else counts[1], series)


def _places(front: Plotted, chosen: _Axes) -> list[_Place]:
    """Say where the points are drawn, in order of x, then the better y."""
    places = []
    for point in front.points:
        of = dict(zip(front.objectives, point, strict=True))
        series = 0 if chosen.series is None else int(of[chosen.series])
        places.append(_Place(of[chosen.x], of[chosen.y], series))
    return sorted(places, key=lambda place: (place.x, _height(place, chosen)))


def _height(place: _Place, chosen: _Axes) -> int | Fraction:
    """Give what is less for the better y."""
    return -place.y if multiplies(chosen.y) else place.y


def _draw(front: Plotted, figure: "Figure") -> None:
    from matplotlib.ticker import MaxNLocator  # noqa: PLC0415 (slow to import, and not installed by everyone)

    chosen = _axes(front)
    points = _places(front, chosen)
    columns = len({point.x for point in points})
    width = min(max(_LEAST_WIDTH, _STEP * (columns + 2)), _MOST_WIDTH)
    title = "\n".join(fill(line, int(width / _LETTER / 1.3)) for line in _title(front, chosen))
    figure.suptitle(title, fontsize=TEXT * 1.1, fontweight="bold")
    lines = title.count("\n")

    axes = figure.subplots()
    axes.set_xlabel(chosen.x.row.words)
    axes.set_ylabel(chosen.y.row.words)
    axes.grid(axis="x")
    if multiplies(chosen.y) and _is_long([float(point.y) for point in points]):
        axes.set_yscale("log")
    right = float(max(point.x for point in points)) + _BEYOND
    if chosen.series is None:
        if front.complete:
            _draw_steps(axes, points, chosen, right, _BLUE, _LINE, 2)
        axes.plot(*_coordinates(points), "o", color=_BLUE, markersize=4.5)
        _name_points(axes, points, chosen)
    else:
        values = _draw_series(axes, points, chosen, right if front.complete else None)
        entry = _ENTRY + max(map(len, values)) * _LETTER
        abreast = min(len(values), int((width - 0.3) / entry))
        name = chosen.series.row.words
        figure.legend(
            loc="outside lower center",
            ncols=abreast,
            title=f"{name} (lines: at most this value)" if front.complete else name,
            handletextpad=0.3,
        )
        lines += ceil(len(values) / abreast) + 1
    named = chosen.series is None  # beside the points, for which there has to be room
    axes.margins(x=0.15 if named else 0.06, y=0.18 if named else 0.1)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    if columns == 1:
        axes.set_xlim(right - _BEYOND - 1, right + 1 - _BEYOND)
    if not multiplies(chosen.y):
        axes.yaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
        heights = {float(point.y) for point in points}
        if len(heights) == 1:
            axes.set_ylim(min(heights) - 1, max(heights) + 1)
    figure.set_size_inches(width, _HEIGHT + lines * TEXT * 1.35 / 72)


def _is_long(successes: Sequence[float]) -> bool:
    return 0 < min(successes) * _LONG < max(successes)


def _coordinates(points: Iterable[_Place]) -> tuple[list[float], list[float]]:
    """Give all x, and all y."""
    listed = list(points)
    return [float(point.x) for point in listed], [float(point.y) for point in listed]


def _draw_series(axes: "Axes", points: Sequence[_Place], chosen: _Axes, right: float | None) -> list[str]:
    """Draw points and, as far as ``right``, lines by the objective that makes series; gives its values.

    Where lines run together, all are seen: the greater the value, the broader the line, and the further back.
    """
    import matplotlib as mpl  # noqa: PLC0415 (see above)

    values = sorted({point.series for point in points})
    palette = mpl.colormaps["viridis"]
    for number, value in enumerate(values):
        part = number / max(len(values) - 1, 1)
        color = palette(_LIGHTEST * part)
        if right is not None:
            below = [point for point in points if point.series <= value]
            _draw_steps(axes, below, chosen, right, color, _LINE * (1 + 1.5 * part), 2 - part)
        here = _coordinates(point for point in points if point.series == value)
        marker = _MARKERS[number % len(_MARKERS)]
        axes.plot(*here, marker, color=color, markersize=6, mec="white", mew=0.6, label=str(value), zorder=3)
    return [str(value) for value in values]


def _draw_steps(
    axes: "Axes",
    points: Sequence[_Place],
    chosen: _Axes,
    right: float,
    color: Any,
    width: float,
    order: float,
) -> None:
    """Draw the best y that there is for each x and less; the points come in order of x, then of y."""
    edge: list[_Place] = []
    for point in points:
        if not edge or _height(point, chosen) < _height(edge[-1], chosen):
            edge.append(point)
    xs, ys = _coordinates(edge)
    axes.step([*xs, right], [*ys, ys[-1]], where="post", color=color, linewidth=width, zorder=order)


def _name_points(axes: "Axes", points: Sequence[_Place], chosen: _Axes) -> None:
    """Put beside each point what it has of y; what it has of x can be read off the axis."""
    measures = [point.y for point in points]
    upwards = multiplies(chosen.y)
    texts = success_texts(list(map(Fraction, measures))) if upwards else list(map(str, measures))
    for x, y, text in zip(*_coordinates(points), texts, strict=True):
        axes.annotate(
            text.removeprefix("≈ "),
            (x, y),
            (0, 4),
            textcoords="offset points",
            ha="right" if upwards else "left",
            va="bottom",
            fontsize=_VALUE,
        )


def _title(front: Plotted, chosen: _Axes) -> tuple[str, ...]:
    by = f"{chosen.y} over {chosen.x}" + (f" by {chosen.series}" if chosen.series else "")
    title = front.goals, f"{by} ({front.conditions})"
    return title if front.complete else (*title, "stopped at a limit: points may be missing")
