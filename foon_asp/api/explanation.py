"""Why there is no tree."""

from foon_asp.explain import why_not as explain
from foon_asp.foon import Foon
from foon_asp.problem import Problem
from foon_asp.questions.result import Result
from foon_asp.report.explanation import explanation_json, explanation_text


class Explanation(Result, explain.Explanation):
    """Why some goals cannot be made, or that all can.

    ``goals`` are those that cannot, ``roots`` what is behind it (each with its ``object``, ``cause``,
    ``stops``, ``cycle`` and ``near`` names), ``dead_ends`` everything that cannot be had; by id, as places in
    ``problem.network.objects``. ``json()`` has names.
    """

    __slots__ = ()

    @property
    def tree_exists(self) -> bool:
        """Whether there is a tree, so that nothing has to be explained."""
        return not self.goals

    def text(self) -> str:
        """Give the explanation as ``foon-asp why-not`` does."""
        return explanation_text(self)

    def json_text(self) -> str:
        """Give the explanation as ``foon-asp why-not --format json`` does."""
        return explanation_json(self)


def why_not(problem: Problem) -> Explanation:
    """Explain why there is no task tree, constraints left aside; :func:`foon_asp.clash` is about those.

    Takes time about linear in the network, which of a store is read as a whole.
    """
    asked = problem.whole
    items = Foon.of(asked).dataset.data.kitchen_items
    return Explanation._make(explain.why_not(asked, items))
