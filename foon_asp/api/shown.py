"""How results show themselves: as text, as plain values, and as a picture in a notebook."""

import base64
import contextlib
import html
import json
from collections.abc import Iterable
from typing import Any

from foon_asp.errors import UserError
from foon_asp.report.drawing import Drawing
from foon_asp.report.picture import svg_picture


class Shown:
    """A result. ``print`` shows what the command line prints, a notebook that and the picture of its tree."""

    __slots__ = ()

    def text(self) -> str:
        """Give the result in words, as the command line does."""
        raise NotImplementedError

    def json_text(self) -> str:
        """Give the result as JSON, as the command line does with ``--format json``."""
        raise NotImplementedError

    def json(self) -> Any:
        """Give the result as plain values: lists, dictionaries, strings and numbers (docs/json.md)."""
        return json.loads(self.json_text())

    def drawing(self) -> Drawing | None:
        """Give what the picture shows, or ``None`` where there is no tree to draw."""
        return None

    def svg(self) -> str:
        """Give the picture as SVG.

        Raises :class:`UserError` where there is none: without a tree, without the packages of
        ``foon-asp[pictures]``, and for a tree too large for a picture.
        """
        drawing = self.drawing()
        if drawing is None:
            raise UserError("there is no tree to draw")
        return svg_text(drawing)

    def __str__(self) -> str:
        return self.text().rstrip("\n")

    def __repr__(self) -> str:
        lines = [line for line in self.text().split("\n") if line and not line.startswith(("goal:", "  "))]
        return f"<{type(self).__name__}: {lines[0] if lines else 'nothing'}>"

    def _repr_mimebundle_(
        self, include: Iterable[str] | None = None, exclude: Iterable[str] | None = None
    ) -> dict[str, str]:
        """Give what a notebook shows: the text, and below it the picture where there is one."""
        pictures = [] if (drawing := self.drawing()) is None else [drawing]
        return page_bundle(self, pictures)


def svg_text(drawing: Drawing) -> str:
    """Give a drawing as SVG that can stand inside a page: from its first tag on."""
    text = svg_picture(drawing).decode()
    return text[text.index("<svg") :]


def picture_bundle(value: object, drawing: Drawing) -> dict[str, str]:
    """Give by media type what shows a value as a picture; as text where no picture can be drawn."""
    try:
        return {"text/plain": repr(value), "image/svg+xml": svg_text(drawing)}
    except UserError:
        return page_bundle(value, ())


def page_bundle(value: object, drawings: Iterable[Drawing]) -> dict[str, str]:
    """Give by media type what shows a value as text, with pictures below it as far as they can be drawn.

    A cell of a notebook shows the page; lists of values and consoles show the short form.
    """
    parts = [f"<pre>{html.escape(str(value))}</pre>"]
    with contextlib.suppress(UserError):
        parts += [_image(svg_text(drawing)) for drawing in drawings]
    return {"text/plain": repr(value), "text/html": "\n".join(parts)}


def _image(svg: str) -> str:
    # as an image, so that the style and the names in one picture stay its own
    coded = base64.b64encode(svg.encode()).decode()
    return f'<img alt="task tree" src="data:image/svg+xml;base64,{coded}"/>'
