"""How results show themselves: as text, as plain values, and as a picture in a notebook."""

import contextlib
import json
from collections.abc import Iterable
from typing import Any

from foon_asp.errors import UserError
from foon_asp.report.drawing import Drawing
from foon_asp.report.picture import svg_picture


class Shown:
    """A result. ``print`` shows what the command line prints, a notebook also the picture of its tree."""

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
        """Give what a notebook shows: the picture where there is one, and the text."""
        return notebook_bundle(str(self), self.drawing())


def svg_text(drawing: Drawing) -> str:
    """Give a drawing as SVG that can stand inside a page: from its first tag on."""
    text = svg_picture(drawing).decode()
    return text[text.index("<svg") :]


def notebook_bundle(text: str, drawing: Drawing | None) -> dict[str, str]:
    """Give text and picture by media type; the text alone where no picture can be drawn."""
    bundle = {"text/plain": text}
    if drawing is not None:
        with contextlib.suppress(UserError):
            bundle["image/svg+xml"] = svg_text(drawing)
    return bundle
