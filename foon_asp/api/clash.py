"""Which constraints cannot hold together, and which to drop."""

from collections.abc import Mapping

from foon_asp.dataset.paths import File, Files
from foon_asp.errors import UserError
from foon_asp.explain import clash as explain
from foon_asp.problem import Problem
from foon_asp.questions.answer import Answer
from foon_asp.questions.arguments import Constants, Objectives, chosen_objectives, file_weights, settings
from foon_asp.questions.caller import caller
from foon_asp.questions.result import Result
from foon_asp.report.clash import clash_json, clash_text
from foon_asp.report.drawing import Drawing


class Clash(Result, explain.Clash):
    """Whether the constraints of a question leave a tree, and if not, why.

    ``smallest`` is a smallest set of ``constraints`` that cannot hold together, ``proved`` to be one;
    ``dropped`` is the cheapest set to drop. Both are empty where the constraints leave a tree. Each
    constraint has its ``source``, ``text`` and ``constants``.
    """

    __slots__ = ()

    @property
    def outcome(self) -> Answer | None:
        """The best tree without what is dropped; ``None`` where there is none, or a limit came first."""
        outcome = super().outcome
        return None if outcome is None else Answer._make(outcome)

    def text(self) -> str:
        """Give the clash as ``foon-asp clash`` does."""
        return clash_text(self)

    def json_text(self) -> str:
        """Give the clash as ``foon-asp clash --format json`` does."""
        return clash_json(self)

    def drawing(self) -> Drawing | None:
        """Give what the picture of the tree shows."""
        return None if self.outcome is None else self.outcome.drawing()


def clash(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    constraints: Files,
    weights: Mapping[File, int] | None = None,
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
) -> Clash:
    """Find a smallest set of constraints that cannot hold together, and the cheapest ones to drop.

    Every rule without a head in the files of ``constraints`` is a constraint of its own; ``weights`` says
    what it costs to drop one of a file, else 1. Of a store, the whole network is read. Otherwise as
    :func:`foon_asp.solve`.
    """
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    if not how.constraints:
        raise UserError("name constraints; why_not explains other reasons")
    found = explain.find_clash(problem.whole, chosen, how, file_weights(weights or {}), caller().reporter)
    return Clash._make(found)
