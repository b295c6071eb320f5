"""A drawing as PNG or PDF: what Graphviz laid out, painted by matplotlib."""

from collections.abc import Iterable
from io import BytesIO
from typing import TYPE_CHECKING, Any, Literal

from foon_asp.pictures.chart import new_figure
from foon_asp.pictures.drawing import Drawing
from foon_asp.pictures.graphviz import layout

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_DPI = 144  # of a PNG
_MAX_PIXELS = 40e6  # of a PNG; viewers refuse larger ones


def painted(drawing: Drawing, form: Literal["png", "pdf"]) -> bytes:
    """Return a drawing as PNG or PDF, with a font that comes along, so that no machine is without.

    Raises :class:`UserError` for a drawing that is too large, and without Graphviz or matplotlib.
    """
    graph = layout(drawing)
    _, _, width, height = map(float, graph["bb"].split(","))
    picture = BytesIO()
    with new_figure(width / 72, height / 72) as figure:
        axes = figure.add_axes((0, 0, 1, 1), xlim=(0, width), ylim=(0, height))
        axes.set_axis_off()
        _paint(axes, [graph, *graph.get("edges", []), *graph.get("objects", [])])
        dpi = min(_DPI, 72 * (_MAX_PIXELS / width / height) ** 0.5)
        metadata = {"CreationDate": None} if form == "pdf" else None
        figure.savefig(picture, format=form, dpi=dpi, metadata=metadata, bbox_inches="tight", pad_inches=0.15)
    return picture.getvalue()


def _paint(axes: "Axes", parts: Iterable[dict[str, Any]]) -> None:
    """Paint the operations of each part, as the documentation of Graphviz' output format xdot has them."""
    from matplotlib.patches import Circle, PathPatch, Polygon  # noqa: PLC0415 (slow to import)
    from matplotlib.path import Path  # noqa: PLC0415

    for part in parts:
        bold = int(part.get("class", "head0").rpartition("head")[2])  # lines of text
        look: dict[str, Any] = {"linestyle": "solid", "linewidth": 1.0, "clip_on": False}
        for each in (*part.get("_draw_", ()), *part.get("_hdraw_", ()), *part.get("_ldraw_", ())):
            kind = each["op"]
            if kind in "cC":
                look["edgecolor" if kind == "c" else "facecolor"] = each["color"]
            elif kind == "F":
                size = each["size"]
            elif kind == "S":
                name, _, width = each["style"].rstrip(")").partition("(")
                look |= {"linewidth": float(width)} if width else {"linestyle": name}
            elif kind == "T":
                weight = "bold" if bold > 0 else "normal"
                x, y = each["pt"]
                axes.text(x, y, each["text"], ha="center", size=size, color=look["edgecolor"], weight=weight)
                bold -= 1
            elif kind in "eE":
                axes.add_artist(Circle(each["rect"][:2], each["rect"][2], **look))
            elif kind in "pP":
                axes.add_artist(Polygon(each["points"], fill=kind == "P", **look))
            else:
                codes = [Path.MOVETO, *[Path.CURVE4] * (len(each["points"]) - 1)]
                axes.add_artist(PathPatch(Path(each["points"], codes), fill=kind == "B", **look))
