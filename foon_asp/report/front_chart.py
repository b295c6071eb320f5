"""The Pareto front as a chart: one objective over another, and steps between the points."""

from collections.abc import Sequence
from fractions import Fraction
from math import ceil
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Any, NamedTuple

from foon_asp.explain.alternatives import Tree
from foon_asp.explain.pareto import Front
from foon_asp.problem import Objective, multiplies
from foon_asp.report.chart_file import TEXT, write_figure
from foon_asp.report.pareto import success_texts

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_NAMES = {
    Objective.UNITS: "functional units",
    Objective.INPUTS: "input object nodes",
    Objective.INPUTS_AND_INGREDIENTS: "input object nodes and ingredients",
    Objective.SUCCESS: "success rate",
    Objective.KITCHEN: "kitchen items",
}
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


class _Axes(NamedTuple):
    """What is drawn to the right, what upwards, and what makes series, if there are three objectives."""

    x: Objective
    y: Objective
    series: Objective | None


def write_front_chart(front: Front, file: Path) -> None:
    """Draw a front that has a point into a file, SVG or PNG by its suffix.

    Two objectives are the axes, ``success`` upwards if it is one of them. Of three, the one with the fewest
    values of those that count makes series: the points of a series have its value, and its line leads along
    the best of all points that have so much at most. Where the front is not complete there are no lines, for
    they say that there is no tree beyond them. Raises :class:`UserError` like
    :func:`foon_asp.report.chart_file.write_figure`.
    """
    write_figure(lambda figure: _draw(front, figure), file)


def _axes(front: Front) -> _Axes:
    """Choose what is drawn where."""
    upwards = Objective.SUCCESS in front.objectives
    counts = [objective for objective in front.objectives if not multiplies(objective)]
    series = None
    if len(front.objectives) > 2:
        series = min(counts, key=lambda objective: len({t.costs.measure(objective) for t in front.points}))
        counts.remove(series)
    return _Axes(counts[0], Objective.SUCCESS if upwards else counts[1], series)


def _draw(front: Front, figure: "Figure") -> None:
    from matplotlib.ticker import MaxNLocator  # noqa: PLC0415 (slow to import, and not installed by everyone)

    chosen = _axes(front)
    points = sorted(front.points, key=lambda tree: tree.costs.key((chosen.x, chosen.y)))
    places = len({tree.costs.measure(chosen.x) for tree in points})
    width = min(max(_LEAST_WIDTH, _STEP * (places + 2)), _MOST_WIDTH)
    title = "\n".join(fill(line, int(width / _LETTER / 1.3)) for line in _title(front, chosen))
    figure.suptitle(title, fontsize=TEXT * 1.1, fontweight="bold")
    lines = title.count("\n")

    axes = figure.subplots()
    axes.set_xlabel(_NAMES[chosen.x])
    axes.set_ylabel(_NAMES[chosen.y])
    axes.grid(axis="x")
    if multiplies(chosen.y) and _is_long([float(tree.costs.measure(chosen.y)) for tree in points]):
        axes.set_yscale("log")
    right = max(x for x, _ in _places(points, chosen)) + _BEYOND
    if chosen.series is None:
        if front.complete:
            _draw_steps(axes, points, chosen, right, _BLUE, _LINE, 2)
        axes.plot(*zip(*_places(points, chosen), strict=True), "o", color=_BLUE, markersize=4.5)
        _name_points(axes, points, chosen)
    else:
        values = _draw_series(axes, points, chosen, right if front.complete else None)
        entry = _ENTRY + max(map(len, values)) * _LETTER
        columns = min(len(values), int((width - 0.3) / entry))
        name = _NAMES[chosen.series]
        figure.legend(
            loc="outside lower center",
            ncols=columns,
            title=f"{name} (lines: so many at most)" if front.complete else name,
            handletextpad=0.3,
        )
        lines += ceil(len(values) / columns) + 1
    named = chosen.series is None  # beside the points, for which there has to be room
    axes.margins(x=0.15 if named else 0.06, y=0.18 if named else 0.1)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    if places == 1:
        axes.set_xlim(right - _BEYOND - 1, right + 1 - _BEYOND)
    if not multiplies(chosen.y):
        axes.yaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
        heights = {y for _, y in _places(points, chosen)}
        if len(heights) == 1:
            axes.set_ylim(min(heights) - 1, max(heights) + 1)
    figure.set_size_inches(width, _HEIGHT + lines * TEXT * 1.35 / 72)


def _is_long(successes: Sequence[float]) -> bool:
    return 0 < min(successes) * _LONG < max(successes)


def _places(trees: Sequence[Tree], chosen: _Axes) -> list[tuple[float, float]]:
    return [(float(t.costs.measure(chosen.x)), float(t.costs.measure(chosen.y))) for t in trees]


def _draw_series(axes: "Axes", points: Sequence[Tree], chosen: _Axes, right: float | None) -> list[str]:
    """Draw points and, as far as ``right``, lines by the objective that makes series; gives its values.

    Where lines run together, all are seen: the greater the value, the broader the line, and the further back.
    """
    import matplotlib as mpl  # noqa: PLC0415 (see above)

    assert chosen.series is not None
    of = [int(tree.costs.measure(chosen.series)) for tree in points]
    values = sorted(set(of))
    palette = mpl.colormaps["viridis"]
    for number, value in enumerate(values):
        part = number / max(len(values) - 1, 1)
        color = palette(_LIGHTEST * part)
        if right is not None:
            below = [tree for tree, its in zip(points, of, strict=True) if its <= value]
            _draw_steps(axes, below, chosen, right, color, _LINE * (1 + 1.5 * part), 2 - part)
        here = [tree for tree, its in zip(points, of, strict=True) if its == value]
        marker = _MARKERS[number % len(_MARKERS)]
        places = zip(*_places(here, chosen), strict=True)
        axes.plot(
            *places, marker, color=color, markersize=6, mec="white", mew=0.6, label=str(value), zorder=3
        )
    return [str(value) for value in values]


def _draw_steps(
    axes: "Axes", trees: Sequence[Tree], chosen: _Axes, right: float, color: Any, width: float, order: float
) -> None:
    """Draw the best y that there is for each x and less; the trees come in order of x, then of y."""
    edge: list[Tree] = []
    for tree in trees:
        if not edge or tree.costs.key((chosen.y,)) < edge[-1].costs.key((chosen.y,)):
            edge.append(tree)
    places = _places(edge, chosen)
    xs, ys = zip(*places, (right, places[-1][1]), strict=True)
    axes.step(xs, ys, where="post", color=color, linewidth=width, zorder=order)


def _name_points(axes: "Axes", points: Sequence[Tree], chosen: _Axes) -> None:
    """Put beside each point what it has of y; what it has of x can be read off the axis."""
    measures = [tree.costs.measure(chosen.y) for tree in points]
    upwards = multiplies(chosen.y)
    texts = success_texts(list(map(Fraction, measures))) if upwards else list(map(str, measures))
    for place, text in zip(_places(points, chosen), texts, strict=True):
        axes.annotate(
            text.removeprefix("≈ "),
            place,
            (0, 4),
            textcoords="offset points",
            ha="right" if upwards else "left",
            va="bottom",
            fontsize=_VALUE,
        )


def _title(front: Front, chosen: _Axes) -> tuple[str, ...]:
    objects = front.problem.network.objects
    goals = " + ".join(objects[goal].label for goal in front.problem.goals)
    by = f"{chosen.y} over {chosen.x}" + (f" by {chosen.series}" if chosen.series else "")
    title = goals, f"{by} ({front.problem.conditions})"
    return title if front.complete else (*title, "stopped at a limit: points may be missing")
