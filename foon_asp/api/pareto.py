"""What one objective costs by another: the Pareto front."""

from fractions import Fraction
from pathlib import Path

from foon_asp.dataset.paths import File, Files
from foon_asp.explain import pareto as explain
from foon_asp.problem import Problem
from foon_asp.questions.arguments import Constants, Objectives, asked_with, chosen_objectives, settings
from foon_asp.questions.caller import caller
from foon_asp.questions.result import NothingToDrawError, Result
from foon_asp.questions.tree import Tree
from foon_asp.report.answer import costs_text
from foon_asp.report.pareto import front_json, front_text


class Front(Result, explain.Front):
    """Trees none of which is as good as another by every objective and better by one.

    ``points`` has for each its ``units`` by id and its ``costs``, in order of the first objective;
    :attr:`task_trees` has them as values. ``complete`` says that none is missing.
    """

    __slots__ = ()

    @property
    def values(self) -> tuple[tuple[int | Fraction, ...], ...]:
        """Where the points stand: for each its measure by every objective, exact."""
        return tuple(map(self.measures, self.points))

    @property
    def task_trees(self) -> tuple[Tree, ...]:
        """The trees as values, in the same order."""
        found = enumerate(self.points, 1)
        return tuple(
            Tree.of(self.problem, tree.units, f"point {number}: {costs_text(tree.costs)}")
            for number, tree in found
        )

    def text(self) -> str:
        """Give the front as ``foon-asp pareto`` does."""
        return front_text(self)

    def json_text(self) -> str:
        """Give the front as ``foon-asp pareto --format json`` does."""
        return front_json(self)

    def write_chart(self, file: File) -> None:
        """Draw the front into a file, SVG or PNG by its suffix.

        Raises :class:`UserError` where there is no point to draw, for another suffix, and without the
        packages of ``foon-asp[pictures]``.
        """
        from foon_asp.report.front_chart import write_front_chart  # noqa: PLC0415 - charts are seldom asked for

        if not self.points:
            raise NothingToDrawError("there is no point to draw")
        write_front_chart(self, Path(file))


def pareto(
    problem: Problem,
    objectives: Objectives = ("units", "success"),
    *,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
) -> Front:
    """Find the whole Pareto front of two or three objectives, with a tree for every point.

    ``time_limit`` is for all of it. Otherwise as :func:`foon_asp.solve`.
    """
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    return Front._make(explain.pareto_front(asked_with(problem, how), chosen, how, caller().reporter))
