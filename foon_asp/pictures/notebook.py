"""MIME bundles, by which notebooks display values as text and pictures."""

import base64
import contextlib
import html
from collections.abc import Iterable

from foon_asp.errors import UserError
from foon_asp.pictures.drawing import Drawing
from foon_asp.pictures.graphviz import svg_picture


def picture_bundle(value: object, drawing: Drawing) -> dict[str, str]:
    """Return the MIME bundle of a value: its ``repr``, and the drawing as SVG.

    If the picture cannot be drawn, the text of the value as HTML replaces it.
    """
    try:
        return {"text/plain": repr(value), "image/svg+xml": svg_picture(drawing)}
    except UserError:
        return page_bundle(value, ())


def page_bundle(value: object, drawings: Iterable[Drawing]) -> dict[str, str]:
    """Return the MIME bundle of a value: its ``repr``, and HTML of its text with pictures below.

    If one of the pictures cannot be drawn, none are shown. Cells of a notebook show the HTML; lists of values
    and consoles show the ``repr``.
    """
    blocks = [f"<pre>{html.escape(str(value))}</pre>"]
    with contextlib.suppress(UserError):
        blocks += [_image_tag(svg_picture(drawing)) for drawing in drawings]
    return {"text/plain": repr(value), "text/html": "\n".join(blocks)}


def _image_tag(svg: str) -> str:
    """Return an HTML image of an SVG element, in a base64 URL."""
    # as an image, so that styles and ids of one picture do not apply to another
    coded = base64.b64encode(svg.encode()).decode()
    return f'<img alt="task tree" src="data:image/svg+xml;base64,{coded}"/>'
