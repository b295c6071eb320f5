"""Charts as files: their look, and writing them as SVG or PNG."""

from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from foon_asp.errors import UserError
from foon_asp.report.whole_file import write_whole

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SUFFIXES = (".svg", ".png")
_INK = "#333333"  # of text and axes
TEXT = 8.0  # the size of text, in points

_STYLE: dict[Any, Any] = {  # by the names that matplotlib has for its settings
    "font.family": "sans-serif",
    # The first comes with matplotlib, so every machine lays out alike; the others are for viewers of an SVG
    # who do not have it.
    "font.sans-serif": ["DejaVu Sans", "Verdana", "Arial"],
    "font.size": TEXT,
    "text.parse_math": False,  # a $ in a name is a $
    "text.color": _INK,
    "axes.edgecolor": _INK,
    "axes.labelcolor": _INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.grid.axis": "y",
    "axes.axisbelow": True,
    "grid.color": "#DDDDDD",
    "grid.linewidth": 0.6,
    "xtick.color": _INK,
    "xtick.major.size": 0.0,
    "ytick.color": _INK,
    "ytick.major.size": 2.5,
    "patch.linewidth": 0.8,
    "hatch.linewidth": 0.6,
    "legend.frameon": False,
    "legend.handlelength": 1.2,
    "legend.handleheight": 0.9,
    "legend.columnspacing": 1.5,
    "savefig.dpi": 300,
    "svg.fonttype": "none",  # text stays text, which can be searched, read aloud and edited
    "svg.hashsalt": "foon-asp",  # names within the file come from what they name, and not from chance
}


def check_suffix(file: Path) -> None:
    """Raise :class:`UserError` for a file whose name says neither SVG nor PNG."""
    if file.suffix.lower() not in _SUFFIXES:
        raise UserError(f"{file}: the name of a chart ends in {' or '.join(_SUFFIXES)}")


def write_figure(draw: Callable[["Figure"], None], file: Path) -> None:
    """Write what is drawn, as SVG or PNG by the file's suffix; the file is complete or not written at all.

    It looks the same whatever settings of matplotlib the user has, and those stay as they are. Raises
    :class:`UserError` for another suffix, and where matplotlib is not installed.
    """
    check_suffix(file)
    try:
        # Slow to import, and not installed by everyone.
        import matplotlib as mpl  # noqa: PLC0415
        from matplotlib.figure import Figure  # noqa: PLC0415
    except ImportError as error:
        raise UserError(f"a chart needs matplotlib ({error}): pip install 'foon-asp[pictures]'") from None
    picture = BytesIO()
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(_STYLE)
        figure = Figure(layout="constrained")
        draw(figure)
        figure.savefig(picture, format=file.suffix.lower().removeprefix("."), metadata={"Date": None})
    write_whole(file, picture.getvalue())
