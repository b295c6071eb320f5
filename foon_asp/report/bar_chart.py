"""The bar chart of task tree sizes: the searches beside the proved optimum, goal by goal."""

from collections.abc import Sequence
from math import ceil
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Literal, NamedTuple

from foon_asp.errors import UserError
from foon_asp.report.chart_file import TEXT, check_suffix, write_figure

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Okabe and Ito's colors, which people with any of the common color deficiencies can tell apart, ordered so
# that neighbours differ in lightness too. Their eighth is black, which is the optimum's.
_COLORS = ("#0072B2", "#E69F00", "#009E73", "#56B4E9", "#D55E00", "#CC79A7", "#F0E442")
_OPTIMUM_COLOR = "#000000"
_WAY_COLOR = "#777777"  # of the legend that is about no series

# How a tree executes, as a bar has it and as the legend says it.
_WAYS = {
    "as listed": "executes as listed",
    "reordered": "executes when reordered",
    "never": "never executes",
    "none": "no tree",
}

# In inches, so that a chart can be printed as it is over both columns of a page.
_SLOT = 0.145  # from one bar to the next; two digits fit above a bar
_ROW_WIDTH = 6.6  # of all bars in a row; the groups that do not fit go on in a further row
_ROW_HEIGHT = 1.6  # without the names of the goals
_MARGIN = 0.55  # the width of the axis and its name
_LEAST_ROW_WIDTH = 2.9  # for the legends of a chart with few bars; with the margin, a column of a page
_EDGES = 0.5  # the height of the legends' and the figure's padding

# In slots.
_BAR = 0.8  # the width of a bar
_GAP = 1.5  # between two groups, at least
_LEAST_PITCH = 6.0  # from one group to the next, for the words of their names
_APART = 0.3  # between the searches and the optimum

# In points, of which an inch has 72.
_VALUE = 7.0
_LINE = TEXT * 1.25
_LETTER = TEXT * 0.58  # the mean width of a letter


class Bar(NamedTuple):
    """The tree that one series has for a goal, with ``units`` functional units, or ``None`` without a tree.

    ``executes`` says how it executes: ``as listed``, ``reordered`` (in another order only), ``never`` (in no
    order), or ``none`` where there is no tree.
    """

    series: str
    units: int | None
    executes: str


class BarGroup(NamedTuple):
    """The bars of one goal. The place of a series without a bar stays empty."""

    goal: str
    bars: tuple[Bar, ...]


class BarChart(NamedTuple):
    """Groups of bars under a title; ``optimum`` is the name of the series that is the proved optimum."""

    title: str
    groups: tuple[BarGroup, ...]
    optimum: str


def write_chart(chart: BarChart, file: Path) -> None:
    """Draw a chart into a file, as SVG or PNG by its suffix; the file is complete or not written at all."""
    check_suffix(file)
    if not chart.groups:
        raise UserError(f"{file}: no goal to draw a chart of")
    write_figure(lambda figure: _draw(chart, figure), file)


def _draw(chart: BarChart, figure: "Figure") -> None:
    """Lay the groups out in rows of one scale, below the legend of the series and above that of the ways."""
    colors = _series_colors(chart)
    offsets = _offsets(tuple(colors), chart.optimum)
    extent = max(offsets.values()) + 1  # of a group, in slots
    pitch = max(extent + _GAP, _LEAST_PITCH)  # from one group to the next, in slots
    rows = ceil(len(chart.groups) / int(_ROW_WIDTH / _SLOT / pitch))
    columns = ceil(len(chart.groups) / rows)
    pitch = max(pitch, _LEAST_ROW_WIDTH / _SLOT / columns)
    names = [fill(group.goal, int(pitch * _SLOT * 72 / _LETTER) - 1) for group in chart.groups]

    width = columns * pitch * _SLOT + _MARGIN
    swatches = [_swatch(color, "as listed") for color in colors.values()]
    lines = _add_legend(figure, "outside upper center", swatches, tuple(colors), width, chart.title)
    swatches = [_swatch(_WAY_COLOR, way) for way in _WAYS]
    lines += _add_legend(figure, "outside lower center", swatches, tuple(_WAYS.values()), width)
    lines += rows * (1 + max(name.count("\n") for name in names))
    figure.set_size_inches(width, rows * _ROW_HEIGHT + _EDGES + lines * _LINE / 72)

    highest = max((bar.units or 0 for group in chart.groups for bar in group.bars), default=0)
    upright = highest >= 100  # three digits are wider than a slot
    for row, axes in enumerate(figure.subplots(rows, sharey=True, squeeze=False)[:, 0]):
        here = slice(row * columns, (row + 1) * columns)
        for place, group in enumerate(chart.groups[here]):
            for bar in group.bars:
                _draw_bar(axes, place * pitch + offsets[bar.series], bar, colors[bar.series], upright)
        axes.set_xticks([place * pitch + (extent - 1) / 2 for place in range(len(names[here]))], names[here])
        axes.set_xlim((extent - 1 - pitch) / 2, (extent - 1 - pitch) / 2 + columns * pitch)
        axes.set_ylim(0, max(highest, 1) * (1.22 if upright else 1.12))  # with room for the highest number
        axes.set_ylabel("functional units")
        axes.yaxis.get_major_locator().set_params(integer=True, nbins=6)


def _series_colors(chart: BarChart) -> dict[str, str]:
    """Give each series its color: the searches as the groups bring them up, then the optimum."""
    series = dict.fromkeys(bar.series for group in chart.groups for bar in group.bars)
    searches = [name for name in series if name != chart.optimum]
    if len(searches) > len(_COLORS):
        raise UserError(f"a chart shows at most {len(_COLORS)} searches, found {len(searches)}")
    return {**dict(zip(searches, _COLORS, strict=False)), chart.optimum: _OPTIMUM_COLOR}


def _offsets(series: Sequence[str], optimum: str) -> dict[str, float]:
    """Give each series its place in a group, in slots from the first, with the optimum a little apart."""
    return {name: place + (_APART if name == optimum else 0) for place, name in enumerate(series)}


def _add_legend(
    figure: "Figure",
    place: Literal["outside upper center", "outside lower center"],
    swatches: Sequence["Artist"],
    names: Sequence[str],
    width: float,
    title: str = "",
) -> int:
    """Add a legend in as many columns as fit into ``width`` (inches), and give its number of lines."""
    lines = 1
    while lines < len(names) and _legend_width(names, lines) > width:
        lines += 1
    title = fill(title, int(width * 72 / _LETTER / 1.4))  # larger than other text, and bold
    legend = figure.legend(
        swatches,
        names,
        loc=place,
        ncols=ceil(len(names) / lines),
        title=title or None,
        title_fontproperties={"weight": "bold", "size": TEXT * 1.2},
    )
    legend.get_title().set_multialignment("center")
    return lines + (title.count("\n") + 2 if title else 0)


def _legend_width(names: Sequence[str], lines: int) -> float:
    """Estimate the width in inches of a legend that is filled column by column."""
    columns = [names[first : first + lines] for first in range(0, len(names), lines)]
    swatch = 5  # with the space around it, in letters
    return sum(max(map(len, column)) + swatch for column in columns) * _LETTER / 72


def _swatch(color: str, way: str) -> "Artist":
    """Give what stands for a color or for a way of executing in a legend."""
    from matplotlib.lines import Line2D  # noqa: PLC0415
    from matplotlib.patches import Patch  # noqa: PLC0415

    if way == "none":
        return Line2D([], [], color=color, linestyle="", marker="x", markersize=4.5)
    face, hatch = _filling(color, way)
    return Patch(facecolor=face, edgecolor=color, hatch=hatch)


def _filling(color: str, way: str) -> tuple[str, str | None]:
    """Give the ground and the hatching of a bar: the emptier it looks, the less its tree is worth."""
    fillings = {
        "as listed": (color, None),
        "reordered": (_lighter(color), "/////"),
        "never": ("white", None),
    }
    return fillings[way]


def _lighter(color: str) -> str:
    """Mix a color, as ``#RRGGBB``, with three parts of white."""
    return "#" + "".join(f"{(int(color[i : i + 2], 16) + 3 * 255) // 4:02X}" for i in (1, 3, 5))


def _draw_bar(axes: "Axes", x: float, bar: Bar, color: str, upright: bool) -> None:
    """Draw a bar with its number above it, or a cross on the axis where there is no tree."""
    if bar.units is None:
        axes.annotate("×", (x, 0), (0, 0), "data", "offset points", ha="center", color=color, fontsize=11)
        return
    face, hatch = _filling(color, bar.executes)
    axes.bar(x, bar.units, _BAR, facecolor=face, edgecolor=color, hatch=hatch)
    axes.annotate(
        str(bar.units),
        (x, bar.units),
        (0, 1.5),
        textcoords="offset points",
        ha="center",
        va="bottom",
        fontsize=_VALUE,
        fontweight="bold" if color == _OPTIMUM_COLOR else "normal",
        rotation=90 if upright else 0,
    )
