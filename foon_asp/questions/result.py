"""The result of a question: text, JSON, and a picture."""

from collections.abc import Iterable
from enum import StrEnum
from typing import TYPE_CHECKING, Any

from foon_asp.dataset.paths import File
from foon_asp.errors import UserError
from foon_asp.text.json_value import json_text, read_json

if TYPE_CHECKING:
    from foon_asp.report.drawing import Drawing
    from foon_asp.report.renderable import Renderable


class Ending(StrEnum):
    """How a question ended, which is what an exit code says."""

    DONE = "done"
    """What was asked for was found, and proved where there is something to prove."""
    NEGATIVE = "negative"
    """It is proved that there is none, or a check failed."""
    LIMIT = "limit"
    """It was stopped at a limit, with what was known by then."""


class NothingToDrawError(UserError):
    """There is nothing to draw."""


class NoTreeError(UserError):
    """There is no tree to go on with; ``ending`` says how it ended where one was looked for."""

    def __init__(self, message: str, ending: Ending = Ending.NEGATIVE) -> None:
        super().__init__(message)
        self.ending = ending


class Result:
    """The result of a question; ``print`` shows the text of the command line, a notebook also a picture."""

    __slots__ = ()

    @property
    def ending(self) -> Ending:
        """How the question ended."""
        return Ending.DONE

    def text(self) -> str:
        """Give the result in words, as the command line does."""
        raise NotImplementedError

    def json_dict(self) -> object:
        """Give the result as plain values, in the order in which JSON has them."""
        raise NotImplementedError

    def json_text(self) -> str:
        """Give the result as JSON, as the command line does with ``--format json``."""
        return json_text(self.json_dict())

    def json(self) -> Any:
        """Give the result as plain values: lists, dictionaries, strings and numbers (docs/json.md)."""
        return read_json(self.json_text())

    def to_frame(self) -> Any:
        """Give a data frame of pandas: a row for each thing that is listed, or one where nothing is.

        Columns are the keys of the JSON; those of what is inside have a dot (``costs.units``).

        Raises:
            UserError: if pandas is not installed.
        """
        from foon_asp.report.frame import frame  # noqa: PLC0415 (seldom asked for)

        return frame(self.json())

    def csv(self) -> str:
        """Give a line for each thing that is listed, under headings, for a spreadsheet."""
        from foon_asp.report.frame import csv_text  # noqa: PLC0415 (seldom asked for)

        return csv_text(self.json())

    def markdown(self) -> str:
        """Give the same as a table in Markdown."""
        from foon_asp.report.frame import markdown_text  # noqa: PLC0415 (seldom asked for)

        return markdown_text(self.json())

    def foon(self) -> str:
        """Give the tree as FOON text.

        Raises:
            UserError: for a result that is no tree.
        """
        raise UserError("this is no tree, which FOON text could hold")

    def steps(self) -> str:
        """Give the plan for a robot's program, as JSON: each step with its objects by role.

        Raises:
            UserError: for a result that is no tree.
        """
        raise UserError("this is no tree, whose steps could be listed")

    def renderable(self) -> "Renderable | None":
        """Give what a console shows in place of the text, as wide and in such colours as it has.

        ``None`` where that is the text.
        """
        return None

    def remark(self, format_: str) -> str:
        """Give what a format other than text cannot tell; empty if there is nothing to add.

        Parameters:
            format_: The name of the format, for example ``foon``.
        """
        return ""

    def write(self, file: File, format_: str | None = None) -> None:
        """Write the result into a file.

        Parameters:
            file: The path of the file.
            format_: The format; without it, the end of the file name chooses one.

        Raises:
            NothingToDrawError: if there is nothing to write.
            UserError: for a result that cannot be written into a file, or another format.
        """
        raise UserError(f"{file}: this is not written into files")

    def write_chart(self, file: File) -> None:
        """Draw a chart of the result into a file.

        Parameters:
            file: The path of the file, which ends in ``.svg`` or ``.png``.

        Raises:
            NothingToDrawError: if there is nothing to draw.
            UserError: for a result that has no chart, for another file name, or if the packages of
                ``foon-asp[pictures]`` are missing.
        """
        raise UserError(f"{file}: there is no chart of this")

    def drawing(self) -> "Drawing | None":
        """Give what the picture shows, or ``None`` where there is no tree to draw."""
        return None

    def svg(self) -> str:
        """Give the picture as SVG.

        Raises:
            UserError: if there is no tree, if the tree is too large for a picture, or if the packages of
                ``foon-asp[pictures]`` are missing.
        """
        from foon_asp.report.notebook import svg_text  # noqa: PLC0415

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
        """Give what a notebook shows."""
        return self._in_notebook()

    def _in_notebook(self) -> dict[str, str]:
        """Give what a notebook shows by media type: the text, and below it the picture if there is one."""
        from foon_asp.report.notebook import page_bundle  # noqa: PLC0415

        pictures = [] if (drawing := self.drawing()) is None else [drawing]
        return page_bundle(self, pictures)
