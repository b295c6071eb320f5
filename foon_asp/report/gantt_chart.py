"""Schedules as Gantt charts in files: a bar for each step, in the colour of who does it."""

from fractions import Fraction
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Any

from foon_asp.report.chart_file import TEXT, write_figure
from foon_asp.report.gantt import Gantt, time_text

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_COLORS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#F0E442")
_NOBODY = "#999999"
_BESIDE = "by itself"

# In inches.
_WIDTH, _LINE, _EDGES = 7.15, 0.17, 1.0

# Between two times of the axis, in seconds; above them, any number of days.
_STEPS = (1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400, 43200, 86400)
_TIMES = 9  # of the axis, at most


def write_gantt(gantt: Gantt, file: Path) -> None:
    """Draw a schedule that has a step into a file, SVG or PNG by its suffix.

    Raises :class:`UserError` like :func:`foon_asp.report.chart_file.write_figure`.
    """
    write_figure(lambda figure: _draw(gantt, figure), file)


def _draw(gantt: Gantt, figure: "Figure") -> None:
    from matplotlib.patches import Patch  # noqa: PLC0415 (slow to import)

    rows = gantt.in_order
    figure.set_size_inches(_WIDTH, len(rows) * _LINE + _EDGES)
    axes = figure.subplots()
    axes.grid(visible=True, axis="x")
    axes.grid(visible=False, axis="y")
    swatches = {}
    for place, row in enumerate(rows):
        look = _look(row.agent)
        axes.barh(place, float(row.end - row.start), left=float(row.start), height=0.8, **look)
        swatches[_BESIDE if row.agent is None else f"agent {row.agent}"] = Patch(**look)
    axes.set_yticks(range(len(rows)), [f"{row.name}  {row.number}" for row in rows], fontsize=TEXT - 1)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    times = _times(gantt.makespan)
    axes.set_xticks([float(time) for time in times], [time_text(time) for time in times])
    axes.set_xlim(0, float(gantt.makespan))
    names = sorted(swatches, key=lambda name: (name == _BESIDE, len(name), name))
    legend = figure.legend(
        [swatches[name] for name in names],
        names,
        loc="outside upper center",
        ncols=min(len(names), 6),
        title=fill(gantt.title, 70),
        title_fontproperties={"weight": "bold", "size": TEXT * 1.2},
    )
    legend.get_title().set_multialignment("center")


def _look(agent: int | None) -> dict[str, Any]:
    """Give the look of a bar; what goes on by itself is hatched."""
    if agent is None:
        return {"facecolor": "white", "edgecolor": _NOBODY, "hatch": "/////"}
    return {"facecolor": _COLORS[(agent - 1) % len(_COLORS)], "edgecolor": "white"}


def _times(makespan: Fraction) -> list[Fraction]:
    """Give the times of the axis, in seconds."""
    least = makespan / (_TIMES - 1)
    step = next((Fraction(step) for step in _STEPS if step >= least), Fraction(86400 * (least // 86400 + 1)))
    if makespan <= 2:
        step = makespan / 4
    return [step * number for number in range(int(makespan / step) + 1)]
