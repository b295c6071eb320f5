"""Charts drawn by matplotlib: their common style, and writing them as SVG or PNG."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from foon_asp.errors import UserError
from foon_asp.whole_file import write_whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Okabe and Ito's colors, which people with any of the common color deficiencies can tell apart.
COLORS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#F0E442")

_SUFFIXES = (".svg", ".png")
_INK = "#333333"  # of text and axes
_MATPLOTLIB_STYLE: dict[Any, Any] = {  # by the names that matplotlib has for its settings
    "font.family": "sans-serif",
    # The first comes with matplotlib, so that layouts are equal on all machines; the others are for viewers
    # of an SVG without it.
    "font.sans-serif": ["DejaVu Sans", "Verdana", "Arial"],
    "font.size": 8.0,
    "text.parse_math": False,  # a $ in a name is a $
    "text.color": _INK,
    "axes.edgecolor": _INK,
    "axes.labelcolor": _INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.prop_cycle": f"cycler('color', {COLORS})",
    "figure.titlesize": 9.0,
    "figure.titleweight": "bold",
    "grid.color": "#DDDDDD",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "savefig.dpi": 300,
    "svg.fonttype": "none",  # text stays text, which can be searched, read aloud and edited
    "svg.hashsalt": "foon-asp",  # ids in the file are derived from their contents, and not random
}


def check_suffix(file: Path) -> None:
    """Raise :class:`UserError` unless the suffix of a file is .svg or .png, in small letters or capitals."""
    if file.suffix.lower() not in _SUFFIXES:
        raise UserError(f"{file}: the name of a chart ends in {' or '.join(_SUFFIXES)}")


def write_chart(file: Path, title: str, height: float, draw: "Callable[[Figure, Axes], None]") -> None:
    """Write a chart to a file, as SVG or PNG by its suffix; ``draw`` fills the figure and its axes.

    The chart is as wide as a printed page; ``height`` is in inches. The file is written completely or not at
    all. Raises :class:`UserError` for another suffix, and if matplotlib is not installed.
    """
    check_suffix(file)
    picture = BytesIO()
    # as wide as both columns of a printed page
    with new_figure(7.15, height, layout="constrained") as figure:
        figure.suptitle(title, wrap=True)
        draw(figure, figure.subplots())
        figure.savefig(picture, format=file.suffix.lower().removeprefix("."), metadata={"Date": None})
    write_whole(file, picture.getvalue())


@contextmanager
def new_figure(width: float, height: float, **options: Any) -> "Iterator[Figure]":
    """Yield a new figure of a size in inches, in the style of all charts.

    The user's own settings of matplotlib do not change. Raises :class:`UserError` if matplotlib is not
    installed.
    """
    try:
        # Slow to import, and not installed by everyone.
        import matplotlib as mpl  # noqa: PLC0415
        from matplotlib.figure import Figure  # noqa: PLC0415
    except ImportError as error:
        raise missing_package_error(error) from None
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(_MATPLOTLIB_STYLE)
        yield Figure((width, height), **options)


def missing_package_error(error: object) -> UserError:
    """Return the error that a picture needs a package which is not installed; it says how to install it.

    ``error`` is the reason, in parentheses.
    """
    return UserError(f"a picture needs more packages ({error}): pip install 'foon-asp[pictures]'")
