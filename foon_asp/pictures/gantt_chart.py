"""Schedules as Gantt charts in files: a bar for each step, in the colour of who does it."""

from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from foon_asp.pictures.chart import write_chart
from foon_asp.pictures.gantt import Gantt, time_text

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_BY_ITSELF: dict[str, Any] = {"facecolor": "white", "edgecolor": "#999999", "hatch": "/////"}
_LINE, _EDGES = 0.17, 1.2  # inches

# Between two times of the axis, in seconds; above them, any number of days.
_STEPS = (1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400, 43200, 86400)
_TICKS = 8


def write_gantt(gantt: Gantt, file: Path) -> None:
    """Draw a schedule that has a step into a file, SVG or PNG by its suffix.

    Raises :class:`UserError` like :func:`foon_asp.pictures.chart.write_chart`.
    """
    write_chart(
        file,
        gantt.title,
        len(gantt.rows) * _LINE + _EDGES,
        lambda figure, axes: _draw(gantt, figure, axes),
    )


def _draw(gantt: Gantt, figure: "Figure", axes: "Axes") -> None:
    rows = gantt.in_order
    agents = sorted({row.agent for row in rows}, key=lambda agent: (agent is None, agent))
    for agent in agents:
        look = _BY_ITSELF if agent is None else {"facecolor": f"C{agent - 1}", "edgecolor": "white"}
        name = "by itself" if agent is None else f"agent {agent}"
        own = [(place, row) for place, row in enumerate(rows) if row.agent == agent]
        starts = [float(row.start) for _, row in own]
        lengths = [float(row.end - row.start) for _, row in own]
        axes.barh([place for place, _ in own], lengths, left=starts, label=name, **look)
    axes.grid(visible=False, axis="y")
    axes.set_yticks(range(len(rows)), [f"{row.name}  {row.step}" for row in rows])
    axes.set_ylim(len(rows) - 0.4, -0.6)
    times = _times(gantt.makespan)
    axes.set_xticks([float(time) for time in times], list(map(time_text, times)))
    axes.set_xlim(0, float(gantt.makespan))
    figure.legend(loc="outside lower center", ncols=6)


def _times(makespan: Fraction) -> list[Fraction]:
    """Return the times of the axis, in seconds."""
    least = makespan / _TICKS
    step = next((Fraction(step) for step in _STEPS if step >= least), Fraction(86400 * (least // 86400 + 1)))
    if makespan <= 2:
        step = makespan / 4
    return [step * number for number in range(int(makespan / step) + 1)]
