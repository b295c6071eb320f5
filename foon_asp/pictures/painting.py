"""Drawings as PNG or PDF, with the layout of Graphviz, painted by matplotlib."""

from collections.abc import Iterable
from io import BytesIO
from typing import TYPE_CHECKING, Any, Literal

from foon_asp.pictures.chart import new_figure
from foon_asp.pictures.drawing import Drawing
from foon_asp.pictures.graphviz import layout_json

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def paint_drawing(drawing: Drawing, picture_format: Literal["png", "pdf"]) -> bytes:
    """Return the bytes of a drawing as PNG or PDF, in the font of matplotlib.

    A large PNG has fewer dots per inch, at most 40 million in all. Raises :class:`UserError` for a drawing
    that is too large, and if Graphviz or matplotlib is not installed.
    """
    graph = layout_json(drawing)
    _, _, width, height = map(float, graph["bb"].split(","))
    picture = BytesIO()
    with new_figure(width / 72, height / 72) as figure:
        axes = figure.add_axes((0, 0, 1, 1), xlim=(0, width), ylim=(0, height))
        axes.set_axis_off()
        _paint_elements(axes, [graph, *graph.get("edges", []), *graph.get("objects", [])])
        # more dots per inch are sharper in print, and larger files; viewers refuse more than 40 million dots
        dpi = min(144, 72 * (40e6 / width / height) ** 0.5)
        metadata = {"CreationDate": None} if picture_format == "pdf" else None
        figure.savefig(
            picture, format=picture_format, dpi=dpi, metadata=metadata, bbox_inches="tight", pad_inches=0.15
        )
    return picture.getvalue()


def _paint_elements(axes: "Axes", elements: Iterable[dict[str, Any]]) -> None:
    """Paint elements of a graph on axes, by the drawing operations in Graphviz' JSON of the graph.

    The operations are those of Graphviz' output format xdot. The class of an element, such as ``goal head2``,
    says how many first lines of its text are bold.
    """
    from matplotlib.patches import Circle, PathPatch, Polygon  # noqa: PLC0415 (slow to import)
    from matplotlib.path import Path  # noqa: PLC0415

    for element in elements:
        bold_lines = int(element.get("class", "head0").rpartition("head")[2])
        style: dict[str, Any] = {"linestyle": "solid", "linewidth": 1.0, "clip_on": False}
        for operation in (
            *element.get("_draw_", ()),
            *element.get("_hdraw_", ()),
            *element.get("_ldraw_", ()),
        ):
            kind = operation["op"]
            if kind in "cC":
                style["edgecolor" if kind == "c" else "facecolor"] = operation["color"]
            elif kind == "F":
                size = operation["size"]
            elif kind == "S":
                name, _, width = operation["style"].rstrip(")").partition("(")
                style |= {"linewidth": float(width)} if width else {"linestyle": name}
            elif kind == "T":
                weight = "bold" if bold_lines > 0 else "normal"
                x, y = operation["pt"]
                axes.text(
                    x, y, operation["text"], ha="center", size=size, color=style["edgecolor"], weight=weight
                )
                bold_lines -= 1
            elif kind in "eE":
                axes.add_artist(Circle(operation["rect"][:2], operation["rect"][2], **style))
            elif kind in "pP":
                axes.add_artist(Polygon(operation["points"], fill=kind == "P", **style))
            else:
                codes = [Path.MOVETO, *[Path.CURVE4] * (len(operation["points"]) - 1)]
                axes.add_artist(PathPatch(Path(operation["points"], codes), fill=kind == "B", **style))
