"""A page that shows a tree and what else is known: one file, for any browser, without a network."""

from dataclasses import dataclass
from pathlib import Path

from foon_asp.dataset.paths import File, Files
from foon_asp.errors import UserError
from foon_asp.problem import Problem
from foon_asp.questions.answer import Answer, answered
from foon_asp.questions.arguments import Constants, Objectives, asked_with, chosen_objectives, settings
from foon_asp.questions.contract import question, question_of
from foon_asp.questions.options import CONTAINERS, GOALS, HOW, ITEMS, OBJECTIVES
from foon_asp.questions.result import Ending, Result
from foon_asp.report.whole_file import utf_8, write_whole
from foon_asp.text.json_value import Json


@dataclass(frozen=True, repr=False)
class View(Result):
    """A page about an ``answer``; :meth:`html` gives it, and :meth:`write` writes it into a file.

    Example:
        >>> page = foon_asp.view(foon_asp.load().problem("ice"))
        >>> page.html().splitlines()[0]
        '<!DOCTYPE html>'
    """

    answer: Answer

    @property
    def ending(self) -> Ending:
        """As that of the answer."""
        return self.answer.ending

    def text(self) -> str:
        """Give the answer in words."""
        return self.answer.text()

    def json_dict(self) -> Json:
        """Give what is in the page: the documents of the answers as they are."""
        return self.answer.view().data

    def html(self) -> str:
        """Give the page, a document by itself."""
        return self.answer.view()._replace(data=self.json_dict()).html()

    def remark(self, format_: str) -> str:
        """Say what is claimed, where that is not the best tree."""
        return self.answer.remark(format_)

    def write(self, file: File, format_: str | None = None) -> None:
        """Write the page into a file.

        Parameters:
            file: The path of the file.
            format_: ``html``, or ``json`` for what is in the page; without it, the end of the file name
                chooses one.

        Raises:
            UserError: for another format, or a file that cannot be written.
        """
        how = question_of(view)
        form = format_ or how.format_of(Path(file))
        if form not in how.formats:
            raise UserError(f"found the format {form!r}, expected one of {', '.join(how.formats)}")
        write_whole(Path(file), utf_8(self.html() if form == "html" else self.json_text()))

    def __repr__(self) -> str:
        return f"<View of {self.answer!r}>"

    def _in_notebook(self) -> dict[str, str]:
        """Give what a notebook shows by media type: the page, in a frame of its own."""
        page = self.answer.view()._replace(data=self.json_dict())
        return {"text/plain": repr(self), "text/html": page.frame()}


@question(
    GOALS,
    OBJECTIVES,
    CONTAINERS,
    *ITEMS,
    *HOW,
    help_="""
    \b
    foon-asp view --goal macaroni -o macaroni.html
    foon-asp view --goal 'greek salad' --objective success -o salad.html

    The file is whole in itself: open it in any browser, with no network. It shows the best tree and walks
    through it step by step.

    Exits with 0 when the tree is proved optimal, and otherwise as `solve` does.
    """,
    formats=("html", "json"),
    suffixes={".html": "html", ".htm": "html", ".json": "json"},
)
def view(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
) -> View:
    """Solve a problem, and show what was found on a page that any browser opens.

    Returns:
        The page: ``html()`` gives it, ``write`` writes it into a file, and a notebook shows it.

    Raises:
        UserError: for a wrong argument or constraint.

    Example:
        >>> foon_asp.view(foon_asp.load().problem("ice"))
        <View of <Answer: optimal by units (strict containers): 2 units, 6 inputs, success ≈ 0.644>>
    """
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    return View(answered(asked_with(problem, how), chosen, how))
