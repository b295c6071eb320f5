"""MIME bundles with which values are displayed in a notebook: text, and pictures below it."""

import base64
import contextlib
import html
from collections.abc import Iterable

from foon_asp.errors import UserError
from foon_asp.pictures.drawing import Drawing
from foon_asp.pictures.graphviz import svg_picture


def picture_bundle(value: object, drawing: Drawing) -> dict[str, str]:
    """Return the MIME bundle of a value as a picture, or as text where no picture can be drawn."""
    try:
        return {"text/plain": repr(value), "image/svg+xml": svg_picture(drawing)}
    except UserError:
        return page_bundle(value, ())


def page_bundle(value: object, drawings: Iterable[Drawing]) -> dict[str, str]:
    """Return the MIME bundle of a value as text, with pictures below it as far as they can be drawn.

    Cells of a notebook show the HTML; lists of values and consoles show ``repr(value)``.
    """
    blocks = [f"<pre>{html.escape(str(value))}</pre>"]
    with contextlib.suppress(UserError):
        blocks += [_image(svg_picture(drawing)) for drawing in drawings]
    return {"text/plain": repr(value), "text/html": "\n".join(blocks)}


def _image(svg: str) -> str:
    # as an image, so that styles and ids of one picture do not apply to another
    coded = base64.b64encode(svg.encode()).decode()
    return f'<img alt="task tree" src="data:image/svg+xml;base64,{coded}"/>'
