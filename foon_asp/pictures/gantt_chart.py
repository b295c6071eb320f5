"""Gantt chart of a schedule: a bar for each step, in the color of its agent."""

from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from foon_asp.pictures.chart import write_chart
from foon_asp.pictures.gantt import Gantt, time_text

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_PASSIVE_LOOK: dict[str, Any] = {"facecolor": "white", "edgecolor": "#999999", "hatch": "/////"}
_ROW_INCHES, _MARGIN_INCHES = 0.17, 1.2  # of height

# Seconds between two ticks of the axis; above them, any number of days.
_TICK_SECONDS = (1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400, 43200, 86400)


def write_gantt(gantt: Gantt, file: Path) -> None:
    """Write the chart of a schedule with at least one step, as SVG or PNG by the suffix of the file.

    Raises :class:`UserError` as :func:`foon_asp.pictures.chart.write_chart` does.
    """
    write_chart(
        file,
        gantt.title,
        len(gantt.rows) * _ROW_INCHES + _MARGIN_INCHES,
        lambda figure, axes: _draw_chart(gantt, figure, axes),
    )


def _draw_chart(gantt: Gantt, figure: "Figure", axes: "Axes") -> None:
    """Draw the chart: a bar and a name for each step, the ticks of the time, and a legend of agents.

    The first step is on top. Each agent has a color; steps without an agent are hatched.
    """
    rows = gantt.sorted_rows
    agents = sorted({row.agent for row in rows}, key=lambda agent: (agent is None, agent))
    for agent in agents:
        style = _PASSIVE_LOOK if agent is None else {"facecolor": f"C{agent - 1}", "edgecolor": "white"}
        name = "by itself" if agent is None else f"agent {agent}"
        bars = [(position, row) for position, row in enumerate(rows) if row.agent == agent]
        starts = [float(row.start) for _, row in bars]
        lengths = [float(row.end - row.start) for _, row in bars]
        axes.barh([position for position, _ in bars], lengths, left=starts, label=name, **style)
    axes.grid(visible=False, axis="y")
    axes.set_yticks(range(len(rows)), [f"{row.name}  {row.step}" for row in rows])
    axes.set_ylim(len(rows) - 0.4, -0.6)
    times = _tick_times(gantt.makespan)
    axes.set_xticks([float(time) for time in times], list(map(time_text, times)))
    axes.set_xlim(0, float(gantt.makespan))
    figure.legend(loc="outside lower center", ncols=6)


def _tick_times(makespan: Fraction) -> list[Fraction]:
    """Return the times of the ticks on the axis, in seconds from 0: at most nine.

    If the makespan is at most 2 seconds, the ticks divide it into quarters. Otherwise their interval is a
    round number of seconds, minutes, hours or days.
    """
    min_interval = makespan / 8  # more labels would overlap
    days = Fraction(86400 * (min_interval // 86400 + 1))
    interval = next((Fraction(seconds) for seconds in _TICK_SECONDS if seconds >= min_interval), days)
    if makespan <= 2:
        interval = makespan / 4
    return [interval * number for number in range(int(makespan / interval) + 1)]
