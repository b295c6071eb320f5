"""What else: all optimal trees, the next best, or those that differ most."""

from collections.abc import Iterable
from fractions import Fraction

from foon_asp.dataset.paths import File, Files
from foon_asp.errors import UserError
from foon_asp.explain import alternatives as explain
from foon_asp.problem import Problem
from foon_asp.questions.arguments import (
    Constants,
    Objectives,
    asked_with,
    at_least,
    chosen_objectives,
    settings,
)
from foon_asp.questions.caller import caller
from foon_asp.questions.result import Result
from foon_asp.questions.tree import Tree
from foon_asp.report.alternatives import alternatives_json, alternatives_text
from foon_asp.report.answer import costs_text
from foon_asp.report.drawing import Drawing
from foon_asp.report.notebook import page_bundle

_PICTURES = 4  # that a notebook shows


class Alternatives(Result, explain.Alternatives):
    """Trees in order of their costs, the optimal ones first; none holds another.

    ``trees`` has for each its ``units`` by id and its ``costs``; :attr:`task_trees` has them as values.
    ``complete`` says that no tree that was asked for is left out. ``optimal`` are the trees as good as the
    first; ``in_every`` and ``in_some`` are the units, by id, that all or some of those have.
    """

    __slots__ = ()

    @property
    def task_trees(self) -> tuple[Tree, ...]:
        """The trees as values, in the same order."""
        found = enumerate(self.trees, 1)
        return tuple(
            Tree.of(self.problem, tree.units, f"tree {number}: {costs_text(tree.costs)}")
            for number, tree in found
        )

    def text(self) -> str:
        """Give the trees as ``foon-asp alternatives`` does."""
        return alternatives_text(self)

    def json_text(self) -> str:
        """Give the trees as ``foon-asp alternatives --format json`` does."""
        return alternatives_json(self)

    def drawing(self) -> Drawing | None:
        """Give what the picture of the first tree shows."""
        return self.task_trees[0].drawing() if self.trees else None

    def _repr_mimebundle_(
        self, include: Iterable[str] | None = None, exclude: Iterable[str] | None = None
    ) -> dict[str, str]:
        """Give what a notebook shows: the text, and the pictures of the first trees."""
        return page_bundle(self, (tree.drawing() for tree in self.task_trees[:_PICTURES]))


def alternatives(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    best: int | None = None,
    different: int | None = None,
    within: int = 0,
    limit: int = 100,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
) -> Alternatives:
    """Find all optimal trees; or with ``best`` so many of the best; or with ``different`` so unlike ones.

    With ``different``, so many trees are chosen that differ most, among those whose first objective is worse
    by no more than ``within`` percent. At most ``limit`` trees are looked at. Otherwise as
    :func:`foon_asp.solve`.
    """
    if best is not None and different is not None:
        raise UserError("best and different ask for different things; give one of them")
    if within and different is None:
        raise UserError("within goes with different")
    worse = Fraction(at_least(within, 0, "within"), 100)
    at_least(limit, 1, "limit")
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    asked = asked_with(problem, how)
    if best is not None:
        found = explain.best_trees(asked, chosen, how, at_least(best, 1, "best"), caller().reporter)
    elif different is not None:
        count = at_least(different, 2, "different")
        found = explain.most_different(asked, chosen, how, count, worse, limit, caller().reporter)
    else:
        found = explain.all_optimal(asked, chosen, how, limit, caller().reporter)
    return Alternatives._make(found)
