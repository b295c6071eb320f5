"""Several goals by one tree, beside a tree for each."""

from foon_asp.dataset.paths import File, Files
from foon_asp.errors import UserError
from foon_asp.explain import menu as explain
from foon_asp.problem import Problem
from foon_asp.questions.answer import Answer
from foon_asp.questions.arguments import Constants, Objectives, asked_with, chosen_objectives, settings
from foon_asp.questions.caller import caller
from foon_asp.questions.result import Result
from foon_asp.report.answer import headline
from foon_asp.report.drawing import Drawing
from foon_asp.report.menu import menu_json, menu_text


class Menu(Result, explain.Menu):
    """A tree for all goals, and one for each, in the order of the goals.

    ``serves`` gives for each unit of the tree for all, by id, the goals that need it; ``shared`` are the
    units that serve several; :meth:`sum_of_separate` adds up what the trees cost one by one.
    """

    __slots__ = ()

    @property
    def together(self) -> Answer:
        """The best tree that makes all goals."""
        return Answer._make(super().together)

    @property
    def separate(self) -> tuple[Answer, ...]:
        """The best tree for each goal."""
        return tuple(map(Answer._make, super().separate))

    def text(self) -> str:
        """Give the menu as ``foon-asp menu`` does."""
        return menu_text(self)

    def json_text(self) -> str:
        """Give the menu as ``foon-asp menu --format json`` does."""
        return menu_json(self)

    def drawing(self) -> Drawing | None:
        """Give what the picture of the tree for all shows."""
        return self.together.drawing()

    def __repr__(self) -> str:
        return f"<Menu of {len(self.separate)}: {headline(self.together)}>"


def menu(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
) -> Menu:
    """Solve a problem with several goals by one tree, and goal by goal.

    ``time_limit`` is for each answer. Otherwise as :func:`foon_asp.solve`.
    """
    if len(problem.goals) < 2:
        raise UserError("a menu has several goals: foon.problem(FIRST, SECOND, ...)")
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    return Menu._make(explain.menu(asked_with(problem, how), chosen, how, caller().reporter))
