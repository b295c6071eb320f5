"""The best tree for a problem, and what is proved of it."""

from collections.abc import Iterable

from foon_asp.asp import Outcome, Status
from foon_asp.asp.soft import SoftOutcome
from foon_asp.questions.result import Ending, Result
from foon_asp.questions.tree import Tree
from foon_asp.report.answer import headline, outcome_dict, outcome_text
from foon_asp.report.drawing import Drawing
from foon_asp.report.notebook import picture_bundle
from foon_asp.report.soft import soft_json, soft_text
from foon_asp.report.tree_drawing import solved_tree


def of_status(status: Status) -> Ending:
    """Say how a question ended whose answer has a status."""
    return {
        Status.OPTIMAL: Ending.DONE,
        Status.INFEASIBLE: Ending.NEGATIVE,
        Status.FEASIBLE: Ending.LIMIT,
        Status.UNKNOWN: Ending.LIMIT,
    }[status]


class Answer(Result, Outcome):
    """The answer to one problem: an :class:`~foon_asp.Outcome` that shows itself.

    ``status`` says what is proved, ``costs`` what the tree costs, ``units`` are its units by id in an order
    that executes; :attr:`tree` has them as values.
    """

    __slots__ = ()

    @property
    def tree(self) -> Tree | None:
        """The tree, in an order that executes; ``None`` where there is none."""
        return None if self.units is None else Tree.of(self.problem, self.units, headline(self))

    @property
    def ending(self) -> Ending:
        """Done when the tree is proved to be the best."""
        return of_status(self.status)

    def text(self) -> str:
        """Give the answer as ``foon-asp solve`` does."""
        return outcome_text(self)

    def json_dict(self) -> object:
        """Give the answer as ``foon-asp solve --format json`` does; docs/json.md describes it."""
        return outcome_dict(self)

    def drawing(self) -> Drawing | None:
        """Give what the picture shows."""
        return None if self.units is None else solved_tree(self, self.units)

    def _repr_mimebundle_(
        self, include: Iterable[str] | None = None, exclude: Iterable[str] | None = None
    ) -> dict[str, str]:
        """Give what a notebook shows: the picture, whose caption says what is proved, or the text."""
        drawing = self.drawing()
        return super()._repr_mimebundle_() if drawing is None else picture_bundle(self, drawing)


class SoftAnswer(Result, SoftOutcome):
    """The answer under constraints that may be broken at a price.

    ``penalty`` is what the tree of ``outcome`` pays, ``constraints`` says for each how often it is broken.
    """

    __slots__ = ()

    @property
    def outcome(self) -> Answer:
        """The best tree among those with the least penalty."""
        return Answer._make(super().outcome)

    def text(self) -> str:
        """Give the answer as ``foon-asp solve --soft`` does."""
        return soft_text(self)

    def json_text(self) -> str:
        """Give the answer as ``foon-asp solve --soft --format json`` does."""
        return soft_json(self)

    def drawing(self) -> Drawing | None:
        """Give what the picture shows."""
        return self.outcome.drawing()
