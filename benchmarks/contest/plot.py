"""The plots of the page on performance."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contest.ratio import Figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

# Okabe and Ito's colors, which people with any of the common color deficiencies can tell apart.
_COLORS = ("#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9")
_MARKS = "os^Dvp"
_STYLE: dict[Any, Any] = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans", "Verdana", "Arial"],
    "font.size": 8.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#DDDDDD",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "svg.fonttype": "none",
    "svg.hashsalt": "foon-asp",  # the same figures give the same file
}


Curves = Mapping[str, Sequence[tuple[int, float]]]


def draw_growth(panels: Mapping[str, Curves], title: str, file: Path) -> None:
    """Draw what is measured against units, both by powers of ten: a panel for each, a curve for each name."""
    from matplotlib import rc_context  # noqa: PLC0415 (an optional extra)
    from matplotlib.figure import Figure as Canvas  # noqa: PLC0415

    with rc_context(_STYLE):
        canvas = Canvas(figsize=(4.2 * len(panels), 3.4), layout="constrained")
        canvas.suptitle(title, x=0.0, ha="left", fontsize=8)
        logarithmic: dict[str, Any] = {"xscale": "log", "yscale": "log", "xlabel": "units in the network"}
        for number, (measured, curves) in enumerate(panels.items(), start=1):
            axes = canvas.add_subplot(1, len(panels), number, ylabel=measured, **logarithmic)
            for place, (name, points) in enumerate(curves.items()):
                sizes, figures = zip(*points, strict=True)
                color, mark = _COLORS[place % len(_COLORS)], _MARKS[place % len(_MARKS)]
                axes.plot(sizes, figures, color=color, marker=mark, markersize=4, label=name)
            axes.legend(loc="best")
        _save(canvas, file)


def draw_ratios(groups: Mapping[str, Mapping[str, Figure]], title: str, file: Path) -> None:
    """Draw how many times slower engines are, by powers of ten: a panel for a group, a bar for an engine.

    A figure that is only known to be larger has an open end.
    """
    from matplotlib import rc_context  # noqa: PLC0415
    from matplotlib.figure import Figure as Canvas  # noqa: PLC0415

    with rc_context(_STYLE):
        rows = (len(groups) + 1) // 2
        canvas = Canvas(figsize=(7.0, 0.4 + 2.1 * rows), layout="constrained")
        canvas.suptitle(title, x=0.0, ha="left", fontsize=8)
        first: Any = None
        for place, (name, bars) in enumerate(groups.items()):
            axes = canvas.add_subplot(rows, 2, place + 1, xscale="log", sharex=first)
            first = first or axes
            axes.set_title(name, loc="left", fontsize=8)
            engines = list(bars)
            axes.barh(
                engines,
                [figure.value for figure in bars.values()],
                color=["#FFFFFF" if figure.beyond else _COLORS[0] for figure in bars.values()],
                edgecolor=_COLORS[0],
                hatch=["///" if figure.beyond else "" for figure in bars.values()],
            )
            for y, figure in enumerate(bars.values()):
                axes.text(figure.value, y, f" {figure}", va="center", fontsize=7)
            axes.axvline(1.0, color="#333333", linewidth=0.8)
            axes.invert_yaxis()
            axes.grid(visible=False, axis="y")
            axes.margins(x=0.15)
        _save(canvas, file)


def _save(canvas: "Canvas", file: Path) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    canvas.savefig(file, metadata={"Date": None} if file.suffix == ".svg" else None, dpi=150)
