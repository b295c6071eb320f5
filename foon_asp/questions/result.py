"""The result of a question: a document that can be drawn, and written into files."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from foon_asp.dataset.paths import File
from foon_asp.errors import UserError
from foon_asp.questions.ending import Ending
from foon_asp.results.document import Document

if TYPE_CHECKING:
    from foon_asp.pictures.drawing import Drawing
    from foon_asp.questions.robot_plan import RobotPlan


ENDINGS = {
    ".html": "html",
    ".htm": "html",
    ".json": "json",
    ".txt": "text",
    ".csv": "csv",
    ".md": "markdown",
}
"""The format by the ending of a file name."""


class NothingToDrawError(UserError):
    """There is nothing to draw."""


class NoTreeError(UserError):
    """There is no tree to go on with; ``ending`` is that of the search for a tree."""

    def __init__(self, message: str, ending: Ending = Ending.NEGATIVE) -> None:
        super().__init__(message)
        self.ending = ending


class Result(Document, frozen=True, kw_only=True):
    """The result of a question; ``print`` shows the text of the command line, and a notebook adds a picture.

    The class attribute ``SUFFIXES`` has the format that each ending of a file name stands for.
    """

    SUFFIXES: ClassVar[Mapping[str, str]] = ENDINGS

    @property
    def ending(self) -> Ending:
        """How the question ended."""
        return Ending.DONE

    def foon(self) -> str:
        """Return the tree as FOON text.

        Raises:
            UserError: for a result that is no tree.
        """
        raise UserError("this is no tree, which FOON text could hold")

    def robot_plan(self) -> "RobotPlan | None":
        """Return the plan for a robot's program; ``None`` without a tree.

        Raises:
            UserError: for a result that is no tree.
        """
        raise UserError("this is no tree, whose steps could be listed")

    def steps(self) -> str:
        """Return the plan for a robot's program as JSON, each step with its objects by role.

        It is empty without a tree.

        Raises:
            UserError: for a result that is no tree.
        """
        return "" if (plan := self.robot_plan()) is None else plan.json_text()

    def steps_csv(self) -> str:
        """Return the plan for a robot's program as CSV, a row for each step; empty without a tree.

        Raises:
            UserError: for a result that is no tree.
        """
        return "" if (plan := self.robot_plan()) is None else plan.csv()

    def behaviour_tree(self) -> str:
        """Return the plan as a behaviour tree, XML of BehaviorTree.CPP 4; empty without a tree.

        Raises:
            UserError: for a result that is no tree.
        """
        return "" if (plan := self.robot_plan()) is None else plan.behaviour_tree()

    def remark(self, format_: str) -> str:
        """Return the remarks that a format other than text cannot express; empty without any.

        Parameters:
            format_: The name of the format, for example ``foon``.
        """
        return ""

    def write(self, file: File, format_: str | None = None) -> None:
        """Write the result into a file.

        Parameters:
            file: The path of the file.
            format_: A format in ``SUFFIXES`` that the result has; without it, the ending of the name decides.

        Raises:
            NothingToDrawError: for a picture, if there is nothing to draw.
            UserError: for another format or ending, or a file that cannot be written.
        """
        from foon_asp.whole_file import utf_8, write_whole  # noqa: PLC0415 (most results are printed)

        formats = {
            suffix: chosen for suffix, chosen in self.SUFFIXES.items() if hasattr(self, format_method(chosen))
        }
        chosen = format_ or formats.get(Path(file).suffix.lower())
        if chosen is None:
            raise UserError(f"{file}: the name says no format: end it in {' '.join(formats)}")
        if chosen not in formats.values():
            raise UserError(
                f"found the format {chosen!r}, expected one of {', '.join(dict.fromkeys(formats.values()))}"
            )
        content: str | bytes = getattr(self, format_method(chosen))()
        write_whole(Path(file), utf_8(content) if isinstance(content, str) else content)

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
        """Return the drawing of the tree; ``None`` without a tree, and for results that have no drawing."""
        return None

    def svg(self) -> str:
        """Return the picture as SVG.

        Raises:
            NothingToDrawError: if there is no tree.
            UserError: if the tree is too large for a picture, or if the packages of
                ``foon-asp[pictures]`` are missing.
        """
        from foon_asp.pictures.graphviz import svg_picture  # noqa: PLC0415

        drawing = self.drawing()
        if drawing is None:
            raise NothingToDrawError("there is no tree to draw")
        return svg_picture(drawing)

    def __str__(self) -> str:
        return self.text().rstrip("\n")

    def __repr__(self) -> str:
        lines = [line for line in self.text().split("\n") if line and not line.startswith(("goal:", "  "))]
        return f"<{type(self).__name__}: {lines[0] if lines else 'nothing'}>"

    def _repr_mimebundle_(
        self, include: Iterable[str] | None = None, exclude: Iterable[str] | None = None
    ) -> dict[str, str]:
        """Return the notebook display by media type; the arguments that IPython passes are ignored."""
        return self._in_notebook()

    def _in_notebook(self) -> dict[str, str]:
        """Return the notebook display by media type: the text, and the picture if there is a tree."""
        from foon_asp.pictures.notebook import page_bundle  # noqa: PLC0415

        pictures = [] if (drawing := self.drawing()) is None else [drawing]
        return page_bundle(self, pictures)


def format_method(format_: str) -> str:
    """Return the name of the method of a result that returns a format.

    It is the name of the format, with underscores for dashes: ``steps_csv`` for ``steps-csv``. Only for
    ``json``, it is ``json_text``.
    """
    return "json_text" if format_ == "json" else format_.replace("-", "_")
