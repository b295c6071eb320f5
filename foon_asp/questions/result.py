"""The result of a question: text, JSON, and a picture."""

from collections.abc import Iterable, Iterator
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from msgspec import Struct

from foon_asp.dataset.paths import File
from foon_asp.errors import UserError
from foon_asp.network import counted
from foon_asp.problem import ContainerRule, Objective, conditions
from foon_asp.results.plain import csv_text, flat_row, frame, markdown_text, plain
from foon_asp.results.table import Part, rendered
from foon_asp.results.values import Node
from foon_asp.text.json_value import Json, json_text, read_json

if TYPE_CHECKING:
    from foon_asp.pictures.drawing import Drawing


ENDINGS = {
    ".html": "html",
    ".htm": "html",
    ".json": "json",
    ".txt": "text",
    ".csv": "csv",
    ".md": "markdown",
}
"""The formats that the ends of file names choose."""


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
        """Return the result in words, as the command line does."""
        raise NotImplementedError

    def show(self) -> Iterator[Part]:
        """Return the lines and tables that the result is for people."""
        if text := self.text():
            yield from text.removesuffix("\n").split("\n")

    def json_dict(self) -> object:
        """Give the result as plain values, in the order in which JSON has them."""
        raise NotImplementedError

    def json_text(self) -> str:
        """Give the result as JSON, as the command line does with ``--format json``."""
        return json_text(self.json_dict())

    def json(self) -> Any:
        """Give the result as plain values: lists, dictionaries, strings and numbers (docs/json.md)."""
        return read_json(self.json_text())

    def table_rows(self) -> Iterator[Json]:
        """Return a row for each thing that is listed, or one where nothing is.

        What is inside another value has a name with a dot (``costs.units``); numbers are decimals, with the
        exact one beside it where it is another (``costs.success_exact``).
        """
        from foon_asp.report.frame import listed_rows  # noqa: PLC0415 (results that are no documents)

        return map(flat_row, listed_rows(self.json()))

    def to_frame(self) -> Any:
        """Return a data frame of pandas with the rows and columns of :meth:`csv`.

        Raises:
            UserError: if pandas is not installed.
        """
        return frame(self.table_rows())

    def csv(self) -> str:
        """Return a line for each thing that is listed, under headings, for a spreadsheet."""
        return csv_text(self.table_rows())

    def markdown(self) -> str:
        """Return the same as a table in Markdown, for people: without empty columns and exact numbers."""
        return markdown_text(self.table_rows())

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
        """Give what a notebook shows."""
        return self._in_notebook()

    def _in_notebook(self) -> dict[str, str]:
        """Give what a notebook shows by media type: the text, and below it the picture if there is one."""
        from foon_asp.pictures.notebook import page_bundle  # noqa: PLC0415

        pictures = [] if (drawing := self.drawing()) is None else [drawing]
        return page_bundle(self, pictures)


class Document(Result, Struct, frozen=True, kw_only=True, dict=True, tag_field="schema"):
    """A result that is a value: its fields are its JSON, in their order.

    A class names the field that lists its rows as ``ROWS``; without one, and where it is ``None``, the result
    itself is one row.
    """

    ROWS: ClassVar[str] = ""

    def show(self) -> Iterator[Part]:
        """Return the lines and tables that the result is for people."""
        raise NotImplementedError

    def text(self) -> str:
        """Return the result in words, as the command line does."""
        return rendered(self.show())

    def write(self, file: File, format_: str | None = None) -> None:
        """Write the result into a file.

        Parameters:
            file: The path of the file.
            format_: ``text``, ``json``, ``csv``, ``markdown``, or ``html`` where there is a page; without it,
                the end of the name chooses.

        Raises:
            UserError: for another format, or a file that cannot be written.
        """
        from foon_asp.report.whole_file import utf_8, write_whole  # noqa: PLC0415

        form = format_ or ENDINGS.get(Path(file).suffix.lower(), "")
        if form not in ENDINGS.values() or not hasattr(self, form):
            raise UserError(f"{file}: the name says no format: end it in {' '.join(ENDINGS)}")
        write_whole(Path(file), utf_8(self.json_text() if form == "json" else getattr(self, form)()))

    def json_dict(self) -> Json:
        """Return the result as plain values, in the order in which JSON has them."""
        found: Json = plain(self)
        return found

    def table_rows(self) -> Iterator[Json]:
        """Return the rows as :meth:`Result.table_rows` describes them."""
        rows = getattr(self, self.ROWS) if self.ROWS else None
        yield from map(flat_row, [self.json_dict()] if rows is None else map(plain, rows))


class AboutGoals(Document, frozen=True, kw_only=True):
    """A document about goals, which begins with the question.

    Attributes:
        goals: What is to be made.
        containers: Whether a unit needs every input (strict), or takes as given a utensil whose only
            ingredient is an input too (implied).
        items: Whether what is at hand or was made can be used again (lasting), or is used up (used-up).
        level: What counts of an object node: 3 all, 2 no contents, 1 the label alone.
        objectives: The objectives, the first counting most; units decides last in any case.
        starting_kitchen: Where no kitchen was given, the items that are assumed to be available and can be
            needed for the goals; null where a kitchen was given.
    """

    goals: tuple[Node, ...]
    containers: ContainerRule
    items: Literal["lasting", "used-up"]
    level: int
    objectives: tuple[Objective, ...]
    starting_kitchen: tuple[Node, ...] | None

    @property
    def conditions(self) -> str:
        """What every claim holds under, in a few words: ``strict containers``."""
        said = conditions(self.containers, self.level, self.starting_kitchen is not None)
        return said if self.items == "lasting" else f"{said}, items used up"

    def goal_lines(self, shown: int = 5) -> Iterator[str]:
        """Return a line for each goal; below level 3 with level-3 nodes that it stands for."""
        for goal in self.goals:
            yield f"goal: {goal}"
            if isinstance(goal.stands_for, tuple):
                yield f"  stands for {counted(len(goal.stands_for), 'object node')} at level 3:"
                yield from (f"    {node}" for node in goal.stands_for[:shown])
                if len(goal.stands_for) > shown:
                    yield f"    ... and {len(goal.stands_for) - shown} more; --format json lists all"
